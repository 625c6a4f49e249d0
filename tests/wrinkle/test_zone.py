"""The zone table: weights by rest area."""

import numpy as np
import pytest

from seatlook import wrinkle
from seatlook.wrinkle import zone
from support.wrinkle_samples import shaped, wave


def test_quantile_counts_area_not_faces():
    values, weight = np.array([0.0, 1.0, 5.0]), np.array([0.90, 0.08, 0.02])
    assert zone.quantile(values, weight, 0.95) == 1.0
    assert zone.quantile(values, weight, 0.99) == 5.0


def test_rows_hold_means_by_area_cause_size_and_error():
    solution = shaped(wave(0.0005, 0.06), h=0.005, kind="right", panels=2)
    indices = wrinkle.wrinkle_indices(
        *wrinkle.surface_strains(solution), solution.cover.thickness, 20.0, "tensor"
    )
    rows = wrinkle.zone_table(solution, indices)
    assert [r.zone for r in rows] == ["P0", "P1"]
    for row in rows:
        mine = solution.cover.panel == int(row.zone[1])
        weight = solution.cover.rest_area[mine]
        assert row.area == pytest.approx(0.12**2)
        assert row.w2_mean == pytest.approx(np.average(indices.w2[mine], weights=weight))
        assert row.w_stretch_mean + row.w_compression_mean == pytest.approx(row.w2_mean)
        assert row.stretch_share == pytest.approx(row.w_stretch_mean / row.w2_mean)
        assert row.element_size == pytest.approx(0.005 * (2 + np.sqrt(2)) / 3)
        assert 0 < row.w2_error < 0.1


def test_a_flat_zone_has_neither_share_nor_error():
    solution = shaped(wave(0.0, 0.06))
    indices = wrinkle.wrinkle_indices(*wrinkle.surface_strains(solution), 0.001, 20.0)
    (row,) = wrinkle.zone_table(solution, indices)
    assert row.w2_mean == pytest.approx(0.0, abs=1e-9)
    assert row.w2_error == pytest.approx(0.0, abs=1e-9)
