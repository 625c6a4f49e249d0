"""Chains of lines on one wire: found by where they lie, laid from junction to junction."""

import dataclasses
import itertools

import numpy as np
import pytest

from seatlook import io, mesh
from seatlook.assembly.hooking import hooks_beside
from seatlook.assembly.lines import Line, rings_on
from seatlook.errors import InputError
from seatlook.model import Hook
from support.example_scene import EXAMPLE, write_example_files

TURN = np.linspace(np.pi, 0.0, 181)
SHOE = 0.2 * np.column_stack([np.cos(TURN), np.sin(TURN), 0.0 * TURN])  # right, rear, left
LENGTH = mesh.length(SHOE)
NONE = np.empty(0)  # no other wire crosses


def part(low, high, *, lift=0.005):
    """The piece of the horseshoe between two shares of its length, above it."""
    arc = mesh.arc_length(SHOE)
    at = np.linspace(low * LENGTH, high * LENGTH, 40)
    points = np.column_stack([np.interp(at, arc, c) for c in SHOE.T])
    return points + np.array([0.0, 0.0, lift])


def hooks(lines, wires=None, **choices):
    return hooks_beside(lines, wires or {"shoe": SHOE}, reach=0.03, stage="hook", **choices)


@pytest.mark.parametrize("seed", range(8))
def test_seams_under_a_horseshoe_make_one_hook_in_their_order(seed):
    rng = np.random.default_rng(seed)
    count = int(rng.integers(2, 9))
    cuts = np.concatenate([[0.0], np.sort(rng.uniform(0.05, 0.95, count - 1)), [1.0]])
    if np.diff(cuts).min() < 0.03:
        cuts = np.linspace(0.0, 1.0, count + 1)
    lines = {}
    for k in range(count):
        ends = (cuts[k], cuts[k + 1])
        lines[f"seam {k}"] = part(*(ends if rng.random() < 0.5 else ends[::-1]))
    # Across the wire, and beside it but farther away.
    lines["across"] = np.array([[0.0, 0.1, 0.0], [0.0, 0.3, 0.0]])
    lines["farther"] = part(0.2, 0.6, lift=0.02)
    order = rng.permutation(list(lines))
    (hook,) = hooks({name: lines[name] for name in order})
    assert hook.chain == tuple(f"seam {k}" for k in range(count))
    assert hook.wire == hook.name == "shoe"
    np.testing.assert_allclose(hook.junctions, cuts * LENGTH, atol=2e-4)
    assert (hook.start, hook.end) == (0.0, None)


def test_one_line_over_the_whole_wire_needs_no_junctions():
    (hook,) = hooks({"seam": part(1.0, 0.0)})
    assert (hook.line, hook.chain, hook.junctions) == ("seam", (), ())


def test_a_line_goes_to_the_nearest_wire_and_a_gap_parts_a_chain():
    lower = SHOE - [0.0, 0.0, 0.012]
    found = hooks({"one": part(0.0, 0.3), "two": part(0.6, 1.0)}, {"far": lower, "near": SHOE})
    assert [hook.wire for hook in found] == ["near", "near"]
    assert {hook.name for hook in found} == {"near.left", "near.right"}
    assert found[0].junctions == pytest.approx((0.0, 0.3 * LENGTH), abs=2e-4)


def test_a_line_that_goes_on_beyond_its_wire_is_hooked_in_part():
    wire = part(0.2, 0.8, lift=0.0)
    (hook,) = hooks({"seam": part(0.0, 1.0)}, {"wire": wire})
    assert hook.start == pytest.approx(0.2 * LENGTH, abs=0.02)
    assert hook.end == pytest.approx(0.8 * LENGTH, abs=0.02)


def on_loop(low, high, *, lift=0.005):
    """The piece of an oval between two angles, above it."""
    turn = np.linspace(low, high, 60)
    return np.column_stack([0.2 * np.cos(turn), 0.15 * np.sin(turn), np.full(60, lift)])


