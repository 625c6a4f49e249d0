"""Votes of a jury to strengths and calibration in one call."""

from __future__ import annotations

import json

import pytest

import seatlook
from cli.test_jury import fit, folder, questionnaire
from seatlook.errors import InputError
from seatlook.report.sections.jury_tables import calibration_rows

__all__ = ["folder", "questionnaire"]  # the fixtures


def test_python_and_the_command_give_the_same(folder, capsys):
    answer = seatlook.fit_jury(folder / "jury.json", sorted(folder.glob("votes-*.json")))
    assert fit(folder, "--json") == 0
    printed = json.loads(capsys.readouterr().out)
    assert [*answer.results] == ["wrinkles", "preference"]
    for question, result in answer.results.items():
        strengths = {answer.labels[c]: e.value for c, e in result.everyone.strengths.items()}
        listed = printed["questions"][question]["all judges"]["strengths"]
        assert strengths == {label: row["value"] for label, row in listed.items()}
    assert calibration_rows(answer.calibration) == printed["calibration"]
    assert answer.not_calibrated == ""


def test_a_key_without_scores_still_ranks(folder):
    path = folder / "jury.json"
    document = json.loads(path.read_text())
    del document["key"]["s2"]["vwi"]
    path.write_text(json.dumps(document))
    answer = seatlook.fit_jury(path, folder.glob("votes-*.json"))
    assert answer.calibration is None
    assert answer.not_calibrated.startswith("key s2: got no vwi, ")
    assert len(answer.results["wrinkles"].everyone.strengths) == 8


def test_without_a_vote_that_counts_every_file_says_why(folder):
    for path in folder.glob("votes-*.json"):
        path.write_text('{"schema": 1')
    with pytest.raises(InputError) as caught:
        seatlook.fit_jury(folder / "jury.json", folder.glob("votes-*.json"))
    assert len(caught.value.problems) == 7
    assert "votes: got none that counts, expected at least one" in str(caught.value)
