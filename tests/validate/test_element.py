"""The element against closed forms, every bar with its measured value printed (``-s``)."""

import numpy as np
import pytest
from scipy.sparse.linalg import eigsh

from seatlook.model import Curve, Fabric
from seatlook.solver import Load, Sheet, SheetSettings, Support, solve_sheet
from seatlook.solver.element.elastic import ElasticSheet
from support import fabrics, meshes
from support.reference import annulus
from support.reference.elastica import hanging_tip
from support.reference.rim_layer import rim_stiffness
from support.reference.rolled import missed
from support.reference.waves import (
    false_bending,
    flat,
    lateral_load,
    normal_part,
    sine_curvature_error,
    winkler_load,
)

pytestmark = pytest.mark.validate
FAIR = ("uns", "right", "sliver")


@pytest.fixture
def report(capsys):
    def show(text):
        with capsys.disabled():
            print(f"\n    {text}", end="")

    return show


def hanging(kind, gamma, slenderness, edges, width=0.2):
    """Tip error / L, sideways drift / L."""
    X, T = meshes.rectangle(kind, 1.0, width, 1.0 / edges)
    fabric = fabrics.isotropic(12.0 / slenderness**2, 1.0, density=1.0, thickness=slenderness)
    solved = solve_sheet(
        Sheet(X, T, fabric),
        support=Support(clamped=X[:, 0] < 1e-9),
        load=Load(gravity=(0, 0, -gamma)),
        settings=SheetSettings(tolerance=1e-5),
        strict=True,
    )
    tip = solved.positions[X[:, 0] > 1 - 1e-9].mean(axis=0)
    x, z = hanging_tip(gamma, slenderness)
    return np.hypot(tip[0] - x, tip[2] - z), abs(tip[1] - 0.5 * width)


@pytest.mark.parametrize("kind", FAIR)
@pytest.mark.parametrize("gamma", [1.0, 10.0, 100.0])
@pytest.mark.parametrize("slenderness", [0.02, 0.002])
def test_elastica(kind, gamma, slenderness, report):
    edges = np.array([10, 20, 40])
    errors, drift = zip(*[hanging(kind, gamma, slenderness, n) for n in edges], strict=True)
    rate = -np.polyfit(np.log(edges), np.log(errors), 1)[0]
    report(f"tip {errors[0]:.5f} {errors[1]:.5f} {errors[2]:.5f} drift {drift[2]:.5f} {rate=:.2f}")
    assert errors[-1] <= 5e-4
    assert drift[-1] <= 1e-3
    # A strip as thick as 0.02 L keeps (t kappa)^2 / 12 between its theory and that of the line.
    if slenderness == 0.002:
        assert rate >= 1.8


@pytest.mark.parametrize("kind", ["uns", "right"])
def test_elastica_at_gamma_1000(kind, report):
    error, drift = hanging(kind, 1000.0, 0.002, 120, width=0.1)
    report(f"{kind}: tip {error:.5f} drift {drift:.5f}")
    assert error <= 3e-3
    assert drift <= 1e-3


@pytest.mark.parametrize("kind", FAIR)
def test_cantilever_with_a_load_at_its_end(kind, report):
    """Published shell benchmark (Sze, Liu and Lo 2004): P L^2 / E I = 4, no Poisson's ratio."""
    length, width, thickness, young, load = 10.0, 1.0, 0.1, 1.2e6, 4.0
    X, T = meshes.rectangle(kind, length, width, length / 20)
    fabric = fabrics.isotropic(
        young * thickness, young * thickness**3 / 12, 0.0, thickness=thickness
    )
    end = np.flatnonzero(X[:, 0] > length - 1e-9)
    end = end[np.argsort(X[end, 1])]
    half = 0.5 * np.diff(X[end, 1]) / width
    loads = np.zeros((len(X), 3))
    loads[end[:-1], 2] += load * half
    loads[end[1:], 2] += load * half
    solved = solve_sheet(
        Sheet(X, T, fabric),
        support=Support(clamped=X[:, 0] < 1e-9),
        load=Load(forces=loads),
        settings=SheetSettings(tolerance=1e-6),
        strict=True,
    )
    tip = solved.positions[end].mean(axis=0)
    report(f"{kind}: deflection {tip[2]:.4f} of 6.698, shortening {length - tip[0]:.4f} of 3.286")
    assert tip[2] == pytest.approx(6.698, rel=3e-3)
    assert length - tip[0] == pytest.approx(3.286, rel=3e-3)


