"""The sentences on top of a page: hand-made zones, cells and checks."""

from __future__ import annotations

from types import MappingProxyType

import pytest

from seatlook.chain.assess import Assessment
from seatlook.report import Check
from seatlook.report.sections.in_short import missed, seen, wrinkled
from seatlook.wrinkle import ZoneRow


class Zones(Assessment):
    """An assessment of which only the zones are given."""

    def __init__(self, *zones: ZoneRow) -> None:
        self.zones = zones


def zone(name: str, *, share: float, stretch: float = 0.5, area: float = 0.01) -> ZoneRow:
    return ZoneRow(
        zone=name,
        area=area,
        stretch_share=stretch,
        element_size=0.007,
        w2_face_rms=0.01,
        figures=MappingProxyType({"w2_p95": 0.2 + share, "w2_area_share": share}),
    )


def test_a_smooth_cover_names_its_highest_zone():
    zones = Zones(zone("insert", share=0.0), zone("free edge", share=0.9))
    (sentence,) = wrinkled(zones)
    assert sentence.startswith("W2 is nowhere above 1")
    assert sentence.endswith("Highest: insert, where 95 % of the area is below 0.200.")
    assert zones.share_above_one == 0
    assert list(wrinkled(Zones())) == []


@pytest.mark.parametrize(
    ("stretch", "cause"),
    [
        (0.9, "by stretch one way"),
        (0.1, "by excess fabric"),
        (0.5, "by stretch and excess fabric equally"),
    ],
)
def test_a_wrinkled_cover_says_where_and_why(stretch, cause):
    zones = Zones(zone("insert", share=0.0, area=0.03), zone("seam", share=0.2, stretch=stretch))
    (sentence,) = wrinkled(zones)
    assert sentence == f"W2 is above 1 on 5 % of the cover, most in seam: 20 % of it, {cause}."


def test_the_most_and_least_visible_are_named():
    cells = {("black", "sun"): 1.0, ("black", "bulb"): 4.0, ("suede", "sun"): 2.0}
    assert list(seen(cells)) == [
        "Most visible: black under bulb, VWI 4.",
        "Least visible: suede, VWI 2 under its worst light.",
    ]
    assert list(seen({("black", "sun"): 1.0})) == ["Most visible: black under sun, VWI 1."]
    assert list(seen({})) == []


def test_missed_limits_are_said():
    met = Check(name="insert: vwi", value="1", limit="2", kept=True)
    bad = Check(name="class A: w2_area_share", value="0.2", limit="0.1", kept=False)
    assert list(missed([met])) == []
    assert list(missed([met, bad])) == ["Missed: class A: w2_area_share is 0.2, the limit is 0.1."]
