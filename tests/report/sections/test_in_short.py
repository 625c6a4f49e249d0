"""The sentences on top of a page: hand-made wrinkles, places and limits."""

from __future__ import annotations

from types import MappingProxyType, SimpleNamespace

import numpy as np
import pytest

from seatlook.report import Check
from seatlook.report.page.types import ScoreSection, SeenPlace
from seatlook.report.sections.in_short import accepted, first_lines
from seatlook.report.sections.words import panel_words, seam_words, zone_words

PANELS = ("INSERT", "BOLSTER_L", "BOLSTER_R", "Lehne_L", "FLAP_R")
SIDES = (0.0, 0.3, -0.3, 0.0, 0.3)  # [m] where each panel lies; the last one's name is wrong
FACES = np.arange(3 * len(PANELS)).reshape(-1, 3)
SOLUTION = SimpleNamespace(
    positions=np.repeat([[x, 0.0, 0.0] for x in SIDES], 3, axis=0),
    cover=SimpleNamespace(panel_names=PANELS, panel=np.arange(len(PANELS)), faces=FACES),
)
GOOD = SimpleNamespace(balance="", resolved=True, coarseness=())


def wrinkle(**changes):
    values = {
        "panel": "INSERT", "near_kind": "seam", "near": "INSERT-BOLSTER_L", "distance": 0.01,
        "kind": "wrinkle", "resolved": True,
    }  # fmt: skip
    return SimpleNamespace(**(values | changes))


def advice(*ranks, sentence="take 3 mm out of the insert"):
    return SimpleNamespace(wrinkles=ranks, sentence=sentence, confidence="high")


def assessment(*wrinkles, resolution=GOOD, advice=()):
    return SimpleNamespace(
        wrinkles=wrinkles, solution=SOLUTION, resolution=resolution, advice=advice
    )


def place(rank=1, zone="INSERT interior", hidden_by=("suede",), shows=True):
    return SeenPlace(
        rank=rank, zone=zone, shows=shows, texture="black-leather", rig="sun", vwi=5.0,
        hidden_by=hidden_by, x=1.0, y=2.0,
    )  # fmt: skip


def lines(*places, of=None, checks=()):
    score = ScoreSection(cells=MappingProxyType({}), places=places)
    return first_lines(of or assessment(wrinkle()), score, checks)


def test_sides_are_said_where_name_and_place_agree():
    words = panel_words(SOLUTION)
    assert words == {
        "INSERT": "insert",
        "BOLSTER_L": "left bolster",
        "BOLSTER_R": "right bolster",
        "Lehne_L": "Lehne_L",
        "FLAP_R": "flap r",
    }
    assert seam_words("INSERT-BOLSTER_L", words) == (
        "the seam of insert and left bolster (INSERT-BOLSTER_L)"
    )
    assert seam_words("welt", words) == "seam welt"
    assert zone_words("BOLSTER_R interior", words) == "inside right bolster (BOLSTER_R)"
    assert zone_words("INSERT interior", words) == "inside insert"
    assert zone_words("box 1", words) == "in box 1"


def test_nothing_that_shows_is_said_first():
    said = lines(place(shows=False))
    assert said[0] == "No wrinkle shows in any colour under any light of this page."
    assert said[1] == "One wrinkle cannot be seen from here."
    assert lines(of=assessment())[:2] == (
        "No wrinkle shows in any colour under any light of this page.",
        "Nothing is accepted or rejected: the scene sets no limit.",
    )


@pytest.mark.parametrize(
    ("hidden", "end"),
    [
        (("suede",), "suede hides it."),
        ((), "no colour here hides it."),
        (("suede", "bright-leather"), "suede and bright leather hide it."),
    ],
)
def test_one_wrinkle_is_said_with_place_look_light_and_cure(hidden, end):
    of = assessment(wrinkle(), advice=(advice(2, sentence="no"), advice(1)))
    first, second, *_ = lines(place(hidden_by=hidden), of=of)
    assert first == (
        "One wrinkle shows: beside the seam of insert and left bolster (INSERT-BOLSTER_L), "
        f"most in black leather under the sun; {end}"
    )
    assert second == "Take 3 mm out of the insert (confidence: high)."


