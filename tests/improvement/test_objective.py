"""The objective: its derivative, and what it counts."""

import numpy as np
import pytest

from seatlook.improvement.objective import Goal, weights
from seatlook.model.zones import FREE_EDGE


def test_its_gradient_is_that_of_central_differences(objective, balance):
    sheet, x = balance.process.sheet, balance.x.copy()
    gradient = objective.gradient(sheet, x)
    way = 1e-3 * np.random.default_rng(0).standard_normal(x.shape)
    slope = float((gradient * way).sum())
    errors = []
    for step in (1e-3, 5e-4):
        ends = [objective.parts(sheet, x + s * step * way).total for s in (1.0, -1.0)]
        errors.append(abs((ends[0] - ends[1]) / (2.0 * step) - slope))
    assert errors[1] < 1e-3 * abs(slope)
    assert errors[1] < 0.3 * errors[0]  # second order


def test_at_its_own_shape_it_counts_the_net_curvature(objective, balance, slippery):
    """What the design asks for is taken out, so a goal out of reach leaves next to nothing."""
    parts = objective.parts(balance.process.sheet, balance.x)
    assert parts.w2 > 0.0
    assert parts.strain > 0.0
    assert parts.gap > 0.0
    assert parts.total == pytest.approx(parts.w2 + parts.strain + parts.gap)
    objective.goal = Goal(w2=50.0, strain=(-1.0, 1.0), gap=1.0)
    try:
        assert objective.parts(balance.process.sheet, balance.x).total < 1e-3
    finally:
        objective.goal = Goal(w2=0.02, strain=(-0.002, 0.01), gap=5e-4)


def test_free_edges_do_not_count_and_classes_weigh(solved):
    cover = solved.cover
    plain = weights(cover, {})
    free = cover.zone == cover.zone_names.index(FREE_EDGE)
    assert not plain[free].any()
    assert (plain[~free] == 1.0).all()
    zone = next(name for name in cover.zone_names if name != FREE_EDGE)
    own = cover.zone == cover.zone_names.index(zone)
    assert (weights(cover, {zone: "C"})[own] == 0.2).all()
