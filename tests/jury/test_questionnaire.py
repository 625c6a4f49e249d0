"""Sessions: what every judge must be shown, and what a questionnaire refuses to be."""

import itertools
import json
from collections import Counter
from dataclasses import replace

import pytest

from seatlook.errors import InputError
from seatlook.jury.questionnaire import (
    Catch,
    Questionnaire,
    questionnaire_document,
    read_questionnaire,
    trials,
)
from support.seen.juries import make_questionnaire, stimulus

FROZEN = [
    ("catch", "flat0", "deep0"),
    ("pair", "s0", "s1"),
    ("pair", "s0", "s2"),
    ("pair", "s2", "s1"),
    ("repeat", "s1", "s0"),
]


@pytest.fixture
def questionnaire():
    return make_questionnaire(9, 4)


@pytest.mark.parametrize("seed", range(6))
def test_every_pair_once_repeats_exchanged_catches_under_wrinkles(questionnaire, seed):
    session = trials(questionnaire, seed)
    assert [t.number for t in session] == list(range(2 * 36 + 2 * 4 + 4))
    for question in questionnaire.questions:
        block = [t for t in session if t.question == question]
        assert [t.number for t in block] == list(range(block[0].number, block[-1].number + 1))
        first = {frozenset((t.left, t.right)): t for t in block if t.kind == "pair"}
        assert set(first) == set(map(frozenset, itertools.combinations(questionnaire.names, 2)))
        repeats = [t for t in block if t.kind == "repeat"]
        assert len(repeats) == 4
        for again in repeats:
            before = first[frozenset((again.left, again.right))]
            assert (again.left, again.right) == (before.right, before.left)
            assert again.number > before.number
    assert {t.question for t in session if t.kind == "catch"} == {"wrinkles"}


@pytest.mark.parametrize(
    ("asked", "under"),
    [
        (("seen",), {"seen"}),
        (("preference", "seen"), {"seen"}),
        (("seen", "wrinkles"), {"wrinkles"}),
        (("preference",), set()),
    ],
)
def test_judges_are_screened_under_a_question_that_has_a_right_answer(questionnaire, asked, under):
    session = trials(replace(questionnaire, questions=asked), 1)
    caught = [t for t in session if t.kind == "catch"]
    assert {t.question for t in caught} == under
    assert len(caught) == (len(questionnaire.catches) if under else 0)


def test_order_and_sides_differ_between_judges_and_are_balanced_over_them(questionnaire):
    sessions = [trials(questionnaire, seed) for seed in range(200)]
    assert len({tuple((t.left, t.right) for t in s) for s in sessions}) == 200
    assert {s[0].question for s in sessions} == set(questionnaire.questions)
    left = Counter(t.left for s in sessions for t in s if t.kind == "pair")
    right = Counter(t.right for s in sessions for t in s if t.kind == "pair")
    for name in questionnaire.names:
        assert left[name] / (left[name] + right[name]) == pytest.approx(0.5, abs=0.03)
    first = Counter(
        name for s in sessions for t in s[:10] if t.kind == "pair" for name in (t.left, t.right)
    )
    assert max(first.values()) < 1.3 * min(first.values())


def test_a_session_never_changes():
    """Votes already given depend on it: the sequence is fixed for all versions."""
    session = trials(make_questionnaire(3, 1, questions=("wrinkles",), repeat_share=0.34), 5)
    assert [(t.kind, t.left, t.right) for t in session] == FROZEN


def test_a_document_comes_back(questionnaire):
    document = json.loads(json.dumps(questionnaire_document(questionnaire, judges=3, seed=40)))
    assert read_questionnaire(document) == questionnaire
    assert [s["seed"] for s in document["sessions"]] == [40, 41, 42]
    shown = trials(questionnaire, 41)
    assert document["sessions"][1]["trials"] == [
        [t.question, t.kind, t.left, t.right] for t in shown
    ]
    assert document["questions"]["preference"] == "Which one would you rather have?"


def test_a_changed_document_is_refused(questionnaire):
    document = questionnaire_document(questionnaire, judges=1, seed=1)
    document["stimuli"][0]["picture"] = "another.png"
    with pytest.raises(
        InputError, match=f"questionnaire.digest: got {questionnaire.digest}, expected "
    ):
        read_questionnaire(document)
    with pytest.raises(
        InputError, match="questionnaire: got KeyError: 'title', expected a questionnaire document"
    ):
        read_questionnaire({})


def test_a_questionnaire_names_all_that_is_wrong():
    with pytest.raises(InputError) as caught:
        Questionnaire(
            title="x",
            stimuli=(stimulus("a"), stimulus("b")),
            catches=(Catch(wrinkled=stimulus("a"), smooth=stimulus("c")),),
            questions=("wrinkles", "beauty"),
            repeat_share=2.0,
        )
    assert str(caught.value).splitlines() == [
        "Questionnaire.stimuli: got 2 named 'a', expected one",
        "Questionnaire.questions: got 'beauty', expected one of seen, wrinkles, preference",
        "Questionnaire.stimuli: got 2, expected 3 or more",
        "Questionnaire.repeat_share: got 2.0, expected 0 to 1",
    ]
