"""Where a variant is worse than the first, where better, and whether that is beyond its errors."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from seatlook.chain.companions import differs
from seatlook.comparison.compare import Comparison
from seatlook.comparison.visibility import VariantScores
from seatlook.model.table import Table
from seatlook.model.zones import FREE_EDGE
from seatlook.visibility.observer import NULL_LIMIT


@dataclass(frozen=True, slots=True, kw_only=True)
class Change:
    """One figure of one place in a variant and in the first: more is worse.

    Parameters
    ----------
    place : a zone; or texture and rig
    weight : of the place among others: its area [m2], or 1
    beyond : whether the change is more than the errors of both; None where they are not known
    """

    variant: str
    place: str
    before: float
    after: float
    weight: float = 1.0
    beyond: bool | None = None

    @property
    def amount(self) -> float:
        """How much worse it is; below 0 better."""
        return self.after - self.before


def zone_changes(comparison: Comparison) -> tuple[Change, ...]:
    """Mean W2 of every zone of every variant but the first; free edges are left out.

    Zones with one name are compared. Which changes are beyond mesh error and scatter is known where
    both results carry them, as those of ``at_equal_error`` do.
    """
    return tuple(_zone_changes(comparison))


def _zone_changes(comparison: Comparison) -> Iterator[Change]:
    base = {row.zone: row for row in comparison.first.assessment.zones}
    for name, case in list(comparison.variants.items())[1:]:
        for row in case.assessment.zones:
            if row.zone in base and row.zone != FREE_EDGE:
                first = base[row.zone]
                yield Change(
                    variant=name,
                    place=row.zone,
                    before=first["w2_mean"],
                    after=row["w2_mean"],
                    weight=first.area,
                    beyond=differs(first, row),
                )


def sight_changes(scores: VariantScores) -> tuple[Change, ...]:
    """VWI of every picture of every variant but the first.

    A cover without wrinkles scores up to ``NULL_LIMIT``: less of a change is none.
    """
    first, *others = scores.variants
    return tuple(
        Change(
            variant=name,
            place=f"{texture} under {rig}",
            before=scores.vwi[first, texture, rig],
            after=value,
            beyond=abs(value - scores.vwi[first, texture, rig]) >= NULL_LIMIT,
        )
        for (name, texture, rig), value in scores.vwi.items()
        if name in others and (first, texture, rig) in scores.vwi
    )


def worse(changes: Iterable[Change]) -> tuple[Change, ...]:
    """Places that are worse and not within their errors, the largest change of all W2 first."""
    return _ranked(change for change in changes if change.amount > 0)


def better(changes: Iterable[Change]) -> tuple[Change, ...]:
    """Places that are better and not within their errors, the largest change of all W2 first."""
    return _ranked(change for change in changes if change.amount < 0)


def _ranked(changes: Iterable[Change]) -> tuple[Change, ...]:
    real = [change for change in changes if change.beyond is not False]
    return tuple(sorted(real, key=lambda change: -abs(change.amount) * change.weight))


def change_table(changes: Iterable[Change], head: str, first: str, *, errors: bool) -> Table:
    """Places with their figures before and after.

    Parameters
    ----------
    head : of the column of places
    first : name of the variant that the others are compared with
    errors : whether to say what is beyond mesh error and scatter
    """
    words = {True: "yes", False: "no", None: "not known"}
    further = ("beyond mesh error and scatter",) if errors else ()
    return Table(
        heads=(head, "variant", first, "now", "change", *further),
        rows=tuple(
            (
                c.place,
                c.variant,
                c.before,
                c.after,
                c.amount,
                *([words[c.beyond]] if errors else ()),
            )
            for c in changes
        ),
    )


def difference_tables(
    comparison: Comparison, zones: Iterable[Change], sights: Iterable[Change]
) -> dict[str, Table]:
    """Name -> table: worse and better zones, then worse and better pictures; empty ones as well."""
    first = comparison.baseline
    shape, look = tuple(zones), tuple(sights)
    return {
        f"{what}: {kind}": change_table(rank(changes), head, first, errors=errors)
        for kind, head, changes, errors in (
            ("mean W2 of zones", "zone", shape, True),
            ("VWI of pictures", "picture", look, False),
        )
        for what, rank in (("Worse", worse), ("Better", better))
    }
