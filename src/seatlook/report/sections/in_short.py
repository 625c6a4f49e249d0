"""The first sentences of a page: what shows, what to do about it, what is accepted."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import groupby

from seatlook.chain.assess import Assessment
from seatlook.model.table import number
from seatlook.report.page.types import Check, ScoreSection, SeenPlace
from seatlook.report.sections.words import (
    counted,
    light_words,
    listed,
    look_words,
    panel_words,
    wrinkle_words,
    zone_words,
)
from seatlook.results.resolution import Resolution, Status
from seatlook.visibility.places import SHOWS
from seatlook.wrinkle import Wrinkle, advice_on

WORDS: Mapping[Status, str] = {
    "resolved": "resolved",
    "converged, not resolved": "unresolved",
    "not converged": "unconverged",
}


def first_lines(
    assessment: Assessment, score: ScoreSection | None, checks: Sequence[Check]
) -> tuple[str, ...]:
    """Say what shows where, what to do about it, which limits are kept, and what not to trust."""
    return (
        *(_shown(assessment, score) if score and score.places is not None else ()),
        *(_unscored(assessment, score) if not score or score.places is None else ()),
        *_correction(assessment, score),
        *accepted(checks),
        *_doubt(assessment.resolution),
    )


def _shown(assessment: Assessment, score: ScoreSection) -> Iterator[str]:
    """The answer where the wrinkles were scored."""
    seen = [place for place in score.places or () if place.shows]
    if not seen:
        yield "No wrinkle shows in any colour under any light of this page."
        yield from _broad(score)
        hidden = len(_ranked(assessment))
        if hidden:
            yield f"{_capital(counted(hidden, 'wrinkle'))} cannot be seen from here."
        return
    first = seen[0]
    where = place_words(assessment, first)
    many = (
        f"One wrinkle shows: {where}"
        if len(seen) == 1
        else f"Wrinkles show in {counted(len(seen), 'place')}, most of all {where}"
    )
    degree = "most" if len(seen) == 1 else "plainest"
    most = f"{degree} in {look_words(first.texture)} under {light_words(first.rig)}"
    yield f"{many}, {most}; {_hiding(seen)}."


def _broad(score: ScoreSection) -> Iterator[str]:
    """What the score sees where there is no valley."""
    texture, rig = max(score.cells, key=lambda cell: score.cells[cell], default=("", ""))
    vwi = score.cells.get((texture, rig), 0.0)
    if vwi >= SHOWS:
        where = f"most in {look_words(texture)} under {light_words(rig)}"
        yield f"Broad waves, flatter than a radius of 1 m, score VWI {number(vwi)}, {where}."


def _hiding(seen: Sequence[SeenPlace]) -> str:
    """Which look hides all places."""
    looks = [name for name in seen[0].hidden_by if all(name in place.hidden_by for place in seen)]
    what = "it" if len(seen) == 1 else "them all"
    if not looks:
        return f"no colour here hides {what}"
    verb = "hides" if len(looks) == 1 else "hide"
    return f"{listed(map(look_words, looks))} {verb} {what}"


def place_words(assessment: Assessment, place: SeenPlace) -> str:
    """Where a place is, in words."""
    panels = panel_words(assessment.solution)
    if place.rank is None:
        return zone_words(place.zone, panels)
    return wrinkle_words(assessment.wrinkles[place.rank - 1], panels)


def _unscored(assessment: Assessment, score: ScoreSection | None) -> Iterator[str]:
    """The answer by shape alone."""
    why = "it was not scored" if not score or not score.refused else "the score was refused"
    wrinkles = _ranked(assessment)
    if not wrinkles:
        yield f"No valley is as sharp as a wrinkle; whether flatter waves show is not known: {why}."
        return
    where = wrinkle_words(wrinkles[0], panel_words(assessment.solution))
    many = counted(len(wrinkles), "wrinkle")
    first = f"{_capital(many)}{', the worst' if len(wrinkles) > 1 else ':'} {where}"
    yield f"{first}; whether that shows is not known: {why}."


def _correction(assessment: Assessment, score: ScoreSection | None) -> Iterator[str]:
    """What to change at the place that shows most; without one, the largest correction."""
    shown = [place for place in (score and score.places) or () if place.shows]
    known = assessment.advice
    rank = next((place.rank for place in shown if place.rank), None)
    best = next((a for a in known if rank in a.wrinkles), next(iter(known), None))
    if best is not None:
        # Right below "no wrinkle shows", a correction alone would read as a contradiction.
        seen = (
            max(score.cells.values(), default=0.0) if score and score.places is not None else SHOWS
        )
        although = "" if shown or seen >= SHOWS else "to be corrected although it does not show: "
        yield f"{_capital(although + best.sentence)} (confidence: {best.confidence})."
    elif rank:
        why = advice_on(assessment.wrinkles[rank - 1], rank, known).removeprefix("none: ")
        yield f"No correction: {why}."


def _ranked(assessment: Assessment) -> list[Wrinkle]:
    """The wrinkles that are some, without what lies at ties and corners."""
    return [wrinkle for wrinkle in assessment.wrinkles if wrinkle.kind == "wrinkle"]


def state_lines(assessment: Assessment, asked: Mapping[str, str], source: str) -> tuple[str, ...]:
    """Say of a state of another program's result where it wrinkles, how much and by what measure.

    Parameters
    ----------
    asked : mode, threshold and strain measure of the indices, by their names
    source : what the curvature is from
    """
    wrinkles, largest = _ranked(assessment), float(assessment.indices.w2.max(initial=0.0))
    if wrinkles:
        where = wrinkle_words(wrinkles[0], panel_words(assessment.solution))
        worst = f"the worst {where}" if len(wrinkles) > 1 else where
        first = f"{_capital(counted(len(wrinkles), 'wrinkle'))} in this state, {worst}: "
        first += f"W2 up to {number(largest)}."
    else:
        first = (
            f"No valley in this state is as sharp as a wrinkle: W2 is at most {number(largest)}."
        )
    zones = [row for row in assessment.zones if row["w2_mean"] > 0]
    weight = sum(row["w2_mean"] * row.area for row in zones)
    stretch = sum(row["w2_mean"] * row.area * row.stretch_share for row in zones)
    cause = (
        f"; stretch makes {number(round(100 * stretch / weight))} % of W2, excess fabric the rest"
        if weight
        else ""
    )
    share = number(100 * assessment.share_above_one)
    measure = ", ".join(f"{key} {value}" for key, value in asked.items())
    return (
        first,
        f"W2 is above 1 on {share} % of the area{cause}.",
        f"Indices: {measure}, curvature from {source}. How visible that is was not scored.",
    )


def accepted(checks: Sequence[Check]) -> Iterator[str]:
    """Zones and classes with a limit of [accept], each accepted or rejected, and by what."""
    verdicts = []
    for zone, group in groupby(checks, key=lambda check: check.name.partition(": ")[0]):
        missed = [
            f"{check.name.partition(': ')[2]} {check.value}, at most {check.limit}"
            for check in group
            if not check.kept
        ]
        verdicts.append(f"{zone} rejected ({'; '.join(missed)})" if missed else f"{zone} accepted")
    if verdicts:
        yield f"{_capital('; '.join(verdicts))}."
    else:
        yield "Nothing is accepted or rejected: the scene sets no limit."


def _doubt(found: Resolution) -> Iterator[str]:
    if found.balance:
        yield "Do not rely on this: the cover did not come to rest."
    elif not found.resolved:
        yield f"Do not build on this yet: {found.coarseness[0]}."


def _capital(text: str) -> str:
    return text[:1].upper() + text[1:]
