"""Statistics of faces count area, not faces."""

import numpy as np

from seatlook.mesh.statistics import quantile


def test_quantile_counts_area_not_faces():
    values, weight = np.array([0.0, 1.0, 5.0]), np.array([0.90, 0.08, 0.02])
    assert quantile(values, weight, 0.95) == 1.0
    assert quantile(values, weight, 0.99) == 5.0
