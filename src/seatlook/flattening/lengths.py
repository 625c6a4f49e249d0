"""The two lines of a seam: agreeing on their lengths, and easing one of them on purpose."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from scipy.spatial import cKDTree

from seatlook.errors import SeatlookError
from seatlook.flattening.pattern import pair
from seatlook.flattening.relax import HeldEdges, Openings, flatten_patch
from seatlook.flattening.surface import Patch, Side, darts
from seatlook.mesh import arc_length, segment_lengths
from seatlook.model import Fabric, FloatArray, IntArray

_Slits = list[tuple[IntArray, IntArray]]  # vertices of both sides of darts, mouth to tip

# [m] over which the stretch beside an eased sewing line fades out. A linear fade over a strip is
# a bend in the plane, which costs no strain; a shorter one drives the ease to the line's ends.
_EASE_REACH = 0.15
_EASE_PRECISION = 2e-5  # [m]
_EASE_ROUNDS = 30
_LEAST_RESPONSE = 0.25  # of a line's length to growth along it, over its length; about 1 as a rule
_LENGTH_PRECISION = 2e-5  # [m] of a sewing line; both lines of a seam then agree to 4e-5
_LENGTH_ROUNDS = 8
# Of the length that the panels of a seam want, and the other way round. Held at 4.5 % more the line
# crumpled; held at 14 % less, as that of a pillow of two panels, all cloth was 10 % too small.
_LONGEST = 1.02
# Share of its length by which a dart is open at least: so much is left between its sides where the
# form asks for none, or for cloth that is let in.
_OPENING = 0.02


def agreed_ratios(
    patches: tuple[Patch, ...],
    borders: tuple[Side, ...],
    shapes: Mapping[str, FloatArray],
    *,
    limit: float,
) -> dict[str, FloatArray]:
    """Return per side and segment its flat length over that on the surface, agreed by both.

    It is within the limit of 1, but for segments that both panels want much shorter or longer.
    """
    by_name = {patch.name: patch for patch in patches}
    wishes = {}
    for side in borders:
        patch = by_name[side.panel]
        at = side.indices(patch)
        wishes[side.name] = segment_lengths(shapes[side.panel][at]) / segment_lengths(
            patch.vertices[at]
        )
    agreed: dict[str, FloatArray] = {}
    for seam in pair(borders):
        b = seam.b[0]
        wanted = wishes[seam.a], wishes[b][::-1]
        mean = (wanted[0] + wanted[1]) / 2
        held = np.minimum(np.clip(mean, 1 - limit, 1 + limit), _LONGEST * mean)
        held = np.maximum(held, np.minimum(*wanted) / _LONGEST)
        agreed |= {seam.a: held, b: held[::-1]}
    return agreed


def relax_panel(
    patch: Patch,
    own: Sequence[Side],
    ratio: Mapping[str, FloatArray],
    start: FloatArray,
    ease: Mapping[str, float],
    *,
    fabric: Fabric | None = None,
) -> FloatArray:
    """Flatten one panel with its seam lengths held, eased sides at their length in total.

    Holding an eased side piece by piece would crumple it: a chain under compression buckles.
    """
    eased = [side for side in own if side.name in ease]
    slits = darts(patch, own)
    plain = [side for side in own if side not in eased]
    x, held = _with_lengths(patch, plain, ratio, start, fabric, slits)
    if not eased:
        return x
    agreed = np.array(
        [segment_lengths(patch.vertices[s.indices(patch)]) @ ratio[s.name] for s in eased]
    )
    goal = agreed * [1 + ease[s.name] for s in eased]
    amount, slope = np.zeros(len(eased)), agreed
    lengths = _lengths(patch, x, eased)
    for _ in range(_EASE_ROUNDS):
        if np.abs(lengths - goal).max() < _EASE_PRECISION:
            return x
        step = (goal - lengths) / slope
        amount = amount + step
        growth = _growth(patch, eased, amount)
        apart = _openings(patch, slits, x)
        x = flatten_patch(
            patch.vertices, patch.faces, held, openings=apart, growth=growth, start=x, fabric=fabric
        )
        before, lengths = lengths, _lengths(patch, x, eased)
        slope = np.where(step == 0, slope, (lengths - before) / np.where(step == 0, 1.0, step))
        # Rounding of small steps must not throw the next one far off.
        slope = np.clip(slope, _LEAST_RESPONSE * agreed, agreed / _LEAST_RESPONSE)
    raise SeatlookError("it cannot be stretched to the ease of its sewing lines")


def _with_lengths(
    patch: Patch,
    own: Sequence[Side],
    ratio: Mapping[str, FloatArray],
    start: FloatArray,
    fabric: Fabric | None,
    slits: _Slits,
) -> tuple[FloatArray, HeldEdges]:
    """Flatten a panel with the lengths of some sides held; return the lengths that did it too.

    Lengths give way a little to a large strain beside them. Where that adds up to more than a
    trace, what is missing is added to the lengths asked for (the method of multipliers).
    """
    held = _held(patch, own, ratio)
    form, apart = (patch.vertices, patch.faces), _openings(patch, slits, start)
    x = flatten_patch(*form, held, openings=apart, start=start, fabric=fabric)
    goal = held.length
    for _ in range(_LENGTH_ROUNDS):
        edge = x[held.vertices[:, 1]] - x[held.vertices[:, 0]]
        missing = goal - np.linalg.norm(edge, axis=1)
        by_side = np.split(missing, np.cumsum([side.count for side in own])[:-1])
        if max((abs(part.sum()) for part in by_side), default=0.0) < _LENGTH_PRECISION:
            break
        held = HeldEdges(vertices=held.vertices, length=held.length + missing)
        apart = _openings(patch, slits, x)
        x = flatten_patch(*form, held, openings=apart, start=x, fabric=fabric)
    return x, held


def _openings(patch: Patch, slits: _Slits, x: FloatArray) -> Openings | None:
    """Return what keeps the sides of a panel's darts apart, None where it has none."""
    parts = []
    for a, b in slits:
        middle = (x[a] + x[b]) / 2
        along = np.gradient(middle, axis=0)
        along /= np.linalg.norm(along, axis=1, keepdims=True)
        way = arc_length(patch.vertices[a])
        to_tip = way[-1] - way
        if a[0] == b[0]:
            to_tip = np.minimum(to_tip, way)
        apart = a != b
        parts.append((np.column_stack([a, b])[apart], along[apart], _OPENING * to_tip[apart]))
    if not parts:
        return None
    pairs, along, least = (np.concatenate(column) for column in zip(*parts, strict=True))
    across = np.column_stack([along[:, 1], -along[:, 0]])
    return Openings(vertices=pairs, across=across, least=least)


