"""Work-precision diagrams: error against CPU seconds, for elements, methods and counter-examples.

Run it with: python gallery/work_precision.py

Rows are kept in docs/charts/work_precision.csv as they are finished and not run again; delete a row
to repeat it. Covers come from gallery/scaling.py, other programs from gallery/peers.py. All run on
one thread, the compiled kernels' cache warm; times include the set-up of the element.
"""

from __future__ import annotations

import csv
import sys
import time
from collections import defaultdict
from collections.abc import Callable, Iterator
from functools import cache, partial
from itertools import product
from pathlib import Path

import numpy as np

ROOT = Path(__file__).parents[1]
CHARTS = ROOT / "docs" / "charts"
TABLE = CHARTS / "work_precision.csv"
sys.path.insert(0, str(ROOT / "tests"))

import matplotlib  # noqa: E402

matplotlib.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402

from seatlook.solver import Load, Sheet, SheetSettings, Support, solve_sheet  # noqa: E402
from seatlook.solver.element.loads import DeadLoad  # noqa: E402
from seatlook.solver.methods.newton import Potential  # noqa: E402
from seatlook.solver.process.statics import equilibrium  # noqa: E402
from support import (  # noqa: E402
    fabrics,
    meshes,
)
from support.reference.buckling import threshold  # noqa: E402
from support.reference.counter_examples import position_based, sheet_of  # noqa: E402
from support.reference.elastica import hanging_tip  # noqa: E402
from support.reference.morley import MorleySheet  # noqa: E402
from support.reference.stretched import WAVE, stretched, wave_and_amplitude  # noqa: E402

COLUMNS = ("panel", "series", "parameter", "seed", "cpu_seconds", "error")
Case = tuple[str, str, float, int, Callable[[], float]]
SEEDS = (0, 1, 2)
ELEMENTS = ("edgeslope", "hinge", "patch6", "morley")
GAMMA, SLENDERNESS, WIDTH = 10.0, 0.02, 0.2
NAMES = {
    "morley": "Morley (slopes unknown)",
    "morley, newton": "Morley, Newton",
    "lbfgs": "L-BFGS",
    "newton": "Newton",
    "explicit": "explicit, masses scaled",
}
TITLES = {
    "threshold": "Threshold: buckling load of a sheet on springs\n(4 to 16 edges per wave, exact)",
    "tension": "The same, pulled across the wave by 2 kN/m\n(6 to 16 edges per wave, exact)",
    "equilibrium": "Equilibrium: tip of a hanging strip, Γ = 10, t/L = 0.02\n"
    "(5 to 40 edges, elastica)",
    "stretched": "Wrinkles of a stretched clamped sheet: wave length\n"
    "(uns, h 5, 3.5, 2.5 mm; 1: no train of waves; fine aligned grid)",
    "cover": "Cover of the demo seat, sewn, hooked, at rest\n(20 to 5 mm; mean W2 against 3.5 mm)",
}


def cases() -> Iterator[Case]:
    """Yield panel, series, parameter, seed and what returns the error."""
    for element, edges, seed in product(ELEMENTS, (4, 6, 8, 12, 16), SEEDS):
        call = partial(threshold, element, "uns", edges, seed=seed)
        yield "threshold", element, edges, seed, call
        if edges >= 6:
            yield "tension", element, edges, seed, partial(call, tension=2000.0)
    for method in ("newton", "lbfgs", "explicit"):
        for edges in (5, 10, 20, 40) if method != "explicit" else (5, 10, 20):
            yield "equilibrium", method, edges, 0, partial(strip_error, method, edges)
    for element in ELEMENTS[1:]:
        for edges in (5, 10, 20):
            call = partial(counter_strip_error, element, edges)
            yield "equilibrium", f"{element}, newton", edges, 0, call
    for sweeps in (100, 1000, 10_000):
        yield "equilibrium", "XPBD, 10 edges", sweeps, 0, partial(position_error, sweeps)
    yield from wrinkles()


