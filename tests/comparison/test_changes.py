"""What counts as worse, as better, and in which order."""

from __future__ import annotations

from types import MappingProxyType

from seatlook.comparison.changes import Change, better, change_table, sight_changes, worse
from seatlook.comparison.visibility import VariantScores


def change(place, amount, *, weight=1.0, beyond=None):
    return Change(
        variant="b", place=place, before=1.0, after=1.0 + amount, weight=weight, beyond=beyond
    )


CHANGES = (
    change("small", 0.9, weight=0.1),
    change("large", 0.2, weight=1.0),
    change("noise", 5.0, beyond=False),
    change("gain", -0.5, beyond=True),
    change("same", 0.0),
)


def test_worse_and_better_are_apart_and_the_largest_area_times_change_is_first():
    assert [c.place for c in worse(CHANGES)] == ["large", "small"]
    assert [c.place for c in better(CHANGES)] == ["gain"]


def test_what_is_within_its_errors_is_neither():
    assert all(c.place != "noise" for c in (*worse(CHANGES), *better(CHANGES)))


def test_the_table_says_what_is_beyond_the_errors():
    table = change_table(better(CHANGES), "zone", "a", errors=True)
    assert table.heads == ("zone", "variant", "a", "now", "change", "beyond mesh error and scatter")
    assert table.rows == (("gain", "b", 1.0, 0.5, -0.5, "yes"),)
    assert change_table(worse(CHANGES), "zone", "a", errors=True).rows[0][-1] == "not known"


def test_a_picture_changes_by_more_than_a_cover_without_wrinkles_scores():
    vwi = {
        ("a", "suede", "sun"): 1.0, ("b", "suede", "sun"): 1.05,
        ("a", "black", "sun"): 1.0, ("b", "black", "sun"): 3.0, ("b", "new", "sun"): 9.0,
    }  # fmt: skip
    nothing = MappingProxyType({})
    scores = VariantScores(variants=("a", "b"), vwi=MappingProxyType(vwi), refused=nothing)
    (row,) = worse(sight_changes(scores))
    assert (row.place, row.before, row.after) == ("black under sun", 1.0, 3.0)
    assert better(sight_changes(scores)) == ()
