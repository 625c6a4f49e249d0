"""Whether a result is resolved: elements small enough for its wrinkles, no edge folded sharply.

Every door asks ``resolution``, and none decides by itself.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Literal

import numpy as np
import numpy.typing as npt

from seatlook.mesh import face_normals, inner_sides
from seatlook.model import Cover, FloatArray, IntArray, Solution
from seatlook.model.table import number
from seatlook.solver import foam_wavelength

Status = Literal["resolved", "converged, not resolved", "not converged"]
PER_WAVE = 8.0  # elements on the shortest wrinkle of a fabric on its foam
SHARPEST = 45.0  # deg, of the fold between neighbours: a radius of 1.3 elements
# Recovered curvature of a wave: relative error 3.9 (h / lambda)^2, measured at 8 and 16 elements.
CURVATURE_ERROR = 3.9
# Figures of a result that was solved to a tolerance: what was asked for, and the error measured.
ASKED, REACHED = "w2_tolerance", "w2_error"
_WORK = 2.6  # time to solve over element size, as a power: docs/charts/scaling.csv
_MESHED = 0.02  # by which a mesh may miss the size it is asked for: sides hold whole elements


@dataclass(frozen=True, slots=True, kw_only=True)
class Waves:
    """The elements of a material's panels against the shortest wrinkle that it makes.

    Parameters
    ----------
    panels : names of its panels with the largest elements
    wavelength : float [m]
    element_size : float [m]   edge of the equilateral triangle of a panel's mean area
    """

    material: str
    panels: tuple[str, ...]
    wavelength: float
    element_size: float

    @property
    def per_wave(self) -> float:
        """Elements per wave, lambda / h."""
        return self.wavelength / self.element_size

    @property
    def error(self) -> float:
        """Relative error of W2 of such a wave, as an estimate: 3.9 (h / lambda)^2."""
        return CURVATURE_ERROR / self.per_wave**2

    @property
    def resolved(self) -> bool:
        """Whether the elements are at most an eighth of the wave."""
        return self.per_wave >= PER_WAVE * (1.0 - _MESHED)

    @property
    def sentence(self) -> str:
        """What the mesh cannot show, which mesh can, and how much longer that takes."""
        where = "" if len(self.panels) > 3 else f" in {', '.join(self.panels)}"
        h, wave = number(1e3 * self.element_size), number(1e3 * self.wavelength)
        finer = largest_size(self.wavelength)
        longer = max((1e3 * self.element_size / finer) ** _WORK, 1.0)
        return (
            f"the mesh is too coarse to show the wrinkles of {self.material}{where}: elements of "
            f"{h} mm, {self.per_wave:.1f} to a wave of {wave} mm, and 8 show it; "
            f"--element-size-mm {finer:g} resolves them and takes about {longer:.2g} times as long"
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class Fold:
    """An inner edge that is folded, and its place.

    Parameters
    ----------
    angle : float [deg]            between the two faces, beyond that at the start
    uv : (2,) float64 [m]          middle of the edge in pattern coordinates
    position : (3,) float64 [m]    the same in space
    """

    angle: float
    panel: str
    zone: str
    uv: FloatArray
    position: FloatArray


@dataclass(frozen=True, eq=False, kw_only=True)
class Resolution:
    """What is to be thought of a result, and why.

    Parameters
    ----------
    balance : why it is not at rest; "" where it is
    waves : of each material on foam
    folds : of the inner edges folded by more than 45 degrees, the sharpest first
    largest_fold : float [deg]       of all inner edges
    unresolved : (m,) bool           faces at such edges, or of panels with too large elements
    error, tolerance : float [1]     measured error of the zone means of W2 and what was asked
        for; None where no second mesh measured it
    """

    balance: str
    waves: tuple[Waves, ...]
    folds: tuple[Fold, ...]
    largest_fold: float
    unresolved: npt.NDArray[np.bool_]
    error: float | None = None
    tolerance: float | None = None

    @property
    def status(self) -> Status:
        """The status that every command and page shows."""
        if self.balance:
            return "not converged"
        return "converged, not resolved" if self.coarseness else "resolved"

    @property
    def resolved(self) -> bool:
        """Whether wrinkles and limits can be judged on it."""
        return self.status == "resolved"

    @property
    def reason(self) -> str:
        """Why it is not resolved, with places; "" where it is."""
        return self.balance or "; ".join(self.coarseness)

    @property
    def sentence(self) -> str:
        """Status and reason."""
        return f"{self.status}: {self.reason}" if self.reason else self.status

    @cached_property
    def coarseness(self) -> tuple[str, ...]:
        """What the mesh does not carry, a sentence each."""
        return tuple(self._coarseness())

    def measured(self, error: float, tolerance: float) -> Resolution:
        """The same with an error that a second mesh has measured."""
        return replace(self, error=error, tolerance=tolerance)

    def _coarseness(self) -> Iterator[str]:
        if self.tolerance is None:
            yield from (wave.sentence for wave in self.waves if not wave.resolved)
        if self.folds:
            first, count = self.folds[0], len(self.folds)
            many = f"{count} edges are" if count > 1 else "1 edge is"
            sharpest = ", the sharpest" if count > 1 else ""
            u, v = 1e3 * first.uv
            yield (
                f"{many} folded over {SHARPEST:g} degrees inside a panel{sharpest} by "
                f"{first.angle:.0f} in zone {first.zone} (panel {first.panel}, pattern u, v = "
                f"{u:.0f}, {v:.0f} mm)"
            )
        if self.error is not None and self.tolerance is not None and self.error > self.tolerance:
            yield (
                f"zone means of W2 err by {100 * self.error:.2g} %, asked for "
                f"{100 * self.tolerance:.2g} %"
            )


def resolution(solution: Solution) -> Resolution:
    """Say whether a result is resolved by its mesh.

    It is where it is at rest, every material has ``PER_WAVE`` elements on the shortest wrinkle that
    it makes on its foam, and no edge inside a panel is folded by more than ``SHARPEST`` degrees.
    Solved to a tolerance, the error that was measured counts instead of elements to a wave, which
    are then those where the cover is bent. Without foam no wavelength is known, and folds decide
    alone.
    """
    cover = solution.cover
    sides = inner_sides(cover.faces)
    angle = np.degrees(_turned(cover, solution.positions, sides))
    sharp = np.flatnonzero(angle > SHARPEST)
    sharp = sharp[np.argsort(-angle[sharp], kind="stable")]
    asked = solution.figures.get(ASKED)
    bent = np.linalg.norm(solution.strain_top - solution.strain_bottom, axis=(1, 2))
    waves = expected_waves(cover, None if asked is None else bent / cover.thickness)
    coarse = {
        panel for wave in waves if asked is None and not wave.resolved for panel in wave.panels
    }
    unresolved = np.isin(cover.panel, [cover.panel_names.index(name) for name in coarse])
    unresolved[sides[sharp].ravel() // 3] = True
    return Resolution(
        balance="" if solution.status == "converged" else solution.reason or "not at rest",
        waves=waves,
        folds=tuple(_fold(solution, sides[k], float(angle[k])) for k in sharp),
        largest_fold=float(angle.max(initial=0.0)),
        unresolved=unresolved,
        error=solution.figures.get(REACHED),
        tolerance=asked,
    )


def expected_waves(cover: Cover, weight: FloatArray | None = None) -> tuple[Waves, ...]:
    """The shortest wrinkle of each material of a cover on foam against its elements.

    Known before anything is solved. None without foam.

    Parameters
    ----------
    weight : (m,) [1]   by which elements of a panel count beside their area, where sizes vary
    """
    if cover.foam is None:
        return ()
    size = _panel_sizes(cover, weight)
    fabrics = {m.name: m.fabric for m in cover.materials}
    result = []
    for name, fabric in fabrics.items():
        own = [k for k, m in enumerate(cover.materials) if m.name == name]
        wave = foam_wavelength(fabric, cover.foam.material)
        largest = max(size[k] for k in own)
        # Where some are too coarse all of these are named, else the coarsest.
        limit = min(largest, wave / PER_WAVE / (1.0 - _MESHED))
        panels = tuple(cover.panel_names[k] for k in own if size[k] >= limit)
        result.append(
            Waves(material=name, panels=panels, wavelength=wave, element_size=float(largest))
        )
    return tuple(result)


def largest_size(wavelength: float) -> float:
    """Element size [mm] that resolves a wave [m], down to a tenth of a millimetre."""
    return int(1e4 * wavelength / PER_WAVE) / 10


def _panel_sizes(cover: Cover, weight: FloatArray | None) -> FloatArray:
    """Element size (p,) [m] of each panel, see ``Waves``."""
    count = len(cover.panel_names)
    if weight is not None:
        share = cover.rest_area * np.maximum(weight, 1e-9)
        whole = np.maximum(np.bincount(cover.panel, share, count), 1e-300)
        wrinkled = np.bincount(cover.panel, share * cover.rest_area, count) / whole
        return np.asarray(np.sqrt(wrinkled * 4.0 / np.sqrt(3.0)))
    area = np.bincount(cover.panel, cover.rest_area, count)
    mean = area / np.maximum(np.bincount(cover.panel, minlength=count), 1)
    return np.asarray(np.sqrt(mean * 4.0 / np.sqrt(3.0)))


def _turned(cover: Cover, x: FloatArray, sides: IntArray) -> FloatArray:
    """Angle (k,) [rad] by which inner edges are folded, away from their start."""
    turn = _dihedral(cover, x, sides) - _dihedral(cover, cover.positions, sides)
    return np.asarray(np.abs((turn + np.pi) % (2.0 * np.pi) - np.pi))


def _dihedral(cover: Cover, x: FloatArray, sides: IntArray) -> FloatArray:
    """Signed angle (k,) [rad] between the normals of both faces of an edge."""
    face, corner = np.divmod(sides, 3)
    normal = face_normals(x, cover.faces)[face]
    begin, end = (cover.faces[face[:, 0], (corner[:, 0] + step) % 3] for step in (0, 1))
    along = x[end] - x[begin]
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    sine = np.einsum("kc,kc->k", np.cross(normal[:, 0], normal[:, 1]), along)
    cosine = np.einsum("kc,kc->k", normal[:, 0], normal[:, 1])
    return np.asarray(np.arctan2(sine, cosine))


def _fold(solution: Solution, side: IntArray, angle: float) -> Fold:
    cover = solution.cover
    face, corner = divmod(int(side[0]), 3)
    ends = cover.faces[face, [corner, (corner + 1) % 3]]
    return Fold(
        angle=angle,
        panel=cover.panel_names[cover.panel[face]],
        zone=cover.zone_names[cover.zone[face]],
        uv=cover.uv[ends].mean(axis=0),
        position=solution.positions[ends].mean(axis=0),
    )
