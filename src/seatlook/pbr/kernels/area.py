"""Rectangles that shine: how a point sees their cells, and what lobes reflect of these.

The half-vectors between the eye and the outline of a cell bound a polygon of slopes. A GGX lobe is
a cosine over the half-space, stretched by its width (Heitz et al. 2016): its share in the polygon
is a form factor, known exactly (Lambert). So no highlight falls between samples of the lamp. What
else the BRDF holds changes slowly over a cell and is taken at its middle.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from seatlook.pbr.kernels import leaf
from seatlook.pbr.kernels.surface import along, cross, dot, minus, row

# Codes of ``Lights.near``: shining to one side, or to both.
ONE_SIDED, TWO_SIDED = 2, 3
# Cells whose shadows are apart, one bit each; along the length of a strip, or in two rows.
CELLS = 8
ALL = (1 << CELLS) - 1
# Sides' ratio from which a rectangle is a strip.
_LONG = 4.0
# Widest angle [rad] of a cell over which a lobe is integrated at once, where it is wide; the share
# of a narrow one's width by which the chords of a cell may miss its sides; the most cuts of one.
_WIDE, _MISSED, _CUTS = 0.35, 0.07, 4
# Corners of all cells at most, and lines of a strip's.
CORNERS = (CELLS * _CUTS + 1) * (_CUTS + 1)
# Least distance [m] from the line of a rectangle's middle.
_NEAR = 1e-4


class Rectangle(NamedTuple):
    """A rectangle as a point sees it.

    ``to`` (3,): from the point to its middle; ``a, b`` (3,): halves of its sides; ``foot``: where
    the line along its middle is closest, in halves of its length, ``high``: how far that is, same
    unit; ``low, step`` [rad]: angle at the point of its first end, and of one cell; ``columns,
    rows``: cells; ``normal`` (3,): unit, to the side that shines towards the point, whose distance
    before it is ``ahead`` [m], 0 where it does not shine.
    """

    to: tuple[float, float, float]
    a: tuple[float, float, float]
    b: tuple[float, float, float]
    foot: float
    high: float
    low: float
    step: float
    columns: int
    rows: int
    normal: tuple[float, float, float]
    ahead: float


@leaf()
def is_rectangle(lights, k):
    """Whether light k is a rectangle."""
    return lights.near[k] >= ONE_SIDED


@leaf()
def rectangle_at(lights, k, p):
    """Rectangle of light k seen from ``p``."""
    to = minus(row(lights.vector, k), p)
    a, b = row(lights.sides[k], 0), row(lights.sides[k], 1)
    aa, bb = dot(a, a), dot(b, b)
    columns = CELLS if aa > _LONG * _LONG * bb else CELLS // 2
    foot = -dot(to, a) / aa
    away = along(to, foot, a)
    high = max(np.sqrt(dot(away, away)), _NEAR) / np.sqrt(aa)
    low, end = np.arctan((-1.0 - foot) / high), np.arctan((1.0 - foot) / high)
    n = cross(a, b)
    size = 1.0 / np.sqrt(dot(n, n))
    ahead = -dot(n, to) * size
    if ahead < 0.0 and lights.near[k] == TWO_SIDED:
        size, ahead = -size, -ahead
    normal = (n[0] * size, n[1] * size, n[2] * size)
    rows = CELLS // columns
    step = (end - low) / columns
    return Rectangle(to, a, b, foot, high, low, step, columns, rows, normal, max(ahead, 0.0))


@leaf()
def across_at(rectangle, column):
    """Place along the length of a rectangle, in halves of it, at a column and part of one.

    Cells are equal in angle: those of a near strip are short where it is close.
    """
    return rectangle.foot + rectangle.high * np.tan(rectangle.low + rectangle.step * column)


@leaf()
def place_on(rectangle, x, y):
    """Vector from the point to a place on a rectangle, in halves of its sides."""
    return along(along(rectangle.to, x, rectangle.a), y, rectangle.b)


@leaf()
def cuts_of(rectangle, alpha):
    """How often each cell is cut, along and across, for lobes at least ``alpha`` wide."""
    b, a = np.sqrt(dot(rectangle.b, rectangle.b)), np.sqrt(dot(rectangle.a, rectangle.a))
    wide = 2.0 * b / (rectangle.rows * max(rectangle.high * a, 0.5 * b))
    # A side seen under an angle a bends by a^2 / 8 in the space of slopes.
    most = min(_WIDE, np.sqrt(8.0 * _MISSED * alpha))
    along_it = min(_CUTS, max(1, int(np.ceil(rectangle.step / most))))
    return along_it, min(_CUTS, max(1, int(np.ceil(wide / most))))


@leaf()
def half_vectors(rectangle, cuts, v, out):
    """Half-vectors, not unit, to the corners of all cells into ``out`` (n, 4), column by column.

    The last column is the cube of the inverse distance of the corner.
    """
    columns, lines = rectangle.columns * cuts[0], rectangle.rows * cuts[1]
    # Tangents of equal steps follow from one.
    step = np.tan(rectangle.step / cuts[0])
    t = np.tan(rectangle.low)
    for i in range(columns + 1):
        x = rectangle.foot + rectangle.high * t
        t = (t + step) / (1.0 - t * step)
        for j in range(lines + 1):
            d = place_on(rectangle, x, 2.0 * j / lines - 1.0)
            scale = 1.0 / np.sqrt(max(dot(d, d), 1e-20))
            for c in range(3):
                out[i * (lines + 1) + j, c] = v[c] + scale * d[c]
            out[i * (lines + 1) + j, 3] = scale * scale * scale


class Cell(NamedTuple):
    """Part of a rectangle seen from a point.

    ``l``: unit direction to its middle; ``angle``: its solid angle [sr]; ``radius`` [rad]: that of
    a disc as large.
    """

    l: tuple[float, float, float]
    angle: float
    radius: float


@leaf()
def cell_of(rectangle, half, i, j, lines, x0, x1):
    """Cell between two places along, line j of ``lines`` across; ``half``: see ``half_vectors``.

    Its solid angle is that of its middle and corners, exact to third order.
    """
    y0, y1 = 2.0 * j / lines - 1.0, 2.0 * (j + 1) / lines - 1.0
    d = place_on(rectangle, 0.5 * (x0 + x1), 0.5 * (y0 + y1))
    square = 1.0 / dot(d, d)
    scale = np.sqrt(square)
    area = dot(rectangle.a, rectangle.a) * dot(rectangle.b, rectangle.b)
    area = (x1 - x0) * (y1 - y0) * np.sqrt(area)
    a, b = i * (lines + 1) + j, (i + 1) * (lines + 1) + j
    around = half[a, 3] + half[a + 1, 3] + half[b, 3] + half[b + 1, 3]
    angle = area * rectangle.ahead * (2.0 * scale * square + 0.25 * around) / 3.0
    l = (d[0] * scale, d[1] * scale, d[2] * scale)
    return Cell(l, angle, np.sqrt(angle / np.pi))


@leaf()
def arc(cosine):
    """Angle over its sine over 2 pi, by the cosine; Hill 2016, to 1e-5."""
    x = abs(cosine)
    value = 0.8543985 + (0.4965155 + 0.0145206 * x) * x
    value /= 3.4175940 + (4.1616724 + x) * x
    if cosine > 0.0:
        return value
    return 0.5 / np.sqrt(max(1.0 - cosine * cosine, 1e-7)) - value


@leaf()
def slopes_of(half, axes, ax, ay, count, out):
    """Half-vectors (n, 3) in the space of slopes over the widths of a lobe, unit, into ``out``."""
    n, warp, weft = axes
    for i in range(count):
        h = row(half, i)
        x, y, z = dot(warp, h) / ax, dot(weft, h) / ay, max(dot(n, h), 1e-4)
        scale = 1.0 / np.sqrt(x * x + y * y + z * z)
        out[i, 0], out[i, 1], out[i, 2] = x * scale, y * scale, z * scale


@leaf()
def edge_of(slopes, i, j):
    """Form factor of the arc between two directions (Lambert)."""
    x0, y0, x1, y1 = slopes[i, 0], slopes[i, 1], slopes[j, 0], slopes[j, 1]
    return (x0 * y1 - y0 * x1) * arc(x0 * x1 + y0 * y1 + slopes[i, 2] * slopes[j, 2])


@leaf()
def shares_of(slopes, columns, lines, edges, out):
    """Share of a lobe whose half-vectors lie in each cell, into ``out``, column by column.

    ``edges``: room for those across a column; each edge is taken once.
    """
    for j in range(lines):
        edges[j] = edge_of(slopes, j, j + 1)
    for i in range(columns):
        a, b = i * (lines + 1), (i + 1) * (lines + 1)
        low = edge_of(slopes, a, b)
        for j in range(lines):
            right, high = edge_of(slopes, b + j, b + j + 1), edge_of(slopes, a + j + 1, b + j + 1)
            out[i * lines + j] = abs(low + right - high - edges[j])
            edges[j], low = right, high


@leaf()
def mean_lobe(share, cell, masking, NoH, LoH):
    """Mean of D V over a cell in which ``share`` of the half-vectors of D lie."""
    return share * 4.0 * masking * LoH / (NoH * cell.angle)