def wrinkles() -> Iterator[Case]:
    """The same of the stretched sheet; Morley's plate would want a right start of its slopes."""
    for element in ELEMENTS[:3]:
        for h in (5.0, 3.5, 2.5) if element == "edgeslope" else (5.0, 3.5):
            for seed in SEEDS if element == "edgeslope" else SEEDS[:1]:
                yield "stretched", element, h, seed, partial(wave_error, element, h, seed)


def strip(edges: int, kind: str) -> tuple[np.ndarray, np.ndarray, object]:
    """Mesh and fabric of a strip with L = 1 and B = 1."""
    X, T = meshes.rectangle(kind, 1.0, WIDTH, 1.0 / edges)
    fabric = fabrics.isotropic(12.0 / SLENDERNESS**2, 1.0, density=1.0, thickness=SLENDERNESS)
    return X, T, fabric


def tip_error(X: np.ndarray, x: np.ndarray) -> float:
    """Distance of the tip from the extensible elastica's, over the length."""
    tip = x[X[:, 0] > X[:, 0].max() - 1e-9].mean(axis=0)
    exact = reference()
    return float(np.hypot(tip[0] - exact[0], tip[2] - exact[1]))


@cache
def reference() -> tuple[float, float]:
    """Tip of the extensible elastica, solved once."""
    return hanging_tip(GAMMA, SLENDERNESS)


def strip_error(method: str, edges: int) -> float:
    """The product's element by one of its methods."""
    X, T, fabric = strip(edges, "uns")
    solved = solve_sheet(
        Sheet(X, T, fabric),
        support=Support(clamped=X[:, 0] < 1e-9),
        load=Load(gravity=(0, 0, -GAMMA)),
        settings=SheetSettings(method=method, tolerance=5e-4),
    )
    return tip_error(X, solved.positions) if solved.converged else float("nan")


def counter_strip_error(element: str, edges: int) -> float:
    """Other elements on a regular mesh, mirrored about the clamp, which so adds no error."""
    X, T = meshes.rectangle("right", 2.0, WIDTH, 1.0 / edges)
    X = X - [1.0, 0.0]
    fabric = strip(edges, "right")[2]
    x = np.pad(X, ((0, 0), (0, 1)))
    if element == "morley":
        sheet = MorleySheet(X, T, fabric)
        x = sheet.flat(x)
    else:
        sheet = sheet_of(element, X, T, fabric)
    held = np.zeros(x.shape, dtype=bool)
    held[: len(X)] = np.abs(X[:, :1]) < 1e-9
    weight = DeadLoad(np.outer(sheet.mass, (0, 0, -GAMMA)))
    potential = Potential(sheet.energies, [weight], ~held)
    found = equilibrium(sheet, potential, x, "newton", tolerance=5e-4, max_iterations=None)
    return tip_error(X, found.x[: len(X)]) if found.residual <= 5e-4 else float("nan")


def wave_error(element: str, h_mm: float, seed: int) -> float:
    """Wave length of a stretched sheet over the reference's, minus 1; 1 where there is no train."""
    wave, _ = wave_and_amplitude(*stretched("uns", 1e-3 * h_mm, seed=seed, element=element))
    return wave / WAVE - 1.0 if np.isfinite(wave) else 1.0


def position_error(sweeps: int) -> float:
    """Position-based dynamics with hinges, one long step from rest, mirrored as above."""
    X, T = meshes.rectangle("right", 2.0, WIDTH, 0.1)
    X = X - [1.0, 0.0]
    fabric, x = strip(10, "right")[2], np.pad(X, ((0, 0), (0, 1)))
    held = np.abs(X[:, 0]) < 1e-9
    moved = position_based(X, T, fabric, x, held, (0, 0, -GAMMA), dt=1.0, iterations=sweeps)
    return tip_error(X, moved)


