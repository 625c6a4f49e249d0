"""What a surface reflects of a rectangle that shines: cell by cell, or over a relief's samples."""

from __future__ import annotations

import numpy as np

from seatlook.pbr.kernels import leaf
from seatlook.pbr.kernels.area import (
    ALL,
    arc,
    cell_of,
    cuts_of,
    half_vectors,
    mean_lobe,
    rectangle_at,
    shares_of,
    slopes_of,
)
from seatlook.pbr.kernels.brdf import layered, widened
from seatlook.pbr.kernels.light import above_horizon
from seatlook.pbr.kernels.lobes import V_SmithGGXCorrelated
from seatlook.pbr.kernels.relief_light import reflected_by
from seatlook.pbr.kernels.relief_samples import layers_towards
from seatlook.pbr.kernels.surface import along, cross, dot, row, unit

# Width of a lobe from which cells along a strip are taken two by two for a relief.
_COARSE = 0.25


@leaf()
def is_seen(bits, column, line, rows):
    """Whether a cell is among those that a sample sees."""
    return (bits >> (column * rows + line)) & 1


@leaf()
def radiance_of(lights, k, rectangle, c):
    """Radiance [cd/m2] of rectangle k in channel c."""
    area = 4.0 * np.sqrt(dot(rectangle.a, rectangle.a) * dot(rectangle.b, rectangle.b))
    return lights.intensity[k, c] / area


