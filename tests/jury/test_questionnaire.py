"""Sessions: what every judge must be shown, and what a panel refuses to be."""

import itertools
import json
from collections import Counter

import pytest

from seatlook.errors import InputError
from seatlook.jury.questionnaire import Catch, Panel, panel_document, read_panel, trials
from support.seen.juries import make_panel, stimulus

FROZEN = [
    ("catch", "flat0", "deep0"),
    ("pair", "s0", "s1"),
    ("pair", "s0", "s2"),
    ("pair", "s2", "s1"),
    ("repeat", "s1", "s0"),
]


@pytest.fixture
def panel():
    return make_panel(9, 4)


@pytest.mark.parametrize("seed", range(6))
def test_every_pair_once_repeats_exchanged_catches_under_wrinkles(panel, seed):
    session = trials(panel, seed)
    assert [t.number for t in session] == list(range(2 * 36 + 2 * 4 + 4))
    for question in panel.questions:
        block = [t for t in session if t.question == question]
        assert [t.number for t in block] == list(range(block[0].number, block[-1].number + 1))
        first = {frozenset((t.left, t.right)): t for t in block if t.kind == "pair"}
        assert set(first) == set(map(frozenset, itertools.combinations(panel.names, 2)))
        repeats = [t for t in block if t.kind == "repeat"]
        assert len(repeats) == 4
        for again in repeats:
            before = first[frozenset((again.left, again.right))]
            assert (again.left, again.right) == (before.right, before.left)
            assert again.number > before.number
    assert {t.question for t in session if t.kind == "catch"} == {"wrinkles"}


def test_order_and_sides_differ_between_judges_and_are_balanced_over_them(panel):
    sessions = [trials(panel, seed) for seed in range(200)]
    assert len({tuple((t.left, t.right) for t in s) for s in sessions}) == 200
    assert {s[0].question for s in sessions} == set(panel.questions)
    left = Counter(t.left for s in sessions for t in s if t.kind == "pair")
    right = Counter(t.right for s in sessions for t in s if t.kind == "pair")
    for name in panel.names:
        assert left[name] / (left[name] + right[name]) == pytest.approx(0.5, abs=0.03)
    first = Counter(
        name for s in sessions for t in s[:10] if t.kind == "pair" for name in (t.left, t.right)
    )
    assert max(first.values()) < 1.3 * min(first.values())


def test_a_session_never_changes():
    """Votes already given depend on it: the sequence is fixed for all versions."""
    session = trials(make_panel(3, 1, questions=("wrinkles",), repeat_share=0.34), 5)
    assert [(t.kind, t.left, t.right) for t in session] == FROZEN


def test_a_document_comes_back(panel):
    document = json.loads(json.dumps(panel_document(panel, judges=3, seed=40)))
    assert read_panel(document) == panel
    assert [s["seed"] for s in document["sessions"]] == [40, 41, 42]
    shown = trials(panel, 41)
    assert document["sessions"][1]["trials"] == [
        [t.question, t.kind, t.left, t.right] for t in shown
    ]
    assert document["questions"]["preference"] == "Which one would you rather have?"


def test_a_changed_document_is_refused(panel):
    document = panel_document(panel, judges=1, seed=1)
    document["stimuli"][0]["picture"] = "another.png"
    with pytest.raises(InputError, match=f"panel.digest: got {panel.digest}, expected "):
        read_panel(document)
    with pytest.raises(InputError, match="panel: got KeyError: 'title', expected a panel document"):
        read_panel({})


def test_a_panel_tells_all_that_is_wrong():
    with pytest.raises(InputError) as caught:
        Panel(
            title="x",
            stimuli=(stimulus("a"), stimulus("b")),
            catches=(Catch(wrinkled=stimulus("a"), smooth=stimulus("c")),),
            questions=("wrinkles", "beauty"),
            repeat_share=2.0,
        )
    assert str(caught.value).splitlines() == [
        "Panel.stimuli: got 2 named 'a', expected one",
        "Panel.questions: got 'beauty', expected one of wrinkles, preference",
        "Panel.stimuli: got 2, expected 3 or more",
        "Panel.repeat_share: got 2.0, expected 0 to 1",
    ]
