import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.model import Curve, Fabric
from seatlook.solver import Load, Sheet, SheetError, SheetSettings, Support, solve_sheet
from support import fabrics, meshes
from support.reference.elastica import hanging_tip


def cantilever(kind, gamma, slenderness, edges, **options):
    """Tip error / L and sideways drift / L of a strip of length 1 that hangs from a clamp."""
    X, T = meshes.rectangle(kind, 1.0, 0.2, 1.0 / edges)
    fabric = fabrics.isotropic(12.0 / slenderness**2, 1.0, density=1.0, thickness=slenderness)
    solved = solve_sheet(
        Sheet(X, T, fabric),
        support=Support(clamped=X[:, 0] < 1e-9),
        load=Load(gravity=(0, 0, -gamma)),
        settings=SheetSettings(**options),
        strict=True,
    )
    tip = solved.positions[X[:, 0] > 1 - 1e-9].mean(axis=0)
    x, z = hanging_tip(gamma, slenderness)
    return np.hypot(tip[0] - x, tip[2] - z), abs(tip[1] - 0.1), solved


def test_reference_agrees_with_the_inextensible_elastica():
    np.testing.assert_allclose(hanging_tip(10.0, 1e-6), (0.65636, -0.70020), atol=2e-5)
    np.testing.assert_allclose(hanging_tip(100.0, 1e-6), (0.15922, -0.93752), atol=2e-5)


@pytest.mark.parametrize("kind", ["uns", "right", "sliver"])
@pytest.mark.parametrize("slenderness", [0.02, 0.002])
def test_hanging_strip_of_20_edges(kind, slenderness):
    error, drift, _ = cantilever(kind, 10.0, slenderness, 20, tolerance=1e-5)
    assert error < 2e-3
    assert drift < 1e-3


def test_weight_is_carried_by_the_clamp():
    _, _, solved = cantilever("uns", 10.0, 0.02, 10, tolerance=1e-8)
    np.testing.assert_allclose(solved.reactions.sum(axis=0), [0.0, 0.0, 10.0 * 0.2], atol=1e-5)
    assert (solved.reactions[solved.positions[:, 0] > 0.01] == 0.0).all()


@pytest.mark.parametrize("kind", ["uns", "sliver"])
def test_stretch_by_the_rim_is_uniform_inside(kind):
    X, T = meshes.rectangle(kind, 1.0, 1.0, 0.1)
    rim = ((X < 1e-9) | (X > 1 - 1e-9)).any(axis=1)
    flat = np.pad(X, ((0, 0), (0, 1)))
    solved = solve_sheet(
        Sheet(X, T, fabrics.isotropic(poisson=0.3)),
        support=Support(fixed=rim, prescribed=flat * [1.05, 1.01, 1.0]),
        settings=SheetSettings(tolerance=1e-10),
        strict=True,
    )
    mid = solved.sheet.strains(solved.positions)[1]
    expected = 0.5 * (np.diag([1.05, 1.01]) ** 2 - np.eye(2))
    assert np.sqrt(((mid - expected) ** 2).mean()) < 1e-9


def test_stress_and_contraction_of_a_free_strip_follow_the_curve():
    curve = Curve(strain=[0.0, 0.05], stiffness=[500.0, 3000.0])
    fabric = Fabric(
        thickness=1e-3,
        density=0.3,
        warp=curve,
        weft=Curve.linear(800.0),
        shear=Curve.linear(200.0),
        poisson=0.4,
        bending_warp=1e-4,
        bending_weft=1e-4,
        bending_twist=5e-5,
    )
    X, T = meshes.rectangle("uns", 1.0, 0.5, 0.1)
    left, right = X[:, 0] < 1e-9, X[:, 0] > 1 - 1e-9
    fixed = np.stack([left | right, np.zeros(len(X), bool), np.ones(len(X), bool)], axis=1)
    fixed[np.flatnonzero(left)[0], 1] = True
    flat = np.pad(X, ((0, 0), (0, 1)))
    solved = solve_sheet(
        Sheet(X, T, fabric),
        support=Support(fixed=fixed, prescribed=flat * [1.08, 1, 1]),
        settings=SheetSettings(tolerance=1e-10),
        strict=True,
    )
    E = solved.sheet.strains(solved.positions)[1]
    e1, e2 = E[:, 0, 0].mean(), E[:, 1, 1].mean()
    assert np.ptp(E[:, 0, 0]) < 1e-9
    tension = 500.0 * e1 + 0.5 * 2500.0 / 0.05 * e1**2
    if e1 > 0.05:
        tension = 500.0 * 0.05 + 0.5 * 2500.0 * 0.05 + 3000.0 * (e1 - 0.05)
    coupling = 0.4 * 800.0
    assert e2 == pytest.approx(-coupling * e1 / 800.0, rel=1e-6)
    S = solved.sheet.membrane.stress(solved.positions)
    np.testing.assert_allclose(S[:, 0], tension + coupling * e2, rtol=1e-6)
    force = solved.reactions[right, 0].sum()
    assert force == pytest.approx((tension + coupling * e2) * 1.08 * 0.5, rel=1e-6)


def test_membrane_under_pressure_bulges_by_the_closed_form():
    # Far from the ends of a long strip an arc with N = k E and p = N / R.
    X, T = meshes.rectangle("uns", 0.4, 0.1, 0.01)
    rim = ((X < 1e-9) | (X.max(axis=0) - 1e-9 < X)).any(axis=1)
    solved = solve_sheet(
        Sheet(X, T, fabrics.isotropic(1000.0, 1e-7)),
        support=Support(fixed=rim),
        load=Load(pressure=200.0),
        settings=SheetSettings(tolerance=1e-6),
        strict=True,
    )
    middle = (np.abs(X - [0.2, 0.05]) < [0.02, 0.006]).all(axis=1)
    sag = solved.positions[middle, 2].max()
    radius = (0.05**2 + sag**2) / (2 * sag)
    arc = 2 * radius * np.arcsin(0.05 / radius)
    stretch = arc / 0.1
    tension = 1000.0 * 0.5 * (stretch**2 - 1) * stretch
    assert tension / radius == pytest.approx(200.0, rel=0.01)


def test_not_converged_is_raised_with_the_last_state():
    with pytest.raises(SheetError, match=r"residual .* above") as caught:
        cantilever("right", 10.0, 0.02, 10, max_iterations=2)
    assert caught.value.solution.positions.shape[1] == 3
    assert not caught.value.solution.converged


@pytest.mark.parametrize("mask", [np.zeros(4, bool), np.array([0, 1])])
def test_wrong_mask_is_refused(mask):
    X, T = meshes.rectangle("right", 1.0, 1.0, 0.5)
    with pytest.raises(InputError, match=r"fixed: got .*, expected bool \(9,\) or \(9, 3\)"):
        solve_sheet(Sheet(X, T, fabrics.isotropic()), support=Support(fixed=mask))
