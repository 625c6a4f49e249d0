"""The likeliest way to sew a pattern, and how sure each of its seams is.

Surest seams first, each with its mirror image where there is one; then exchanges: a pair is put in
for those it stands against, what became free is sewn again, and the better state stays. The states
that do not stay tell how sure a seam is: its probability is the share of the state found among
all states tried in which it is another way, each weighted by its likelihood.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable, Iterable, Sequence
from dataclasses import dataclass, field

import numpy as np

from seatlook.assembly.seam_guess.sewing import Sewing

TEMPERATURE = 1.6  # terms are not independent; fitted, see docs/measurements/pattern.md
WINNERS_CURSE = 2.0  # the state found is the likeliest of many; fitted likewise
_SWEEPS = 4
_BUDGET = 4000  # exchanges tried
_AHEAD = 2.5  # nat, that neighbours sewn later may bring a seam
_HOPE = 8.0  # nat, that sewing again what an exchange freed may bring
_FAR = 14.0  # the same where a seam is judged; states worse by more count nothing


@dataclass(slots=True)
class Doubt:
    """How much worse a cover is in which a seam is another way.

    Parameters
    ----------
    left_out : [nat] loss of leaving the seam away
    rivals : other pair -> loss of taking it instead
    alike : rivals that only symmetry tells from it
    """

    left_out: float = np.inf
    rivals: dict[int, float] = field(default_factory=dict)
    alike: set[int] = field(default_factory=set)

    def probability(self, slack: float = 0.0) -> float:
        """Probability of the seam; rivals that are alike by symmetry are not against it.

        ``slack`` [nat] is taken off every loss.
        """
        losses = [self.left_out, *(v for k, v in self.rivals.items() if k not in self.alike)]
        odds = sum(np.exp(-max(x - slack, -30.0) / TEMPERATURE) for x in losses)
        return float(1.0 / (1.0 + WINNERS_CURSE * odds))


class Search:
    """Sews a ``Sewing`` and judges its seams.

    Parameters
    ----------
    kinds : per pair, what symmetry leaves of it
    """

    def __init__(self, sewing: Sewing, kinds: Sequence[Hashable]) -> None:
        self._sewing = sewing
        self._kinds = kinds
        self._with: dict[int, list[int]] = {}
        for number, atoms in enumerate(sewing.atoms):
            for atom in atoms:
                self._with.setdefault(atom, []).append(number)
        self._near: dict[int, set[int]] = {}
        for number, pair in enumerate(sewing.pairs):
            for stop in (pair.a.first, pair.a.end, pair.b_first, pair.b_end):
                self._near.setdefault(stop, set()).add(number)
        self._tried = 0

    def run(self, *, thorough: bool = True) -> None:
        """Sew all that is likelier sewn than not."""
        self._greedy()
        for _ in range(_SWEEPS if thorough else 0):
            if not (self._exchange() | self._sew_panels_anew()):
                break

    def _sew_panels_anew(self) -> bool:
        """Take a panel and its twin out, sew them again; whether any made the cover likelier."""
        sewing = self._sewing
        of: dict[int, set[int]] = {}
        for number in sewing.sewn:
            for panel in sewing.pairs[number].panels:
                of.setdefault(panel, set()).add(number)
        better = False
        for panel in sorted(of):
            home, score = frozenset(sewing.sewn), sewing.score
            taken = of[panel] & home
            taken |= {sewing.mirrored[n] for n in taken} & home
            self._drop(sorted(taken))
            atoms = {atom for n in taken for atom in sewing.atoms[n]}
            self._greedy({n for atom in atoms for n in self._with[atom]})
            if sewing.score > score + 1e-6:
                better = True
            else:
                self._restore(home, score)
        return better

    def doubts(self) -> dict[int, Doubt]:
        """Judge each seam by the states that are next to the one found."""
        best, home = self._sewing.score, frozenset(self._sewing.sewn)
        doubts = {number: Doubt() for number in home}
        for number in sorted(home):
            self._drop(self._group(number))
            if number not in self._sewing.sewn:
                self._note(doubts, home, best, None)
            self._restore(home, best)
            for rival in self._rivals(number):
                for group in self._ways(rival):
                    if self._put_in(group, _FAR):
                        self._note(doubts, home, best, rival)
                    self._restore(home, best)
        return doubts

    def _note(
        self, doubts: dict[int, Doubt], home: frozenset[int], best: float, rival: int | None
    ) -> None:
        """Put a state down against the seams it lacks."""
        sewing, kinds = self._sewing, self._kinds
        loss = best - sewing.score
        lost, gained = home - sewing.sewn, sewing.sewn - home
        # Seams of the same kinds make the same cover, with some panels in each other's place.
        same = Counter(kinds[n] for n in lost) == Counter(kinds[n] for n in gained)
        for number in lost:
            doubt = doubts[number]
            own = set(sewing.atoms[number])
            against = [r for r in gained if own & set(sewing.atoms[r])]
            if not against and not same:
                doubt.left_out = min(doubt.left_out, loss)
            for other in against:
                doubt.rivals[other] = min(doubt.rivals.get(other, np.inf), loss)
                if same or kinds[other] == kinds[number]:
                    doubt.alike.add(other)

    def _greedy(self, numbers: Iterable[int] | None = None) -> None:
        """Sew the surest pair again and again, of all or of some."""
        sewing = self._sewing
        sewing.unfinished = True
        self._sew_surest(range(len(sewing.pairs)) if numbers is None else numbers)
        sewing.unfinished = False
        # What no neighbour came to support goes again.
        weak = True
        while weak:
            losses = {n: self._loss(n) for n in sorted(sewing.sewn)}
            weak = False
            for number in sorted(losses, key=lambda n: losses[n]):
                if losses[number] < 0 and self._loss(number) < 0:
                    sewing.undo(number)
                    weak = True

    def _loss(self, number: int) -> float:
        """What leaving a seam out would cost."""
        score = self._sewing.score
        self._sewing.undo(number)
        loss = score - self._sewing.score
        self._sewing.sew(number)
        self._sewing.score = score
        return loss

    def _sew_surest(self, numbers: Iterable[int]) -> None:
        sewing = self._sewing
        gains = {n: sewing.gain(n) for n in numbers if sewing.free(n)}
        while gains:
            best, margin = -1, -np.inf
            for number, gain in gains.items():
                if gain <= -_AHEAD:
                    continue
                rival = max((gains[r] for r in self._rivals(number) if r in gains), default=0.0)
                # A lead over the rivals counts, and so does the evidence itself.
                sure = min(gain - max(rival, 0.0), 4.0) + 0.1 * gain
                if sure > margin:
                    best, margin = number, sure
            if best < 0:
                return
            self._sew_and_update(best, gains)
            other = sewing.mirrored[best]
            if other >= 0 and other in gains and sewing.gain(other) > 0:
                self._sew_and_update(other, gains)

    def _sew_and_update(self, number: int, gains: dict[int, float]) -> None:
        sewing = self._sewing
        sewing.sew(number)
        for atom in sewing.atoms[number]:
            for other in self._with[atom]:
                gains.pop(other, None)
        for other in self._touching(number):
            if other in gains:
                gains[other] = sewing.gain(other)

    def _touching(self, number: int) -> set[int]:
        """Pairs that end at the points at which a pair ends, and its mirror image."""
        sewing = self._sewing
        pair = sewing.pairs[number]
        stops = {
            s
            for end in (pair.a.first, pair.a.end, pair.b_first, pair.b_end)
            for s in sewing.point(end)[0]
        }
        return set().union(*(self._near.get(s, set()) for s in stops)) | {sewing.mirrored[number]}

    def _rivals(self, number: int) -> list[int]:
        """Pairs that share an atom with one, best evidence first."""
        sewing = self._sewing
        others = {r for atom in sewing.atoms[number] for r in self._with[atom]} - {number}
        return sorted(others, key=lambda r: -sewing.pairs[r].score)

    def _group(self, number: int) -> tuple[int, ...]:
        other = self._sewing.mirrored[number]
        return (number,) if other in (-1, number) else (number, other)

    def _ways(self, number: int) -> list[tuple[int, ...]]:
        """Ways to put a pair in: alone, and with its mirror image."""
        group = self._group(number)
        if len(group) == 1:
            return [group]
        one, other = (set(self._sewing.atoms[n]) for n in group)
        return [(number,)] if one & other else [group, (number,)]

    def _drop(self, group: Sequence[int]) -> None:
        for number in group:
            if number in self._sewing.sewn:
                self._sewing.undo(number)

    def _put_in(self, group: Sequence[int], hope: float) -> bool:
        """Put pairs in for those they stand against and sew again what became free.

        Given up where the score falls by more than ``hope`` before that.
        """
        sewing = self._sewing
        group = [n for n in group if n not in sewing.sewn]
        if not group:
            return False
        before = sewing.score
        freed: set[int] = set()
        touched: set[int] = set()
        for number in group:
            for blocker in sewing.blockers(number):
                if blocker in group:
                    return False
                freed.update(sewing.atoms[blocker])
                sewing.undo(blocker)
            sewing.sew(number)
            touched |= self._touching(number)
        if sewing.score < before - hope:
            return False
        self._mend(touched | {n for atom in freed for n in self._with[atom]})
        return True

    def _mend(self, numbers: set[int]) -> None:
        """Sew of some pairs those that are free, best first."""
        sewing = self._sewing
        while True:
            options = {n for n in numbers if n >= 0 and sewing.free(n)}
            gains = {n: sewing.gain(n) for n in options}
            best = max(gains, key=lambda n: gains[n], default=-1)
            if best < 0 or gains[best] <= 0:
                return
            sewing.sew(best)
            numbers |= self._touching(best)

    def _restore(self, home: frozenset[int], score: float) -> None:
        sewing = self._sewing
        for number in sewing.sewn - home:
            sewing.undo(number)
        for number in home - sewing.sewn:
            sewing.sew(number)
        sewing.score = score

    def _exchange(self) -> bool:
        """Try each pair for those it stands against; whether any made the cover likelier."""
        sewing = self._sewing
        better = False
        for number in range(len(sewing.pairs)):
            if number in sewing.sewn or self._tried > _BUDGET:
                continue
            for group in self._ways(number):
                self._tried += 1
                home, score = frozenset(sewing.sewn), sewing.score
                if self._put_in(group, _HOPE) and sewing.score > score + 1e-6:
                    better = True
                    break
                self._restore(home, score)
        for number in sorted(sewing.sewn):
            home, score = frozenset(sewing.sewn), sewing.score
            if number not in home:
                continue
            self._drop(self._group(number))
            if sewing.score > score + 1e-6:
                better = True
            else:
                self._restore(home, score)
        return better