def run_missing() -> None:
    """Run what the table lacks; a first, unkept run of each series compiles its kernels."""
    done = {tuple(row[c] for c in COLUMNS[:4]) for row in read(TABLE)}
    warm: set[str] = set()
    for panel, series, parameter, seed, error in cases():
        if (panel, series, str(parameter), str(seed)) in done:
            continue
        if series not in warm:
            warm.add(series)
            error()
        clock = time.process_time()
        value = error()
        row = (panel, series, parameter, seed, f"{time.process_time() - clock:.4f}", f"{value:.3g}")
        print(*row, flush=True)
        fresh = not TABLE.exists()
        with TABLE.open("a", newline="", encoding="utf-8") as file:
            out = csv.writer(file)
            if fresh:
                out.writerow(COLUMNS)
            out.writerow(row)


def read(path: Path) -> list[dict[str, str]]:
    """Return the rows of a table, none if there is no file."""
    if not path.exists():
        return []
    with path.open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


def covers() -> list[dict[str, str]]:
    """Rows of the demo cover by size and seed, their error against the finest."""
    rows = [row for row in read(CHARTS / "scaling.csv") if row["status"] == "converged"]
    if not rows:
        return []
    finest = min(rows, key=lambda row: float(row["element_size_mm"]))
    return [
        {"panel": "cover", "series": "lbfgs", "parameter": row["element_size_mm"],
         "seed": row["seed"], "cpu_seconds": row["cpu_seconds"],
         "error": f"{float(row['w2_mean']) / float(finest['w2_mean']) - 1.0:.4g}"}
        for row in rows if row["element_size_mm"] != finest["element_size_mm"]
    ]  # fmt: skip


def draw(path: Path) -> None:
    """Draw the diagrams; bars span the seeds."""
    figure, axes = plt.subplots(2, 3, figsize=(16, 8.5), layout="constrained")
    axes.flat[-1].set_axis_off()
    rows = [*read(TABLE), *read(CHARTS / "peers.csv"), *covers()]
    series = list(dict.fromkeys(row["series"] for row in rows))
    looks = {name: look(name, number) for number, name in enumerate(series)}
    for axis, (panel, title) in zip(axes.flat, TITLES.items(), strict=False):
        for name in series:
            mine = [row for row in rows if (row["panel"], row["series"]) == (panel, name)]
            if mine:
                t, error, spread = averages(mine)
                axis.errorbar(t, error, yerr=spread, **looks[name])
        axis.set(xscale="log", yscale="log", title=title, xlabel="CPU s, 1 thread",
                 ylabel="relative error")  # fmt: skip
        low, high = np.log10(axis.get_xlim())
        axis.set_xlim(10.0 ** np.floor(low), 10.0 ** np.ceil(high))
        axis.grid(alpha=0.3, which="both")
        if panel != "equilibrium":
            axis.legend(fontsize=8)
    lines = axes.flat[list(TITLES).index("equilibrium")].get_legend_handles_labels()
    axes.flat[-1].legend(*lines, loc="upper left", title="Equilibrium")
    figure.suptitle("Error against work; dashed: counter-examples; dotted: other programs")
    figure.savefig(path)


def averages(rows: list[dict[str, str]]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Mean time and error of every size, and how far the seeds lie below and above."""
    sizes: dict[str, list[tuple[float, float]]] = defaultdict(list)
    for row in rows:
        sizes[row["parameter"]].append((float(row["cpu_seconds"]), abs(float(row["error"]))))
    values = [np.array(pairs) for pairs in sizes.values()]
    t, error = np.array([v.mean(axis=0) for v in values]).T
    low, high = (np.array([f(v[:, 1]) for v in values]) for f in (np.min, np.max))
    return t, error, np.maximum([error - low, high - error], 0.0)


def look(name: str, number: int) -> dict[str, object]:
    """Colour, line and label of a series."""
    line = "--" if name.startswith(("hinge", "patch6", "XPBD")) else "-"
    line = ":" if name.startswith(("CalculiX", "MuJoCo")) else line
    marker = "s" if line == ":" else "o"
    return {"ls": line, "marker": marker, "capsize": 3, "color": plt.get_cmap("tab20")(number),
            "label": NAMES.get(name, name)}  # fmt: skip


if __name__ == "__main__":
    run_missing()
    draw(CHARTS / "work_precision.svg")
