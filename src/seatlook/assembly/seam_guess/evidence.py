"""What speaks for a pair of sides being sewn together, as log-likelihood ratios.

Every term is ``log p(seen | sewn) - log p(seen | any two sides)``, in nats; the sum over the terms
is the score of a pair, apart from what its neighbours in the sewn cover say (see ``sewing``). The
length decides how rare a partner is; how exactly partners agree, and how reliable notches are, is
learned from the pattern itself: the second round takes the rates of the seams of the first.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from seatlook.assembly.panel_names import hand
from seatlook.assembly.seam_guess.kin import Kin
from seatlook.assembly.seam_guess.notches import match_notches, notches_at_joints
from seatlook.assembly.seam_guess.outlines import Outlines, Side
from seatlook.model import FloatArray

LONGEST_EASE = 0.035  # of one edge on one edge
LONGEST_RUN_EASE = 0.006  # where atoms are merged: many sums come near by chance
_ATOMS_IN_PAIR = 5
_DART = 2.2  # nat; two edges that meet in a narrow notch of the outline are few
_HOLLOW = 0.4  # rad
_JOINT_NOTCH = 1.5  # nat, of a notch where the far side goes from one edge to the next
_KEPT = 16  # best partners of each side that are looked at further
_REFLEX = np.radians(240.0)  # inside angle at the tip of a dart
_SLIT = np.radians(353.5)  # and at that of an open slit
_NARROW = np.radians(340.0)  # and at that of most
_WEDGE = np.radians(150.0)  # widest corner of a piece that is set into a cut
_LONE_DART = 4.0  # nat; in a cover of several panels darts come in mirrored pairs
_BY_SHAPE = -3.0  # of edges that are equal by the symmetry of their panels
_PRIOR = -2.0
_NEAR_LENGTH = 0.25  # log; edges that are as long, for how rare a partner is
# Spread of the difference of sewn lengths: a part that is exact, of the length, and floor [m].
_SPREADS = ((0.0, 0.0001), (0.003, 0.0003), (0.015, 0.0005))


@dataclass(frozen=True, slots=True, kw_only=True)
class Rates:
    """What is learned from a pattern.

    Parameters
    ----------
    exact : (3,) shares of seams whose sides agree exactly, within a cutter's reach, with ease
    meets, misses : log-likelihood ratio of a notch that meets one, and of one that does not
    bare : the same of two sides without any notch
    """

    exact: tuple[float, float, float] = (0.5, 0.3, 0.2)
    meets: float = 0.9
    misses: float = -0.7
    bare: float = 0.0


@dataclass(frozen=True, slots=True)
class Pair:
    """Two sides that may be sewn, with their evidence.

    Parameters
    ----------
    a, b : the sides; ``b`` may run over several panels
    b_parts : the sides that ``b`` is made of
    score : sum of ``terms`` [nat]
    meeting, missing : numbers of notches that meet one, and that do not
    """

    a: Side
    b: tuple[Side, ...]
    terms: dict[str, float] = field(default_factory=dict)
    meeting: int = 0
    missing: int = 0

    @property
    def score(self) -> float:
        """Sum of the terms [nat]."""
        return sum(self.terms.values())

    @property
    def atoms(self) -> tuple[int, ...]:
        """All atoms of both sides."""
        return self.a.atoms + tuple(atom for side in self.b for atom in side.atoms)

    @property
    def panels(self) -> frozenset[int]:
        """Numbers of the panels of both sides."""
        return frozenset((self.a.panel, *(side.panel for side in self.b)))

    @property
    def is_dart(self) -> bool:
        """Whether one side goes over into the other, at the tip of a dart."""
        b = self.b[0]
        return len(self.b) == 1 and (self.a.end == b.first or b.end == self.a.first)

    @property
    def is_tube(self) -> bool:
        """Whether a panel is sewn to itself, but for a dart."""
        return len(self.panels) == 1 and not self.is_dart

    @property
    def b_first(self) -> int:
        """Stop at which the far side starts; it meets the end of the near side."""
        return self.b[0].first

    @property
    def b_end(self) -> int:
        """Stop at which the far side ends; it meets the start of the near side."""
        return self.b[-1].end

    @property
    def b_length(self) -> float:
        """Length of the far side [m]."""
        return sum(side.length for side in self.b)

    @property
    def difference(self) -> float:
        """Difference of the lengths [m]."""
        return abs(self.a.length - self.b_length)

    @property
    def class_(self) -> int:
        """0 exact, 1 within a cutter's reach, 2 eased."""
        mean = 0.5 * (self.a.length + self.b_length)
        limits = [2.5 * (share * mean + floor) for share, floor in _SPREADS[:2]]
        return int(np.searchsorted(limits, self.difference))


