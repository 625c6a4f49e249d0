"""Where a ray meets the surface: what was gathered at vertices, also beside a face."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from numba import njit

from seatlook.pbr.kernels import stage
from seatlook.pbr.kernels.surface import blend

FACES = np.array([[2, 0, 1]])
inside, open_at = stage.inside, stage._open_at
levels = st.lists(st.floats(0.0, 1e5), min_size=9, max_size=9)
beside = st.floats(-0.5, 1.5)


@njit
def both(light, share, faces, b1, b2):
    c1, c2 = inside(b1, b2)
    return blend(light, faces, 0, c1, c2), open_at(share, faces, 0, c1, c2)


@settings(deadline=None)  # the first example compiles
@given(levels, beside, beside)
def test_light_beside_a_face_lies_between_that_of_its_corners(values, b1, b2):
    """A line through a bright and a dark corner would lead below 0 or above the bright one."""
    light = np.array(values).reshape(3, 3)
    share = light[:, 0] / max(1.0, light[:, 0].max())
    got, open_share = both(light, share, FACES, b1, b2)
    assert (np.array(got) >= light.min(axis=0) - 1e-9).all()
    assert (np.array(got) <= light.max(axis=0) * (1 + 1e-12)).all()
    assert share.min() - 1e-12 <= open_share <= share.max() + 1e-12
    if b1 >= 0 and b2 >= 0 and b1 + b2 <= 1:
        corners = np.array([1.0 - b1 - b2, b1, b2])
        np.testing.assert_allclose(got, corners @ light[FACES[0]], rtol=1e-9, atol=1e-6)


def test_light_beside_a_bright_corner_is_that_of_the_edge():
    """Extended along a line it would be -40."""
    light = np.array([[100.0, 50.0, 0.0], [0.0, 0.0, 0.0], [0.0, 10.0, 20.0]])
    got, _ = both(light, np.ones(3), FACES, -0.4, 0.2)
    np.testing.assert_allclose(got, (0.0, 8.0, 16.0), atol=1e-12)
