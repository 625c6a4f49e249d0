"""Shells of which no two are alike: curvature, strain, thickness, shape, order, sides."""

import dataclasses

import numpy as np
import pytest

from seatlook.chain.shells.states import ShellCriteria, shell_indices
from seatlook.model import Shells, ShellState
from seatlook.shells.strains import element_frames
from support.cubic import FRAME, SIZE, exact, share, surface

THRESHOLD = 20.0


def skew_grid(n=30, m=22):
    """Corners (k, 4) of a skew, uneven grid on the rest plane in any order, a third triangles."""
    rng = np.random.default_rng(11)
    x, y = np.meshgrid(np.linspace(0, 1, n + 1) ** 1.3, np.linspace(0, 1, m + 1), indexing="ij")
    X = np.stack([x + 0.03 * np.sin(7 * y) * x * (1 - x), y + 0.04 * np.sin(9 * x) * y * (1 - y)])
    X = X.reshape(2, -1).T * SIZE
    i, j = (a.ravel() for a in np.meshgrid(np.arange(n), np.arange(m), indexing="ij"))
    a = i * (m + 1) + j
    quads = np.stack([a, a + m + 1, a + m + 2, a + 1], axis=1)
    split = rng.random(len(quads)) < 0.2
    halves = [quads[split][:, columns] for columns in ([0, 1, 2, 2], [0, 2, 3, 3])]
    corners = np.concatenate([quads[~split], *halves])[rng.permutation(len(quads) + split.sum())]
    turn = rng.integers(0, 4, len(corners))
    whole = corners[:, 2] != corners[:, 3]
    for k in np.flatnonzero(whole):
        corners[k] = np.roll(corners[k], turn[k])
    return X, corners


def shells_on(positions, reference, corners, **change):
    rng = np.random.default_rng(5)
    k = len(corners)
    shells = Shells(
        corners=corners, element_ids=rng.permutation(k) + 1, part=np.ones(k, int),
        node_count=len(positions), reference=reference,
    )  # fmt: skip
    values = {
        "time": 0.0, "positions": positions, "thickness": rng.uniform(0.0008, 0.003, k),
        "alive": rng.random(k) > 0.1,
    }  # fmt: skip
    return shells, ShellState(**(values | change))


def middles(points, corners):
    """Mean of the three or four corners (k, ...)."""
    weight = np.ones((len(corners), 4))
    weight[corners[:, 2] == corners[:, 3], 3] = 0.0
    return np.einsum("kc,kcd->kd", weight, points[corners]) / weight.sum(axis=1)[:, None]


def inner(centre, rows=2.5):
    return (np.minimum(centre, SIZE - centre) > rows * 0.004).all(axis=1)


def turned_round(corners, rows):
    """Number some elements the other way round."""
    corners = corners.copy()
    whole = corners[:, 2] != corners[:, 3]
    for k in rows:
        corners[k] = corners[k][[3, 2, 1, 0]] if whole[k] else corners[k][[1, 0, 2, 2]]
    return corners