def find_pairs(outlines: Outlines, kin: Kin, rates: Rates) -> list[Pair]:
    """All pairs of sides that could be sewn, best first, the best few of each side."""
    background = Background(outlines)
    notched = any(p.notches for p in outlines.panels)
    pairs: list[Pair] = []
    for a, b in _candidates(outlines, kin):
        pairs.append(weigh(Pair(a, (b,)), outlines, kin, rates, background, notched=notched))
    return _pruned([p for p in pairs if p.score > -5.0])


def _pruned(pairs: Sequence[Pair]) -> list[Pair]:
    kept: list[Pair] = []
    seen: dict[tuple[int, ...], int] = {}
    for pair in sorted(pairs, key=lambda p: -p.score):
        keys = (pair.a.atoms, pair.b[0].atoms)
        if min(seen.get(k, 0) for k in keys) < _KEPT:
            kept.append(pair)
            for key in keys:
                seen[key] = seen.get(key, 0) + 1
    return kept


def _candidates(outlines: Outlines, kin: Kin) -> Iterator[tuple[Side, Side]]:
    sides = sorted(outlines.sides, key=lambda s: s.length)
    lengths = np.array([s.length for s in sides])
    for k, a in enumerate(sides):
        last = int(np.searchsorted(lengths, a.length * (1 + LONGEST_EASE), side="right"))
        for b in sides[k + 1 : last]:
            merged = len(a.atoms) + len(b.atoms) > 2
            if len(a.atoms) + len(b.atoms) > _ATOMS_IN_PAIR or (
                merged and b.length - a.length > LONGEST_RUN_EASE * a.length + 0.0005
            ):
                continue
            if kin.never(a.panel, b.panel) or set(a.atoms) & set(b.atoms):
                continue
            if a.panel == b.panel and not _may_close(outlines, a, b):
                continue
            yield (a, b) if a.first < b.first else (b, a)


def _may_close(outlines: Outlines, a: Side, b: Side) -> bool:
    """Whether two sides of one panel may be sewn: the legs of a dart, or apart from each other."""
    joints = [x for x, y in ((a.end, b.first), (b.end, a.first)) if x == y]
    return all(outlines.angle[joint] > _REFLEX for joint in joints)


class Background:
    """What any two sides of the pattern look like.

    Attributes
    ----------
    bend : [rad] half of all pairs of edges differ by more
    """

    def __init__(self, outlines: Outlines) -> None:
        self._log = np.log(outlines.lengths)
        bends = np.array([s.bend[-1] for s in outlines.atoms])
        spread = np.abs(bends[:, None] + bends)[np.triu_indices(len(bends), 1)]
        self.bend = float(max(np.quantile(spread, 0.5) if len(spread) else 0.0, 0.15))

    def density(self, length: float) -> float:
        """Edges per metre near a length."""
        near = np.abs(self._log - np.log(length)) < _NEAR_LENGTH
        return (0.5 + float(near.sum())) / (2 * _NEAR_LENGTH * length)


