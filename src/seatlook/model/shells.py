"""Shell elements of a finite-element result: what stays, and one state of it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Literal

import numpy as np

from seatlook.errors import InputError
from seatlook.model._check import FloatArray, IntArray, floats, ints

StrainAxes = Literal["global", "element"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Shells:
    """Three- and four-cornered shells, the same in all states.

    Parameters
    ----------
    corners : (e, 4) int64       into the nodes, in the file's order; a triangle repeats its third
    element_ids : (e,) int64     the numbers the user knows
    part : (e,) int64            part number of each element, likewise
    part_names : part number -> title
    node_count : int             n
    reference : (n, 3) float64 [m]   nodes before any load, None where the file has none
    """

    corners: IntArray
    element_ids: IntArray
    part: IntArray
    part_names: MappingProxyType[int, str] = field(default_factory=lambda: MappingProxyType({}))
    node_count: int
    reference: FloatArray | None = None

    def __post_init__(self) -> None:
        if self.reference is not None:
            floats(self, "reference", self.node_count, 3)
        ints(self, "corners", None, 4, below=self.node_count)
        ints(self, "element_ids", len(self.corners))
        ints(self, "part", len(self.corners))

    def __len__(self) -> int:
        return len(self.corners)

    def triangles(self) -> tuple[IntArray, IntArray]:
        """Split the quadrilaterals.

        Returns
        -------
        faces : (m, 3) int64
        element : (m,) int64    the element of each face; both halves of a quadrilateral share it
        """
        quads = np.flatnonzero(self.corners[:, 2] != self.corners[:, 3])
        faces = np.concatenate([self.corners[:, :3], self.corners[quads][:, [0, 2, 3]]])
        return faces, np.concatenate([np.arange(len(self)), quads])


@dataclass(frozen=True, slots=True, kw_only=True)
class ShellState:
    """Shape, thickness and strains of all shells at one time.

    Parameters
    ----------
    time : float               in the unit of the calculation
    positions : (n, 3) float64 [m]
    thickness : (e,) float64 [m]
    strain_inner, strain_outer : (e, 3, 3) float64 [1], or None where the file has no strains
        Inner is the side the element's normal points away from.
    strain_axes : "global", or "element" for strains that are in the element's plane already
    alive : (e,) bool       False for elements that the calculation deleted
    """

    time: float
    positions: FloatArray
    thickness: FloatArray
    strain_inner: FloatArray | None = None
    strain_outer: FloatArray | None = None
    strain_axes: StrainAxes = "global"
    alive: np.ndarray[tuple[int], np.dtype[np.bool_]]

    def __post_init__(self) -> None:
        e = len(self.alive)
        floats(self, "positions", None, 3)
        floats(self, "thickness", e)
        if (self.strain_inner is None) != (self.strain_outer is None):
            raise InputError.single(
                "strains", got="one surface only", expected="inner and outer, or neither"
            )
        if self.strain_inner is not None:
            floats(self, "strain_inner", e, 3, 3)
            floats(self, "strain_outer", e, 3, 3)


@dataclass(frozen=True, slots=True, kw_only=True)
class ShellResult:
    """A file of shell states, each read when it is used.

    Parameters
    ----------
    times : (s,) float64        in the unit of the calculation
    read : index -> ShellState
    notes : what a reader of the figures must know, one sentence each
    """

    shells: Shells
    times: FloatArray
    read: Callable[[int], ShellState]
    notes: tuple[str, ...] = ()

    def __len__(self) -> int:
        return len(self.times)

    def __iter__(self) -> Iterator[ShellState]:
        return (self.read(i) for i in range(len(self)))
