"""Merging the files of judges: what counts, and that everything else is named."""

import copy
import json
from pathlib import Path

import pytest

from seatlook.jury.votes import merge_votes
from support.seen.juries import ballots, documents, make_questionnaire

A, B = Path("anna.json"), Path("ben.json")


@pytest.fixture
def questionnaire():
    return make_questionnaire(4, 1)


@pytest.fixture
def given(questionnaire):
    return ballots(questionnaire, [[0, 1, 2, 3], None])


@pytest.fixture
def files(given):
    first, second = documents(given).values()
    return {A: first, B: second}


def merge(files, questionnaire):
    texts = {path: v if isinstance(v, str) else json.dumps(v) for path, v in files.items()}
    return merge_votes(texts, questionnaire)


def test_what_was_exported_comes_back(files, given, questionnaire):
    merged = merge(files, questionnaire)
    assert merged.votes == given.votes
    assert merged.problems == merged.notices == ()


def test_the_same_votes_sent_twice_count_once(files, given, questionnaire):
    merged = merge({**files, Path("anna (1).json"): files[A]}, questionnaire)
    assert merged.votes == given.votes
    count = len(files[A]["votes"])
    assert merged.notices == (
        f"anna (1).json: {count} votes of judge 'judge 0' sent twice count once",
    )


def test_two_answers_to_one_trial_count_neither_time(files, given, questionnaire):
    other = copy.deepcopy(files[A])
    other["votes"] = other["votes"][:1]
    wanted = {"left": "right", "right": "left"}[other["votes"][0]["choice"]]
    other["votes"][0]["choice"] = wanted
    merged = merge({**files, Path("again.json"): other}, questionnaire)
    assert len(merged.votes) == len(given.votes) - 1
    (problem,) = merged.problems
    assert str(problem) == (
        "again.json: votes[0]: got a second answer of judge 'judge 0' to trial 0, "
        "expected one answer; neither counts"
    )
    assert f"judge 'judge 0' answered {len(files[A]['votes']) - 1} of" in merged.notices[0]


def test_one_name_with_two_seeds_is_two_people(files, questionnaire):
    other = {**files[A], "seed": 77}
    merged = merge({**files, Path("other.json"): other}, questionnaire)
    (problem,) = merged.problems
    assert str(problem) == (
        "other.json: seed: got 77 for judge 'judge 0', expected 1, as in this judge's earlier file"
    )


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"choice": "both"}, "votes[2].choice: got 'both', expected one of left, right"),
        ({"choice": "tie"}, "votes[2].choice: got 'tie', expected one of left, right"),
        ({"question": ["x"]}, "votes[2].question: got ['x'], expected one of wrinkles, preference"),
        ({"trial": True}, "votes[2].trial: got true, expected a number from 0 up"),
        ({"trial": -1}, "votes[2].trial: got -1, expected a number from 0 up"),
        ({"seconds": float("nan")}, "votes[2].seconds: got nan, expected seconds from 0 up"),
        ({"left": "s9"}, "votes[2].left: got 's9', expected a stimulus of the questionnaire"),
        ({"left": "s1", "right": "s1"}, "votes[2]: got 's1' beside 's1' under"),
        ({"left": "s1", "right": "deep0"}, "expected two ranked stimuli, or a catch pair under"),
    ],
)
def test_a_malformed_vote_is_named_and_the_others_count(files, questionnaire, change, message):
    files[B]["votes"][2].update(change)
    merged = merge(files, questionnaire)
    (problem,) = merged.problems
    assert str(problem).startswith("ben.json: votes[2]")
    assert message in str(problem)
    assert len(merged.votes) == 2 * len(files[A]["votes"]) - 1


def test_a_vote_without_its_keys(files, questionnaire):
    files[A]["votes"][0] = 7
    del files[A]["votes"][1]["left"]
    keys = "an object with choice, left, question, right, trial"
    assert [str(p) for p in merge(files, questionnaire).problems] == [
        f"anna.json: votes[0]: got 7, expected {keys}",
        f"anna.json: votes[1]: got keys choice, question, right, seconds, trial, expected {keys}",
    ]


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (
            '{"schema": 1,\n "questionnaire": }',
            "anna.json:2: file: got Expecting value, expected JSON",
        ),
        ("[]", "anna.json: file: got [], expected an object"),
        ('{"schema": 1}', "anna.json: questionnaire: got None, expected str"),
    ],
)
def test_a_malformed_file_is_named_and_the_others_count(files, questionnaire, content, message):
    merged = merge({**files, A: content}, questionnaire)
    assert message in [str(p) for p in merged.problems]
    assert merged.judges == ("judge 1",)


def test_votes_of_another_questionnaire_do_not_count(files, questionnaire):
    merged = merge(files, make_questionnaire(5, 1))
    assert merged.votes == ()
    assert f"anna.json: questionnaire: got '{questionnaire.digest}'" in str(merged.problems[0])


def test_a_pair_shown_a_third_time_does_not_count(files, questionnaire, given):
    extra = {**files[A]["votes"][-1], "trial": 999}
    files[A]["votes"].append(extra)
    merged = merge(files, questionnaire)
    assert len(merged.votes) == len(given.votes)
    assert "once more, expected each pair once" in str(merged.problems[0])