def weigh(
    pair: Pair,
    outlines: Outlines,
    kin: Kin,
    rates: Rates,
    background: Background,
    *,
    notched: bool,
) -> Pair:
    """Return the pair with its evidence."""
    a, b = pair.a, pair.b
    meeting, missing = match_notches(a, b)
    same = _same_kind(pair, kin)
    terms = {
        "prior": _PRIOR,
        "length": _length_term(pair, rates, background, same=same),
        "notches": _notch_term(meeting, missing, rates, same=same) if notched else 0.0,
        "bend": _bend_term(pair, background, same=same),
        "grain": _grain_term(pair, outlines),
        "names": _name_term(pair, outlines, same=same),
        "merged": _merge_term(pair),
        "panel": _panel_term(pair, outlines, kin, same=same),
        "joint notches": _JOINT_NOTCH * notches_at_joints(a, b),
    }  # fmt: skip
    return replace(pair, terms=terms, meeting=meeting, missing=missing)


def _same_kind(pair: Pair, kin: Kin) -> bool:
    """Whether the two sides are alike by the shape of their panels alone."""
    if len(pair.b) > 1 or _tips(pair):
        return False
    near = [kin.shape[atom] for atom in pair.a.atoms]
    far = [kin.shape[atom] for atom in pair.b[0].atoms]
    return near in (far, far[::-1])


def _tips(pair: Pair) -> set[int]:
    """Stops at which a side goes over into the one it is sewn to: the tip of a dart."""
    a, b = pair.a, pair.b[0]
    return {x for x, y in ((a.end, b.first), (b.end, a.first)) if x == y and len(pair.b) == 1}


def _panel_term(pair: Pair, outlines: Outlines, kin: Kin, *, same: bool) -> float:
    """Edges of one panel, and ends of panels of nearly one shape, are rarely sewn together."""
    far = pair.b[0]
    if len(pair.b) > 1:
        return 0.0
    if pair.a.panel == far.panel:
        if tips := _tips(pair):
            wide = max(float(_NARROW) - float(outlines.angle[list(tips)].min()), 0.0)
            # What takes out next to nothing is a slit; so is, most often, what has no twin.
            slit = float(outlines.angle[list(tips)].max()) > _SLIT
            alone = len(outlines.panels) > 1 and all(
                kin.mirror.get(a, a) in pair.atoms for a in pair.atoms
            )
            hole = _has_wedge(pair, outlines)
            return float(_DART - wide / np.radians(8.0) - 4.0 * (slit + hole) - _LONE_DART * alone)
        return -1.0 if same else -3.5
    both = zip(pair.a.atoms, far.atoms[::-1], strict=False)
    return -2.5 if any((min(x), max(x)) in kin.ends for x in both) else 0.0


def _has_wedge(pair: Pair, outlines: Outlines) -> bool:
    """Whether another panel has a corner between two edges as long as a dart's: a gusset for it."""
    near = np.abs(np.log(outlines.lengths / pair.a.length)) < LONGEST_RUN_EASE
    behind = {ahead: atom for atom, ahead in enumerate(outlines.ahead)}
    return any(
        near[behind[k]] and outlines.angle[k] < _WEDGE and outlines.panel_of[k] != pair.a.panel
        for k in np.flatnonzero(near).tolist()
    )


def _length_term(pair: Pair, rates: Rates, background: Background, *, same: bool) -> float:
    if pair.is_tube:
        return 0.5 * _BY_SHAPE  # opposite sides of a panel are often as long as each other
    if same:
        return _BY_SHAPE
    mean = 0.5 * (pair.a.length + pair.b_length)
    sewn = 0.0
    for weight, (share, floor) in zip(rates.exact, _SPREADS, strict=True):
        sigma = share * mean + floor
        sewn += (
            weight * np.exp(-0.5 * (pair.difference / sigma) ** 2) / (np.sqrt(2 * np.pi) * sigma)
        )
    return float(np.log(max(sewn, 1e-9) / background.density(mean)))


def _notch_term(meeting: int, missing: int, rates: Rates, *, same: bool) -> float:
    if meeting + missing == 0:
        return rates.bare
    gain = 0.0 if same else rates.meets * min(meeting, 3)
    return gain + max(rates.misses * missing, -4.5)


