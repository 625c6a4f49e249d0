"""The mesh and the drawn pattern go through the same change."""

import numpy as np
import pytest

from seatlook import mesh
from seatlook.errors import InvertedElementError
from seatlook.improvement.candidate import share_of, stops_of, words_of

MM = 1e-3


def some(candidates, kind, count, seed=0):
    rng = np.random.default_rng(seed)
    own = [c for c in candidates if c.kind == kind]
    return [own[k] for k in rng.choice(len(own), count, replace=False)]


def test_all_stretches_of_a_side_together_are_a_parallel_line(changes):
    for outline in changes.outlines:
        for side in outline.sides:
            shares = [share_of(side, k, side.arc) for k in range(len(stops_of(side)) - 1)]
            assert np.allclose(np.sum(shares, axis=0), 1.0)
            assert min(share.min() for share in shares) >= 0.0


def test_places_are_named_by_notches(changes):
    side = next(s for s in changes.outlines[0].sides if len(s.notches))
    last = len(stops_of(side)) - 2
    assert words_of(side, 0, last) == ("its beginning", "its end")
    assert any("notch" in word for k in range(last) for word in words_of(side, k, k))


def test_mesh_and_pattern_change_alike(changes, candidates):
    amounts = {c: (-1) ** k * 2 * MM for k, c in enumerate(some(candidates, "offset", 4))}
    amounts |= dict.fromkeys(some(candidates, "length", 2), 3 * MM)
    cover, pattern = changes.cover(amounts), changes.pattern(amounts)
    for outline, panel in zip(changes.outlines, pattern.panels, strict=True):
        ring = np.vstack([panel.outline, panel.outline[:1]])
        away, _ = mesh.nearest_places(ring, cover.uv[outline.vertices])
        assert away.max() < 0.15 * MM  # chords of a drawing with a point every 20 mm
    assert pattern.edges == changes.drawn.edges
    assert cover.scene_digest == ""


def test_nothing_changes_by_nothing_and_half_moves_half(changes, candidates):
    (candidate,) = some(candidates, "offset", 1, seed=1)
    assert np.array_equal(changes.cover({candidate: 0.0}).rest, changes.solution.cover.rest)
    rest = changes.solution.cover.rest
    way = changes.cover({candidate: 2 * MM}).rest - rest
    half = changes.cover({candidate: MM}).rest - rest
    assert np.allclose(half, 0.5 * way, atol=1e-15)
    assert np.linalg.norm(way, axis=1).max() <= 2.9 * MM  # a sharp corner goes a little farther


def test_notches_and_allowance_follow_the_sew_line(changes, candidates):
    candidate = next(
        c
        for c in candidates
        if c.kind == "offset" and len(changes.outlines[c.panel].sides[c.side].notches)
    )
    before = changes.drawn.panels[candidate.panel]
    after = changes.pattern({candidate: 3 * MM}).panels[candidate.panel]
    ring = np.vstack([after.outline, after.outline[:1]])
    old = np.vstack([before.outline, before.outline[:1]])
    for was, now in zip(before.notches, after.notches, strict=True):
        start = mesh.nearest_places(old, was.position[None])[0]
        assert mesh.nearest_places(ring, now.position[None])[0] == pytest.approx(start, abs=2e-5)


def test_a_change_that_the_mesh_cannot_follow_is_refused(changes, candidates):
    (candidate,) = some(candidates, "offset", 1)
    with pytest.raises(InvertedElementError, match="cannot follow"):
        changes.cover({candidate: -0.2})


def test_a_hook_goes_into_the_foam(changes, candidates):
    hook = next(c for c in candidates if c.kind == "hook")
    cover = changes.cover({hook: 2 * MM})
    for was, now in zip(changes.solution.cover.anchors, cover.anchors, strict=True):
        way = now.target - was.target
        if was.name == hook.name:
            assert np.allclose(np.linalg.norm(way, axis=1), 2 * MM)
            assert (way[:, 2] < 0.0).all()
        else:
            assert not way.any()


def test_foam_rises_below_its_panel_only(changes, candidates):
    foam = next(c for c in candidates if c.kind == "foam")
    raised = changes.cover({foam: 3 * MM}).foam
    height = np.linalg.norm(raised.vertices - changes.solution.cover.foam.vertices, axis=1)
    assert height.max() == pytest.approx(3 * MM)
    assert 0.0 < (height > 0.0).mean() < 0.9
