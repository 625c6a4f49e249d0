"""The zone table: weights by rest area."""

import numpy as np
import pytest

from seatlook.chain.assess import assess
from seatlook.model import Criteria
from support.wrinkle_samples import shaped, wave


def test_rows_hold_means_by_area_cause_size_and_error():
    solution = shaped(wave(0.0005, 0.06), h=0.005, kind="right", panels=2)
    assessment = assess(solution, Criteria(thresholds=(20.0,)))
    indices, rows = assessment.indices, assessment.zones
    assert [r.zone for r in rows] == ["P0", "P1"]
    for row in rows:
        mine = solution.cover.panel == int(row.zone[1])
        weight = solution.cover.rest_area[mine]
        assert row.area == pytest.approx(0.12**2)
        assert row["w2_mean"] == pytest.approx(np.average(indices.w2[mine], weights=weight))
        assert row["w_stretch_mean"] + row["w_compression_mean"] == pytest.approx(row["w2_mean"])
        assert row.stretch_share == pytest.approx(row["w_stretch_mean"] / row["w2_mean"])
        assert row.element_size == pytest.approx(0.005 * (2 + np.sqrt(2)) / 3)
        assert 0 < row.w2_face_rms < 0.1


def test_a_flat_zone_has_neither_share_nor_error():
    solution = shaped(wave(0.0, 0.06))
    (row,) = assess(solution, Criteria(thresholds=(20.0,))).zones
    assert row["w2_mean"] == pytest.approx(0.0, abs=1e-9)
    assert row.w2_face_rms == pytest.approx(0.0, abs=1e-9)