@pytest.mark.parametrize("kind", FAIR)
@pytest.mark.parametrize(("edges", "bar"), [(8, 0.025), (12, 0.015), (16, 0.01)])
def test_winkler_load(kind, edges, bar, report):
    error = winkler_load(kind, edges)
    report(f"{kind} {edges} edges per wave: {error:+.4f}")
    assert abs(error) <= bar


@pytest.mark.parametrize("kind", meshes.KINDS)
def test_false_bending(kind, report):
    angles = (0.0, 20.0, 45.0, 80.0, 130.0)
    worst = [max((false_bending(kind, n, degrees=d) for d in angles), key=abs) for n in (8, 16)]
    report(f"{kind}: c of the worst of five directions {worst[0]:+.5f} {worst[1]:+.5f}")
    # The bar is that of unstructured meshes; where long edges all lie one way it is missed.
    assert max(map(abs, worst)) <= {"uns": 1e-4, "cross": 1e-3, "sliver": 3e-3}.get(kind, 2e-3)


@pytest.mark.parametrize("kind", meshes.KINDS)
@pytest.mark.parametrize("slenderness", [0.02, 0.05])
def test_lateral_buckling(kind, slenderness, report):
    # 13.0 and 13.3 are the values of these finite widths; 12.85 that of none.
    load = lateral_load(kind, slenderness, 4)
    report(f"{kind} W/L {slenderness}: {load:.3f}")
    assert load == pytest.approx({0.02: 12.85, 0.05: 13.33}[slenderness], rel=0.03)


@pytest.mark.parametrize("kind", meshes.KINDS)
def test_sine_sheet(kind, report):
    raw8, better8 = sine_curvature_error(kind, 8)
    raw16, better16 = sine_curvature_error(kind, 16)
    report(f"{kind}: raw {raw8:.3f} {raw16:.3f}, recovered {better8:.3f} {better16:.3f}")
    assert better8 <= 0.08
    assert better16 <= 0.04
    assert raw16 <= 0.08
    assert raw8 <= (0.16 if kind in ("alt", "sliver") else 0.15)


def half_space(sheet, X, modulus, waves):
    """Stiffness of an elastic half-space below, k E* / 2 for each cosine wave number k."""
    size = X.max(axis=0)
    weight = sheet.mass / sheet.mass.sum()
    i, j = (a.ravel() for a in np.meshgrid(np.arange(waves[0]), np.arange(waves[1])))
    k = np.hypot(i * np.pi / size[0], j * np.pi / size[1])
    modes = np.cos(np.outer(X[:, 0], i * np.pi / size[0]))
    modes *= np.cos(np.outer(X[:, 1], j * np.pi / size[1]))
    modes *= np.sqrt(np.where(i > 0, 2.0, 1.0) * np.where(j > 0, 2.0, 1.0))
    projected = weight[:, None] * modes
    return (projected * (0.5 * modulus * k * size.prod())) @ projected.T


