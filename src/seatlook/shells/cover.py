"""A state of a finite-element result as a solved cover, which maps, pictures and scores take."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from seatlook.errors import InputError
from seatlook.mesh import face_vectors
from seatlook.model import Cover, FloatArray, IntArray, Material, Shells, ShellState, Solution
from seatlook.shells.strains import ShellStrains, element_frames

_FLAT = 1e-3  # of a part's extent; what lies further from its plane is not flat
_GAP = 0.05  # [m] between panels that are laid side by side


@dataclass(frozen=True, slots=True, kw_only=True)
class ShellCover:
    """A state of a finite-element result, ready for maps and pictures.

    Parameters
    ----------
    solution : Solution       zones are the parts
    element : (m,) int64      row of the ``ShellStrains`` of each face, to map its values
    projected : names of the parts that have no flat undeformed state: they are cut into panels by
        the world axis that their faces look along, and textures are laid on along that axis
    """

    solution: Solution
    element: IntArray
    projected: tuple[str, ...]


def shell_cover(
    shells: Shells,
    state: ShellState,
    wrinkles: ShellStrains,
    materials: Material | Mapping[int, Material],
) -> ShellCover:
    """Make a solution of the evaluated shells; each part becomes a panel and a zone.

    The undeformed state of a part is its pattern if it is flat, and the world axis in which it is
    longer is its warp. The strains on both surfaces are those that were evaluated, and a panel's
    thickness is the mean of its shells.

    Parameters
    ----------
    wrinkles : of the same state, from ``shell_strains``
    materials : one for all parts, or part number -> Material

    Raises
    ------
    InputError
        A part without a material.
    """
    parts, part = np.unique(shells.part[wrinkles.element], return_inverse=True)
    chosen = _materials(parts, materials)
    reference = state.positions if shells.reference is None else shells.reference
    faces, element = _oriented(shells, wrinkles)
    area = face_vectors(reference, faces)
    flat = np.array([
        shells.reference is not None and _is_flat(reference, faces[rows], area[rows])
        for rows in (part[element] == k for k in range(len(parts)))
    ])  # fmt: skip
    panel, owner, look = _panels(area, part[element], flat)
    corners, node, of_panel = _own_vertices(faces, panel, shells.node_count)
    rest, warp = _laid_out(reference[node], of_panel, look)
    names = tuple(shells.part_names.get(int(p)) or f"part {p}" for p in parts)
    thickness = [state.thickness[wrinkles.element[part == k]].mean() for k in range(len(parts))]
    cover = Cover(
        rest=rest,
        uv=rest,
        positions=reference[node],
        faces=corners,
        panel=panel,
        panel_names=_panel_names(names, owner, look, flat),
        materials=tuple(_as_thick(chosen[k], thickness[k]) for k in owner),
        zone=part[element],
        zone_names=names,
        element_size=float(wrinkles.size.mean()),
    )
    strains = _strains(shells, reference, wrinkles, element, warp[panel])
    return ShellCover(
        solution=_solution(cover, state, node, strains),
        element=element,
        projected=tuple(name for name, is_flat in zip(names, flat, strict=True) if not is_flat),
    )


def _solution(
    cover: Cover,
    state: ShellState,
    node: IntArray,
    strains: tuple[FloatArray, FloatArray, FloatArray],
) -> Solution:
    x = state.positions[node]
    top, mid, bottom = strains
    return Solution(
        cover=cover,
        positions=x,
        velocities=np.zeros_like(x),
        strain_top=top,
        strain_mid=mid,
        strain_bottom=bottom,
        friction_anchor=np.full_like(x, np.nan),
        stage=f"time {state.time:g}",
        status="converged",
        reason="read from a finite-element result; equilibrium is that calculation's word",
    )


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


def _oriented(shells: Shells, wrinkles: ShellStrains) -> tuple[IntArray, IntArray]:
    """Return triangles of the evaluated shells, seen from outside, and their rows."""
    faces, owner = shells.triangles()
    row = np.full(len(shells), -1)
    row[wrinkles.element] = np.arange(len(wrinkles.element))
    live = row[owner] >= 0
    faces, element = faces[live], row[owner[live]]
    turned = wrinkles.sign[element] < 0
    return np.where(turned[:, None], faces[:, ::-1], faces), element


def _as_thick(material: Material, thickness: float) -> Material:
    fabric = replace(material.fabric, thickness=float(thickness))
    return replace(material, fabric=fabric)


def _is_flat(points: FloatArray, faces: IntArray, area: FloatArray) -> bool:
    """Whether a part lies in its mean plane, with no face turned over in it."""
    used = np.zeros(len(points), dtype=bool)
    used[faces] = True
    p = points[used]
    normal = area.sum(axis=0)
    size = float(np.linalg.norm(normal))
    if size == 0 or not (area @ normal > 0).all():
        return False
    return bool(np.ptp(p @ (normal / size)) <= _FLAT * np.ptp(p, axis=0).max())


def _panels(
    area: FloatArray, part: IntArray, flat: np.ndarray
) -> tuple[IntArray, IntArray, FloatArray]:
    """Panel (m,) of each face; the part (p,) and the outward direction (p, 3) of each panel."""
    axis = np.abs(area).argmax(axis=1)
    side = 2 * axis + (area[np.arange(len(area)), axis] < 0)
    key, panel = np.unique(6 * part + np.where(flat[part], 0, side), return_inverse=True)
    owner = key // 6
    look = np.repeat(np.eye(3), 2, axis=0) * np.tile([1.0, -1.0], 3)[:, None]
    out = look[key % 6]
    for k in np.flatnonzero(flat[owner]):
        total = area[panel == k].sum(axis=0)
        out[k] = total / np.linalg.norm(total)
    return panel.astype(np.int64), owner, out


def _panel_names(
    names: tuple[str, ...], owner: IntArray, look: FloatArray, flat: np.ndarray
) -> tuple[str, ...]:
    """Part names; of a part in several panels with where each looks, such as ``part 3 +z``."""
    out = []
    for k, direction in zip(owner.tolist(), look, strict=True):
        axis = int(np.abs(direction).argmax())
        sign = "-" if direction[axis] < 0 else "+"
        out.append(names[k] if flat[k] else f"{names[k]} {sign}{'xyz'[axis]}")
    return tuple(out)


def _own_vertices(
    faces: IntArray, panel: IntArray, node_count: int
) -> tuple[IntArray, IntArray, IntArray]:
    """Give every panel its own vertices, as a seam has two sides.

    Returns
    -------
    corners (m, 3), and the node (n,) and the panel (n,) of each vertex
    """
    corners = np.empty_like(faces)
    nodes, count = [], 0
    for k in range(int(panel.max()) + 1):
        rows = panel == k
        used = np.zeros(node_count, dtype=bool)
        used[faces[rows]] = True
        # A sort of all corners would cost more than the counting of each panel's nodes.
        corners[rows] = (count - 1 + np.cumsum(used))[faces[rows]]
        nodes.append(np.flatnonzero(used))
        count += len(nodes[-1])
    owner = np.repeat(np.arange(len(nodes)), [len(own) for own in nodes])
    return corners, np.concatenate(nodes), owner


def _laid_out(
    points: FloatArray, owner: IntArray, look: FloatArray
) -> tuple[FloatArray, FloatArray]:
    """Plane coordinates (n, 2), panels side by side, and the warp (p, 3) of each."""
    rest = np.zeros((len(points), 2))
    warp = np.zeros((len(look), 3))
    left = 0.0
    for k, normal in enumerate(look):
        rows = owner == k
        p = points[rows] - points[rows].mean(axis=0)
        axes = _warp_and_weft(p, normal)
        warp[k] = axes[0]
        flat = p @ axes.T
        rest[rows] = flat - [flat[:, 0].min() - left, flat[:, 1].min()]
        left = float(rest[rows][:, 0].max()) + _GAP
    return rest, warp


def _warp_and_weft(p: FloatArray, normal: FloatArray) -> FloatArray:
    """Axes (2, 3) in the plane: along the world axis in which the panel is longer, and across."""
    first, second = np.argsort(np.abs(normal), kind="stable")[:2]
    longer = first if np.ptp(p[:, first]) >= np.ptp(p[:, second]) else second
    warp = np.eye(3)[longer] - normal[longer] * normal
    warp /= np.linalg.norm(warp)
    return np.stack([warp, np.cross(normal, warp)])


def _strains(
    shells: Shells,
    reference: FloatArray,
    wrinkles: ShellStrains,
    element: IntArray,
    warp: FloatArray,
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Turn the strains (m, 2, 2) of each face from the element's axes into warp and weft."""
    frame, _ = element_frames(shells, reference, wrinkles.element)
    first, second = np.einsum("mad,md->am", frame[element, :2], warp)
    size = np.hypot(first, second)
    c, s = first / size, second / size
    # Seen from the visible side, weft is to the left of warp, also where the shell was turned over.
    left = wrinkles.sign[element]
    mid = _turned(wrinkles.strain_mid[element], c, s, left)
    half = _turned(wrinkles.strain_half[element], c, s, left)
    return mid + half, mid, mid - half


def _turned(e: FloatArray, c: FloatArray, s: FloatArray, left: FloatArray) -> FloatArray:
    """Symmetric tensors (m, 2, 2) in axes (c, s) and ``left`` times (-s, c)."""
    xx, yy, xy = e[:, 0, 0], e[:, 1, 1], e[:, 0, 1]
    out = np.empty_like(e)
    out[:, 0, 0] = c * c * xx + s * s * yy + 2 * c * s * xy
    out[:, 1, 1] = s * s * xx + c * c * yy - 2 * c * s * xy
    out[:, 0, 1] = out[:, 1, 0] = left * (c * s * (yy - xx) + (c * c - s * s) * xy)
    return out
