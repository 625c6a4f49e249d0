"""Virtual test rig: what goes in as a curve comes back from the solver as a force.

Run it with: python gallery/test_rig.py

Strip tension along warp and weft, picture frame, bias extension, pure bending and a cantilever of a
woven fabric, each on an unstructured mesh; docs/charts/test_rig.svg and .csv. A line is the input,
dots are what the supports of the solved sheet push back with.
"""

from __future__ import annotations

import csv
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).parents[1]
CHARTS = ROOT / "docs" / "charts"
sys.path.insert(0, str(ROOT / "tests"))

import matplotlib  # noqa: E402

matplotlib.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402

from seatlook.model import Curve, Fabric  # noqa: E402
from seatlook.solver import Load, Sheet, SheetSettings, Support, solve_sheet  # noqa: E402
from support import (  # noqa: E402
    fabrics,
    meshes,
)
from support.reference.elastica import hanging_tip  # noqa: E402

BACK = {
    "warp_unloading": Curve(strain=[0.0, 0.01, 0.03], stiffness=[1500.0, 6000.0, 12000.0]),
    "weft_unloading": Curve(strain=[0.0, 0.02, 0.04], stiffness=[900.0, 2500.0, 6000.0]),
}
TIGHT = SheetSettings(tolerance=1e-8)
Row = tuple[str, float, float, float]  # test, abscissa, input, solver


def tension_at(curve: Curve, strain: float) -> float:
    """Tension [N/m] (second Piola-Kirchhoff) of a curve at a Green strain."""
    fine = np.linspace(0.0, strain, 2001)
    return float(np.trapezoid(np.interp(fine, curve.strain, curve.stiffness), fine))


def strain_at(curve: Curve, tension: float) -> float:
    """Green strain at which a curve reaches a tension."""
    low, high = 0.0, 1.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if tension_at(curve, middle) < tension else (low, middle)
    return low


def square(h: float = 0.1) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Unstructured unit square (m), flat."""
    X, T = meshes.rectangle("uns", 1.0, 1.0, h)
    return X, T, np.pad(X, ((0, 0), (0, 1)))


def tension(axis: int) -> list[Row]:
    """Pull a strip between clamps that let it contract, and let it back; force over stretch."""
    fabric, rows = plain(**BACK), []
    X, T, flat = square()
    low, high = X[:, axis] < 1e-9, X[:, axis] > 1 - 1e-9
    fixed = np.zeros((len(X), 3), dtype=bool)
    fixed[:, 2] = True
    fixed[low | high, axis] = True
    fixed[np.flatnonzero(low)[0], 1 - axis] = True
    name = ("warp", "weft")[axis]
    out, back = getattr(fabric, name), getattr(fabric, f"{name}_unloading")
    before, peak = None, 0.5 * (1.08**2 - 1.0)
    start = strain_at(back, tension_at(out, peak))
    for stretch in (*np.linspace(1.01, 1.08, 8), *np.linspace(1.074, 1.05, 5)):
        target = flat.copy()
        target[:, axis] *= stretch
        solved = solve_sheet(Sheet(X, T, fabric), start=before, settings=TIGHT, strict=True,
                             support=Support(fixed=fixed, prescribed=target))  # fmt: skip
        came_back = before is not None and before.positions[high, axis][0] > stretch
        before = solved
        force = solved.reactions[high, axis].sum()
        E = 0.5 * (stretch**2 - 1.0)
        given = tension_at(back, E - peak + start) if came_back else tension_at(out, E)
        rows.append((f"strip tension, {name}", E, given, force / stretch))
    return rows


def picture_frame() -> list[Row]:
    """Shear a square by its rim, sides as long as before; mean shear stress over the shear."""
    fabric, rows = plain(), []
    X, T, flat = square()
    rim = ((X < 1e-9) | (X > 1 - 1e-9)).any(axis=1)
    fixed = np.stack([rim, rim, np.ones_like(rim)], axis=1)  # kept flat: it would wrinkle
    for angle in np.linspace(0.02, 0.3, 8):
        # Sides stay as long: warp and weft are not stretched.
        target = flat.copy()
        target[:, 0] = X[:, 0] * np.cos(0.5 * angle) + X[:, 1] * np.sin(0.5 * angle)
        target[:, 1] = X[:, 0] * np.sin(0.5 * angle) + X[:, 1] * np.cos(0.5 * angle)
        solved = solve_sheet(Sheet(X, T, fabric), settings=TIGHT, strict=True,
                             support=Support(fixed=fixed, prescribed=target))  # fmt: skip
        shear = np.sin(angle)
        stress = float(solved.sheet.membrane.stress(solved.positions)[:, 2].mean())
        rows.append(("picture frame", shear, tension_at(fabric.shear, shear), stress))
    return rows


def bias_extension() -> list[Row]:
    """Pull a square cut at 45 degrees, free to contract and shear evenly; force per width."""
    fabric, rows = plain(), []
    X, T, _ = square()
    turn = np.sqrt(0.5) * np.array([[1.0, 1.0], [-1.0, 1.0]])
    rest = X @ turn.T
    flat = np.pad(rest, ((0, 0), (0, 1)))
    along = np.array([*(turn @ [1.0, 0.0]), 0.0])
    rim = ((X < 1e-9) | (X > 1 - 1e-9)).any(axis=1)
    for stretch in np.linspace(1.005, 1.04, 8):
        a, b = uniform_bias(fabric, stretch)
        F = np.outer(along[:2], along[:2]) * (a - b) + b * np.eye(2)
        target = flat.copy()
        target[:, :2] = rest @ F.T
        solved = solve_sheet(Sheet(rest, T, fabric), settings=TIGHT, strict=True,
                             support=Support(fixed=rim, prescribed=target))  # fmt: skip
        right = (X[:, 0] > 1 - 1e-9) & (X[:, 1] > 1e-9) & (X[:, 1] < 1 - 1e-9)
        ends = (X[:, 0] > 1 - 1e-9) & ~right
        # The rim's sides carry nothing, so that corner forces belong to the pulled edge.
        force = float((solved.reactions[right | ends] @ along).sum())
        rows.append(("bias extension", a - 1.0, bias_force(fabric, a, b), force))
    return rows


def bias_force(fabric: Fabric, a: float, b: float) -> float:
    """Force per width of a bias strip stretched by ``a`` and contracted to ``b``, by the curves."""
    E = 0.25 * (a * a + b * b) - 0.5
    normal = 0.5 * (tension_at(fabric.warp, E) + tension_at(fabric.weft, E))
    return a * (normal + tension_at(fabric.shear, 0.5 * (a * a - b * b)))


def uniform_bias(fabric: Fabric, a: float) -> tuple[float, float]:
    """Stretch and contraction (a, b) at which a bias strip has no transverse stress."""
    low, high = 0.8, 1.0
    for _ in range(60):
        b = 0.5 * (low + high)
        E = 0.25 * (a * a + b * b) - 0.5
        normal = 0.5 * (slack(fabric.warp, E) + slack(fabric.weft, E))
        low, high = (
            (low, b) if normal > tension_at(fabric.shear, 0.5 * (a * a - b * b)) else (b, high)
        )
    return a, b


def slack(curve: Curve, strain: float) -> float:
    """Tension of a curve that answers compression with its first stiffness."""
    return tension_at(curve, strain) if strain > 0.0 else float(curve.stiffness[0]) * strain


def plain(**change: object) -> Fabric:
    """The tests' woven fabric, uncoupled and as stiff in compression."""
    woven = fabrics.woven(compression_ratio=1.0)
    return Fabric(**{name: getattr(woven, name) for name in Fabric.__dataclass_fields__}
                  | {"poisson": 0.0} | change)  # fmt: skip


