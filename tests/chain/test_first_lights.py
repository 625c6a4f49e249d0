"""Where the bulbs of a first scene hang."""

import numpy as np
import pytest

from seatlook.chain.start.scene_file import _bulb
from support.boxes import box_scene

LYING, STANDING = np.array([0.0, 0.0, 1.0]), np.array([0.0, -1.0, 0.0])


@pytest.mark.parametrize(
    ("size", "seen"),
    [
        ((0.50, 0.55, 0.12), LYING),
        ((0.30, 0.62, 0.25), LYING),
        ((0.45, 0.12, 0.65), STANDING),
        ((0.28, 0.13, 0.176), STANDING),
    ],
)
def test_bulbs_light_the_side_that_is_seen(size, seen):
    """They hang before it, farther out than the foam is thick, and mirror each other."""
    foam = box_scene(size=size, spacing=0.03, element_size=0.03).foam
    middle = (foam.vertices.min(axis=0) + foam.vertices.max(axis=0)) / 2
    left, right = (np.array(_bulb(foam, 0.38, sign)) / 1000 - middle for sign in (1.0, -1.0))
    assert left @ seen > 0.38
    assert left[0] > 0.38
    np.testing.assert_allclose(right, left * [-1, 1, 1], atol=0.011)
