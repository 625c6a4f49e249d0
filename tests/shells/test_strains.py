"""Shell results: strains in the element plane, sides, membranes, shape where strains are absent."""

import dataclasses

import numpy as np
import pytest

from seatlook.chain.shells.states import ShellCriteria, shell_indices
from seatlook.errors import InputError
from seatlook.model import Shells, ShellState

R, T = 0.05, 0.0012


def strip(n=20, m=6, *, quads=True):
    """Corners of a grid and its flat nodes, 2 mm by 3 mm."""
    X = np.stack(np.meshgrid(np.arange(n + 1) * 2e-3, np.arange(m + 1) * 3e-3, indexing="ij"), -1)
    i, j = (a.ravel() for a in np.meshgrid(np.arange(n), np.arange(m), indexing="ij"))
    a = i * (m + 1) + j
    corners = np.stack([a, a + m + 1, a + m + 2, a + 1], axis=1)
    if not quads:
        upper, lower = corners[::2], corners[1::2]
        half = [lower[:, [0, 1, 2, 2]], lower[:, [0, 2, 3, 3]]]
        corners = np.concatenate([upper, *half])
    X = X.reshape(-1, 2)
    return corners, np.column_stack([X, np.zeros(len(X))])


def bent(sign, *, quads=True, strains=True, tilt=True):
    """A strip bent to a cylinder, in any position, with the exact strains of its two faces."""
    corners, flat = strip(quads=quads)
    angle = flat[:, 0] / R
    x = np.column_stack([R * np.sin(angle), flat[:, 1], sign * R * (np.cos(angle) - 1)])
    q = np.linalg.qr(np.random.default_rng(3).normal(size=(3, 3)))[0] if tilt else np.eye(3)
    q *= np.linalg.det(q)
    x = x @ q.T
    p = x[corners]
    normal = np.cross(p[:, 2] - p[:, 0], p[:, 3] - p[:, 1])
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    along = np.cross(q[:, 1], normal)
    e = T / 2 / R * sign
    outer = e * (along[:, :, None] * along[:, None] - normal[:, :, None] * normal[:, None])
    shells = Shells(
        corners=corners, element_ids=np.arange(len(corners)) + 1, part=np.ones(len(corners), int),
        node_count=len(flat), reference=flat,
    )  # fmt: skip
    return shells, ShellState(
        time=0.0, positions=x, thickness=np.full(len(corners), T),
        alive=np.ones(len(corners), bool),
        strain_inner=-outer if strains else None, strain_outer=outer if strains else None,
    )  # fmt: skip


def turned(shells, state, rows):
    """The same result with some elements numbered the other way round."""
    corners = shells.corners.copy()
    quad = corners[:, 2] != corners[:, 3]
    for k in rows:
        corners[k] = corners[k][[3, 2, 1, 0]] if quad[k] else corners[k][[2, 1, 0, 0]]
    inner, outer = state.strain_inner.copy(), state.strain_outer.copy()
    inner[rows], outer[rows] = state.strain_outer[rows], state.strain_inner[rows]
    return (
        dataclasses.replace(shells, corners=corners),
        dataclasses.replace(state, strain_inner=inner, strain_outer=outer),
    )


@pytest.mark.parametrize("quads", [True, False])
@pytest.mark.parametrize("sign", [1, -1])
@pytest.mark.parametrize(("mode", "share"), [("paper", 0.5), ("tensor", 1.0)])
def test_arch_and_valley_from_global_strains(quads, sign, mode, share):
    """The thickness strain, as large as the bending strain, does not win eq. (1)."""
    w = shell_indices(*bent(sign, quads=quads), ShellCriteria(curvature=mode))
    np.testing.assert_allclose(w.indices.c, sign * share / R, rtol=1e-6)
    assert w.source == "strains"
    assert w.indices.w2.max() == pytest.approx(1.0 if sign < 0 else 0.0, abs=1e-6)


@pytest.mark.parametrize("mode", ["paper", "tensor"])
def test_elements_numbered_the_other_way_round_change_nothing(mode):
    shells, state = bent(-1, quads=False)
    rows = [0, 3, 17, 60, 61, 100]
    plain = shell_indices(shells, state, ShellCriteria(curvature=mode))
    w = shell_indices(*turned(shells, state, rows), ShellCriteria(curvature=mode))
    assert w.turned == len(rows)
    np.testing.assert_allclose(w.indices.c, plain.indices.c)


