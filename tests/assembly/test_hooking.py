"""Hog rings: where they stand, what they pull with, and what is said when that is too much."""

import dataclasses

import numpy as np
import pytest

from seatlook.assembly import assemble
from seatlook.assembly.lines import Line, crossings, rings_on
from seatlook.model import Hook
from seatlook.results.ring_pulls import overpulled, ring_pulls
from seatlook.solver import solve
from seatlook.solver.process.crossing import crossing_pairs, visible_crossings
from support import scenes

DEEP = 0.006


def hooked(**change):
    """The two panels, sewn side by side, their seam pulled 6 mm into the foam."""
    scene = scenes.two_panels(gap=0.004, element_size=0.02)
    wire = scene.foam.curves["wire"] - [0.0, 0.0, DEEP]
    curves = type(scene.foam.curves)({**scene.foam.curves, "wire": wire})
    (hook,) = scene.hooks
    return dataclasses.replace(
        scene,
        foam=dataclasses.replace(scene.foam, curves=curves),
        hooks=(dataclasses.replace(hook, **change),),
    )


def anchor(**change):
    return next(a for a in assemble(hooked(**change)).anchors if a.kind == "hook")


@pytest.mark.parametrize(
    ("pitch", "start", "end", "at"),
    [
        (0.05, 0.0, None, [0.0, 0.05, 0.1]),
        (0.03, 0.0, None, [0.0, 0.1 / 3, 0.2 / 3, 0.1]),
        (0.03, 0.02, 0.08, [0.02, 0.05, 0.08]),
        (0.5, 0.02, 0.08, [0.02, 0.08]),
        (0.001, 0.02, 0.08, [0.02, 0.04, 0.06, 0.08]),  # not closer than vertices
    ],
)
def test_rings_stand_at_the_pitch_over_the_part(pitch, start, end, at):
    ring = anchor(pitch=pitch, start=start, end=end)
    np.testing.assert_allclose(ring.at, at, atol=1e-12)
    # The wire runs from y = 0.1 to 0; the seam upward: each ring goes to its own place.
    np.testing.assert_allclose(ring.target[:, 1], at, atol=1e-12)
    np.testing.assert_allclose(ring.target[:, 2], 0.0006 - DEEP)
    assert ring.length.sum() == pytest.approx(at[-1] - at[0])


def test_part_pulled_all_along_takes_its_vertices():
    whole, part = anchor(), anchor(start=0.02, end=0.06)
    np.testing.assert_allclose(whole.at, np.arange(6) * 0.02, atol=1e-12)
    np.testing.assert_allclose(part.at, [0.02, 0.04, 0.06], atol=1e-12)
    np.testing.assert_allclose(part.target, whole.target[1:4], atol=1e-12)


def test_rings_may_slide_between_the_ends_of_their_wire():
    assert anchor(pitch=0.05).wire is None
    ring = anchor(pitch=0.05, slides=True)
    np.testing.assert_allclose(ring.wire.place, [0.1, 0.05, 0.0], atol=1e-12)
    np.testing.assert_allclose(ring.wire.stops, np.tile([0.0, 0.1], (3, 1)), atol=1e-12)


ALONG = np.array([[0.0, 0.0, 0.0], [0.2, 0.0, 0.0]])


@pytest.mark.parametrize(
    ("others", "places"),
    [
        ([], []),
        ([[[0.05, 0.0, 0.001], [0.05, 0.1, 0.0]]], [0.05]),  # ends on it
        ([[[0.05, -0.1, 0.0], [0.07, 0.1, 0.0]]], [0.06]),  # crosses it
        ([[[0.05, 0.003, 0.0], [0.05, 0.1, 0.0]]], []),  # ends 3 mm before it
        (
            [[[0.15, 0.0, 0.0], [0.15, 0.1, 0.0], [0.05, 0.1, 0.0], [0.05, 0.0, 0.0]]],
            [0.05, 0.15],
        ),
        ([[[0.3, 0.0, 0.0], [0.3, 1.0, 0.0]]], []),  # beyond its end
    ],
)
def test_wires_cross_where_they_meet(others, places):
    got = crossings(ALONG, [np.array(other) for other in others])
    np.testing.assert_allclose(got, places, atol=5e-4)


