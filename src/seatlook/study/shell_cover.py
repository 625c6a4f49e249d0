"""A state of a finite-element result as a solved cover, which maps, pictures and scores take."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from seatlook.errors import InputError
from seatlook.mesh import edge_lengths, face_vectors
from seatlook.model import Cover, FloatArray, IntArray, Material, Shells, ShellState, Solution
from seatlook.wrinkle.shells import ShellWrinkles, element_frames

_FLAT = 1e-3  # of a part's extent; what lies further from its plane is not flat


def shell_solution(
    shells: Shells,
    state: ShellState,
    wrinkles: ShellWrinkles,
    materials: Material | Mapping[int, Material],
) -> tuple[Solution, IntArray]:
    """Make a solution of the evaluated shells; each part becomes a panel and a zone.

    The undeformed state must be flat, part by part: it is the pattern, and the world axis in which
    a part is longer is its warp. The materials give the thickness of the pictures; the strains on
    both surfaces are those that were evaluated.

    Parameters
    ----------
    wrinkles : of the same state, from ``shell_indices``
    materials : one for all parts, or part number -> Material

    Returns
    -------
    solution : Solution
    element : (m,) int64     row of ``wrinkles`` of each face, to map its values

    Raises
    ------
    InputError
        No undeformed state, a part of it that is not flat, a part without a material.
    """
    if shells.reference is None:
        raise InputError.single(
            "reference", got="none", expected="the undeformed state, as pattern of the texture"
        )
    parts, panel = np.unique(shells.part[wrinkles.element], return_inverse=True)
    chosen = _materials(parts, materials)
    faces, element = _oriented(shells, wrinkles)
    # Nodes on the border of two parts become two vertices, as a seam has two sides.
    pair = panel[element][:, None] * np.int64(shells.node_count) + faces
    vertices, corners = np.unique(pair, return_inverse=True)
    corners = corners.reshape(-1, 3)
    node, owner = vertices % shells.node_count, vertices // shells.node_count
    rest, axes = _flat_parts(shells.reference[node], owner, corners, parts)
    top, mid, bottom = _strains(shells, shells.reference, wrinkles, axes[panel])
    names = tuple(shells.part_names.get(int(p)) or f"part {p}" for p in parts)
    cover = Cover(
        rest=rest,
        uv=rest,
        positions=shells.reference[node],
        faces=corners,
        panel=panel[element],
        panel_names=names,
        materials=chosen,
        zone=panel[element],
        zone_names=names,
        element_size=float(edge_lengths(rest, corners).mean()),
    )
    x = state.positions[node]
    return Solution(
        cover=cover,
        positions=x,
        velocities=np.zeros_like(x),
        strain_top=top[element],
        strain_mid=mid[element],
        strain_bottom=bottom[element],
        friction_anchor=np.full_like(x, np.nan),
        stage=f"time {state.time:g}",
        status="converged",
        reason="read from a finite-element result; equilibrium is that calculation's word",
    ), element


def _materials(
    parts: IntArray, materials: Material | Mapping[int, Material]
) -> tuple[Material, ...]:
    if isinstance(materials, Material):
        return (materials,) * len(parts)
    absent = [int(p) for p in parts if int(p) not in materials]
    if absent:
        raise InputError.single(
            "materials", got=f"none for parts {absent}", expected="a material for every part"
        )
    return tuple(materials[int(p)] for p in parts)


def _oriented(shells: Shells, wrinkles: ShellWrinkles) -> tuple[IntArray, IntArray]:
    """Return triangles of the evaluated shells, seen from outside, and their rows."""
    faces, owner = shells.triangles()
    row = np.full(len(shells), -1)
    row[wrinkles.element] = np.arange(len(wrinkles.element))
    live = row[owner] >= 0
    faces, element = faces[live], row[owner[live]]
    turned = wrinkles.sign[element] < 0
    return np.where(turned[:, None], faces[:, ::-1], faces), element


def _flat_parts(
    points: FloatArray, owner: IntArray, corners: IntArray, parts: IntArray
) -> tuple[FloatArray, FloatArray]:
    """Return plane coordinates (n, 2), parts side by side, and their axes (parts, 2, 3)."""
    rest = np.zeros((len(points), 2))
    axes = np.zeros((len(parts), 2, 3))
    left = 0.0
    for k, number in enumerate(parts.tolist()):
        mine = owner == k
        p = points[mine] - points[mine].mean(axis=0)
        normal = face_vectors(points, corners[mine[corners[:, 0]]]).sum(axis=0)
        normal /= np.linalg.norm(normal)
        height = p @ normal
        if np.ptp(height) > _FLAT * np.ptp(p, axis=0).max():
            raise InputError.single(
                f"part {number}", got=f"{1e3 * np.ptp(height):.3g} mm out of plane at the start",
                expected="a flat undeformed state",
            )  # fmt: skip
        axes[k] = _warp_and_weft(p, normal)
        flat = p @ axes[k].T
        rest[mine] = flat - [flat[:, 0].min() - left, flat[:, 1].min()]
        left = float(rest[mine][:, 0].max()) + 0.05
    return rest, axes


def _warp_and_weft(p: FloatArray, normal: FloatArray) -> FloatArray:
    """Axes (2, 3) in the plane: along the world axis in which the part is longer, and across."""
    first, second = np.argsort(np.abs(normal), kind="stable")[:2]
    longer = first if np.ptp(p[:, first]) >= np.ptp(p[:, second]) else second
    warp = np.eye(3)[longer] - normal[longer] * normal
    warp /= np.linalg.norm(warp)
    return np.stack([warp, np.cross(normal, warp)])


def _strains(
    shells: Shells, reference: FloatArray, wrinkles: ShellWrinkles, axes: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Turn the strains from the elements' axes into warp and weft."""
    frame, _ = element_frames(shells, reference, wrinkles.element)
    turn = axes @ np.swapaxes(frame[:, :2], 1, 2)
    mid, half = (
        turn @ strain @ np.swapaxes(turn, 1, 2)
        for strain in (wrinkles.strain_mid, wrinkles.strain_half)
    )
    return mid + half, mid, mid - half
