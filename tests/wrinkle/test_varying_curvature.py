"""Curvature that varies and turns over an uneven mesh: no value stands for its neighbours."""

import numpy as np
import pytest

from seatlook import wrinkle
from seatlook.mesh import face_areas
from seatlook.wrinkle.jet import vertex_curvature
from support.cubic import FRAME, SIZE, derivatives, exact, share, surface
from support.meshes import rectangle
from support.wrinkle_samples import shaped

H = 0.004


def inner(X, rows=2.5):
    return (np.minimum(X, SIZE - X) > rows * H).all(axis=1)


@pytest.fixture(scope="module")
def sample():
    return shaped(surface, h=H, kind="graded", size=SIZE)


def test_the_sample_varies_in_size_sign_and_direction(sample):
    K, _ = exact(sample.cover.rest)
    values, axes = np.linalg.eigh(K)
    assert values[:, 0].min() < -10
    assert values[:, 1].max() > 10
    turn = np.degrees(np.arctan2(axes[:, 1, 0], axes[:, 0, 0]))
    assert np.ptp(turn % 180) > 60
    # One value for all would be off by as much as all of the field.
    assert share(K - K.mean(axis=0), K) == pytest.approx(1.0)


@pytest.mark.parametrize("flip", [1, -1])
def test_tensor_in_space(sample, flip):
    """All nine components, at every inner vertex of either orientation."""
    rest, faces = sample.cover.rest, sample.cover.faces
    _, K = exact(rest)
    got = vertex_curvature(sample.positions, faces[:, ::flip])
    inside = inner(rest, rows=1.0)
    assert share((got - flip * K)[inside], K[inside]) < 0.008
    np.testing.assert_allclose(got, got.transpose(0, 2, 1), atol=1e-9)


def test_tensor_is_tangent_also_on_the_outline(sample):
    """There the mean normal of the faces is off by a degree or two; the fit's slope corrects it."""
    rest, faces = sample.cover.rest, sample.cover.faces
    first, _ = derivatives(rest)
    normal = np.cross(first[:, 0], first[:, 1])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    K = vertex_curvature(sample.positions, faces)
    out_of_plane = np.einsum("nij,nj->ni", K, normal)
    outline = (np.minimum(rest, SIZE - rest) < 1e-9).any(axis=1)
    size = np.sqrt((exact(rest)[1][outline] ** 2).sum(axis=(1, 2)).mean())
    assert np.sqrt((out_of_plane[outline] ** 2).sum(axis=1).mean()) < 0.006 * size


def test_shape_in_rest_axes(sample):
    """Pulled back through stretch and shear, to the middle of every face."""
    cover = sample.cover
    centre = cover.rest[cover.faces].mean(axis=1)
    K, _ = exact(centre)
    got = wrinkle.shape_curvature(cover, sample.positions)
    inside = inner(centre)
    assert share((got - K)[inside], K[inside]) < 0.013


def test_recovered_from_the_strains(sample):
    """Face by face the element is rough; carried to the vertices it follows the field."""
    cover = sample.cover
    raw = wrinkle.curvature_tensor(sample.strain_top, sample.strain_bottom, cover.thickness)
    K, _ = exact(cover.rest)
    inside = inner(cover.rest)
    got = wrinkle.recover(cover.rest, cover.faces, raw)
    assert share((got - K)[inside], K[inside]) < 0.012


def test_every_component_is_carried_by_itself():
    """A plane for each of six, none of them symmetric."""
    rest, faces = rectangle("graded", *SIZE, H)
    slope = np.random.default_rng(1).normal(size=(2, 2, 3)) * 50
    field = np.einsum("md,dij->mij", rest[faces].mean(axis=1), slope) + np.arange(6).reshape(2, 3)
    back = wrinkle.recover(rest, faces, field)
    whole = np.einsum("nd,dij->nij", rest, slope) + np.arange(6).reshape(2, 3)
    np.testing.assert_allclose(back, whole, rtol=1e-9, atol=1e-9)


