"""Labels of a drawing hide neither each other nor more of its lines than they must."""

from __future__ import annotations

import numpy as np
import pytest

from seatlook.pbr.maps.labels import place_boxes


def overlap(one, two):
    return min(one[2], two[2]) > max(one[0], two[0]) and min(one[3], two[3]) > max(one[1], two[1])


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("spread", [30.0, 200.0, 2000.0])
def test_no_two_labels_overlap_and_all_lie_inside(seed, spread):
    rng = np.random.default_rng(seed)
    anchors = [tuple(p) for p in np.array([680.0, 400.0]) + spread * (rng.random((40, 2)) - 0.5)]
    sizes = [(float(w), 23.0) for w in rng.uniform(20, 90, 40)]
    boxes = place_boxes(anchors, sizes, np.zeros((800, 1360), dtype=bool))
    assert not [(i, j) for i in range(40) for j in range(i) if overlap(boxes[i], boxes[j])]
    for box, (width, height) in zip(boxes, sizes, strict=True):
        assert min(box) >= 0
        assert box[2] <= 1360
        assert box[3] <= 800
        assert (box[2] - box[0], box[3] - box[1]) == pytest.approx((width, height))


def test_a_label_alone_stays_where_it_belongs_and_leaves_a_line_free():
    lines = np.zeros((400, 400), dtype=bool)
    (box,) = place_boxes([(200.0, 200.0)], [(40.0, 20.0)], lines)
    assert box == (180.0, 190.0, 220.0, 210.0)
    lines[180:220, :] = True
    (box,) = place_boxes([(200.0, 200.0)], [(40.0, 20.0)], lines)
    assert box[3] <= 195 or box[1] >= 205