@pytest.mark.parametrize("kind", ["uns", "right"])
def test_film_on_half_space(kind, report):
    thickness, film, foam = 1e-3, 1e6, 1e3
    stretch, bend = film * thickness, film * thickness**3 / 12
    wave = 2 * np.pi * thickness * (film / (3 * foam)) ** (1 / 3)
    X, T = meshes.rectangle(kind, 5 * wave, 0.5 * wave, wave / 12)
    # A free end would buckle at 0.6 of the load: ends are guided, as the cosines of the bed are.
    ends = (X[:, 0] < 1e-9) | (X[:, 0] > X[:, 0].max() - 1e-9)
    fabric = fabrics.isotropic(stretch, bend)
    sheet = ElasticSheet(X, T, np.zeros(len(T)), [fabric], clamped=ends)
    x = flat(X * [1 - 1e-4, 1.0])
    K = normal_part(sheet.membrane.hessian(x)) / sheet.membrane.stress(x)[0, 0]
    bed = half_space(sheet, X, foam, (40, 6))
    stiff = sheet.bending.stiffness().toarray() + bed
    stiff += 1e-9 * np.trace(stiff) / len(X) * np.eye(len(X))
    top, mode = eigsh(K, k=1, M=stiff, which="LA", v0=np.cos(7.0 * X[:, 0] / wave + 1.0))
    strain = 1 / top[0] / stretch
    axis = np.argsort(X[:, 0])
    line = axis[np.abs(X[axis, 1]) < 1e-9]
    x, z = X[line, 0], mode[line, 0]
    zero = x[:-1] - z[:-1] * np.diff(x) / np.diff(z)
    zero = zero[(z[:-1] * z[1:] < 0) & (x[:-1] > wave) & (x[:-1] < 4 * wave)]
    found = 2 * np.diff(zero).mean()
    critical = 0.25 * (3 * foam / film) ** (2 / 3)
    report(f"{kind}: wave {found / wave:.4f}, strain {strain / critical:.4f} of the closed form")
    assert found == pytest.approx(wave, rel=0.05)
    assert strain == pytest.approx(critical, rel=0.05)


@pytest.mark.parametrize("kind", ["uns", "sliver"])
@pytest.mark.parametrize("degrees", [0, 45, 90])
def test_bending_anisotropy(kind, degrees, report):
    Y, T = meshes.rectangle(kind, 1.0, 0.1, 1 / 40)
    a = np.radians(degrees)
    X = Y @ np.array([[np.cos(a), -np.sin(a)], [np.sin(a), np.cos(a)]]).T
    stiff = Curve.linear(12.0 * 3.0 / 0.02**2)
    fabric = Fabric(
        thickness=0.02,
        density=1.0,
        warp=stiff,
        weft=stiff,
        shear=Curve.linear(0.5 * stiff.stiffness[0]),
        bending_warp=3.0,
        bending_weft=1.0,
        bending_twist=0.5 * np.sqrt(3.0),
    )
    # Compliance along the strip: unit moment along it, twist left free.
    v = np.array([np.cos(a) ** 2, np.sin(a) ** 2, np.cos(a) * np.sin(a)])
    bend = 1 / (v @ np.linalg.solve(fabric.bending_matrix, v))
    solved = solve_sheet(
        Sheet(X, T, fabric),
        start=flat(Y),
        support=Support(clamped=Y[:, 0] < 1e-9),
        load=Load(gravity=(0, 0, -10.0)),
        settings=SheetSettings(tolerance=1e-5),
        strict=True,
    )
    end = np.flatnonzero(Y[:, 0] > 1 - 1e-9)
    tip = solved.positions[end].mean(axis=0)
    x, z = hanging_tip(10.0 / bend, np.sqrt(12 * bend / stiff.stiffness[0]))
    error = np.hypot(tip[0] - x, tip[2] - z)
    low, high = solved.positions[end[np.argsort(Y[end, 1])]][[0, -1]]
    twist = np.degrees(np.arctan2(high[2] - low[2], high[1] - low[1]))
    report(f"{kind} {degrees} deg: B {bend:.3f}, tip error {error:.4f} L, twist {twist:+.1f} deg")
    assert error <= 0.02