def _bend_term(pair: Pair, background: Background, *, same: bool) -> float:
    """Edges that lie on each other without a gap, or that mirror each other."""
    if same or len(pair.b) > 1:
        return 0.0
    near, far = pair.a.bend, pair.b[0].bend
    # Run through backwards, a curve bends the other way.
    if max(near[-1], far[-1]) < -_HOLLOW:
        return -2.0  # openings for arms and necks: both sides bend inward
    back = far[::-1] - far[-1]
    flat = _rms(near - back)
    mirrored = _rms(near + back)
    scale = background.bend
    narrow = 0.06 + 0.1 * max(_rms(near), _rms(far))
    gain = 0.0
    for weight, misfit in ((0.35, flat), (0.2, mirrored)):
        gain += (
            weight * (scale / narrow) * np.exp(-0.5 * (misfit / narrow) ** 2) / _wide(misfit, scale)
        )
    return float(np.clip(np.log(gain + 0.45), -0.8, 1.0))


def _wide(misfit: float, scale: float) -> float:
    return float(max(np.exp(-0.5 * (misfit / (1.5 * scale)) ** 2), 0.05))


def _rms(values: FloatArray) -> float:
    return float(np.sqrt((values**2).mean()))


def _grain_term(pair: Pair, outlines: Outlines) -> float:
    """Grain lines of the two panels, once one edge lies on the other."""
    turn = 0.0
    for side in pair.b:
        grain = [outlines.panels[s.panel].grain for s in (pair.a, side)]
        angle = [np.arctan2(g[1], g[0]) for g in grain]
        away = (angle[0] - pair.a.chord) - (angle[1] - side.chord) + np.pi
        turn += float(np.cos(away)) / len(pair.b)
    return 0.5 * turn


def _name_term(pair: Pair, outlines: Outlines, *, same: bool) -> float:
    """Left goes to left, but where two mirrored pieces meet in the middle."""
    hands = [hand(outlines.panels[s.panel].name) for s in (pair.a, *pair.b)]
    told = {h for h in hands if h}
    if len(told) == 2:
        return 0.0 if same or len(pair.b) > 1 else -2.5
    return 0.4 if len(told) == 1 and all(hands) else 0.0


def _merge_term(pair: Pair) -> float:
    """Corners inside a sewn edge are rarely there."""
    turns = np.concatenate([side.turns for side in (pair.a, *pair.b)])
    sides = len(pair.b) - 1
    return -float((1.0 + np.abs(turns) / np.radians(30.0)).sum()) - 1.0 * sides


def learn(chosen: Sequence[Pair], rest: Sequence[Pair], *, notched: bool) -> Rates:
    """Take the rates of the seams found; ``rest`` are the pairs that fit in length but were not."""
    count = np.array([4.0, 3.0, 3.0])
    for pair in chosen:
        count[pair.class_] += 1.0
    exact = tuple(float(x) for x in count / count.sum())
    if not notched:
        return Rates(exact=(exact[0], exact[1], exact[2]))
    seams = _notch_rates(chosen)
    others = _notch_rates([p for p in rest if p.class_ < 2])
    ratio = [float(np.log(s / o)) for s, o in zip(seams, others, strict=True)]
    return Rates(
        exact=(exact[0], exact[1], exact[2]),
        meets=float(np.clip(ratio[0], 0.3, 2.0)),
        misses=float(np.clip(ratio[1], -2.5, -0.1)),
        bare=float(np.clip(ratio[2], -2.5, 0.5)),
    )


def _notch_rates(pairs: Sequence[Pair]) -> tuple[float, float, float]:
    """Shares of notches that meet and that do not, and of pairs without one."""
    meeting = sum(2 * p.meeting for p in pairs) + 8.0
    missing = sum(p.missing for p in pairs) + 4.0
    bare = sum(1 for p in pairs if p.meeting + p.missing == 0) + 1.0
    total = meeting + missing
    return meeting / total, missing / total, bare / (len(pairs) + 3.0)
