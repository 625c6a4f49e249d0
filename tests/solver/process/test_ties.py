import dataclasses

import numpy as np
import pytest

from seatlook import model
from seatlook.errors import InputError
from seatlook.solver.process.process import Process
from seatlook.solver.process.stages import check_stages, schedule
from seatlook.solver.process.ties import Ties
from support import fabrics
from support.covers import cover, points_along, row, sheet, vertices_as_points
from support.taylor import slopes

SEW = model.Stage(name="sew", start=0.0, end=0.5)
HOOK = model.Stage(name="hook", start=0.25, end=0.75)


def two_strips():
    """Strips of 4 and 6 elements side by side, 20 mm apart, hooked at one end."""
    left, right = sheet(0.12, 0.06, 0.03), sheet(0.12, 0.06, 0.02, at=(0.0, 0.08))
    a, b = row(left[0], 1, 0.06), row(right[0], 1, 0.0)
    at = (np.arange(4) + 0.5) / 4
    pairs = points_along(left[0], a, at), points_along(right[0], b, at)
    n = len(left[0])
    far = model.Points(vertices=pairs[1].vertices + n, weights=pairs[1].weights)
    seam = model.Stitching(name="seam", a=pairs[0], b=far, length=np.full(4, 0.03), stage="sew")
    end = row(left[0], 0, 0.0)
    hook = model.Anchor(
        name="wire",
        kind="hook",
        points=vertices_as_points(end),
        target=np.column_stack([np.zeros(len(end)), left[0][end, 1], np.full(len(end), -0.01)]),
        length=np.full(len(end), 0.02),
        stage="hook",
    )
    return cover([left, right], stitchings=[seam], anchors=[hook], stages=[SEW, HOOK], h=0.03)


@pytest.fixture
def made():
    c = two_strips()
    return c, Ties(c, np.full(len(c.rest), 1e4)), np.array(c.positions)


def test_gaps_at_the_start(made):
    _, ties, x = made
    assert ties.largest_gap(x, "seam") == pytest.approx(0.02)
    assert ties.largest_gap(x, "hook") == pytest.approx(0.01)
    assert ties.largest_gap(x, "frame") == 0.0


def test_taylor(made):
    _, ties, x = made
    ties.close()
    rng = np.random.default_rng(0)
    ties.multiplier[:] = rng.normal(size=ties.multiplier.shape)
    x = x + 1e-3 * rng.normal(size=x.shape)
    first, _ = slopes(ties, x, size=1e-3)
    assert first == pytest.approx(2, abs=0.05)
    g, moved, d = np.zeros_like(x), np.zeros_like(x), rng.normal(size=x.shape)
    ties.value(x, g)
    ties.value(x + d, moved)
    np.testing.assert_allclose((moved - g).ravel(), ties.hessian(x) @ d.ravel(), atol=1e-6)


def test_kernel_equals_numpy(made):
    c, ties, x = made
    ties.close()
    ties.multiplier[:] = np.random.default_rng(1).normal(size=ties.multiplier.shape)
    seam, hook = c.stitchings[0], c.anchors[0]
    gap = np.concatenate([seam.a.at(x) - seam.b.at(x), hook.points.at(x) - hook.target])
    np.testing.assert_allclose(ties.gap(x), gap, atol=1e-15)
    k = ties.full[:, None]
    energy = np.sum(ties.multiplier * gap) + 0.5 * np.sum(k * gap**2)
    assert ties.value(x, np.zeros_like(x)) == pytest.approx(energy, rel=1e-12)
    np.testing.assert_allclose(ties.force(x), -(ties.multiplier + k * gap), rtol=1e-12)


def test_a_seam_pulls_both_sides_equally(made):
    _, ties, x = made
    ties.close()
    ties.full[ties.ties[1].rows] = ties.stiff[ties.ties[1].rows] = 0.0
    g = np.zeros_like(x)
    ties.value(x, g)
    np.testing.assert_allclose(g.sum(axis=0), 0, atol=1e-9 * np.abs(g).max())
    torque = np.cross(x, g).sum(axis=0)
    np.testing.assert_allclose(torque, 0, atol=1e-9 * np.abs(g).max())


def test_a_stage_closes_its_ties_evenly(made):
    c, ties, x = made
    steps = schedule(c.stages, 0.05)
    ties.pull(x, steps[0].before, steps[0].progress)
    # A tenth of the gap in the first of ten steps; the hook's stage has not begun.
    seam, hook = ties.ties[0].rows, ties.ties[1].rows
    np.testing.assert_allclose(ties.target[seam], 0.9 * ties.gap(x)[seam], atol=1e-15)
    assert (ties.stiff[seam] > 0).all()
    assert not ties.stiff[hook].any()
    last = steps[9]
    ties.pull(x, last.before, last.progress)
    np.testing.assert_allclose(ties.target[seam], 0.0, atol=1e-15)
    assert (ties.stiff[seam] < ties.full[seam]).all()


def test_multipliers_take_over_what_the_spring_leaves(made):
    _, ties, x = made
    ties.close()
    before = ties.force(x).copy()
    ties.update(x)
    np.testing.assert_allclose(-ties.multiplier, before, rtol=1e-12)
    ties.update(np.array(x))
    np.testing.assert_allclose(-ties.multiplier, 2 * before, rtol=1e-12)


def test_small_gaps_are_left_to_the_spring(made):
    c, ties, x = made
    ties.close()
    hook = c.anchors[0]
    x[hook.points.vertices[:, 0]] = np.add(hook.target, [0, 0, 4e-5])
    ties.update(x)
    assert not ties.multiplier[ties.ties[1].rows].any()
    assert ties.multiplier[ties.ties[0].rows].any()


