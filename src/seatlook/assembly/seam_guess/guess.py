"""From panels to guessed seams: evidence, search, and what is left for the user."""

from __future__ import annotations

from dataclasses import dataclass

from seatlook.assembly.seam_guess.chains import sew_chains
from seatlook.assembly.seam_guess.evidence import Pair, Rates, find_pairs, learn
from seatlook.assembly.seam_guess.gathers import maybe_gathered
from seatlook.assembly.seam_guess.kin import Kin
from seatlook.assembly.seam_guess.outlines import Outlines
from seatlook.assembly.seam_guess.search import Doubt, Search
from seatlook.assembly.seam_guess.sewing import Sewing

_NEAR = 6.0  # nat; rivals that lose more are not worth a word
_APART = 2.0  # nat off all seams but darts if panels stay apart: some seams do not fit in length
_GATHERED = 0.5  # probability at most, of one whose sides may be gathered to a third panel
_ROUNDS = 4  # in which seams and their neighbours agree on how sure they are
_TIE = 0.5  # nat; alike by symmetry and as likely


@dataclass(frozen=True, slots=True)
class Verdict:
    """A seam found: its pair, how sure it is, and what else would do, best first.

    Parameters
    ----------
    alike : rivals that only symmetry tells from it
    ends : how many of its ends lie at other seams
    mirrored : whether its mirror image is sewn as well
    """

    pair: Pair
    probability: float
    rivals: tuple[Pair, ...]
    alike: tuple[Pair, ...]
    ends: int
    mirrored: bool


def judge(outlines: Outlines, kin: Kin) -> list[Verdict]:
    """Find the likeliest seams and judge each."""
    if not len(outlines):
        return []
    notched = any(p.notches for p in outlines.panels)
    rates = Rates()
    for last in (False, True):
        pairs = find_pairs(outlines, kin, rates)
        sewing = Sewing(outlines, pairs, _mirrored(pairs, kin))
        Search(sewing, [_kind(p, kin) for p in pairs]).run(thorough=last)
        used = rates
        chosen = [pairs[n] for n in sorted(sewing.sewn)]
        rest = [p for n, p in enumerate(pairs) if n not in sewing.sewn]
        rates = learn(chosen, rest, notched=notched)
    leads = sew_chains(sewing, outlines, kin, used)
    doubts = Search(sewing, [_kind(p, kin) for p in sewing.pairs]).doubts()
    for number, lead in leads.items():
        doubts[number].left_out = min(doubts[number].left_out, lead)
    sure = _probabilities(sewing, doubts, maybe_gathered(sewing, outlines))
    return [_verdict(sewing, number, doubt, sure[number]) for number, doubt in doubts.items()]


def _probabilities(
    sewing: Sewing, doubts: dict[int, Doubt], gathered: set[int]
) -> dict[int, float]:
    """Probabilities of the seams; what neighbours say counts as far as they are sure themselves."""
    apart = _APART if len(set(sewing.pieces)) > 1 else 0.0
    support = {number: sewing.support(number) for number in doubts}
    sure = dict.fromkeys(doubts, 1.0)
    for _ in range(_ROUNDS):
        slack = {
            number: sum(
                worth * (1.0 - min((sure[n] for n in others), default=1.0))
                for worth, others in support[number]
            )
            for number in doubts
        }
        sure = {
            number: min(
                doubt.probability(slack[number] + apart * (not sewing.pairs[number].is_dart)),
                _GATHERED if number in gathered else 1.0,
            )
            for number, doubt in doubts.items()
        }
    return sure


def _verdict(sewing: Sewing, number: int, doubt: Doubt, probability: float) -> Verdict:
    pairs, alike = sewing.pairs, doubt.alike
    order = sorted(doubt.rivals, key=lambda r: doubt.rivals[r])
    pair = pairs[number]
    met = [sewing.point(stop)[0] for stop in (pair.a.first, pair.a.end)]
    return Verdict(
        pair=pair,
        probability=probability,
        rivals=tuple(pairs[r] for r in order if r not in alike and doubt.rivals[r] < _NEAR)[:4],
        alike=tuple(pairs[r] for r in order if r in alike and doubt.rivals[r] < _TIE)[:4],
        ends=sum(1 for stops in met if len(stops) > 2),
        mirrored=sewing.mirrored[number] in sewing.sewn,
    )


def _kind(pair: Pair, kin: Kin) -> tuple[tuple[int, ...], ...]:
    near = tuple(kin.kind[a] for a in pair.a.atoms)
    far = tuple(kin.kind[a] for side in pair.b for a in side.atoms)
    return tuple(sorted((min(near, near[::-1]), min(far, far[::-1]))))


def _mirrored(pairs: list[Pair], kin: Kin) -> list[int]:
    """Per pair the number of its mirror image, -1 where there is none."""
    numbers = {_atoms(p): n for n, p in enumerate(pairs)}
    found = []
    for pair in pairs:
        sides = [s.atoms for s in (pair.a, *pair.b)]
        if not all(atom in kin.mirror for atoms in sides for atom in atoms):
            found.append(-1)
            continue
        images = frozenset(frozenset(kin.mirror[a] for a in atoms) for atoms in sides)
        found.append(numbers.get(images, -1))
    return found


def _atoms(pair: Pair) -> frozenset[frozenset[int]]:
    return frozenset(frozenset(s.atoms) for s in (pair.a, *pair.b))
