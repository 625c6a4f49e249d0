"""Rows of edges that fit another row in all their shares, but not in length: gathered seams.

A waistband that is shorter or longer than what it holds is never found by length; a bodice and a
skirt that it joins are then taken for partners of each other. That the shares of three edges in a
row are those of three in a row on a panel that stays apart says so.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from seatlook.assembly.seam_guess.outlines import Outlines
from seatlook.assembly.seam_guess.sewing import Sewing
from seatlook.model import FloatArray

_ROW = 3  # edges
_SHARE = 0.012  # by which a share of a row's length may differ
_UNEVEN = 0.06  # spread of the shares below which a row is like any other


def maybe_gathered(sewing: Sewing, outlines: Outlines) -> set[int]:
    """Seams between panels of one piece that may both be gathered to a panel of another."""
    piece = sewing.pieces
    tips = {s for n in sewing.sewn for s in _dart_atoms(sewing, n)}
    rows = {p: list(_rows(outlines, p, tips)) for p in range(len(outlines.stops))}
    found = set()
    for number in sewing.sewn:
        pair = sewing.pairs[number]
        if len(pair.panels) < 2:
            continue
        apart = [p for p in rows if piece[p] != piece[pair.a.panel]]
        others = [shares for p in apart for _, shares in rows[p]]
        if any(_fits(rows[side.panel], side.first, others) for side in (pair.a, *pair.b)):
            found.add(number)
    return found


def _dart_atoms(sewing: Sewing, number: int) -> tuple[int, ...]:
    return sewing.atoms[number] if sewing.pairs[number].is_dart else ()


def _rows(
    outlines: Outlines, panel: int, tips: set[int]
) -> Iterator[tuple[tuple[int, ...], FloatArray]]:
    """Atoms of a panel in a row, darts closed, with their shares of the row's length."""
    atoms = [atom for atom in outlines.whole(panel) if atom not in tips]
    for k in range(len(atoms) if len(atoms) > _ROW else 0):
        row = tuple(atoms[(k + i) % len(atoms)] for i in range(_ROW))
        lengths = outlines.lengths[list(row)]
        shares = lengths / lengths.sum()
        if np.ptp(shares) > _UNEVEN:
            yield row, shares


def _fits(
    rows: list[tuple[tuple[int, ...], FloatArray]], atom: int, others: list[FloatArray]
) -> bool:
    """Whether a row with an atom in it has the shares of another that runs against it."""
    return any(
        np.abs(shares - other[::-1]).max() < _SHARE
        for row, shares in rows
        if atom in row
        for other in others
    )
