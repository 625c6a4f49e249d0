import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.solver import Load, Sheet, SheetSettings, Support, solve_sheet
from support import fabrics, meshes
from support.reference.shells import half_cylinder, ring


def test_a_pinched_ring_with_a_rate_and_a_bound():
    edges = np.array([6, 12, 24])
    errors = np.array([ring(n) for n in edges])
    rates = -np.polyfit(np.log(edges), np.log(abs(errors)), 1)[0]
    assert (rates > 1.8).all()
    assert abs(errors[-1]).max() < 3e-3


@pytest.mark.parametrize("kind", ["right", "sliver", "alt"])
def test_a_pinched_ring_on_other_meshes(kind):
    assert max(np.abs(ring(12, kind))) < 0.012


def test_half_cylinder_pinched_at_its_end():
    sinks, solved = half_cylinder(0.22, steps=4)
    assert sinks == pytest.approx(1.71505, rel=0.04)
    assert solved.reactions[:, 2].sum() == pytest.approx(1000.0, rel=1e-3)


def test_without_load_a_shell_stays_as_it_is():
    X, T = meshes.rectangle("uns", 1.0, 0.5, 0.1)
    natural = np.column_stack([np.sin(X[:, 0]), X[:, 1], np.cos(X[:, 0])])
    sheet = Sheet(X, T, fabrics.woven(), natural)
    solved = solve_sheet(sheet, support=Support(clamped=X[:, 0] < 1e-9), strict=True)
    np.testing.assert_allclose(solved.positions, natural, atol=1e-12)


def test_a_flattened_shell_springs_back():
    X, T = meshes.rectangle("uns", 1.0, 0.3, 0.1)
    natural = np.column_stack([np.sin(X[:, 0]), X[:, 1], np.cos(X[:, 0])])
    solved = solve_sheet(
        Sheet(X, T, fabrics.isotropic(1e4, 1.0, 0.3, thickness=0.03), natural),
        support=Support(clamped=X[:, 0] < 1e-9),
        start=np.column_stack([X, np.ones(len(X))]),
        settings=SheetSettings(tolerance=1e-6),
        strict=True,
    )
    np.testing.assert_allclose(solved.positions, natural, atol=1e-5)


def test_a_guided_edge_is_a_plane_of_symmetry():
    """Half of a strip that hangs between clamps sags like the whole one."""
    sags = []
    for length in (1.0, 2.0):
        X, T = meshes.rectangle("right", length, 0.2, 0.1)
        ends = X[:, 0] < 1e-9
        middle = X[:, 0] > 1.0 - 1e-9 if length == 1.0 else abs(X[:, 0] - 1.0) < 1e-9
        free = np.zeros_like(middle)
        support = Support(clamped=ends | (X[:, 0] > 2.0 - 1e-9))
        if length == 1.0:
            support = Support(
                clamped=ends, guided=middle, fixed=np.stack([middle, free, free], axis=1)
            )
        solved = solve_sheet(
            Sheet(X, T, fabrics.isotropic(1e5, 1.0, thickness=0.01, density=1.0)),
            support=support,
            load=Load(gravity=(0, 0, -5.0)),
            settings=SheetSettings(tolerance=1e-6),
            strict=True,
        )
        sags.append(-solved.positions[middle, 2].mean())
    assert sags[0] == pytest.approx(sags[1], rel=5e-3)
    assert sags[0] > 0.01


def test_a_mask_of_directions_is_one_for_each_vertex():
    X, T = meshes.rectangle("right", 1.0, 1.0, 0.5)
    with pytest.raises(InputError, match=r"clamped, guided: got \(9, 3\), expected bool \(9,\)"):
        solve_sheet(
            Sheet(X, T, fabrics.isotropic()), support=Support(guided=np.zeros((9, 3), dtype=bool))
        )
