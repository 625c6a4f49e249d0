"""A seat's design surface: one mesh, cut into panels along its seam lines."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from seatlook import mesh
from seatlook.errors import InputError
from seatlook.model import FloatArray, IntArray

FREE = "free"  # stands for the neighbour where a panel is not sewn


@dataclass(frozen=True, slots=True, kw_only=True)
class DesignSurface:
    """The shape the cover is to have, middle surface, with the panel of each face.

    Parameters
    ----------
    vertices : (n, 3) float64 [m]
    faces : (m, 3) int64           normals outward, the visible side
    panel : (m,) int64             index into ``panel_names``
    panel_names : names of the panels; two panels share the vertices of the seam between them
    seam_lines : edge, smaller vertex first -> name of the line it was cut along, if any
    """

    vertices: FloatArray
    faces: IntArray
    panel: IntArray
    panel_names: tuple[str, ...]
    seam_lines: Mapping[tuple[int, int], str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        if (
            self.panel.shape != (len(self.faces),)
            or not np.isin(self.panel, np.arange(len(self.panel_names))).all()
        ):
            raise InputError.single(
                "DesignSurface.panel",
                got=f"shape {self.panel.shape}, labels {np.unique(self.panel).tolist()}",
                expected=f"a label 0..{len(self.panel_names) - 1} for each of {len(self.faces)}"
                " faces",
            )

    def patches(self) -> tuple[Patch, ...]:
        """Return the panels' patches in the order of ``panel_names``."""
        return tuple(self._patch(i) for i in range(len(self.panel_names)))

    def _patch(self, index: int) -> Patch:
        name = self.panel_names[index]
        used, faces = np.unique(self.faces[self.panel == index], return_inverse=True)
        faces = np.asarray(faces.reshape(-1, 3), dtype=np.int64)
        loops = mesh.boundary_loops(faces)
        euler = len(used) - len(mesh.edges(faces)) + len(faces)
        if len(loops) != 1 or euler != 1:
            raise InputError.single(
                f"panel {name}",
                got=f"{len(loops)} boundary curves, Euler number {euler}",
                expected="one connected piece without holes",
            )
        return Patch(
            name=name, vertices=self.vertices[used], faces=faces, source=used, boundary=loops[0]
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Patch:
    """One panel's part of the design surface.

    Parameters
    ----------
    vertices : (n, 3) [m]; faces : (m, 3) into ``vertices``
    source : (n,) int64     the vertices' indices in the whole surface
    boundary : (b,) int64   the outline, counter-clockwise seen from outside
    """

    name: str
    vertices: FloatArray
    faces: IntArray
    source: IntArray
    boundary: IntArray


@dataclass(frozen=True, slots=True, kw_only=True)
class Side:
    """A stretch of a patch's outline with the same neighbour all along.

    Parameters
    ----------
    panel, neighbour : names; the neighbour of a free edge is FREE
    start, count : first position in ``Patch.boundary`` and number of segments
    vertices : (count + 1,) int64   indices in the whole surface, in outline order
    """

    name: str
    panel: str
    neighbour: str
    start: int
    count: int
    vertices: IntArray

    def indices(self, patch: Patch) -> IntArray:
        """Return the vertices (count + 1,) in the patch's own numbering."""
        at = (self.start + np.arange(self.count + 1)) % len(patch.boundary)
        return np.asarray(patch.boundary[at])


def sides(patches: tuple[Patch, ...]) -> tuple[Side, ...]:
    """Split every patch's outline where three panels, or two and the outside, meet.

    A side is called ``PANEL.NEIGHBOUR``; when there are several, ``PANEL.NEIGHBOUR_2`` and so on
    in outline order. An outline with one neighbour all round is one side, closed.
    """
    owner: dict[tuple[int, int], str] = {}
    for patch in patches:
        ring = patch.source[patch.boundary]
        owner |= dict.fromkeys(
            zip(ring.tolist(), np.roll(ring, -1).tolist(), strict=True), patch.name
        )
    return tuple(side for patch in patches for side in _sides_of(patch, owner))


def _sides_of(patch: Patch, owner: dict[tuple[int, int], str]) -> list[Side]:
    ring = patch.source[patch.boundary].tolist()
    b = len(ring)
    across = [owner.get((ring[(i + 1) % b], ring[i]), FREE) for i in range(b)]
    starts = [i for i in range(b) if across[i] != across[i - 1]]
    if not starts:  # closed: both panels of a seam all round start at the same vertex
        starts = [int(np.argmin(ring))]
    result: list[Side] = []
    for k, start in enumerate(starts):
        count = (starts[(k + 1) % len(starts)] - start) % b or b
        again = sum(side.neighbour == across[start] for side in result)
        suffix = f"_{again + 1}" if again else ""
        at = [(start + i) % b for i in range(count + 1)]
        result.append(
            Side(
                name=f"{patch.name}.{across[start]}{suffix}",
                panel=patch.name,
                neighbour=across[start],
                start=start,
                count=count,
                vertices=np.array(ring, dtype=np.int64)[at],
            )
        )
    return result
