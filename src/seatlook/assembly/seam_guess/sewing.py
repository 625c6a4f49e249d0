"""The sewn cover while it is put together: which stops meet, and how likely that is.

Sewing the near side from stop a0 to a1 to the far side from b0 to b1 lets a0 meet b1 and b0 meet
a1. ``next`` of a stop is the stop met across the seam that starts there; going on from it round a
point of the cover ends at the border of the cover or comes back. So the sewn panels are a surface
always; whether it is a believable one, the angles round each point say.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence

import numpy as np

from seatlook.assembly.seam_guess.evidence import Pair
from seatlook.assembly.seam_guess.outlines import Outlines

_MIRRORED = 1.0  # nat, of a seam whose mirror image is sewn too
_CLOSED = -8.0  # of panels without any border left
_LONE = -1.0  # and of one whose mirror image cannot be
_CLOSES = 3.5  # of a strip whose ends meet already and are sewn to each other
_SADDLE = 480.0  # deg
_ALL_ROUND = np.radians(75.0)  # of the angles round that point, from a full turn
_LOOSE = -2.0  # of a panel that is sewn to nothing


def inner_point(angle: float, count: int) -> float:
    """Log-likelihood ratio of a point inside the cover, by the sum of the angles [rad] round it.

    360 degrees where the cover is smooth, 270 at the corner of a box, 180 at that of a pillow.
    """
    degrees = np.degrees(angle)
    sewn = (
        0.60 * _normal(degrees, 360.0, 14.0)
        + 0.25 * _normal(degrees, 320.0, 45.0)
        + 0.04 * _normal(degrees, 180.0, 25.0)
        + _floor(degrees)
    )
    chance = _normal(degrees, 330.0, 130.0) + 0.02 / 720.0
    # That three and more seams agree is rare by chance.
    crowd = -0.8 * max(count - 4, 0) + (0.8 if count > 2 else 0.0)
    # A single corner folded onto itself is a dart if it is one already in the flat.
    alone = -4.0 if count == 1 and degrees < 200.0 else 0.0
    # Two corners on each other make a pocket: a pillow's, but more often a hem sewn shut.
    pocket = -1.5 if count == 2 and degrees < 250.0 else 0.0
    return float(np.log(sewn / chance)) + crowd + alone + pocket


def border_point(angle: float, count: int) -> float:
    """The same of a point on the border at which seams end."""
    if count < 2:
        return 0.0
    degrees = np.degrees(angle)
    sewn = 0.6 * _normal(degrees, 180.0, 15.0) + 0.4 * _normal(degrees, 180.0, 60.0)
    chance = _normal(degrees, 220.0, 90.0) + 0.02 / 720.0
    return float(np.clip(np.log((sewn + _floor(degrees)) / chance), -8.0, 0.4))


def _floor(degrees: float) -> float:
    """Density of angles that are hardly ever sewn; more than a saddle has is none at all."""
    return 1e-8 if degrees > _SADDLE else 2e-6


def _normal(x: float, mean: float, sigma: float) -> float:
    return float(np.exp(-0.5 * ((x - mean) / sigma) ** 2) / (np.sqrt(2 * np.pi) * sigma))


class Sewing:
    """Stops that meet, pairs that are sewn, and the log-likelihood of the whole.

    Parameters
    ----------
    outlines : the panels
    pairs : all that could be sewn
    mirrored : per pair, the pair that mirrors it (its own number if it mirrors itself, -1 if none)
    """

    def __init__(self, outlines: Outlines, pairs: Sequence[Pair], mirrored: Sequence[int]) -> None:
        angle = outlines.angle.tolist()
        self._outlines = outlines
        self._angle = angle
        self.pairs = list(pairs)
        self.mirrored = list(mirrored)
        self.atoms = [pair.atoms for pair in self.pairs]
        self._scores = [pair.score for pair in self.pairs]
        self._panels = [pair.panels for pair in self.pairs]
        self._tubes = [pair.is_tube for pair in self.pairs]
        self._stops = [(p.a.first, p.a.end, p.b_first, p.b_end) for p in self.pairs]
        self._panel_of = outlines.panel_of
        self._left = [len(stops) for stops in outlines.stops]  # free atoms of each panel
        self._joined = [0] * len(outlines.stops)  # seams of each panel with others
        self._involved = _involved(self.pairs, self.mirrored)
        self.next = [-1] * len(angle)
        self._previous = [-1] * len(angle)
        self.owner = [-1] * len(angle)  # of an atom: the pair that holds it
        self.sewn: set[int] = set()
        self.score = 0.0
        self._unfinished = False
        self._known: dict[tuple[int, ...], float] = {}

    def add(self, pair: Pair) -> int:
        """Take a further pair in; its number."""
        self.pairs.append(pair)
        self.mirrored.append(-1)
        self.atoms.append(pair.atoms)
        self._scores.append(pair.score)
        self._panels.append(pair.panels)
        self._tubes.append(pair.is_tube)
        self._stops.append((pair.a.first, pair.a.end, pair.b_first, pair.b_end))
        self._involved.append(set())
        return len(self.pairs) - 1

    @property
    def unfinished(self) -> bool:
        """Whether points on the border may still be closed, so that none counts against a seam."""
        return self._unfinished

    @unfinished.setter
    def unfinished(self, value: bool) -> None:
        stops = [s for n in self.sewn for s in self._stops[n]]
        self.score -= self._at(stops)
        self._unfinished = value
        self.score += self._at(stops)

    @property
    def pieces(self) -> list[int]:
        """Per panel, the number of the piece it belongs to, sewn as far as it is."""
        above = list(range(len(self._left)))

        def top(panel: int) -> int:
            while above[panel] != panel:
                panel = above[panel]
            return panel

        for number in self.sewn:
            first, *others = self._panels[number]
            for other in others:
                above[top(other)] = top(first)
        return [top(panel) for panel in range(len(above))]

    def free(self, number: int) -> bool:
        """Whether none of a pair's atoms is sewn."""
        owner = self.owner
        return all(owner[atom] < 0 for atom in self.atoms[number])

    def blockers(self, number: int) -> set[int]:
        """Pairs that hold the atoms of one."""
        return {self.owner[atom] for atom in self.atoms[number] if self.owner[atom] >= 0}

    def point(self, stop: int) -> tuple[tuple[int, ...], bool]:
        """All stops that meet at one point of the cover in order round it; whether it is inside."""
        around = [stop]
        ahead = self.next[stop]
        while ahead >= 0 and ahead != stop:
            around.append(ahead)
            ahead = self.next[ahead]
        if ahead == stop:
            return tuple(around), True
        behind = self._previous[stop]
        while behind >= 0:
            around.append(behind)
            behind = self._previous[behind]
        return tuple(around), False

    def support(self, number: int) -> list[tuple[float, set[int]]]:
        """What speaks for a sewn pair at its two ends [nat], and the other seams that say so."""
        found = []
        for stop in {self._stops[number][0], self._stops[number][1]}:
            stops, _ = self.point(stop)
            others = {self.owner[s] for s in stops if self.owner[s] >= 0} - {number}
            found.append((max(self._at([stop]), 0.0), others))
        return found

    def gain(self, number: int) -> float:
        """Change of the score if a pair of free atoms is sewn."""
        before = self._around(number)
        self._link(number)
        after = self._around(number)
        self._unlink(number)
        return after - before + self._scores[number]

    def sew(self, number: int) -> None:
        """Sew a pair whose atoms are free."""
        self.score -= self._around(number)
        self._link(number)
        self.score += self._around(number) + self._scores[number]

    def undo(self, number: int) -> None:
        """Take a pair apart."""
        self.score -= self._around(number) + self._scores[number]
        self._unlink(number)
        self.score += self._around(number)

    def _around(self, number: int) -> float:
        """What depends on a pair beside its own evidence."""
        return (
            self._at(self._stops[number])
            + self._symmetry(number)
            + self._closed(number)
            + self._loose(number)
        )

    def _link(self, number: int) -> None:
        a0, a1, b0, b1 = self._stops[number]
        self.next[a0], self.next[b0] = b1, a1
        self._previous[b1], self._previous[a1] = a0, b0
        for atom in self.atoms[number]:
            self.owner[atom] = number
            self._left[self._panel_of[atom]] -= 1
        self._count(number, 1)
        self.sewn.add(number)

    def _unlink(self, number: int) -> None:
        a0, a1, b0, b1 = self._stops[number]
        self.next[a0] = self.next[b0] = -1
        self._previous[b1] = self._previous[a1] = -1
        for atom in self.atoms[number]:
            self.owner[atom] = -1
            self._left[self._panel_of[atom]] += 1
        self._count(number, -1)
        self.sewn.remove(number)

    def _count(self, number: int, step: int) -> None:
        """Count a seam between panels at each of them."""
        panels = self._panels[number]
        if len(panels) > 1:
            for panel in panels:
                self._joined[panel] += step

    def _at(self, stops: Iterable[int]) -> float:
        """Sum over the points at some stops."""
        total = 0.0
        done: set[int] = set()
        for stop in stops:
            if stop not in done:
                point, inside = self.point(stop)
                done.update(point)
                if inside or len(point) > 1:
                    total += self._worth(point, inside=inside)
                if inside and self._closes(point):
                    total += _CLOSES
        return total

    def _closes(self, stops: tuple[int, ...]) -> bool:
        """Whether a strip is sewn to itself at a point at which its ends met without that."""
        if len(stops) < 3 or not any(self._tubes[self.owner[s]] for s in stops):
            return False
        return bool(abs(sum(self._angle[s] for s in stops) - 2 * np.pi) < _ALL_ROUND)

    def _loose(self, number: int) -> float:
        """Panels of a pair that no seam joins to another panel."""
        if len(self._joined) < 3:
            return 0.0  # of two panels any seam would do
        return _LOOSE * sum(1 for panel in self._panels[number] if not self._joined[panel])

    def _worth(self, stops: tuple[int, ...], *, inside: bool) -> float:
        key = (inside, *sorted(stops))
        worth = self._known.get(key)
        if worth is None:
            angle = sum(self._angle[s] for s in stops)
            worth = (inner_point if inside else border_point)(angle, len(stops))
            self._known[key] = worth
        return max(worth, 0.0) if self._unfinished and not inside else worth

    def _closed(self, number: int) -> float:
        """A cover without any border has no way in; said of the panels of a pair."""
        waiting = set(self._panels[number])
        if any(self._left[panel] for panel in waiting):
            return 0.0
        done: set[int] = set()
        while waiting:
            panel = waiting.pop()
            done.add(panel)
            if self._left[panel]:
                return 0.0
            for atom in self._outlines.whole(panel):
                waiting |= self._panels[self.owner[atom]] - done
        return _CLOSED

    def _symmetry(self, number: int) -> float:
        """What mirror images say of a pair and of those it stands in the way of."""
        involved = self._involved[number]
        if not involved:
            return 0.0
        return sum(self._mirror_worth(other) for other in involved & self.sewn)

    def _mirror_worth(self, number: int) -> float:
        other = self.mirrored[number]
        if other == number:
            return 0.5 * _MIRRORED
        if other in self.sewn:
            return _MIRRORED
        image = self.atoms[other]
        return _LONE if any(self.owner[atom] >= 0 for atom in image) else 0.0


def _involved(pairs: Sequence[Pair], mirrored: Sequence[int]) -> list[set[int]]:
    """Per pair, itself, its mirror image and the pairs whose images share an atom with it."""
    holding: dict[int, set[int]] = {}
    for number, other in enumerate(mirrored):
        if other >= 0:
            for atom in pairs[other].atoms:
                holding.setdefault(atom, set()).add(number)
    return [set().union(*(holding.get(atom, set()) for atom in pair.atoms)) for pair in pairs]