def rings(curve, crossed):
    """Rings every 25 mm along a line over a wire 200 mm long."""
    x = np.column_stack([np.linspace(0.0, 0.2, 9), np.zeros((9, 2))])
    hook = Hook(name="h", line="l", wire="w", stage="s", slides=True)
    return rings_on([Line(np.arange(9), x[:, 0])], hook, curve, np.array(crossed), x).wire


def test_rings_stop_at_a_crossing_from_either_side():
    low, high = rings(ALONG, [0.1, 0.16]).stops.T
    np.testing.assert_allclose(low, [0, 0, 0, 0, 0.099, 0.1, 0.1, 0.16, 0.16], atol=1e-12)
    np.testing.assert_allclose(high, [0.1, 0.1, 0.1, 0.1, 0.101, 0.16, 0.16, 0.2, 0.2], atol=1e-12)


def test_a_closed_wire_stops_rings_at_crossings_only():
    turn = np.linspace(0.0, 2 * np.pi, 201)
    circle = 0.1 / np.pi * np.column_stack([np.cos(turn), np.sin(turn), np.zeros(201)])
    circle[-1] = circle[0]
    assert np.isinf(rings(circle, []).stops).all()
    low, high = rings(circle, [0.07]).stops.T
    length = np.linalg.norm(np.diff(circle, axis=0), axis=1).sum()
    place = rings(circle, [0.07]).place
    assert (low < place).all()
    assert (place < high).all()
    np.testing.assert_allclose(high - low, length)
    np.testing.assert_allclose(high, np.where(place < 0.07, 0.07, 0.07 + length))


@pytest.fixture(scope="module")
def pulled():
    return solve(assemble(hooked(pitch=0.05, limit=0.4)))


def test_pull_of_every_ring_is_reported_and_sums_to_the_ties(pulled):
    assert pulled.status == "converged", pulled.reason
    rings = ring_pulls(pulled)
    assert [r.ring for r in rings] == [1, 2, 3]
    assert [r.at for r in rings] == pytest.approx([0.0, 0.05, 0.1])
    assert max(r.gap for r in rings) < 5e-4
    force = pulled.forces["hook"]
    assert [r.pull for r in rings] == pytest.approx(np.linalg.norm(force, axis=1).tolist())
    rail = pulled.forces["rail"].sum(axis=0)
    for k, axis in enumerate("xyz"):
        assert pulled.figures[f"ties_{axis}"] == pytest.approx(force[:, k].sum() + rail[k])
    # Foam pushes up what the rings pull down.
    assert force[:, 2].max() < 0.0


def test_rings_above_their_limit_are_named(pulled):
    over = [r for r in ring_pulls(pulled) if r.pull > 0.4]
    assert over
    (message,) = overpulled(pulled)
    worst = max(over, key=lambda r: r.pull)
    assert message == (
        f"hook hook: ring {worst.ring}, {1e3 * worst.at:.0f} mm along its line, pulls "
        f"{worst.pull:.1f} N; {len(over)} above the limit of 0.4 N"
    )
    weak = [dataclasses.replace(a, limit=1e3) for a in pulled.cover.anchors]
    cover = dataclasses.replace(pulled.cover, anchors=tuple(weak))
    assert overpulled(dataclasses.replace(pulled, cover=cover)) == ()


def test_figures_count_what_passes_through_itself(pulled):
    pairs = crossing_pairs(pulled.cover, pulled.positions)
    assert pulled.figures["intersecting_pairs"] == visible_crossings(pulled.cover, pairs) == 0
    assert "hem_crossing_pairs" not in pulled.figures
