"""Strains of shell results in their planes: consistent sides, from strains or from the shape."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt

from seatlook.errors import InputError
from seatlook.mesh.kinematics import green_of_logarithmic, logarithmic_strain
from seatlook.mesh.orientation import agree
from seatlook.model import FloatArray, IntArray, Shells, ShellState, StrainMeasure, Strains
from seatlook.wrinkle.equations import STRAIN_MEASURES
from seatlook.wrinkle.jet import vertex_curvature

StrainSource = Literal["strains", "shape", "strains and shape"]

_FLAT = 1e-10  # area over the square of the longest diagonal, below which a shell has no plane
_UNBENT = 1e-9  # strain at the surface


@dataclass(frozen=True, slots=True, kw_only=True)
class ShellStrains:
    """Strains of one state, per evaluated element.

    Parameters
    ----------
    element : (k,) int64           into ``Shells``; deleted elements are left out
    strain_mid, strain_half : (k, 2, 2)   mid strain, and half of top minus bottom, in the element
        plane with the first axis along its middle line
    thickness : (k,) float64 [m]
    sign : (k,) float64            -1 where the element was turned over
    area : (k,) float64 [m2]
    size : (k,) float64 [m]        mean length of the sides
    one_sided : pieces that have no two sides
    source : what C comes from; "shape" where there are no strains, or where both surfaces carry
        the same ones although the shells are bent (membrane elements)
    """

    element: IntArray
    strain_mid: FloatArray
    strain_half: FloatArray
    thickness: FloatArray
    sign: FloatArray
    area: FloatArray
    size: FloatArray
    one_sided: int
    source: StrainSource

    @property
    def turned(self) -> int:
        """Number of elements whose normal was turned over to agree with its neighbours."""
        return int((self.sign < 0).sum())

    @property
    def strains(self) -> Strains:
        """On both surfaces and in the middle; one threshold counts for all elements."""
        return Strains(
            top=self.strain_mid + self.strain_half,
            mid=self.strain_mid,
            bottom=self.strain_mid - self.strain_half,
            thickness=self.thickness,
            panel=np.zeros(len(self.element), dtype=np.int64),
        )


def shell_strains(
    shells: Shells,
    state: ShellState,
    *,
    facing: FloatArray | None = None,
    strain_measure: StrainMeasure | None = None,
) -> ShellStrains:
    """Bring the strains of one state into the planes of its shells.

    Normals are made to agree across shared edges, turning the smaller area over, and the strains
    of turned elements change sides. Strains in global axes are brought into the element plane,
    where the thickness strain cannot win eq. (1).

    Parameters
    ----------
    facing : (3,) float64          the visible side: every connected piece is turned so that its
        mean normal has a component along it; without it the file's normals decide
    strain_measure : "green" or "logarithmic", to evaluate the equations in; without it as the
        strains are: logarithmic from a file, Green's where they come from the shape

    Raises
    ------
    InputError
        Shells without area, a thickness of 0 or less, neither strains nor a reference shape.
    """
    element = np.flatnonzero(state.alive)
    if not len(element):
        raise InputError.single(
            f"state at time {state.time:g}", got="no shells left", expected="shells not deleted"
        )
    corners = shells.corners[element]
    frame, area = element_frames(shells, state.positions, element)
    _check_thickness(shells, state, element)
    side = agree(corners, area)
    sign = side.sign * _outward(side.piece, side.sign, frame, area, facing)
    mid, half, source = _strains(shells, state, element, frame, sign)
    if strain_measure is not None:
        given: StrainMeasure = "green" if state.strain_inner is None else "logarithmic"
        mid, half = _measured(mid, half, given, strain_measure)
    return ShellStrains(
        element=element,
        strain_mid=mid,
        strain_half=half,
        thickness=state.thickness[element],
        sign=sign,
        area=area,
        size=_mean_side(state.positions[corners]),
        one_sided=side.one_sided,
        source=source,
    )


def _measured(
    mid: FloatArray, half: FloatArray, given: StrainMeasure, measure: StrainMeasure
) -> tuple[FloatArray, FloatArray]:
    """Turn both surfaces and the middle from one measure into the other."""
    if measure not in STRAIN_MEASURES:
        raise InputError.single(
            "strain_measure", got=repr(measure), expected=f"one of {', '.join(STRAIN_MEASURES)}"
        )
    if given == measure:
        return mid, half
    turn = green_of_logarithmic if measure == "green" else logarithmic_strain
    return turn(mid), 0.5 * (turn(mid + half) - turn(mid - half))


def element_frames(
    shells: Shells, positions: FloatArray, element: IntArray
) -> tuple[FloatArray, FloatArray]:
    """Return axes (k, 3, 3) as rows e1, e2, n, and areas (k,); n follows the corners' order.

    Raises
    ------
    InputError
        Shells without area, by their numbers.
    """
    p0, p1, p2, p3 = (positions.take(corner, axis=0) for corner in shells.corners[element].T)
    d1, d2 = p2 - p0, p3 - p1
    normal = np.cross(d1, d2)
    double = _length(normal)
    flat = double <= _FLAT * np.maximum(_length(d1), _length(d2)) ** 2
    if flat.any():
        first = ", ".join(map(str, shells.element_ids[element[flat]][:5]))
        raise InputError.single(
            "shells", got=f"{int(flat.sum())} without area, first {first}",
            expected="triangles and quadrilaterals with an area",
        )  # fmt: skip
    normal /= double[:, None]
    # Half the difference of the diagonals is the middle line, in the plane of both.
    along = d1 - d2
    along /= _length(along)[:, None]
    return np.stack([along, np.cross(normal, along), normal], axis=1), 0.5 * double


def _length(vectors: FloatArray) -> FloatArray:
    """Length (k,) of the rows; for a million rows three times as fast as ``linalg.norm``."""
    return np.asarray(np.sqrt(np.einsum("kd,kd->k", vectors, vectors)))


def _mean_side(p: FloatArray) -> FloatArray:
    """Mean length of the sides (k,); the side that a triangle lacks has none."""
    side = np.linalg.norm(np.roll(p, -1, axis=1) - p, axis=2)
    return np.asarray(side.sum(axis=1) / np.maximum((side > 0).sum(axis=1), 1))


def _check_thickness(shells: Shells, state: ShellState, element: IntArray) -> None:
    bad = ~(state.thickness[element] > 0)
    if bad.any():
        first = ", ".join(map(str, shells.element_ids[element[bad]][:5]))
        raise InputError.single(
            "thickness", got=f"0 or less in {int(bad.sum())} shells, first {first}",
            expected="above 0", hint="or say the thickness",
        )  # fmt: skip


def _outward(
    piece: IntArray,
    sign: FloatArray,
    frame: FloatArray,
    area: FloatArray,
    facing: FloatArray | None,
) -> FloatArray:
    """Return -1 for elements of pieces that look away from ``facing``."""
    if facing is None:
        return np.ones(len(piece))
    toward = np.bincount(piece, sign * area * (frame[:, 2] @ np.asarray(facing, dtype=float)))
    return np.where(toward[piece] < 0, -1.0, 1.0)


def _strains(
    shells: Shells, state: ShellState, element: IntArray, frame: FloatArray, sign: FloatArray
) -> tuple[FloatArray, FloatArray, StrainSource]:
    """Return mid strain, half the difference outer - inner, and what bending comes from."""
    if state.strain_inner is None or state.strain_outer is None:
        mid = _mid_strain(shells, state.positions, element, frame)
        return mid, _bending_of_shape(shells, state, element, frame, sign), "shape"
    plane = frame[:, :2] if state.strain_axes == "global" else np.eye(3)[None, :2]
    inner, outer = (
        np.einsum("kad,kde,kbe->kab", plane, strain[element], plane, optimize=True)
        for strain in (state.strain_inner, state.strain_outer)
    )
    mid, half = 0.5 * (inner + outer), 0.5 * sign[:, None, None] * (outer - inner)
    blind = _membranes(shells.part[element], half)
    if shells.reference is None or not blind.any():
        return mid, half, "strains"
    half[blind] = _bending_of_shape(shells, state, element, frame, sign)[blind]
    # A flat state bends nobody, and is no reason to speak of shape.
    if not np.abs(half[blind]).max() > _UNBENT:
        return mid, half, "strains"
    return mid, half, "shape" if blind.all() else "strains and shape"


def _membranes(part: IntArray, half: FloatArray) -> npt.NDArray[np.bool_]:
    """Tell which elements belong to parts without any difference between their surfaces."""
    bent = np.abs(half).max(axis=(1, 2)) > 0
    numbers, index = np.unique(part, return_inverse=True)
    return np.asarray(np.bincount(index, bent, len(numbers))[index] == 0)


def _mid_strain(
    shells: Shells, positions: FloatArray, element: IntArray, frame: FloatArray
) -> FloatArray:
    """Green strain at the middle of each element from reference to ``positions``."""
    if shells.reference is None:
        raise InputError.single(
            "strains", got="none, and no reference shape", expected="one of them"
        )
    rest_frame, _ = element_frames(shells, shells.reference, element)
    rest = _midlines(shells.reference[shells.corners[element]], rest_frame)
    now = _midlines(positions[shells.corners[element]], frame)
    F = now @ np.linalg.inv(rest)
    return np.asarray(0.5 * (np.swapaxes(F, 1, 2) @ F - np.eye(2)))


def _midlines(p: FloatArray, frame: FloatArray) -> FloatArray:
    """Columns: the two middle lines of each element in its plane."""
    lines = np.stack([p[:, 1] + p[:, 2] - p[:, 0] - p[:, 3], p[:, 2] + p[:, 3] - p[:, 0] - p[:, 1]])
    return np.asarray(np.einsum("kad,lkd->kal", frame[:, :2], 0.5 * lines))


def _bending_of_shape(
    shells: Shells, state: ShellState, element: IntArray, frame: FloatArray, sign: FloatArray
) -> FloatArray:
    """Half the strain difference that the change of curvature since the reference makes."""
    if shells.reference is None:
        raise InputError.single(
            "strains", got="none, and no reference shape", expected="one of them"
        )
    faces, owner = shells.triangles()
    row = np.full(len(shells), -1)
    row[element] = np.arange(len(element))
    live = row[owner] >= 0
    turned = sign[row[owner[live]]] < 0
    faces = np.where(turned[:, None], faces[live][:, ::-1], faces[live])
    rest_frame, _ = element_frames(shells, shells.reference, element)
    now = _at_elements(state.positions, faces, shells.corners[element], frame)
    rest = _at_elements(shells.reference, faces, shells.corners[element], rest_frame)
    return 0.5 * state.thickness[element, None, None] * (now - rest)


def _at_elements(
    points: FloatArray, faces: IntArray, corners: IntArray, frame: FloatArray
) -> FloatArray:
    """Mean curvature tensor of the corners in each element's plane."""
    at_nodes = vertex_curvature(points, faces)
    weight = np.ones((len(corners), 4))
    weight[corners[:, 2] == corners[:, 3], 3] = 0.0
    mean = np.einsum("kc,kcij->kij", weight, at_nodes[corners]) / weight.sum(axis=1)[:, None, None]
    plane = frame[:, :2]
    return np.asarray(plane @ mean @ np.swapaxes(plane, 1, 2))
