"""Pulls of hog rings: of rings at a pitch, and of a line that is pulled all along."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from seatlook.assembly import assemble
from seatlook.results.ring_pulls import overpulled, ring_pulls
from seatlook.solver import solve
from support import scenes


@pytest.fixture(scope="module", params=[None, 0.05], ids=["all along", "rings"])
def solution(request):
    scene = scenes.two_panels(gap=0.004, element_size=0.02)
    (hook,) = scene.hooks
    hook = dataclasses.replace(hook, pitch=request.param, limit=1e-6)
    return solve(assemble(dataclasses.replace(scene, hooks=(hook,))))


def test_rings_hold_the_whole_line_between_them(solution):
    rings = ring_pulls(solution)
    (anchor,) = (a for a in solution.cover.anchors if a.kind == "hook")
    held = [ring.pull / ring.per_length for ring in rings]
    np.testing.assert_allclose(held, anchor.length, rtol=1e-12)
    along = rings[-1].at - rings[0].at
    # The rings at the ends hold half of what the others do.
    assert sum(held) == pytest.approx(along, rel=0.01)
    assert [ring.ring for ring in rings] == list(range(1, len(rings) + 1))


def test_the_ring_above_its_limit_is_named(solution):
    (message,) = overpulled(solution)
    worst = max(ring_pulls(solution), key=lambda ring: ring.pull)
    assert message.startswith(f"hook {worst.hook}: ring {worst.ring}, {1e3 * worst.at:.0f} mm")
    assert not worst.kept