@pytest.mark.parametrize("degrees", [0, 30, 45, 90])
@pytest.mark.parametrize("kind", FAIR)
def test_curves_come_back_at_any_cut(kind, degrees, report):
    fabric = fabrics.woven()
    X, T = meshes.rectangle(kind, 1.0, 1.0, 0.1)
    a = np.radians(degrees)
    turn = np.array([[np.cos(a), -np.sin(a)], [np.sin(a), np.cos(a)]])
    rest = X @ turn.T
    rim = ((X < 1e-9) | (X > 1 - 1e-9)).any(axis=1)
    stretch = np.array([[1.04, 0.03], [0.0, 1.01]])
    solved = solve_sheet(
        Sheet(rest, T, fabric),
        start=flat(rest),
        support=Support(fixed=rim, prescribed=flat(rest @ stretch.T)),
        settings=SheetSettings(tolerance=1e-9),
        strict=True,
    )
    E = 0.5 * (stretch.T @ stretch - np.eye(2))
    got = solved.sheet.membrane.stress(solved.positions)

    def stress(curve, e):
        s = np.linspace(0.0, e, 4001)
        return np.trapezoid(np.interp(s, curve.strain, curve.stiffness), s)

    p = [E[0, 0] ** 2 / (E[0, 0] + 2e-3), E[1, 1] ** 2 / (E[1, 1] + 2e-3)]
    rate = [1 - (2e-3 / (E[0, 0] + 2e-3)) ** 2, 1 - (2e-3 / (E[1, 1] + 2e-3)) ** 2]
    c = fabric.poisson * fabric.weft.stiffness[0]
    r = fabric.compression_ratio
    expected = [
        stress(fabric.warp, E[0, 0]) + c * ((1 - r) * rate[0] * p[1] + r * E[1, 1]),
        stress(fabric.weft, E[1, 1]) + c * ((1 - r) * rate[1] * p[0] + r * E[0, 0]),
        stress(fabric.shear, 2 * E[0, 1]),
    ]
    worst = abs(got / expected - 1).max()
    report(f"{kind} cut at {degrees} deg: worst stress {worst:.1e}")
    assert worst <= 5e-3


@pytest.mark.parametrize(
    ("kind", "slenderness"),
    [
        *((kind, 0.01) for kind in FAIR),
        pytest.param("uns", 0.002, marks=pytest.mark.xfail(strict=True, reason="0.0012 to 0.0013")),
        ("right", 0.002),
        ("sliver", 0.002),
    ],
)
def test_roll_up_to_a_full_circle(kind, slenderness, report):
    moment, end = missed(kind, 40, slenderness)
    gap = np.hypot(moment, end)
    report(
        f"{kind}, t/L {slenderness}: moment {moment:+.5f} off B kappa, end and moment {gap:.5f} L"
    )
    assert gap <= 1e-3


@pytest.mark.parametrize(
    ("size", "bar"),
    [
        pytest.param(1.0, 0.01, marks=pytest.mark.xfail(strict=True, reason="0.0118")),
        pytest.param(0.7, 0.005, marks=pytest.mark.xfail(strict=True, reason="0.0095")),
        (0.5, 0.006),
    ],
)
def test_slit_annulus(size, bar, report):
    mesh = annulus.uniform(size)
    error = annulus.deflections(*mesh)[0] / annulus.THIN - 1
    report(f"{len(mesh[0])} vertices: {error[0]:+.4f} {error[1]:+.4f} of a thin plate")
    assert abs(error).max() <= bar


@pytest.mark.parametrize(
    ("size", "bar"),
    [
        (1.0, 0.01),
        pytest.param(0.7, 0.005, marks=pytest.mark.xfail(strict=True, reason="0.0070")),
        (0.5, 0.005),
    ],
)
def test_slit_annulus_between_polygons_of_the_circles_areas(size, bar, report):
    mesh = annulus.uniform(size, hold_area=True)
    error = annulus.deflections(*mesh)[0] / annulus.THIN - 1
    report(f"{len(mesh[0])} vertices: {error[0]:+.4f} {error[1]:+.4f} of a thin plate")
    assert abs(error).max() <= bar


@pytest.mark.parametrize("finest", [1.0, 0.4])
def test_slit_annulus_on_a_polar_grid(finest, report):
    error = annulus.deflections(*annulus.polar(8, 64, finest))[0] / annulus.THIN - 1
    report(f"8 x 64, rows at the rims {finest} of the mean: {error[0]:+.4f} {error[1]:+.4f}")
    assert abs(error).max() <= 0.02


@pytest.mark.parametrize("kind", meshes.KINDS)
def test_layer_along_a_free_edge(kind, report):
    errors = [rim_stiffness(kind, ratio) for ratio in (2.0, 1.0, 0.5)]
    report(f"{kind}: elements 2, 1 and 1/2 of the layer {errors[0]:+.3f} {errors[1]:+.3f} "
           f"{errors[2]:+.3f}")  # fmt: skip
    assert abs(errors[2]) <= 0.09
    assert abs(errors[1]) <= (0.22 if kind == "alt" else 0.16)