@pytest.mark.parametrize("bent", [0.0, 0.6])
def test_bending_from_the_shape(bent):
    """Change of curvature since a flat or a bent reference, in every element's own plane."""
    X, corners = skew_grid()
    rows = np.random.default_rng(2).choice(len(corners), len(corners) // 5, replace=False)
    mixed = turned_round(corners, rows)
    shells, state = shells_on(surface(X), surface(X, bent), mixed)
    w = shell_indices(shells, state, ShellCriteria(curvature="tensor", c_threshold=THRESHOLD))
    assert w.source == "shape"
    assert len(w.element) == state.alive.sum() < len(corners)
    assert (np.isin(w.element, rows) == (w.sign < 0)).all()
    centre = middles(X, mixed)[w.element]
    planes = [
        element_frames(shells, points, w.element)[0][:, :2]
        for points in (surface(X), surface(X, bent))
    ]
    now, rest = (
        plane @ exact(centre, share_)[1] @ plane.transpose(0, 2, 1)
        for plane, share_ in zip(planes, (1.0, bent), strict=True)
    )
    change = now - rest
    got = 2.0 * w.strain_half / state.thickness[w.element, None, None]
    inside = inner(centre)
    assert share((got - change)[inside], change[inside]) < 0.03
    smallest = np.linalg.eigvalsh(change)[:, 0]
    w2 = np.maximum(-smallest, 0.0) / THRESHOLD
    assert share((w.indices.w2 - w2)[inside], w2[inside]) < 0.03
    assert w2[inside].max() > 0.3


def test_middle_strain_of_a_sheared_sheet():
    """One deformation for all: the same principal strains in every element, turned as it lies."""
    X, corners = skew_grid()
    F = np.array([[1.06, 0.09], [-0.02, 0.95]])
    flat = np.pad(X, ((0, 0), (0, 1)))
    moved = np.pad(X @ F.T, ((0, 0), (0, 1))) @ FRAME.T
    shells, state = shells_on(moved, flat, corners)
    w = shell_indices(shells, state, ShellCriteria(curvature="tensor"))
    plane = element_frames(shells, flat, w.element)[0][:, :2, :2]
    green = 0.5 * (F.T @ F - np.eye(2))
    np.testing.assert_allclose(
        w.strain_mid, plane @ green @ plane.transpose(0, 2, 1), rtol=0, atol=1e-12
    )
    minor, major = np.linalg.eigvalsh(green)
    assert minor < 0 < major
    np.testing.assert_allclose(w.indices.r_stretch, 1 - min(-minor / major, major / -minor))
    side = [
        np.linalg.norm(moved[corners[:, k]] - moved[corners[:, k - 1]], axis=1) for k in range(4)
    ]
    count = np.where(corners[:, 2] == corners[:, 3], 3, 4)
    np.testing.assert_allclose(w.size, (np.sum(side, axis=0) / count)[w.element])


def test_strains_of_every_element_are_its_own():
    """Any tensors in any plane, with a thickness strain that would win, some elements turned."""
    X, corners = skew_grid(12, 9)
    rows = np.arange(0, len(corners), 5)
    mixed = turned_round(corners, rows)
    shells, state = shells_on(surface(X), None, mixed)
    k = len(corners)
    rng = np.random.default_rng(8)
    bend, mid = (scale * rng.normal(size=(k, 2, 2)) for scale in (0.02, 0.05))
    bend, mid = (0.5 * (a + a.transpose(0, 2, 1)) for a in (bend, mid))
    frame, area = element_frames(shells, state.positions, np.arange(k))
    plane, normal = frame[:, :2], frame[:, 2]
    through = normal[:, :, None] * normal[:, None]

    def in_space(strain, across):
        return plane.transpose(0, 2, 1) @ strain @ plane + across * through

    state = dataclasses.replace(
        state, strain_inner=in_space(mid - bend, 0.3), strain_outer=in_space(mid + bend, -0.4)
    )
    w = shell_indices(shells, state, ShellCriteria(curvature="tensor", c_threshold=THRESHOLD))
    sign = np.where(np.isin(w.element, rows), -1.0, 1.0)
    np.testing.assert_array_equal(w.sign, sign)
    np.testing.assert_allclose(w.area, area[w.element])
    np.testing.assert_allclose(w.strain_mid, mid[w.element], atol=1e-12)
    half = sign[:, None, None] * bend[w.element]
    np.testing.assert_allclose(w.strain_half, half, atol=1e-12)
    smallest = np.linalg.eigvalsh(2 * half / state.thickness[w.element, None, None])[:, 0]
    np.testing.assert_allclose(w.indices.w2, np.maximum(-smallest, 0) / THRESHOLD, atol=1e-9)


def test_only_the_parts_without_bending_strains_are_bent_by_their_shape():
    """Two parts side by side; one has strains, that of the other are those of a membrane."""
    X, corners = skew_grid()
    shells, state = shells_on(surface(X), surface(X, 0.0), corners)
    centre = middles(X, corners)
    blind = centre[:, 0] > 0.07
    shells = dataclasses.replace(shells, part=np.where(blind, 7, 3))
    stretch = np.broadcast_to(0.01 * np.eye(3), (len(corners), 3, 3))
    frame, _ = element_frames(shells, state.positions, np.arange(len(corners)))
    e1 = frame[:, 0]
    own = 0.004 * np.linspace(1, 2, len(corners))[:, None, None] * e1[:, :, None] * e1[:, None]
    bend = np.where(blind[:, None, None], 0.0, own)
    state = dataclasses.replace(state, strain_inner=stretch - bend, strain_outer=stretch + bend)
    w = shell_indices(shells, state, ShellCriteria(curvature="tensor", c_threshold=THRESHOLD))
    assert w.source == "strains and shape"
    side, t = blind[w.element], state.thickness[w.element]
    np.testing.assert_allclose(
        w.strain_half[~side, 0, 0], 0.004 * np.linspace(1, 2, len(corners))[w.element[~side]]
    )
    smallest = np.linalg.eigvalsh(exact(centre)[1])[w.element, 0]
    got = np.linalg.eigvalsh(2 * w.strain_half / t[:, None, None])[:, 0]
    inside = side & inner(centre[w.element])
    assert share((got - smallest)[inside], smallest[inside]) < 0.08
