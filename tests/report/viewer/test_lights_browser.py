"""The points of a wide light from which the viewer's samples are lit."""

from __future__ import annotations

import numpy as np
import pytest

from seatlook.model import Light
from seatlook.model.light.lamps import rectangle, strip
from seatlook.report.viewer.section import _light
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


def test_a_moved_strip_lies_and_faces_as_in_a_scene_with_that_place(browser, tmp_path):
    rng = np.random.default_rng(4)
    middle = np.array([0.02, -0.05, 0.2])
    kinds = [(strip, (1500.0, 100.0)), (rectangle, (400.0, 300.0))] * 6
    aims = middle + 0.2 * rng.uniform(-1.0, 1.0, (12, 3)) * (np.arange(12) > 3)[:, None]
    starts = middle + 1.2 * unit(rng.normal(size=(12, 3)))
    # Where the light's axis passes the middle: what the viewer goes on facing.
    axes = unit(aims - starts)
    aims = starts + ((middle - starts) * axes).sum(axis=1, keepdims=True) * axes

    def light(number: int, where: np.ndarray, along: np.ndarray) -> Light:
        kind, size = kinds[number]
        return kind(
            position_mm=tuple(1e3 * where),
            target_mm=tuple(1e3 * aims[number]),
            along=tuple(along),
            size_mm=size,
        )

    lights = [light(k, starts[k], rng.normal(size=3)) for k in range(12)]
    places = [
        {"azimuth": azimuth, "elevation": elevation, "distance": distance}
        for azimuth, elevation, distance in rng.uniform((-3.1, 0.1, 0.5), (3.1, 1.5, 2.0), (6, 3))
    ]
    content = {
        "lights": [_light(one) for one in lights],
        "middle": middle.tolist(),
        "places": places,
    }
    page = probe_page(browser, "moved", content, tmp_path)
    found = page.evaluate("() => window.probed")
    page.close()
    for number, one in enumerate(lights):
        same = found["same"][number]
        assert np.allclose(same["vector"], one.vector, atol=1e-9)
        assert np.allclose(same["sides"], one.sides, atol=1e-9)
        for moved in found["moved"][number]:
            expected = light(number, np.array(moved["vector"]), one.sides[0])
            assert np.allclose(moved["sides"], expected.sides, atol=1e-9)


def unit(vectors: np.ndarray) -> np.ndarray:
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)