def _held(patch: Patch, own: Sequence[Side], ratio: Mapping[str, FloatArray]) -> HeldEdges:
    """Return the segments of some sides with their lengths on the surface times a ratio."""
    at = [side.indices(patch) for side in own]
    pairs = [np.column_stack([i[:-1], i[1:]]) for i in at]
    length = [
        segment_lengths(patch.vertices[i]) * ratio[s.name] for i, s in zip(at, own, strict=True)
    ]
    return HeldEdges(
        vertices=np.concatenate([np.zeros((0, 2), np.int64), *pairs]),
        length=np.concatenate([np.zeros(0), *length]),
    )


def _lengths(patch: Patch, x: FloatArray, own: Sequence[Side]) -> FloatArray:
    return np.array([segment_lengths(x[side.indices(patch)]).sum() for side in own])


def _growth(patch: Patch, eased: Sequence[Side], amount: FloatArray) -> FloatArray:
    """Return the stretch (m, 3, 3) along eased sides, fading into the panel."""
    growth = np.tile(np.eye(3), (len(patch.faces), 1, 1))
    middle = patch.vertices[patch.faces].mean(axis=1)
    for side, fraction in zip(eased, amount, strict=True):
        line = patch.vertices[side.indices(patch)]
        centre, along = (line[1:] + line[:-1]) / 2, np.diff(line, axis=0)
        along /= np.linalg.norm(along, axis=1, keepdims=True)
        distance, nearest = cKDTree(centre).query(middle)
        share = np.maximum(1 - distance / min(_EASE_REACH, float(np.max(distance))), 0)
        tangent = along[nearest]
        growth += (fraction * share)[:, None, None] * np.einsum("mi,mj->mij", tangent, tangent)
    return growth