def test_facing_decides_which_side_is_seen():
    shells, state = bent(1, tilt=False)
    up, down = np.array([0.0, 0, 1]), np.array([0.0, 0, -1])
    assert shell_indices(shells, state, ShellCriteria(facing=up)).indices.c.min() > 0
    below = shell_indices(shells, state, ShellCriteria(facing=down))
    assert below.indices.c.max() < 0
    assert below.turned == len(shells)


@pytest.mark.parametrize("quads", [True, False])
@pytest.mark.parametrize("sign", [1, -1])
def test_without_strains_the_shape_tells(quads, sign):
    w = shell_indices(*bent(sign, quads=quads, strains=False), ShellCriteria(curvature="tensor"))
    assert w.source == "shape"
    np.testing.assert_allclose(w.indices.c, sign / R, rtol=0.01)
    assert np.abs(w.strain_mid).max() < 1e-3


def test_membranes_get_their_bending_from_the_shape():
    """Equal strains on both surfaces of a whole part must not pass as flat."""
    shells, state = bent(-1)
    stretch = np.broadcast_to(0.02 * np.eye(3), state.strain_inner.shape)
    state = dataclasses.replace(state, strain_inner=stretch, strain_outer=stretch)
    w = shell_indices(shells, state, ShellCriteria(curvature="tensor"))
    assert w.source == "shape"
    np.testing.assert_allclose(w.indices.c, -1 / R, rtol=0.01)
    np.testing.assert_allclose(w.strain_mid, np.broadcast_to(0.02 * np.eye(2), w.strain_mid.shape),
                               atol=1e-12)  # fmt: skip
    part = shells.part.copy()
    part[:40] = 2
    inner, outer = stretch.copy(), stretch.copy()
    outer[:40] += 0.001 * np.eye(3)
    mixed = shell_indices(
        dataclasses.replace(shells, part=part),
        dataclasses.replace(state, strain_inner=inner, strain_outer=outer),
        ShellCriteria(curvature="tensor"),
    )
    assert mixed.source == "strains and shape"
    np.testing.assert_allclose(mixed.indices.c[:40], 0.001 / T, rtol=1e-9)
    np.testing.assert_allclose(mixed.indices.c[40:], -1 / R, rtol=0.01)


def test_a_flat_membrane_stays_flat():
    shells, state = bent(1)
    flat = dataclasses.replace(
        state, positions=shells.reference, strain_inner=0 * state.strain_inner,
        strain_outer=0 * state.strain_outer,
    )  # fmt: skip
    w = shell_indices(shells, flat)
    assert w.source == "strains"
    assert np.abs(w.indices.c).max() < 1e-9


def test_stretch_without_strains_comes_from_the_reference():
    shells, state = bent(1, strains=False)
    x = shells.reference * [1.1, 1.0, 1.0]
    w = shell_indices(shells, dataclasses.replace(state, positions=x))
    np.testing.assert_allclose(w.strain_mid[:, 0, 0], 0.105, rtol=1e-12)
    np.testing.assert_allclose(w.indices.r_stretch, 1.0, atol=1e-9)


def test_strains_in_element_axes():
    shells, state = bent(-1)
    e = np.zeros((len(shells), 3, 3))
    e[:, 0, 0], e[:, 2, 2] = -0.012, 0.012
    state = dataclasses.replace(state, strain_inner=-e, strain_outer=e, strain_axes="element")
    w = shell_indices(shells, state, ShellCriteria(curvature="tensor"))
    np.testing.assert_allclose(w.indices.c, -20.0)


def test_deleted_shells_are_left_out():
    shells, state = bent(-1)
    alive = state.alive.copy()
    alive[[0, 5]] = False
    w = shell_indices(shells, dataclasses.replace(state, alive=alive))
    assert len(w.element) == len(shells) - 2
    assert 5 not in w.element
    with pytest.raises(InputError, match="got no shells left, expected shells not deleted"):
        shell_indices(shells, dataclasses.replace(state, alive=np.zeros_like(alive)))


def test_bad_shells_are_named():
    shells, state = bent(1)
    x = state.positions.copy()
    x[shells.corners[4]] = 0.0
    with pytest.raises(InputError, match=r"shells: got \d+ without area, first "):
        shell_indices(shells, dataclasses.replace(state, positions=x))
    t = state.thickness.copy()
    t[3] = 0.0
    with pytest.raises(InputError, match="got 0 or less in 1 shells, first 4, expected above 0"):
        shell_indices(shells, dataclasses.replace(state, thickness=t))
    with pytest.raises(InputError, match="strains: got none, and no reference shape"):
        shell_indices(
            dataclasses.replace(shells, reference=None),
            dataclasses.replace(state, strain_inner=None, strain_outer=None),
        )
