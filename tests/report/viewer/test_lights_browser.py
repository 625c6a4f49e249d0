"""The points of a wide light from which the viewer's samples are lit."""

from __future__ import annotations

import numpy as np
import pytest

from support.probe import probe_page

pytestmark = pytest.mark.browser


def test_points_of_a_light_lie_around_its_middle_and_fill_it(browser, tmp_path):
    counts = [4, 8, 16, 64]
    page = probe_page(browser, "disc", {"counts": counts}, tmp_path)
    for count, found in zip(counts, page.evaluate("() => window.probed"), strict=True):
        points = np.array(found)
        assert np.abs(points.mean(axis=0)).max() < 1e-12
        radius = np.linalg.norm(points, axis=1)
        assert radius.max() <= 1.0
        # Spread evenly over a disc, the mean of the squared radius is a half.
        assert abs((radius**2).mean() - 0.5) < 0.2 / np.sqrt(count) + 0.05
        apart = np.linalg.norm(points[:, None] - points, axis=2) + 2 * np.eye(count)
        assert apart.min() > 0.5 / np.sqrt(count)
    page.close()
