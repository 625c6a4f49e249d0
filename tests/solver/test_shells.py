import importlib

import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.solver import Load, Moment, Sheet, SheetSettings, Support, solve_sheet
from seatlook.solver.element.elastic import ElasticSheet
from seatlook.solver.element.loads import EdgeMoment, Pressure
from seatlook.solver.element.shell import Shell
from support import fabrics, meshes, taylor
from support.reference.elastica import blown_tip
from support.reference.shells import half_cylinder, ring, rolled_by_a_moment


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


def test_gradient_and_hessian_of_a_moment_agree():
    X, T = meshes.rectangle("uns", 1.0, 0.4, 0.2)
    end = X[:, 0] > 1.0 - 1e-9
    s = Shell(X, T, fabrics.isotropic(), turned=end)
    rim = s.rim_edges(end)
    flat = np.pad(X, ((0, 0), (0, 1)))
    slopes = s.slopes_across(rim)
    load = EdgeMoment(slopes, s.edges.length[rim], np.array([0.3, -2.0, 0.1]), flat)
    x = flat + 0.05 * np.random.default_rng(0).standard_normal(flat.shape)
    first, second = taylor.slopes(load, x, size=1e-2)
    assert first > 1.95
    assert second > 1.95
    # Turned by 0.4 about its own axis, it has done that much work.
    a = 0.4
    turned = flat @ np.array([[np.cos(a), 0, np.sin(a)], [0, 1, 0], [-np.sin(a), 0, np.cos(a)]])
    alone = EdgeMoment(slopes, s.edges.length[rim], np.array([0.0, -2.0, 0.0]), flat)
    work = -alone.value(turned, np.zeros_like(flat))
    assert work == pytest.approx(2.0 * 0.4 * a, rel=1e-9)


def test_a_moment_bends_a_strip_to_a_quarter_of_a_circle():
    edges = np.array([6, 12, 24])
    got, exact = zip(*[rolled_by_a_moment(n, "uns", 0.25, 2) for n in edges], strict=True)
    errors = np.abs(np.array(got) - exact).max(axis=1) / 12.0
    assert -np.polyfit(np.log(edges), np.log(errors), 1)[0] > 1.8
    assert errors[-1] < 5e-4


def test_a_moment_opens_a_shell():
    """B / R all along it makes a cylinder flat."""
    X, T = meshes.rectangle("uns", 1.5, 0.3, 0.1)
    natural = np.column_stack([np.sin(X[:, 0]), X[:, 1], np.cos(X[:, 0])])
    end = X[:, 0] > 1.5 - 1e-9
    solved = solve_sheet(
        Sheet(X, T, fabrics.isotropic(1e5, 1.0, thickness=0.01), natural),
        support=Support(clamped=X[:, 0] < 1e-9),
        load=Load(moments=[Moment(end, (0.0, -1.0, 0.0))]),
        settings=SheetSettings(tolerance=1e-5, steps=3),
        strict=True,
    )
    np.testing.assert_allclose(solved.positions[end, 0], 1.5, atol=5e-3)
    np.testing.assert_allclose(solved.positions[end, 2], 1.0, atol=5e-3)


def test_pressure_follows_a_strip_that_it_blows_up():
    """Its free end turns by 89 degrees."""
    pressure, edges, errors = 10.0, np.array([5, 10, 20]), []
    for n in edges:
        X, T = meshes.rectangle("uns", 1.0, 0.2, 1 / n)
        solved = solve_sheet(
            Sheet(X, T, fabrics.isotropic(12 / 0.01**2, 1.0, thickness=0.01)),
            support=Support(clamped=X[:, 0] < 1e-9),
            load=Load(pressure=pressure),
            settings=SheetSettings(tolerance=1e-4, steps=4),
            strict=True,
        )
        tip = solved.positions[X[:, 0] > 1 - 1e-9].mean(axis=0)
        errors.append(np.hypot(*(tip[[0, 2]] - blown_tip(pressure))))
    assert -np.polyfit(np.log(edges), np.log(errors), 1)[0] > 1.8
    assert errors[-1] < 2e-3


def test_a_pressure_that_has_not_settled_is_not_called_converged(monkeypatch):
    door = importlib.import_module("seatlook.solver.sheet")
    monkeypatch.setattr(door, "_ROUNDS", 1)
    X, T = meshes.rectangle("uns", 1.0, 0.2, 0.2)
    solved = solve_sheet(
        Sheet(X, T, fabrics.isotropic(12 / 0.01**2, 1.0, thickness=0.01)),
        support=Support(clamped=X[:, 0] < 1e-9),
        load=Load(pressure=3.0),
    )
    assert not solved.converged
    assert solved.reason.startswith("residual ")


def test_pressure_presses_on_every_triangle_along_its_normal():
    X, T = meshes.rectangle("sliver", 1.0, 0.8, 0.2)
    x = np.column_stack([X, np.sin(3 * X[:, 0]) * X[:, 1]]) + np.array([0.3, -2.0, 1.0])
    s = ElasticSheet(X, T, np.zeros(len(T)), [fabrics.isotropic()])
    load, force = Pressure(T, 5.0), np.zeros_like(x)
    load.value(x, force)
    force = load.rim_force(x, s.edges.ends[s.edges.free]) - force
    twin = np.zeros_like(x)
    for a, b, c in T:
        twin[[a, b, c]] += 5.0 * np.cross(x[b] - x[a], x[c] - x[a]) / 6
    np.testing.assert_allclose(force, twin, atol=1e-12)


@pytest.mark.parametrize(
    ("moment", "message"),
    [
        (Moment(np.zeros((9, 3), dtype=bool), (0, 1, 0)), r"got \(9, 3\), expected bool \(9,\)"),
        (Moment(np.ones(9, dtype=bool), (0, 0, 0)), "expected three numbers, not all 0"),
        (Moment(np.zeros(9, dtype=bool), (0, 1, 0)), "moments: got no free edge"),
        (Moment(np.arange(9) < 3, (0, 1, 0)), "moments: got 2 edges that are clamped"),
    ],
)
def test_a_moment_that_acts_on_nothing_is_refused(moment, message):
    X, T = meshes.rectangle("right", 1.0, 1.0, 0.5)
    with pytest.raises(InputError, match=message):
        solve_sheet(
            Sheet(X, T, fabrics.isotropic()),
            support=Support(clamped=X[:, 0] < 1e-9),
            load=Load(moments=[moment]),
        )
