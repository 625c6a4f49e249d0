"""Plan and fit a jury from the command line: votes in, strengths with half-widths out."""

from __future__ import annotations

import json
from dataclasses import asdict, replace
from pathlib import Path

import numpy as np
import pytest

from seatlook.cli import run
from seatlook.jury.bradley_terry import STEP
from seatlook.jury.questionnaire import questionnaire_document
from seatlook.visibility.cross_check import Measures
from support.seen.juries import ballots, documents, make_questionnaire

STRENGTHS = STEP * np.arange(8)


@pytest.fixture
def questionnaire():
    return make_questionnaire(8, 2)


@pytest.fixture
def folder(questionnaire, tmp_path: Path) -> Path:
    """Five judges who agree and one who flips coins, with the organiser's key."""
    names = [
        *questionnaire.names,
        *(s.name for c in questionnaire.catches for s in (c.wrinkled, c.smooth)),
    ]
    key = {
        name: {
            "label": f"cover {name}",
            "geometry": "ab"[k % 2],
            **asdict(Measures(vwi=1.0 + k, log_ratio=0.01 * (k + 1), dissimilarity=0.001 * k)),
        }
        for k, name in enumerate(names)
    }
    document = {**questionnaire_document(questionnaire, judges=6, seed=1), "key": key}
    (tmp_path / "jury.json").write_text(json.dumps(document))
    given = ballots(questionnaire, [STRENGTHS] * 5 + [None], seed=3)
    for judge, votes in documents(given).items():
        (tmp_path / f"votes-{judge}.json").write_text(json.dumps(votes))
    return tmp_path


def fit(folder: Path, *words: str) -> int:
    votes = sorted(map(str, folder.glob("votes-*.json")))
    return run(["jury", "fit", str(folder / "jury.json"), *votes, *words])


def test_a_fit_ranks_by_label_with_and_without_the_coin(folder, capsys):
    assert fit(folder, "--json") == 0
    data = json.loads(capsys.readouterr().out)
    wrinkles = data["questions"]["wrinkles"]
    ranked = list(wrinkles["all judges"]["strengths"])
    assert ranked[0] == "cover s7"
    assert ranked[-1] == "cover s0"
    assert all(e["half_width"] > 0 for e in wrinkles["all judges"]["strengths"].values())
    assert [j["judge"] for j in wrinkles["judges"] if j["excluded"]] in ([], ["judge 5"])
    assert data["calibration"]["covers"] == 2
    assert data["calibration"]["verdict"].startswith("VWI ")
    assert data["not_calibrated"] == ""


def test_tables_say_what_the_values_say(folder, capsys):
    assert fit(folder) == 0
    text = capsys.readouterr().out
    for part in ("wrinkles, all judges", "preference, all judges", "neighbours", "Kendall's u"):
        assert part in text
    assert "judge 5" in text
    assert "held_out_log_likelihood_vwi" in text


def test_a_file_that_is_none_is_named_and_the_others_count(folder, capsys):
    bad = folder / "votes-bad.json"
    bad.write_text('{"schema": 1')
    assert fit(folder, "--json") == 0
    printed = capsys.readouterr()
    assert f"{bad}:1: file: got" in printed.err
    assert len(json.loads(printed.out)["questions"]["wrinkles"]["judges"]) == 6


def test_without_a_vote_nothing_is_fitted(folder, capsys):
    for path in folder.glob("votes-*.json"):
        path.write_text(path.read_text().replace('"questionnaire": "', '"questionnaire": "x'))
    assert fit(folder) == 2
    assert "votes: got none that counts, expected at least one" in capsys.readouterr().err


def test_one_cover_is_too_few_to_calibrate(folder, capsys):
    path = folder / "jury.json"
    path.write_text(path.read_text().replace('"geometry": "b"', '"geometry": "a"'))
    assert fit(folder) == 0
    assert "not calibrated: geometries: got 1, expected two or more" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("content", "message"),
    [
        ("{", "jury.json:1: file: got Expecting property name"),
        ("[]", 'jury.json: key: got none, expected the "jury.json"'),
    ],
)
def test_a_key_that_is_none_is_refused(folder, capsys, content, message):
    (folder / "jury.json").write_text(content)
    assert fit(folder) == 2
    assert message in capsys.readouterr().err


def test_a_plan_has_a_row_for_every_size(capsys):
    words = ["jury", "plan", "--judges", "5", "--judges", "20", "--stimuli", "9", "--json"]
    assert run(words) == 0
    rows = json.loads(capsys.readouterr().out)
    assert [(r["judges"], r["stimuli"]) for r in rows] == [(5, 9), (20, 9)]
    assert rows[1]["half_width"] == pytest.approx(rows[0]["half_width"] / 2, rel=0.01)


def test_a_changed_questionnaire_is_refused(questionnaire, folder, capsys):
    other = replace(questionnaire, title="another")
    path = folder / "jury.json"
    document = json.loads(path.read_text())
    path.write_text(json.dumps({**document, "title": other.title}))
    assert fit(folder) == 2
    assert "questionnaire.digest: got" in capsys.readouterr().err