@leaf()
def add_to_lobe(tables, lights, k, bits, place, reflector, axes, beside, scratch):
    """Rectangle k as one lobe with ``axes`` (normal, warp, weft) reflects it.

    ``bits``: cells that are seen; ``beside``: added to the squared width of the lobes.
    """
    material, view, n, v = reflector.material, reflector.sight, axes[0], place.v
    rectangle = rectangle_at(lights, k, place.p)
    if bits == 0 or rectangle.ahead <= 0.0:
        return
    ax, ay = widened(view.alpha_x, beside), widened(view.alpha_y, beside)
    width = widened(material.coat_roughness**2, beside)
    narrowest = min(ax, ay)
    if material.coat > 0.0:
        narrowest = min(narrowest, width)
    cuts = cuts_of(rectangle, narrowest)
    columns, lines = rectangle.columns * cuts[0], rectangle.rows * cuts[1]
    half, base = scratch.corners[0], scratch.corners[1]
    half_vectors(rectangle, cuts, v, half)
    count = (columns + 1) * (lines + 1)
    slopes_of(half, axes, ax, ay, count, base)
    shares_of(base, columns, lines, scratch.edge, scratch.shares[0])
    if material.coat > 0.0:
        slopes_of(half, axes, width, width, count, base)
        shares_of(base, columns, lines, scratch.edge, scratch.shares[1])
    out, f_out = scratch.work[0], scratch.work[1]
    t, step = np.tan(rectangle.low), np.tan(rectangle.step / cuts[0])
    x1 = rectangle.foot + rectangle.high * t
    for i in range(columns):
        x0 = x1
        t = (t + step) / (1.0 - t * step)
        x1 = rectangle.foot + rectangle.high * t
        for j in range(lines):
            if not is_seen(bits, i // cuts[0], j // cuts[1], rectangle.rows):
                continue
            cell = cell_of(rectangle, half, i, j, lines, x0, x1)
            l = cell.l
            NoL = above_horizon(dot(n, l), dot(place.n, l), cell.radius)
            if NoL <= 1e-5:
                continue
            h = unit(along(v, 1.0, l))
            NoH, LoH = min(1.0, max(1e-3, dot(n, h))), min(1.0, dot(l, h))
            x, y = dot(axes[1], l), dot(axes[2], l)
            masking = V_SmithGGXCorrelated(ax, ay, view.ToV, view.BoV, view.NoV, x, y, NoL)
            lobe = mean_lobe(scratch.shares[0, i * lines + j], cell, masking, NoH, LoH)
            top = 0.0
            if material.coat > 0.0:
                masking = V_SmithGGXCorrelated(
                    width, width, view.ToV, view.BoV, view.NoV, x, y, NoL
                )
                top = mean_lobe(scratch.shares[1, i * lines + j], cell, masking, NoH, LoH)
            layered(tables, reflector, (lobe, top), (x, y, NoL, NoH, LoH), f_out)
            for c in range(3):
                e = radiance_of(lights, k, rectangle, c) * cell.angle
                out[c] += f_out[c] * NoL * e


@leaf()
def add_to_relief(lights, k, bits, place, reflector, relief, within, scratch):
    """Rectangle k as the samples of a relief reflect it.

    Their lobes are integrated over all that is seen; what else the BRDF holds is the mean over its
    cells, each weighed by the lobe at its middle.
    """
    rectangle = rectangle_at(lights, k, place.p)
    if bits == 0 or rectangle.ahead <= 0.0:
        return
    rows, size = relief
    half, cells = scratch.corners[0], scratch.cells
    half_vectors(rectangle, (1, 1), place.v, half)
    material, view = reflector.material, reflector.sight
    count = _cells_seen(rectangle, bits, place, half, cells)
    angle = _cosines(cells, count, relief)
    if material.coat > 0.0:
        width = np.sqrt(material.coat_roughness**4 + within)
        _shares(rectangle, bits, width, half, relief, scratch.edge, rows.top)
        _means(width, angle, cells, count, relief, rows.top)
    # The base last: Fresnel's power and the half-vectors of its lobe stand for both.
    width = np.sqrt(view.alpha_x**2 + within)
    _shares(rectangle, bits, width, half, relief, scratch.edge, rows.low)
    _means(width, angle, cells, count, relief, rows.low)
    layers_towards(reflector.layers, rows.NoL, size, rows.light)
    f_out = scratch.work[1]
    reflected_by(reflector, relief, f_out)
    for c in range(3):
        scratch.work[0, c] += f_out[c] * radiance_of(lights, k, rectangle, c) * angle


@leaf()
def _cells_seen(rectangle, bits, place, half, cells):
    """Cells that are seen, into ``cells`` (n, 11); returns their number.

    Columns: direction to the middle, half-vector, cosine between both, Fresnel's power of that,
    cosine to the surface without its relief, solid angle, radius.
    """
    t, step = np.tan(rectangle.low), np.tan(rectangle.step)
    x1, count, v = rectangle.foot + rectangle.high * t, 0, place.v
    for i in range(rectangle.columns):
        x0 = x1
        t = (t + step) / (1.0 - t * step)
        x1 = rectangle.foot + rectangle.high * t
        for j in range(rectangle.rows):
            if not is_seen(bits, i, j, rectangle.rows):
                continue
            cell = cell_of(rectangle, half, i, j, rectangle.rows, x0, x1)
            l = cell.l
            h = unit(along(v, 1.0, l))
            LoH = min(1.0, dot(l, h))
            grazing = 1.0 - LoH
            square = grazing * grazing
            for c in range(3):
                cells[count, c], cells[count, 3 + c] = l[c], h[c]
            cells[count, 6], cells[count, 7] = LoH, square * square * grazing
            cells[count, 8], cells[count, 9] = dot(place.n, l), cell.angle
            cells[count, 10] = cell.radius
            count += 1
    return count


@leaf()
def _cosines(cells, count, relief):
    """Mean cosine of each relief sample to the cells; returns their solid angle."""
    rows, size = relief
    total = 0.0
    for q in range(size):
        rows.NoL[q], rows.part[q] = 0.0, 1.0
    for k in range(count):
        angle, smooth, radius = cells[k, 9], cells[k, 8], cells[k, 10]
        total += angle
        for q in range(size):
            c = rows.x[q] * cells[k, 0] + rows.y[q] * cells[k, 1] + rows.z[q] * cells[k, 2]
            rows.NoL[q] += angle * above_horizon(c, smooth, radius)
    for q in range(size):
        rows.NoL[q] = min(1.0, rows.NoL[q] / total)
    return total


@leaf()
def _shares(rectangle, bits, width, half, relief, edge, out):
    """Share of each sample's lobe whose half-vectors lie in the cells that are seen.

    Only edges between what is seen and what is not count: those between two seen cells cancel.
    """
    size, a2, lines = relief.size, width * width, rectangle.rows
    for q in range(size):
        out[q] = 0.0
    if bits == ALL:
        # For a wide lobe every other corner along a strip is enough.
        jump = 2 if width > _COARSE and lines == 1 else 1
        for i in range(0, rectangle.columns, jump):
            here, there = i * (lines + 1), (i + jump) * (lines + 1)
            _add_edge(half, here, there, a2, relief, 1, edge, out)
            _add_edge(half, there + lines, here + lines, a2, relief, 1, edge, out)
        last = rectangle.columns * (lines + 1)
        for j in range(lines):
            _add_edge(half, j + 1, j, a2, relief, 1, edge, out)
            _add_edge(half, last + j, last + j + 1, a2, relief, 1, edge, out)
        for q in range(size):
            out[q] = abs(out[q])
        return
    for i in range(rectangle.columns + 1):
        for j in range(lines + 1):
            here = i * (lines + 1) + j
            before = i > 0 and j < lines and is_seen(bits, i - 1, j, lines)
            after = i < rectangle.columns and j < lines and is_seen(bits, i, j, lines)
            if before != after:
                _add_edge(half, here, here + 1, a2, relief, before - after, edge, out)
            below = i < rectangle.columns and j > 0 and is_seen(bits, i, j - 1, lines)
            above = i < rectangle.columns and j < lines and is_seen(bits, i, j, lines)
            if below != above:
                there = here + lines + 1
                _add_edge(half, here, there, a2, relief, above - below, edge, out)
    for q in range(size):
        out[q] = abs(out[q])


@leaf()
def _add_edge(half, a, b, a2, relief, sign, edge, out):
    """Form factor of one edge in every sample's space of slopes, times ``sign``, to ``out``.

    A half-vector there is the one here with its part along the normal, which is never below it,
    narrowed by the lobe's width, whose square is ``a2``.
    """
    rows, size = relief
    g, h = row(half, a), row(half, b)
    x = cross(g, h)
    gg, hh, gh = dot(g, g), dot(h, h), dot(g, h)
    for q in range(size):
        m = (rows.x[q], rows.y[q], rows.z[q])
        up, wp = dot(m, g), dot(m, h)
        u, w = max(up, 1e-4), max(wp, 1e-4)
        first, second = gg - up * up + a2 * u * u, hh - wp * wp + a2 * w * w
        scale = 1.0 / np.sqrt(first * second)
        edge[q] = dot(m, x) * scale
        rows.again[q] = max(-1.0, min(1.0, (gh - up * wp + a2 * u * w) * scale))
    for q in range(size):
        out[q] += sign * edge[q] * arc(rows.again[q])


@leaf()
def _means(width, angle, cells, count, relief, out):
    """Mean of D V over what is seen, relative to the mean cosine, of shares in ``out``.

    Leaves Fresnel's power and the cosine of the half-vector of each sample as well.
    """
    (rows, size), a2 = relief, width * width
    for q in range(size):
        rows.again[q] = rows.weight[q] = rows.grazing[q] = rows.NoH[q] = 0.0
    for k in range(count):
        angle_k, LoH, power, smooth = cells[k, 9], cells[k, 6], cells[k, 7], cells[k, 8]
        for q in range(size):
            x, y, z = rows.x[q], rows.y[q], rows.z[q]
            NoH = max(1e-3, x * cells[k, 3] + y * cells[k, 4] + z * cells[k, 5])
            NoL = min(smooth, x * cells[k, 0] + y * cells[k, 1] + z * cells[k, 2])
            NoL, NoV = max(1e-4, NoL), rows.NoV[q]
            seen = NoL * np.sqrt(a2 + (1.0 - a2) * NoV * NoV)
            lit = NoV * np.sqrt(a2 + (1.0 - a2) * NoL * NoL)
            d = NoH * NoH * (a2 - 1.0) + 1.0
            w = angle_k / (d * d)
            bracket = w * NoL * LoH / (NoH * (seen + lit))
            rows.weight[q] += w
            rows.again[q] += bracket
            rows.grazing[q] += bracket * power
            rows.NoH[q] += w * NoH
    for q in range(size):
        rows.grazing[q] /= rows.again[q]
        rows.NoH[q] = min(1.0, rows.NoH[q] / rows.weight[q])
        lobe = 2.0 * out[q] * rows.again[q] / rows.weight[q]
        out[q] = lobe / (max(rows.NoL[q], 1e-5) * angle)
