"""One cut across a wrinkle, from crest to crest: how deep it is, how much cloth is too much."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from seatlook.mesh import length
from seatlook.model import FloatArray, IntArray, Solution
from seatlook.wrinkle.region import bending
from seatlook.wrinkle.section import Section, section

_FARTHEST = 0.06  # [m] to each side that is searched for a crest
# A crest is twice as far as where the valley's curvature ends, in a sine; the shoulder of a lone
# groove is farther; the next valley of a sine begins at three times.
_BEYOND = 3.0
_SMOOTH = 1.5  # elements over which the curvature along a cut is averaged


@dataclass(frozen=True, slots=True, kw_only=True)
class Profile:
    """A cut across a wrinkle.

    Parameters
    ----------
    face : at its middle
    inflection : float [m]     half the width of the valley, to the farther side
    depth : float [m]          of the valley below the straight edge
    waves : float [m]          arc minus chord between the crests
    compression : float [m]    shortening of the cloth between them
    """

    face: int
    inflection: float
    depth: float
    waves: float
    compression: float


def section_reach(cut: Profile) -> float:
    """Half length [m] of a section that shows a wrinkle from crest to crest."""
    return min(_BEYOND * cut.inflection, _FARTHEST)


def profile(solution: Solution, face: int, across: FloatArray) -> Profile:
    """Cut across a wrinkle at one of its faces.

    The valley ends where the curvature across changes its sign; the crests are where a straight
    edge touches that reaches three times as far.
    """
    cover = solution.cover
    middle = cover.rest[cover.faces[face]].mean(axis=0)
    options = {"panel": int(cover.panel[face]), "middle": middle, "direction": across}
    wide = section(cover, solution.positions, half_length=_FARTHEST, **options)
    left, right = _inflections(solution, wide, across)
    half = max(left, right, cover.element_size)
    reach = min(_BEYOND * half, _FARTHEST)
    cut = section(cover, solution.positions, half_length=reach, **options)
    valley = (cut.along >= -left) & (cut.along <= right)
    valley[np.abs(cut.along).argmin()] = True
    low = int(np.flatnonzero(valley)[cut.height[valley].argmin()])
    touches = np.flatnonzero(cut.height > -1e-9)
    first = int(touches[touches <= low].max(initial=0))
    last = int(touches[touches >= low].min(initial=len(cut.along) - 1))
    crests = slice(first, last + 1)
    points = cut.points[crests]
    return Profile(
        face=face,
        inflection=half,
        depth=float(-cut.height[low]),
        waves=length(points) - float(np.linalg.norm(points[-1] - points[0])),
        compression=_compression(solution, cut.along[crests], cut.faces[crests], across),
    )


def _inflections(solution: Solution, cut: Section, across: FloatArray) -> tuple[float, float]:
    """How far from the middle [m] to each side the surface is bent inward across the wrinkle."""
    bent = np.einsum("i,kij,j->k", across, bending(solution, cut.faces), across)
    step = float(cut.along[1] - cut.along[0])
    window = 2 * round(0.5 * _SMOOTH * solution.cover.element_size / step) + 1
    padded = np.pad(bent, window // 2, mode="edge")
    smooth = np.convolve(padded, np.full(window, 1.0 / window), mode="valid")
    out = np.flatnonzero(smooth >= 0.0)
    middle = int(np.abs(cut.along).argmin())
    left = out[out < middle].max(initial=0)
    right = out[out > middle].min(initial=len(bent) - 1)
    return float(-cut.along[left]), float(cut.along[right])


def _compression(
    solution: Solution, along: FloatArray, faces: IntArray, across: FloatArray
) -> float:
    """Shortening [m] of the cloth along a cut."""
    green = np.einsum("i,kij,j->k", across, solution.strain_mid[faces], across)
    strain = np.sqrt(1.0 + 2.0 * green) - 1.0
    return float(np.trapezoid(np.maximum(-strain, 0.0), along))
