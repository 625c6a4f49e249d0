"""Principal stretches, against singular values and where two are all but alike."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from seatlook.flattening.newton import principal_stretches


@given(arrays(float, (5, 2, 2), elements=st.floats(-0.6, 0.6)), st.floats(-3.2, 3.2))
def test_principal_stretches_are_the_singular_values(a, angle):
    c, s = np.cos(angle), np.sin(angle)
    F = np.array([[c, -s], [s, c]]) @ (np.eye(2) + a)
    F = F[np.linalg.det(F) > 0]
    np.testing.assert_allclose(
        principal_stretches(F), np.linalg.svd(F, compute_uv=False), rtol=1e-12, atol=1e-13
    )


def test_a_turn_is_no_strain():
    angle = np.linspace(-3.0, 3.0, 997)
    c, s = np.cos(angle), np.sin(angle)
    F = np.stack([np.stack([c, -s], axis=1), np.stack([s, c], axis=1)], axis=1)
    np.testing.assert_allclose(principal_stretches(F), 1.0, rtol=0, atol=1e-15)


def test_stretches_that_are_all_but_alike_keep_their_difference():
    for apart in (1e-6, 1e-9, 1e-12):
        F = np.diag([1.0 + apart, 1.0])[None]
        high, low = principal_stretches(F)[0]
        np.testing.assert_allclose(high - low, apart, atol=1e-15)