def bending() -> list[Row]:
    """Hold both ends of a strip on a circle; the moment halfway, where the sheet is free."""
    rows = []
    X, T = meshes.rectangle("uns", 1.0, 0.2, 0.05)
    fabric = fabrics.isotropic(12.0e4, 1.0, thickness=0.01)
    ends = np.abs(X[:, 0] - 0.5) > 0.44
    middle = np.abs(X[T].mean(axis=1)[:, 0] - 0.5) < 0.2
    for k in np.linspace(0.25, 2.0, 8):
        x = np.column_stack([np.sin(k * X[:, 0]) / k, X[:, 1], (1 - np.cos(k * X[:, 0])) / k])
        solved = solve_sheet(Sheet(X, T, fabric), start=x, support=Support(fixed=ends), strict=True)
        kappa = solved.sheet.curvatures(solved.positions)[middle, 0, 0].mean()
        rows.append(("pure bending", k, -k, kappa * fabric.bending_warp))
    return rows


def cantilever() -> list[Row]:
    """Tip depth of a hanging strip against the extensible elastica."""
    rows = []
    X, T = meshes.rectangle("uns", 1.0, 0.2, 0.05)
    fabric = fabrics.isotropic(12.0 / 0.02**2, 1.0, density=1.0, thickness=0.02)
    for gamma in (0.5, 1.0, 2.0, 5.0, 10.0, 20.0):
        solved = solve_sheet(Sheet(X, T, fabric), support=Support(clamped=X[:, 0] < 1e-9),
                             load=Load(gravity=(0, 0, -gamma)), strict=True)  # fmt: skip
        tip = solved.positions[X[:, 0] > 1 - 1e-9, 2].mean()
        rows.append(("cantilever", gamma, -hanging_tip(gamma, 0.02)[1], -tip))
    return rows


LABELS = {
    "strip tension, warp": ("Green strain", "S11 [N/m]"),
    "strip tension, weft": ("Green strain", "S22 [N/m]"),
    "picture frame": ("2 E12", "S12 [N/m]"),
    "bias extension": ("stretch - 1", "force per width [N/m]"),
    "pure bending": ("curvature x L", "moment / (B / L)"),
    "cantilever": ("q L³ / B", "depth of the tip / L"),
}


def main() -> None:
    """Run all tests, write table and picture, print the largest error of each."""
    rows = [*tension(0), *tension(1), *picture_frame(), *bias_extension(), *bending(),
            *cantilever()]  # fmt: skip
    CHARTS.mkdir(exist_ok=True)
    with (CHARTS / "test_rig.csv").open("w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(("test", "abscissa", "input", "solver"))
        table.writerows((name, *(f"{v:.6g}" for v in values)) for name, *values in rows)
    figure, axes = plt.subplots(2, 3, figsize=(11, 6.5), layout="constrained")
    for axis, (name, (across, up)) in zip(axes.flat, LABELS.items(), strict=True):
        x, given, got = np.array([row[1:] for row in rows if row[0] == name]).T
        worst = np.abs(got / given - 1.0).max()
        print(f"{name}: largest error {100 * worst:.3g} %")
        axis.plot(x, given, label="input")
        axis.plot(x, got, "o", mfc="none", label=f"solver, within {100 * worst:.2g} %")
        axis.set(title=name, xlabel=across, ylabel=up)
        axis.legend()
    figure.savefig(CHARTS / "test_rig.svg")


if __name__ == "__main__":
    main()