def test_figures_of_a_tie(made):
    _, ties, x = made
    ties.close()
    f = ties.figures(x)
    assert f["seam_gap_max"] == pytest.approx(0.02)
    assert f["hook/wire/gap_mean"] == pytest.approx(0.01)
    assert f["hook/wire/force_sum"] == pytest.approx(
        np.linalg.norm(ties.force(x)[ties.ties[1].rows], axis=1).sum()
    )


def unlike():
    """The two strips with stitches and rings of unequal length, and stiffness of two fabrics.

    On the left every other stitch is at a vertex: its second one has no weight.
    """
    c = two_strips()
    (seam,), (hook,) = c.stitchings, c.anchors
    at_vertices = np.where(np.arange(4)[:, None] % 2 == 0, [1.0, 0.0], seam.a.weights)
    seam = dataclasses.replace(
        seam,
        a=dataclasses.replace(seam.a, weights=at_vertices),
        length=np.array([0.01, 0.1, 0.02, 0.04]),
    )
    c = dataclasses.replace(
        c,
        stitchings=(seam,),
        anchors=(dataclasses.replace(hook, length=np.linspace(0.01, 0.02, len(hook.length))),),
    )
    right = np.arange(len(c.rest)) >= c.faces[c.panel == 1].min()
    random = np.random.default_rng(3).uniform(1.0, 2.0, len(c.rest))
    random[seam.a.vertices[at_vertices == 0.0]] = 0.4
    return c, right, np.where(right, 3e4, 1e4) * random


@pytest.mark.parametrize("stiffer", [1.0, 0.05])
def test_a_tie_is_as_stiff_as_the_softest_fabric_that_it_holds(stiffer):
    """Row by row, whichever side that is; a vertex without weight does not count."""
    c, right, stiffness = unlike()
    stiffness = np.where(right, stiffer * stiffness, stiffness)
    ties = Ties(c, stiffness)
    expected = []
    for part in (*c.stitchings, *c.anchors):
        sides = (part.a, part.b) if isinstance(part, model.Stitching) else (part.points,)
        for k, length in enumerate(part.length):
            held = [
                stiffness[v]
                for side in sides
                for v, w in zip(side.vertices[k], side.weights[k], strict=True)
                if w > 0
            ]
            expected.append(100.0 * length * min(held))
    np.testing.assert_allclose(ties.full, expected, rtol=1e-12)
    assert (np.diff(ties.full) != 0).all()


def test_the_process_gives_every_vertex_the_tension_of_its_own_fabric():
    """Geometric mean of warp and weft over the element size."""
    c, right, _ = unlike()
    c = dataclasses.replace(
        c,
        materials=tuple(
            dataclasses.replace(c.materials[0], fabric=fabric)
            for fabric in (fabrics.isotropic(1000.0), fabrics.woven())
        ),
    )
    values = 1000.0, np.sqrt(900.0 * 700.0)
    got = Process(c).ties
    expected = Ties(c, np.where(right, values[1], values[0]) / c.element_size)
    np.testing.assert_allclose(got.full, expected.full, rtol=1e-12)
    # Rings hold the stiff panel alone, stitches the soft one as well.
    rows = np.array([len(c.stitchings[0].length), len(c.anchors[0].length)])
    length = np.split(np.concatenate([c.stitchings[0].length, c.anchors[0].length]), rows[:1])
    stitch, ring = (f / n for f, n in zip(np.split(got.full, rows[:1]), length, strict=True))
    np.testing.assert_allclose(stitch / ring[0], values[1] / values[0], rtol=1e-12)


def test_figures_of_an_uneven_seam():
    """Gaps and forces row by row: largest, mean and sum are different numbers, and of this tie."""
    c, right, stiffness = unlike()
    ties, x = Ties(c, stiffness), np.array(c.positions)
    x[right] += np.outer(1.5 * c.rest[right, 0], [0.03, 0.02, -0.1])
    ties.close()
    (seam,), (hook,) = c.stitchings, c.anchors
    size = np.linalg.norm(seam.a.at(x) - seam.b.at(x), axis=1)
    f = ties.figures(x)
    assert f["seam_gap_max"] == f["seam/seam/gap_max"] == pytest.approx(size.max())
    assert f["seam_gap_mean"] == f["seam/seam/gap_mean"] == pytest.approx(size.mean())
    force = ties.full[:4] * size
    assert f["seam/seam/force_max"] == pytest.approx(force.max())
    assert f["seam/seam/force_sum"] == pytest.approx(force.sum())
    assert size.max() > 1.1 * size.mean()
    assert force.argmax() != size.argmax()
    rings = ties.full[4:] * np.linalg.norm(hook.points.at(x) - hook.target, axis=1)
    np.testing.assert_allclose(np.linalg.norm(ties.forces(x)["wire"], axis=1), rings, rtol=1e-12)


def test_schedule_covers_the_stages_in_order():
    steps = schedule([SEW, HOOK], 0.02)
    assert len(steps) == round(0.75 / 0.02)
    assert steps[-1].time == pytest.approx(0.75)
    names = [s.stage for s in steps]
    assert names == sorted(names, reverse=True)
    assert steps[-1].progress["hook"] == pytest.approx(1.0)
    assert steps[-1].progress["sew"] == pytest.approx(1.5)
    assert steps[0].before == {"sew": 0.0, "hook": 0.0}


def test_unplanned_stage_is_refused():
    c = two_strips()
    wrong = dataclasses.replace(c, stages=(model.Stage(name="sewing", start=0, end=1), HOOK))
    with pytest.raises(
        InputError, match=r"seam.stage: got 'sew', expected one of .* \(did you mean 'sewing'\?\)"
    ):
        check_stages(wrong)
