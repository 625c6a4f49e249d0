"""Rings slide along their wires: free along them, held across them, stopped at their ends."""

import dataclasses

import numpy as np
import pytest
from scipy.sparse import csc_array, diags_array

from seatlook import mesh, model
from seatlook.errors import InputError
from seatlook.solver import SolverSettings, solve
from seatlook.solver.methods.explicit import Explicit
from seatlook.solver.process.nearest import NearestHessian
from seatlook.solver.process.process import Process
from seatlook.solver.process.ties import Ties
from support.covers import cover, flat_foam, points_along, row, sheet, vertices_as_points
from support.taylor import slopes

HOOK = model.Stage(name="hook", start=0.0, end=0.2)
COUNT = 7
ARC = np.linspace(-np.pi, np.pi, 73)
BEND = np.linspace(-0.5, 0.7, 49)
WIRES = {
    "straight": np.array([[0.02, -0.1, -0.01], [0.02, 0.2, -0.01]]),
    "bent": np.column_stack(
        [0.15 * np.cos(BEND) - 0.14, 0.15 * np.sin(BEND) + 0.03, -0.01 + 0.005 * BEND]
    ),
    "closed": np.column_stack(
        [0.05 * np.cos(ARC) - 0.05, 0.05 * np.sin(ARC) + 0.03, np.full(73, -0.005)]
    ),
}
WIRES["closed"][-1] = WIRES["closed"][0]
VERTICES = np.linspace(0.0, 1.0, 4)  # more rings than these could not all lie on a bent wire


def hooked(curve, *, stops=None, at=None, pull=0.0):
    """A sheet of 60 by 60 mm; points along its left edge are hooked, its right edge is held."""
    X, T, x = sheet(0.06, 0.06, 0.02)
    left, right = row(X, 0, 0.0), row(X, 0, 0.06)
    points = points_along(X, left, np.linspace(0.0, 1.0, COUNT) if at is None else at)
    place = mesh.nearest_places(curve, points.at(x))[1]
    if stops is None:
        stops = (-np.inf, np.inf) if mesh.is_closed(curve) else (0.0, mesh.length(curve))
    wire = model.Wire(curve=curve, place=place, stops=np.tile(stops, (len(place), 1)))
    anchors = [
        model.Anchor(name="wire", kind="hook", points=points, wire=wire, stage="hook",
                     target=mesh.points_at(curve, place), length=np.full(len(place), 0.01)),
        model.Anchor(name="rail", kind="frame", points=vertices_as_points(right), stage="hook",
                     target=x[right] + [0.0, pull, 0.0], length=np.full(len(right), 0.02)),
    ]  # fmt: skip
    return cover([(X, T, x)], anchors=anchors, stages=[HOOK], h=0.02)


def closed_ties(c, x, *, seed=0):
    """Its ties with full stiffness and random multipliers, rings seated at ``x``."""
    ties = Ties(c, np.full(len(c.rest), 1e4))
    ties.close()
    ties.lag(x)
    ties.multiplier[:] = np.random.default_rng(seed).normal(size=ties.multiplier.shape)
    return ties


@pytest.fixture(params=WIRES)
def made(request):
    c = hooked(WIRES[request.param])
    x = np.array(c.positions) + 1e-3 * np.random.default_rng(3).normal(size=c.positions.shape)
    return c, closed_ties(c, x), x


def test_taylor(made):
    _, ties, x = made
    first, _ = slopes(ties, x, size=1e-3)
    assert first == pytest.approx(2, abs=0.05)
    g, moved, d = np.zeros_like(x), np.zeros_like(x), np.random.default_rng(1).normal(size=x.shape)
    ties.value(x, g)
    ties.value(x + 1e-3 * d, moved)
    np.testing.assert_allclose((moved - g).ravel(), ties.hessian(x) @ (1e-3 * d).ravel(), atol=1e-6)


@pytest.mark.parametrize("side", [-1.0, 1.0])
def test_taylor_where_all_rings_press_on_a_stop(side):
    c = hooked(WIRES["straight"])
    x = np.array(c.positions)
    ties = closed_ties(c, x)
    rows = ties.ties[0].rows
    ties.sliding.play[rows] = np.sort([-0.2 * side, -1e-3 * side])  # 1 mm beyond it
    assert not len(ties.released(x).stiffness)
    assert slopes(ties, x, size=1e-4)[0] == pytest.approx(2, abs=0.05)
    along = np.einsum("ij,ij->i", ties.force(x)[rows], ties.sliding.direction[rows])
    assert (side * along < 0.0).all()  # it pushes back, towards the other stop
    held = csc_array(ties.stiffness())
    np.testing.assert_allclose(ties.hessian(x)[1::3, 1::3].toarray(), held.toarray())


