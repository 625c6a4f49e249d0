"""The drawn surface as the viewer takes it: fewer triangles, sorted by panel, quantised."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
import numpy.typing as npt

from seatlook.chain.assess import Assessment
from seatlook.chain.draw import map_ends
from seatlook.io.export.glb import vertex_means
from seatlook.mesh import face_normals
from seatlook.model import FloatArray, IntArray
from seatlook.pbr.maps.face_map import colour_table
from seatlook.pbr.shading.studio import Studio
from seatlook.report.viewer.pack import Buffers, octahedral, quantised
from seatlook.wrinkle import INDICES

# Most triangles of the cover: as many as software draws five times a second.
_MOST_FACES = 130_000
# Directions from which foam is looked at: what none of them sees is not sent.
_DIRECTIONS = 32
# Distance [m] from a seam that is sent as the largest number; none is known from there on.
_SEAM_REACH = 0.014
_NONE = 65535
# Maps that can be laid over, and their order; the gap comes with them.
_MAPS = ("w2", "w_stretch", "w_compression")


@dataclass(frozen=True, slots=True)
class Triangles:
    """Triangles (m, 3) of parts one after the other: panels, then the foam.

    ``parts``: (first, count, of the refined cover) per part; ``used``: the drawn surface's vertices
    that are sent, in their order; ``coarse``: the solver's faces in the order of their triangles.
    """

    faces: IntArray
    parts: list[tuple[int, int, int]]
    used: IntArray
    coarse: IntArray
    children: int


def triangles_of(stage: Studio) -> Triangles:
    """Choose a refinement, and sort its triangles by panel."""
    surface, panels = stage.surface, stage.solution.cover.panel
    finest, level = len(surface.refined.parents), 0
    while level < finest and len(surface.coarse_faces) * 4 ** (level + 1) <= _MOST_FACES:
        level += 1
    children, refined = 4**level, surface.faces_of_level(level)
    seen = _in_sight(stage)
    beside = surface.mesh.faces[surface.faces :][seen]
    owner = surface.mesh.panel[surface.faces :][seen]
    coarse, faces, parts, first = [], [], [], 0
    for panel in range(len(stage.solution.cover.panel_names) + 1):
        own = np.flatnonzero(panels == panel)
        rows = (own[:, None] * children + np.arange(children)).ravel()
        part = np.concatenate([refined[rows], beside[owner == panel]])
        parts.append((first, len(part), len(rows)))
        first += len(part)
        coarse.append(own)
        faces.append(part)
    used, corners = np.unique(np.concatenate(faces), return_inverse=True)
    # Corners of the foam have vertices of their own: alike ones are sent once.
    alike = np.hstack(
        [surface.mesh.vertices[used], surface.mesh.normals[used], surface.mesh.uv[used]]
    )
    _, kept, same = np.unique(alike.round(6), axis=0, return_index=True, return_inverse=True)
    return Triangles(
        same.reshape(-1)[corners].reshape(-1, 3),
        parts,
        used[kept],
        np.concatenate(coarse),
        children,
    )


def _in_sight(stage: Studio) -> npt.NDArray[np.bool_]:
    """Which faces behind those of the panels are sent: all but the foam that the cover hides."""
    surface, foam = stage.surface, stage.solution.cover.foam
    mesh, out = surface.mesh, np.ones(len(surface.mesh.faces) - surface.faces, dtype=bool)
    if foam is None:
        return out
    corners = np.array(foam.faces)
    x = mesh.vertices[mesh.faces[surface.opaque :]]
    normals = face_normals(x.reshape(-1, 3), np.arange(3 * len(x)).reshape(-1, 3))
    seen = stage.seen_from(x.mean(axis=1), normals, _around(_DIRECTIONS))
    # With those beside it: a face may reach out from below the cover's border.
    reached = np.zeros(len(foam.vertices), dtype=bool)
    reached[corners[seen]] = True
    out[surface.opaque - surface.faces :] = reached[corners].any(axis=1)
    return out


def _around(count: int) -> FloatArray:
    """Evenly spread unit vectors (count, 3), on a spiral by the golden angle."""
    k = np.arange(count) + 0.5
    z, turn = 1.0 - 2.0 * k / count, np.pi * (1.0 + np.sqrt(5.0)) * k
    side = np.sqrt(1.0 - z**2)
    return np.column_stack([side * np.cos(turn), side * np.sin(turn), z])


def add_geometry(stage: Studio, buffers: Buffers) -> tuple[Triangles, dict[str, Any]]:
    """Add vertices and triangles to ``buffers``; return them and what is said of them."""
    triangles, mesh = triangles_of(stage), stage.surface.mesh
    used = triangles.used
    place, low, step = quantised(mesh.vertices[used])
    pattern, pattern_low, pattern_step = quantised(mesh.uv[used])
    seam = mesh.seam[used]
    near = np.isfinite(seam).all(axis=1) & (seam[:, 0] < _SEAM_REACH)
    most = float(seam[near, 1].max()) if near.any() else 1.0
    seams = np.full(seam.shape, _NONE, dtype=np.uint16)
    scale = np.array([_SEAM_REACH, max(most, 1e-6), _NONE - 1.0])  # rows of stitches are whole
    seams[near] = np.rint(seam[near] / scale * (_NONE - 1))
    buffers.add("position", place)
    buffers.add("normal", octahedral(mesh.normals[used]))
    buffers.add("pattern", pattern)
    buffers.add("seam", seams)
    buffers.add("open", np.rint(255 * stage.sky_share()[used]).astype(np.uint8))
    wide = np.uint16 if len(used) < 2**16 else np.uint32
    buffers.add("faces", triangles.faces.astype(wide))
    names = [*stage.solution.cover.panel_names, "foam"]
    return triangles, {
        "position": {"low": low, "step": step},
        "pattern": {"low": pattern_low, "step": pattern_step},
        "seam": {"reach": _SEAM_REACH, "arc": most},
        "children": triangles.children,
        "parts": [
            {"name": name, "first": first, "count": count, "refined": refined}
            for name, (first, count, refined) in zip(names, triangles.parts, strict=True)
        ],
    }


def add_maps(
    assessment: Assessment, stage: Studio, triangles: Triangles, buffers: Buffers, top: float
) -> list[dict[str, Any]]:
    """Add each map face by face, and smooth at the vertices; return what is said of them.

    ``top`` is the upper end of the range of W2. With the strain of the mid surface [%] along and
    across the grain, face by face.
    """
    out = []
    for name in _MAPS:
        index = INDICES[name]
        values = assessment.values(name)
        ends = map_ends(index, values, top)
        said = {"name": index.symbol, "unit": index.unit, "meaning": index.meaning}
        out.append(_map(stage, triangles, values, ends, buffers, said))
    gap = {"name": "Gap", "unit": "mm", "meaning": "from the drawn foam to the cover"}
    out.append(_map(stage, triangles, 1e3 * assessment.gap, (-5.0, 5.0), buffers, gap))
    strain = stage.solution.strain_mid[triangles.coarse]
    buffers.add("strain", 100 * np.stack([strain[:, 0, 0], strain[:, 1, 1]], 1).astype(np.float32))
    return out


def add_colours(buffers: Buffers) -> None:
    """Add the colours of the maps, as their square roots."""
    for colours in ("viridis", "diverging"):
        buffers.add(colours, np.rint(255 * np.sqrt(colour_table(colours))).astype(np.uint8))


def _map(
    stage: Studio,
    triangles: Triangles,
    values: FloatArray,
    ends: tuple[float, float],
    buffers: Buffers,
    said: dict[str, str],
) -> dict[str, Any]:
    """Add one map; 0 at a vertex is where nothing is known, 1 to 255 lie between its ends."""
    cover, surface = stage.solution.cover, stage.surface
    known = np.isfinite(values)
    smooth = np.full(len(surface.mesh.vertices), np.nan)
    area = np.where(known, cover.rest_area, 0.0)
    with np.errstate(invalid="ignore"):
        means = vertex_means(
            np.where(known, values, 0.0), np.array(cover.faces), area, len(cover.rest)
        )
    smooth[: surface.vertices] = surface.refined.spread(means[:, None])[:, 0]
    share = (smooth[triangles.used] - ends[0]) / (ends[1] - ends[0])
    code = 1.0 + 254.0 * np.clip(share, 0.0, 1.0)
    buffers.add(f"map {said['name']}", np.rint(np.nan_to_num(code)).astype(np.uint8))
    buffers.add(f"faces {said['name']}", values[triangles.coarse].astype(np.float32))
    return {**said, "low": ends[0], "high": ends[1]}