def test_what_scores_without_a_valley_is_said_beside_it():
    cells = {("black-leather", "sun"): 7.5, ("suede", "sun"): 0.4}
    score = ScoreSection(cells=MappingProxyType(cells), places=())
    said = first_lines(assessment(), score, ())
    assert said[:2] == (
        "No wrinkle shows in any colour under any light of this page.",
        "Broad waves, flatter than a radius of 1 m, score VWI 7.50, "
        "most in black leather under the sun.",
    )
    quiet = ScoreSection(cells=MappingProxyType({("suede", "sun"): 0.4}), places=())
    assert not any("Broad" in line for line in first_lines(assessment(), quiet, ()))


@pytest.mark.parametrize(("vwi", "although"), [(0.4, True), (7.5, False)])
def test_a_correction_of_what_does_not_show_does_not_read_as_a_contradiction(vwi, although):
    cells = MappingProxyType({("suede", "sun"): vwi})
    off = assessment(advice=(advice(),))
    said = first_lines(off, ScoreSection(cells=cells, places=()), ())
    correction = next(line for line in said if line.endswith("(confidence: high)."))
    assert correction.startswith("To be corrected although it does not show: ") == although
    assert "3 mm out of the insert" in correction
    # Without a score nobody knows what shows.
    assert "Take 3 mm out of the insert (confidence: high)." in first_lines(off, None, ())


def test_where_nothing_can_be_advised_the_reason_is_said():
    assert lines(place())[1] == "No correction: nothing is clearly too long or too tight here."
    coarse = assessment(wrinkle(resolved=False))
    assert lines(place(), of=coarse)[1] == (
        "No correction: the mesh does not resolve this wrinkle."
    )


def test_what_lies_at_a_tie_is_no_wrinkle():
    assert "cannot be seen" not in "".join(lines(of=assessment(wrinkle(kind="tie"))))
    assert first_lines(assessment(wrinkle(kind="corner")), None, ())[0].startswith("No valley")


def test_several_places_are_counted_and_only_what_hides_all_of_them_hides_them():
    seen = (place(), place(rank=None, zone="BOLSTER_R interior", hidden_by=()))
    assert lines(*seen)[0] == (
        "Wrinkles show in two places, most of all beside the seam of insert and left bolster "
        "(INSERT-BOLSTER_L), plainest in black leather under the sun; "
        "no colour here hides them all."
    )
    only_zone = lines(seen[1], of=assessment())[0]
    assert only_zone.startswith("One wrinkle shows: inside right bolster (BOLSTER_R), most in")


def test_without_a_score_the_shape_is_said_and_that_nobody_knows_what_shows():
    assert first_lines(assessment(), None, ())[0] == (
        "No valley is as sharp as a wrinkle; whether flatter waves show is not known: "
        "it was not scored."
    )
    refused = ScoreSection(refused="VWI 1.27 of a cover without wrinkles")
    far = wrinkle(distance=0.3)
    said = first_lines(assessment(wrinkle(), far), refused, ())[0]
    assert said.startswith("Two wrinkles, the worst beside the seam of insert and left bolster")
    assert said.endswith("the score was refused.")


def test_limits_are_accepted_or_rejected_class_by_class():
    checks = (
        Check(name="A: vwi", value="4.2", limit="3", kept=False),
        Check(name="A: w2_p95", value="0.2", limit="1", kept=True),
        Check(name="B: vwi", value="4.2", limit="9", kept=True),
    )
    assert list(accepted(checks)) == ["A rejected (vwi 4.2, at most 3); B accepted."]


@pytest.mark.parametrize(
    ("found", "doubt"),
    [
        ({"balance": "seam gap"}, "Do not rely on this: the cover did not come to rest."),
        (
            {"balance": "", "coarseness": ("folds",)},
            "Do not build on this yet: folds.",
        ),
    ],
)
def test_what_is_not_to_be_trusted_is_said_last(found, doubt):
    resolution = SimpleNamespace(resolved=False, **found)
    assert lines(place(), of=assessment(wrinkle(), resolution=resolution))[-1] == doubt