def test_kernel_equals_numpy(made):
    c, ties, x = made
    hook = c.anchors[0]
    rows = ties.ties[0].rows
    ties.sliding.play[rows] = np.column_stack([np.linspace(-2e-3, 1e-3, COUNT),
                                               np.linspace(-1e-3, 2e-3, COUNT)])  # fmt: skip
    gap = hook.points.at(x) - ties.target[rows]
    k, t, m = ties.stiff[rows][:, None], ties.sliding.direction[rows], ties.multiplier[rows]
    pull = m + k * gap
    along = (pull * t).sum(axis=1, keepdims=True)
    low, high = (k * ties.sliding.play[rows]).T[..., None]
    pushed = np.maximum(along - high, 0) + np.minimum(along - low, 0)
    assert {tuple(s) for s in np.sign(pushed[:, 0])[:, None]} == {(-1.0,), (0.0,), (1.0,)}
    force = pull + (pushed - along) * t
    held = (m * t).sum(axis=1, keepdims=True)
    energy = ((force**2).sum() - (m**2).sum() + (held**2).sum() - (held**2).sum()) / (2 * k[0, 0])
    rail = ties.ties[1].rows
    other = c.anchors[1].points.at(x) - ties.target[rail]
    full = ties.stiff[rail][:, None]
    energy += np.sum(ties.multiplier[rail] * other + 0.5 * full * other**2)
    assert ties.value(x, np.zeros_like(x)) == pytest.approx(energy, rel=1e-10)
    np.testing.assert_allclose(ties.force(x)[rows], -force, rtol=1e-10, atol=1e-12)


def test_energy_stays_when_all_slide_along_a_straight_wire():
    c = hooked(WIRES["straight"])
    x = np.array(c.positions)
    ties = closed_ties(c, x)
    held = ties.ties[1].rows
    ties.stiff[held] = 0.0
    before = ties.value(x, np.zeros_like(x))
    for way in (1e-4, -0.01, 0.05):
        moved = x + np.array([0.0, way, 0.0])
        gradient = np.zeros_like(x)
        assert ties.value(moved, gradient) == pytest.approx(before, rel=1e-12)
        assert np.abs(gradient[:, 1]).max() < 1e-9 * np.abs(gradient).max()
        ties.lag(moved)  # seated anew it is the same wire
        assert ties.value(moved, np.zeros_like(x)) == pytest.approx(before, rel=1e-9)


def test_rings_pull_across_the_wire_where_it_runs(made):
    _, ties, x = made
    rows = ties.ties[0].rows
    along = np.einsum("ij,ij->i", ties.force(x)[rows], ties.sliding.direction[rows])
    assert np.abs(along).max() < 1e-9 * np.abs(ties.force(x)[rows]).max()


def test_held_on_their_places_until_they_are_all_but_drawn_in():
    c = hooked(WIRES["straight"])
    ties, x = Ties(c, np.full(len(c.rest), 1e4)), np.array(c.positions)
    ties.pull(x, {"hook": 0.7}, {"hook": 0.75})
    assert not ties.sliding.rings
    ties.pull(x, {"hook": 0.8}, {"hook": 0.9})
    (ring,) = ties.sliding.rings
    # Half of what is left of the way, and all of it across the wire.
    left = (ties.target - ties.goal)[ring.rows]
    np.testing.assert_allclose(left, 0.5 * ties.gap(x)[ring.rows], atol=1e-15)
    np.testing.assert_allclose(left[:, 1], 0.0, atol=1e-15)


