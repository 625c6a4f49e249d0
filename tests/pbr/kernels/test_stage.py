"""Where a ray meets the surface: what was gathered at vertices, also beside a face."""

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from numba import njit

from seatlook.pbr.kernels import stage

FACES = np.array([[2, 0, 1]])
light_at, open_at = stage._light_at, stage._open_at
levels = st.lists(st.floats(0.0, 1e5), min_size=9, max_size=9)
beside = st.floats(-0.5, 1.5)


@njit
def both(light, share, faces, b1, b2):
    return light_at(light, faces, 0, b1, b2), open_at(share, faces, 0, b1, b2)


@settings(deadline=None)  # the first example compiles
@given(levels, beside, beside)
def test_light_is_never_below_0_and_no_more_than_all_is_open(values, b1, b2):
    light = np.array(values).reshape(3, 3)
    share = light[:, 0] / max(1.0, light[:, 0].max())
    got, open_share = both(light, share, FACES, b1, b2)
    corners = np.array([1.0 - b1 - b2, b1, b2])
    expected = corners @ light[FACES[0]]
    np.testing.assert_allclose(got, np.maximum(expected, 0.0), rtol=1e-12, atol=1e-9)
    np.testing.assert_allclose(
        open_share, np.clip(corners @ share[FACES[0]], 0.0, 1.0), rtol=1e-12, atol=1e-12
    )


def test_light_beside_a_bright_corner_is_dark():
    """Extended along a line it would be -40."""
    light = np.array([[100.0, 50.0, 0.0], [0.0, 0.0, 0.0], [0.0, 10.0, 20.0]])
    got, _ = both(light, np.ones(3), FACES, -0.4, 0.2)
    np.testing.assert_allclose(got, (0.0, 0.0, 24.0), atol=1e-12)
