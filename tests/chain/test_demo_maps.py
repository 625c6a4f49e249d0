"""What the paper shows of its indices (Figs. 10 and 11), as numbers on the solved demo cover."""

import numpy as np
import pytest

from seatlook.chain.assess import assess
from seatlook.mesh.kinematics import principal_values
from seatlook.model.zones import FREE_EDGE
from seatlook.visibility.reference import on_foam
from seatlook.wrinkle import shape_curvature

pytestmark = pytest.mark.validate


@pytest.fixture(scope="module")
def judged(spoiled):
    """Indices, principal curvatures of the shape as drawn and as solved, and weights by area."""
    _, solution = spoiled
    cover = solution.cover
    drawn = principal_values(shape_curvature(cover, on_foam(solution).positions))
    solved = principal_values(shape_curvature(cover, solution.positions))
    away = cover.zone != cover.zone_names.index(FREE_EDGE)
    return assess(solution).indices, drawn, solved, np.where(away, cover.rest_area, 0.0)


def mean(values, where, area):
    return float(values[where] @ area[where] / area[where].sum())


def test_w1_marks_the_crown_and_w2_does_not(spoiled, judged, record_property):
    indices, (major, minor), _, area = judged
    limit = spoiled[0].c_threshold
    crown = (major > limit) & (minor > -0.1 * limit)
    assert area[crown].sum() > 0.1 * area.sum()
    w1, w2 = mean(indices.w1, crown, area), mean(indices.w2, crown, area)
    record_property("crown_w1_w2", (w1, w2))
    assert w1 > 0.5
    assert w2 < 0.1 * w1


def test_w2_marks_the_valleys(spoiled, judged, record_property):
    indices, (_, drawn), (_, solved), area = judged
    limit = spoiled[0].c_threshold
    valley = (drawn > -0.1 * limit) & (solved < -limit)
    assert area[valley].sum() > 0.005 * area.sum()
    w1, w2 = mean(indices.w1, valley, area), mean(indices.w2, valley, area)
    record_property("valley_w1_w2", (w1, w2))
    assert w2 > 1.0
    assert w1 < 0


def test_w2_is_split_and_too_much_length_is_compression(spoiled, judged, record_property):
    indices, _, _, area = judged
    cover = spoiled[1].cover
    insert = cover.panel == cover.panel_names.index("INSERT")
    stretch, pressed = (
        mean(values, insert, area) for values in (indices.w_stretch, indices.w_compression)
    )
    assert stretch + pressed == pytest.approx(mean(indices.w2, insert, area), rel=1e-12)
    record_property("stretch_and_compression_of_the_insert", (stretch, pressed))
    assert pressed > 1.5 * stretch