@pytest.mark.parametrize("kind", WIRES)
def test_a_factor_knows_what_slides(kind):
    """Chords and ties alone: the factor's matrix is that of the ties, along the wire too."""
    c = hooked(WIRES[kind])
    x = np.array(c.positions)
    ties, process = closed_ties(c, x), Process(c)
    base = diags_array(np.full(len(x), 10.0))
    results = []
    for released in (None, ties.released(x)):
        nearest = NearestHessian(process.sheet, x, ties.pattern())
        scalar = csc_array(ties.stiffness() + base)
        nearest.factor(x, scalar, np.zeros((len(x), 3, 3)), released)
        columns, out = [], np.empty_like(x)
        for unit in np.eye(x.size):
            nearest.solve(unit.reshape(x.shape), out)
            columns.append(out.ravel().copy())
        results.append(np.linalg.inv(np.array(columns)))
    difference = ties.released(x).matrix(len(x)).toarray()
    np.testing.assert_allclose(results[0] - results[1], difference, atol=1e-6 * difference.max())


@pytest.mark.parametrize("method", ["lbfgs", "newton", Explicit(time_step=2e-5)], ids=str)
@pytest.mark.parametrize("kind", WIRES)
def test_a_pull_along_the_wire_is_followed(kind, method):
    """The right edge goes 5 mm; the left one goes with it, and no ring holds it back."""
    curve = WIRES[kind]
    settings = SolverSettings(method=method)
    s = solve(hooked(curve, at=VERTICES, pull=0.005), settings=settings, strict=True)
    hook = s.cover.anchors[0]
    points = hook.points.at(s.positions)
    place = hook.wire.nearest(points)
    assert np.linalg.norm(points - mesh.points_at(curve, place), axis=1).max() < 1e-4
    slid = place - hook.wire.place
    assert np.abs(np.sign(slid).sum()) == len(slid)
    assert np.abs(slid).mean() > 2e-3
    force, way = s.forces["wire"], mesh.directions_at(curve, place)
    along = np.abs(np.einsum("ij,ij->i", force, way)).max()
    # Within 0.2 mm a wire counts as straight.
    assert along < 0.01 * np.linalg.norm(force, axis=1).max()


def test_stops_hold_what_is_pulled_beyond_them_and_nothing_else():
    """The wire ends at the sheet's ends: pulled 5 mm along, the first rings run into its end."""
    curve = np.array([[0.0, -0.0005, 0.0], [0.0, 0.061, 0.0]])
    s = solve(hooked(curve, stops=(0.0, 0.0615), pull=0.005), strict=True)
    hook = s.cover.anchors[0]
    place = hook.points.at(s.positions)[:, 1] - curve[0, 1]
    along = s.forces["wire"][:, 1]
    assert place.max() == pytest.approx(0.0615, abs=5e-5)
    stopped = place > 0.0615 - 5e-5
    assert 0 < stopped.sum() < COUNT
    assert (along[stopped] < -1e-3).all()
    np.testing.assert_allclose(along[~stopped], 0.0, atol=1e-3 * np.abs(along).max())
    assert (np.diff(place) > 0.0).all()


def test_a_closed_wire_alone_lets_nothing_turn_round():
    """All rings could go round it: weight on the foam below, and nothing else, holds the sheet."""
    c = hooked(WIRES["closed"] + [0.0, 0.0, 0.005], at=VERTICES)
    s = solve(dataclasses.replace(c, anchors=c.anchors[:1], foam=flat_foam()), strict=True)
    hook = s.cover.anchors[0]
    points = hook.points.at(s.positions)
    slid = hook.wire.nearest(points) - hook.wire.place
    assert np.abs(slid.mean()) < 0.05 * mesh.length(hook.wire.curve)
    assert s.figures["hook/wire/gap_max"] < 1e-4


def test_resumed_to_the_byte():
    c = hooked(WIRES["bent"], at=VERTICES, pull=0.005)
    rest = model.Stage(name="rest", start=0.2, end=0.3)
    c = dataclasses.replace(c, stages=(HOOK, rest))
    kept = []
    whole = solve(c, snapshot=kept.append)
    again = solve(c, start=kept[0])
    np.testing.assert_array_equal(again.positions, whole.positions)
    np.testing.assert_array_equal(again.forces["wire"], whole.forces["wire"])


def test_a_wire_has_a_place_for_every_point():
    hook = hooked(WIRES["straight"]).anchors[0]
    short = dataclasses.replace(hook.wire, place=hook.wire.place[1:], stops=hook.wire.stops[1:])
    with pytest.raises(InputError, match=r"hook wire\.wire: got 6 places, expected one for each"):
        dataclasses.replace(hook, wire=short)
