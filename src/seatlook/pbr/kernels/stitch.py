"""Groove, top stitch and needle holes beside a seam."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from seatlook.pbr.kernels import leaf
from seatlook.pbr.kernels.surface import along, cross, dot, minus, row


class Thread(NamedTuple):
    """Top stitch beside each seam, lengths in m.

    ``offset`` from the seam line; ``pitch``: from hole to hole; ``length, width`` of one stitch,
    width 0 for none; ``colour``: linear, of which the thread has the share ``own`` and the panel's
    for the rest. ``gauge``: to a second row, 0 where there is none; ``built``: whether seams
    are drawn as they are built, see ``sewn``, or as grooves with one even row.
    """

    offset: float
    pitch: float
    length: float
    width: float
    colour: tuple[float, float, float]
    own: float
    gauge: float
    built: bool


# Depth [m] and width [m] of the roll into the seam and of the line the stitches press in.
_ROLL_DEPTH, _ROLL_WIDTH = 0.0008, 0.0011
_PRESS_DEPTH, _PRESS_WIDTH = 0.00022, 0.0012
_HOLE = 0.00045


@leaf()
def seam_at(mesh, f, b1, b2):
    """Distance from the seam, length along it and rows of stitches at a point of face f.

    The distance is infinite where there is none.
    """
    a, b, c = mesh.faces[f, 0], mesh.faces[f, 1], mesh.faces[f, 2]
    b0 = 1.0 - b1 - b2
    s, t, u = mesh.seam[a, 1], mesh.seam[b, 1], mesh.seam[c, 1]
    # Where the nearest seam changes, the length along it jumps: no stitch crosses that.
    if not max(s, t, u) - min(s, t, u) < 0.006:
        return np.inf, 0.0, 0.0
    distance = b0 * mesh.seam[a, 0] + b1 * mesh.seam[b, 0] + b2 * mesh.seam[c, 0]
    rows = mesh.seam[a, 2] if mesh.seam[a, 2] == mesh.seam[b, 2] == mesh.seam[c, 2] else 0.0
    return distance, b0 * s + b1 * t + b2 * u, rows


@leaf()
def reach(thread):
    """Distance [m] beyond which nothing of a seam shows: six widths of its widest groove.

    Of one as it is built: three widths of the pucker beside its last row.
    """
    if thread.built:
        return max(thread.offset + thread.gauge + 0.0057, 0.006)
    return thread.offset + 6.0 * _PRESS_WIDTH + thread.width


@leaf()
def away_from_seam(mesh, f):
    """Gradients of distance and length along, as world vectors in the plane of face f."""
    i, j, k = mesh.faces[f, 0], mesh.faces[f, 1], mesh.faces[f, 2]
    e1 = minus(row(mesh.vertices, j), row(mesh.vertices, i))
    e2 = minus(row(mesh.vertices, k), row(mesh.vertices, i))
    n = cross(e1, e2)
    s = 1.0 / dot(n, n)
    p, q = cross(e2, n), cross(n, e1)
    d1, d2 = mesh.seam[j, 0] - mesh.seam[i, 0], mesh.seam[k, 0] - mesh.seam[i, 0]
    a1, a2 = mesh.seam[j, 1] - mesh.seam[i, 1], mesh.seam[k, 1] - mesh.seam[i, 1]
    away = (
        s * (d1 * p[0] + d2 * q[0]),
        s * (d1 * p[1] + d2 * q[1]),
        s * (d1 * p[2] + d2 * q[2]),
    )
    onward = (
        s * (a1 * p[0] + a2 * q[0]),
        s * (a1 * p[1] + a2 * q[1]),
        s * (a1 * p[2] + a2 * q[2]),
    )
    return away, onward


@leaf()
def seam_relief(thread, distance, arc, width):
    """Relief beside a seam that is a groove with one row, for a sample ``width`` [m] wide.

    Returns slope away from the seam, slope along it, share of the base colour left, and share of
    the sample covered by thread.
    """
    roll = np.exp(-distance / _ROLL_WIDTH)
    if thread.width == 0.0:
        share = 1.0 - 0.65 * np.exp(-distance / 0.0006)
        return _ROLL_DEPTH / _ROLL_WIDTH * roll, 0.0, share, 0.0
    x = (distance - thread.offset) / _PRESS_WIDTH
    press = np.exp(-0.5 * x * x)
    away = _ROLL_DEPTH / _ROLL_WIDTH * roll + _PRESS_DEPTH / _PRESS_WIDTH * x * press
    share = 1.0 - 0.65 * np.exp(-distance / 0.0006)
    y = arc / thread.pitch
    y = (y - np.floor(y) - 0.5) * thread.pitch
    x = distance - thread.offset
    half = 0.5 * thread.width
    over = max(0.0, abs(y) - (0.5 * thread.length - half))
    r = np.sqrt(x * x + over * over)
    covered = min(1.0, max(0.0, (half - r) / max(width, 1e-6) + 0.5))
    if covered > 0.0:
        q = min(r / half, 0.95)
        steep = covered * q / np.sqrt(1.0 - q * q)
        away = (1.0 - covered) * away - steep * x / max(r, 1e-9)
        return away, -steep * np.copysign(over, y) / max(r, 1e-9), 1.0, covered
    hole = np.sqrt(x * x + (abs(y) - 0.5 * thread.pitch) ** 2)
    share *= 1.0 - 0.75 * min(1.0, max(0.0, (_HOLE - hole) / max(width, 1e-6) + 0.5))
    return away, 0.0, share, 0.0


@leaf()
def tilt(n, away, onward, slope_away, slope_onward):
    """Normal of a relief with the given slopes along two world vectors; not unit."""
    return along(along(n, -slope_away, away), -slope_onward, onward)
