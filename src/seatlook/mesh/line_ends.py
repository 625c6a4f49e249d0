"""Lines on a surface joined where they end: on each other or on the border."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np
import numpy.typing as npt

from seatlook.errors import InputError, Problem
from seatlook.mesh.closest import closest_places
from seatlook.mesh.polyline import is_closed
from seatlook.mesh.surface import boundary_sides

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

CLEAR = 0.010  # [m] that the tip of a dart stays away: less is an end that was drawn too short


def lay_on(
    vertices: FloatArray,
    faces: IntArray,
    lines: Mapping[str, FloatArray],
    *,
    tolerance: float,
) -> dict[str, FloatArray]:
    """Lay lines onto a surface and join their ends to the border or to each other.

    An end within ``tolerance`` of the border moves there; one within it of another line's end, or
    of another line, moves there, and that line gets a point at the same place. An end ``CLEAR``
    of them stays where it is: the tip of a dart.

    Parameters
    ----------
    vertices : (n, 3) [m]; faces : (m, 3)
    lines : name -> (k, 3) [m]; a closed line repeats its first point
    tolerance : float [m]

    Raises
    ------
    InputError
        A point lies farther than ``tolerance`` from the surface, or a line ends a little before
        the border or another line.
    """
    laid, problems = {}, []
    within = f"within {1e3 * tolerance:g} mm of"
    for name, line in lines.items():
        on = closest_places(line, vertices, faces, reach=np.inf)
        laid[name] = line - on.offset
        worst = int(on.distance.argmax())
        if on.distance[worst] > tolerance:
            problems.append(
                _problem(name, worst, f"{1e3 * on.distance[worst]:.2f} mm", f"{within} the surface")
            )
    if problems:
        raise InputError(problems)
    side, k = np.divmod(boundary_sides(faces), 3)
    border = np.stack([vertices[faces[side, k]], vertices[faces[side, (k + 1) % 3]]], axis=1)
    for name, at, from_border in _open_ends(laid, border, tolerance):
        gap = min(_join(laid, name, at, tolerance), from_border)
        if tolerance < gap < CLEAR:
            i = at % len(lines[name])
            expected = f"an end {within} the border or another line, or as the tip of a dart "
            expected += f"{1e3 * CLEAR:g} mm clear of them"
            problems.append(_problem(name, i, f"an end {1e3 * gap:.1f} mm away", expected))
    if problems:
        raise InputError(problems)
    return laid


def _open_ends(
    laid: dict[str, FloatArray], border: FloatArray, tolerance: float
) -> list[tuple[str, int, float]]:
    """Move ends to the border where it is near; return the others with how far it is.

    Closed lines have no ends.
    """
    open_ends = []
    for name, line in laid.items():
        if is_closed(line):
            line[-1] = line[0]
            continue
        for at in (0, -1):
            place, gap, _ = _nearest(line[at], border)
            if gap <= tolerance:
                line[at] = place
            else:
                open_ends.append((name, at, gap))
    return open_ends


def _join(laid: dict[str, FloatArray], name: str, at: int, tolerance: float) -> float:
    """Move an end onto another line, if one is near; return how far the nearest is."""
    end, others = laid[name][at], {k: v for k, v in laid.items() if k != name}
    if not others:
        return np.inf
    tips = np.concatenate([line[[0, -1]] for line in others.values()])
    gap = np.linalg.norm(tips - end, axis=1)
    if gap.min() <= tolerance:
        laid[name][at] = tips[gap.argmin()]
        return float(gap.min())
    nearest = {k: _nearest(end, np.stack([v[:-1], v[1:]], axis=1)) for k, v in others.items()}
    other = min(nearest, key=lambda k: nearest[k][1])
    place, distance, segment = nearest[other]
    if distance <= tolerance:
        laid[name][at] = place
        laid[other] = np.insert(laid[other], segment + 1, place, axis=0)
    return distance


def _nearest(point: FloatArray, segments: FloatArray) -> tuple[FloatArray, float, int]:
    """Return the closest place on segments (s, 2, 3), how far it is, and the segment."""
    if not len(segments):
        return point, np.inf, -1
    start, way = segments[:, 0], segments[:, 1] - segments[:, 0]
    length2 = np.maximum(np.einsum("sd,sd->s", way, way), np.finfo(float).tiny)
    share = np.clip(np.einsum("sd,sd->s", point - start, way) / length2, 0.0, 1.0)
    places = start + share[:, None] * way
    gap = np.linalg.norm(places - point, axis=1)
    best = int(gap.argmin())
    return places[best], float(gap[best]), best


def _problem(name: str, i: int, got: str, expected: str) -> Problem:
    return Problem(key=f"curve.{name}.points_mm[{i}]", got=got, expected=expected)