def test_crests_of_an_oblique_wave_are_not_lowered():
    """Twelve elements a wave: one fit over a patch takes 5 % off, the second gives it back."""
    wavelength, amplitude, a = 0.06, 0.0005, np.radians(35.0)
    along, k = np.array([np.cos(a), np.sin(a)]), 2 * np.pi / wavelength

    def waves(X):
        return np.column_stack([X, amplitude * np.sin(k * (X @ along))]) @ FRAME.T

    solution = shaped(waves, h=wavelength / 12, kind="graded", size=(0.18, 0.14))
    cover = solution.cover
    raw = wrinkle.curvature_tensor(solution.strain_top, solution.strain_bottom, cover.thickness)
    got = wrinkle.recover(cover.rest, cover.faces, raw)
    size = amplitude * k**2
    full = size * np.sin(k * (cover.rest @ along))[:, None, None] * np.outer(along, along)
    inside = (np.minimum(cover.rest, [0.18, 0.14] - cover.rest) > 0.0125).all(axis=1)
    error = (got - full)[inside]
    assert np.sqrt((error**2).sum(axis=(1, 2)).mean()) < 0.013 * size
    fitted = (got * full)[inside].sum() / (full**2)[inside].sum()
    assert fitted == pytest.approx(1.0, abs=0.012)


def test_error_is_the_distance_from_the_patches():
    """Of one face that stands out by 1, a plane beside it taken off."""
    rest, faces = rectangle("graded", *SIZE, H)
    centre = rest[faces].mean(axis=1)
    plane = 40.0 * centre[:, 0] - 25.0 * centre[:, 1] + 3.0
    assert np.abs(wrinkle.recovery_error(rest, faces, plane)).max() < 1e-9
    one = int(np.argmin(np.linalg.norm(centre - [0.05, 0.05], axis=1)))
    lump = np.zeros(len(faces))
    lump[one] = 1.0
    error = wrinkle.recovery_error(rest, faces, plane + lump)
    touching = np.isin(faces, faces[one]).any(axis=1)
    assert 0.6 < error[one] < 0.95
    assert np.abs(error[~touching]).max() < 1e-9
    # What it stands out by is the mean of what its corners make of it: patches by area.
    area = face_areas(rest, faces)
    share_of_patch = []
    for vertex in faces[one]:
        near = np.flatnonzero((faces == vertex).any(axis=1))
        basis = np.column_stack([np.ones(len(near)), (centre[near] - rest[vertex]) / H])
        w = area[near]
        fit = np.linalg.solve(basis.T @ (w[:, None] * basis), basis.T @ (w * lump[near]))
        share_of_patch.append(fit[0])
    assert error[one] == pytest.approx(1.0 - np.mean(share_of_patch), rel=1e-9)


@pytest.mark.parametrize("degrees", [25.0, 115.0])
def test_low_pass_takes_an_oblique_wave_as_it_says(degrees):
    """1 / (1 + (cut-off / wavelength)^4), whatever the direction, on uneven elements."""
    wavelength, size = 0.03, (0.2, 0.16)
    a = np.radians(degrees)
    along, k = np.array([np.cos(a), np.sin(a)]), 2 * np.pi / wavelength

    def waves(X):
        flat = np.column_stack([X, 0.0004 * np.sin(k * (X @ along))])
        return flat @ FRAME.T

    solution = shaped(waves, h=0.003, kind="graded", size=size)
    smooth = wrinkle.low_passed(solution.cover, solution.positions) @ FRAME
    rest = solution.cover.rest
    middle = (np.minimum(rest, np.array(size) - rest) > 0.045).all(axis=1)
    z, before = smooth[middle, 2], (solution.positions @ FRAME)[middle, 2]
    kept = 1 / (1 + (wrinkle.DESIGN_WAVELENGTH / wavelength) ** 4)
    assert (z @ before) / (before @ before) == pytest.approx(kept, abs=0.02)