@pytest.mark.parametrize("seed", range(8))
def test_a_loop_may_begin_anywhere_beside_its_seams(seed):
    """Every junction lies below the ends of its seams, wherever and whichever way the loop runs."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(1, 7))
    first = rng.uniform(0.0, 2 * np.pi)
    cuts = first + 2 * np.pi * (np.arange(count + 1) + rng.uniform(-0.2, 0.2, count + 1)) / count
    cuts[-1] = cuts[0] + 2 * np.pi
    loop = on_loop(0.0, 2 * np.pi * rng.choice([-1, 1]), lift=0.0)
    loop[-1] = loop[0]
    lines = {f"seam {k}": on_loop(*rng.permutation(cuts[k : k + 2])) for k in range(count)}
    whole = mesh.length(loop)
    (hook,) = hooks(lines, {"loop": loop})
    assert set(hook.lines) == set(lines)
    assert (hook.start, hook.end) == (0.0, None)
    assert hook.junctions[-1] - hook.junctions[0] == pytest.approx(whole)
    assert 0 <= hook.junctions[0] < whole
    arc, at = mesh.arc_length(loop), np.array(hook.junctions) % whole
    places = np.column_stack([np.interp(at, arc, column) for column in loop.T])
    for line, ends in zip(hook.lines, itertools.pairwise(places), strict=True):
        assert same_ends(lines[line], ends) < 0.006

    # One seam left out: the chain begins behind the gap and goes on over the loop's end.
    if count > 1:
        lines.pop("seam 0")
        (hook,) = hooks(lines, {"loop": loop})
        assert set(hook.lines) == set(lines)
        assert hook.junctions[-1] - hook.junctions[0] < whole - 0.02


def same_ends(line, ends):
    """How far the ends of a line are from two places, whichever way it runs."""
    ways = (line[[0, -1]] - ends, line[[-1, 0]] - ends)
    return min(np.linalg.norm(way, axis=1).max() for way in ways)


@pytest.mark.parametrize("begin", [0.0, 1.3, 4.0])
@pytest.mark.parametrize("way", [-1, 1])
def test_rings_of_a_closed_seam_stand_right_above_a_loop(begin, way):
    """One seam all round, as between a top and its boxing strip."""
    loop = on_loop(begin, begin + way * 2 * np.pi, lift=0.0)
    loop[-1] = loop[0]
    seam = on_loop(0.7, 0.7 + 2 * np.pi)
    (hook,) = hooks({"seam": seam}, {"loop": loop})
    ring = rings_on([Line(np.arange(len(seam)), mesh.arc_length(seam))], hook, loop, NONE, seam)
    np.testing.assert_allclose(ring.points.at(seam) - ring.target, [[0, 0, 0.005]] * len(ring.at),
                               atol=2e-3)  # fmt: skip


def chained(cuts, turned, junctions):
    """Lines of a chain on one array of points, some of them turned, and the rings on them."""
    x, lines, count = [], [], 0
    for (low, high), turn in zip(itertools.pairwise(cuts), turned, strict=True):
        points = part(*((high, low) if turn else (low, high)))
        x.append(points)
        lines.append(Line(count + np.arange(len(points)), mesh.arc_length(points)))
        count += len(points)
    hook = Hook(name="h", chain=tuple("abc"), wire="shoe", stage="hook", junctions=junctions)
    return lines, hook, np.concatenate(x)


@pytest.mark.parametrize("turned", [(False, False, False), (True, False, True)])
@pytest.mark.parametrize("pitch", [None, 0.03])
def test_rings_of_a_chain_go_to_their_places_whichever_way_lines_run(turned, pitch):
    cuts = np.array([0.0, 0.25, 0.6, 1.0])
    lines, hook, x = chained(cuts, turned, tuple(cuts * LENGTH))
    ring = rings_on(lines, dataclasses.replace(hook, pitch=pitch), SHOE, NONE, x)
    np.testing.assert_allclose(ring.points.at(x) - ring.target, [[0, 0, 0.005]] * len(ring.at),
                               atol=1e-3)  # fmt: skip
    assert (np.diff(ring.at) > 1e-4).all()  # one ring at each junction
    for cut in cuts[1:-1]:
        assert np.abs(ring.at - cut * LENGTH).min() < 1e-4
    assert ring.length.sum() == pytest.approx(LENGTH, rel=1e-4)


def test_a_stretch_changes_gradually_at_junctions():
    cuts = np.array([0.0, 0.3, 0.6, 1.0])
    lines, hook, x = chained(cuts, (False,) * 3, (0.0, 0.31 * LENGTH, 0.6 * LENGTH, LENGTH))
    ring = rings_on(lines, hook, SHOE, NONE, x)
    step = mesh.segment_lengths(ring.target) / np.diff(ring.at)
    assert np.abs(np.diff(step)).max() < 0.01  # 1.033 to 0.967, were it by pieces


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (('line = "left bolster"', ""), "line: got neither, expected one of line and chain"),
        (('line = "left bolster"', 'line = "left bolster"\nchain = ["front"]'), "got both"),
        (('line = "left bolster"', 'chain = ["left bolster", "left bolster"]'), "twice"),
        (('line = "left bolster"', 'chain = ["left bolstr"]'), "did you mean 'left bolster'"),
        (
            ('wire = "wire left"', 'wire = "wire left"\njunctions_mm = [0.0]'),
            "junctions_mm: got [0.0], expected 2 places",
        ),
        (
            ('wire = "wire left"', 'wire = "wire left"\njunctions_mm = [90.0, 10.0]'),
            "expected places that rise along the curve",
        ),
        (
            ('wire = "wire left"', 'wire = "wire left"\njunctions_mm = [0.0, 900.0]'),
            "expected places on the curve, which is 460.0 mm long",
        ),
    ],
)
def test_chains_that_cannot_be_are_refused(tmp_path, change, message):
    path = write_example_files(tmp_path) / "scene.toml"
    assert change[0] in EXAMPLE
    path.write_text(EXAMPLE.replace(*change, 1))
    with pytest.raises(InputError) as caught:
        io.load_scene(path)
    assert message in str(caught.value)


@pytest.mark.parametrize(("last", "refused"), [(500.0, False), (501.0, True)])
def test_places_on_a_loop_may_go_on_past_its_end_once_round(tmp_path, last, refused):
    path = write_example_files(tmp_path) / "scene.toml"
    path.write_text(
        EXAMPLE.replace('wire = "wire left"', f'wire = "ring"\njunctions_mm = [100, {last}]', 1)
    )
    with (tmp_path / "curves.toml").open("a") as file:
        file.write(
            "[curve.ring]\npoints_mm = [[0,0,60],[100,0,60],[100,100,60],[0,100,60],[0,0,60]]"
        )
    with pytest.raises(InputError) as caught:  # the example's line is longer than this loop
        io.load_scene(path)
    assert ("400.0 mm long, once round at most" in str(caught.value)) == refused
