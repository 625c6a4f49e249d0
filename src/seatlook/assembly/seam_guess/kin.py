"""Which panels mirror each other, repeat each other, or are variants of one piece.

What the shape of a panel makes equal says nothing about sewing: the left and the right edge of a
symmetric panel always fit each other. And of two variants of a piece only one is in the cover.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from seatlook.assembly.panel_names import hand, named_variants
from seatlook.assembly.seam_guess.outlines import Outlines
from seatlook.model import FloatArray

_ALIKE = 0.012  # share of a length by which edges of mirrored panels may differ
_COPY = 0.002  # the same of repeated panels
_VARIANT = 0.2  # log; and of variants of one piece
_ALIKE_ANGLE = np.radians(8.0)
_VARIANT_ANGLE = np.radians(20.0)
_ACROSS = 0.6  # cosine of the angle to the grain below which an edge runs across it


@dataclass(frozen=True, slots=True)
class Kin:
    """Relations between panels, by atoms.

    Parameters
    ----------
    mirror : atom -> the atom that mirrors it, in the panel's twin or in the panel itself
    kind : atom -> number of the atoms that are alike but for their place
    shape : atom -> the same, by the outline of its own panel alone
    ends : pairs of atoms that lie across the grain of two panels of nearly one shape, such as the
        hems of front and back
    variants : pairs of panels of which only one is in the cover
    """

    mirror: dict[int, int]
    kind: list[int]
    shape: list[int]
    ends: frozenset[tuple[int, int]]
    variants: frozenset[tuple[int, int]]

    def never(self, one: int, other: int) -> bool:
        """Whether two panels are never sewn to each other."""
        return (min(one, other), max(one, other)) in self.variants


def find_kin(outlines: Outlines) -> Kin:
    """Compare all panels with each other."""
    mirror = _mirrors(outlines)
    kind, shape = _Classes(len(outlines)), _Classes(len(outlines))
    kind.join(mirror)
    shape.join({a: b for a, b in mirror.items() if outlines.panel_of[a] != outlines.panel_of[b]})
    names = [p.name for p in outlines.panels]
    for panel in range(len(names)):
        for turned in (True, False):
            for fit in _fits(outlines, panel, panel, turned=turned, share=_ALIKE):
                shape.join(fit.atoms)
    variants: set[tuple[int, int]] = set()
    ends: set[tuple[int, int]] = set()
    for one, other in combinations(range(len(names)), 2):
        near = [
            *_fits(outlines, one, other, turned=True, share=_VARIANT, angle=_VARIANT_ANGLE),
            *_fits(outlines, one, other, turned=False, share=_VARIANT, angle=_VARIANT_ANGLE),
        ]
        if near and named_variants(names[one], names[other]) and len(names) > 2:
            variants.add((one, other))
        for fit in near:
            ends |= {(a, b) for a, b in fit.atoms.items() if _across(outlines, a)}
        for turned in (False, True):
            for fit in _fits(outlines, one, other, turned=turned, share=_COPY):
                kind.join(fit.atoms)
                shape.join(fit.atoms)
    return Kin(
        mirror=mirror, kind=kind.numbers, shape=shape.numbers, ends=frozenset(ends),
        variants=frozenset(variants),
    )  # fmt: skip


class _Classes:
    """Atoms that are alike, joined pair by pair."""

    def __init__(self, count: int) -> None:
        self._of = list(range(count))

    def _root(self, atom: int) -> int:
        while self._of[atom] != atom:
            atom = self._of[atom]
        return atom

    def join(self, pairs: dict[int, int]) -> None:
        for one, other in pairs.items():
            self._of[self._root(one)] = self._root(other)

    @property
    def numbers(self) -> list[int]:
        return [self._root(atom) for atom in range(len(self._of))]


def _across(outlines: Outlines, atom: int) -> bool:
    """Whether an atom runs across the grain of its panel."""
    grain = outlines.panels[outlines.panel_of[atom]].grain
    chord = outlines.atoms[atom].chord
    return bool(abs(np.cos(chord) * grain[0] + np.sin(chord) * grain[1]) < _ACROSS)


def _mirrors(outlines: Outlines) -> dict[int, int]:
    """Atom -> its mirror image, where one twin stands out."""
    mirror: dict[int, int] = {}
    hands = [hand(p.name) for p in outlines.panels]
    for panel in range(len(hands)):
        if outlines.base[panel] in mirror:
            continue
        fits = {
            other: fit
            for other in range(panel, len(hands))
            if outlines.base[other] not in mirror
            and (fit := _best(_fits(outlines, panel, other, turned=True))) is not None
        }
        opposite = [o for o in fits if hands[panel] and hands[o] and hands[o] != hands[panel]]
        others = [o for o in fits if o != panel]
        twin = (
            opposite[0] if len(opposite) == 1
            else panel if panel in fits and not hands[panel]
            else others[0] if len(others) == 1
            else None
        )  # fmt: skip
        if twin is not None:
            mirror |= fits[twin] | {b: a for a, b in fits[twin].items()}
    return mirror


@dataclass(frozen=True, slots=True)
class _Fit:
    """Atoms of two panels of one shape; the misfit counts grain lines and lengths."""

    atoms: dict[int, int]
    misfit: float


def _best(fits: Sequence[_Fit]) -> dict[int, int] | None:
    """Of several ways, as for a square, the one that keeps the grain lines along each other."""
    return min(fits, key=lambda fit: fit.misfit).atoms if fits else None


def _fits(
    outlines: Outlines,
    one: int,
    other: int,
    *,
    turned: bool,
    share: float = _ALIKE,
    angle: float = _ALIKE_ANGLE,
) -> list[_Fit]:
    """All ways to lay a panel on another, turned over or not."""
    a, b = outlines.whole(one), outlines.whole(other)
    if len(a) != len(b):
        return []
    lengths = outlines.lengths[list(a)]
    angles = outlines.angle[list(a)]
    chords = _chords(outlines, one, turned=False)
    fits = []
    for shift in range(len(b)):
        # Run through the other way, atom k ends where it started before.
        atoms = np.roll(np.array(b[::-1] if turned else b), shift)
        starts = np.array([outlines.ahead[x] for x in atoms]) if turned else atoms
        off = np.abs(np.log(lengths / outlines.lengths[atoms]))
        away = np.abs(angles - outlines.angle[starts])
        if off.max() > share or away.max() > angle:
            continue
        turn = _chords(outlines, other, turned=turned)[atoms - outlines.base[other]] - chords
        misfit = float(1.0 - np.cos(turn) @ lengths / lengths.sum()) + float(off.max())
        fits.append(_Fit(dict(zip(a, atoms.tolist(), strict=True)), misfit))
    return fits


def _chords(outlines: Outlines, panel: int, *, turned: bool) -> FloatArray:
    """Angles [rad] of a panel's atoms from its grain, as seen from behind if ``turned``."""
    grain = outlines.panels[panel].grain
    along = float(np.arctan2(grain[1], grain[0]))
    chord = np.array([outlines.atoms[atom].chord for atom in outlines.whole(panel)]) - along
    return np.pi - chord if turned else chord
