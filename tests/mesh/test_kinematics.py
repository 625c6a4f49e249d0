"""Strains and principal values against NumPy's eigenvalues."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from seatlook.mesh.kinematics import (
    deformation_gradient,
    green_strain,
    logarithmic_strain,
    major_direction,
    principal_values,
)


@given(arrays(float, (4, 2, 2), elements=st.floats(-0.2, 0.4)))
def test_logarithmic_strain_is_the_logarithm_of_the_stretch(a):
    gradient = np.eye(2) + a  # of any a drawn here none crushes the sheet to nothing
    green = 0.5 * (np.swapaxes(gradient, 1, 2) @ gradient - np.eye(2))
    values, axes = np.linalg.eigh(green)
    expected = axes @ (0.5 * np.log1p(2 * values)[:, :, None] * np.swapaxes(axes, 1, 2))
    np.testing.assert_allclose(logarithmic_strain(green), expected, atol=1e-7)


def test_equal_stretches_have_a_logarithm_too():
    green = np.broadcast_to(0.105 * np.eye(2), (3, 2, 2))
    np.testing.assert_allclose(logarithmic_strain(green), np.log(1.1) * green / 0.105, rtol=1e-12)


def test_a_stretch_that_cannot_be_is_nan():
    assert np.isnan(logarithmic_strain(np.diag([0.1, -0.6])[None])).any()


@given(arrays(float, (5, 2, 2), elements=st.floats(-1, 1)))
def test_major_direction_is_the_eigenvector(a):
    t = a + np.swapaxes(a, 1, 2)
    angle = major_direction(t)
    v = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    along = np.einsum("mi,mij,mj->m", v, t, v)
    np.testing.assert_allclose(along, principal_values(t)[0], atol=1e-9)


@given(arrays(float, (3, 2), elements=st.floats(-1, 1)))
def test_a_linear_map_gives_its_own_gradient(F):
    rest = np.array([[0.0, 0.0], [1.0, 0.2], [0.3, 0.9]])
    faces = np.array([[0, 1, 2]])
    np.testing.assert_allclose(deformation_gradient(rest, rest @ F.T, faces)[0], F, atol=1e-12)
    np.testing.assert_allclose(green_strain(F[None])[0], 0.5 * (F.T @ F - np.eye(2)), atol=1e-15)
