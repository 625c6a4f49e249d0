"""From seats to a page for judges in one call."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import pytest

import seatlook
from jury.test_stimuli import scene
from seatlook.chain.case import Case
from seatlook.errors import InputError
from seatlook.report.jury_page import read_jury
from support.seen.covers import oblique
from visibility.test_view import wrinkled

pytestmark = pytest.mark.render
__all__ = ["wrinkled"]  # the fixture


def cases(solution, folders):
    """One scene in several folders, as designers keep variants."""
    camera = oblique((200, 150))
    return [
        Case(
            replace(scene(), path=Path(folder) / "scene.toml", cameras=(camera,)),
            solution=solution,
        )
        for folder in folders
    ]


def test_scenes_of_one_name_are_told_apart_by_their_folders(wrinkled, tmp_path):
    steps = []
    result = seatlook.export_jury(
        cases(wrinkled, ["fits", "eased"]), tmp_path, rigs=["sun"], judges=3, seed=4,
        width=120, title="Two covers", progress=lambda name, **at: steps.append(at["scene"]),
    )  # fmt: skip
    labels = [cell.label for cell in result.stimuli.cells]
    name = scene().name
    assert labels == [
        f"{name} ({folder}), {texture}, sun"
        for folder in ("fits", "eased") for texture in ("black", "rough")
    ]  # fmt: skip
    assert {*steps} == {f"{name} (fits)", f"{name} (eased)"}
    assert {one.picture.radiance.shape for one in result.stimuli.shown} == {(150, 120, 3)}
    assert (result.page, result.key) == (tmp_path / "page/index.html", tmp_path / "jury.json")
    questionnaire, pictures = read_jury(result.key)
    assert (questionnaire, pictures) == (
        result.questionnaire, json.loads(json.dumps(result.stimuli.key)),
    )  # fmt: skip
    sessions = json.loads(result.key.read_text())["sessions"]
    assert [len(session["trials"]) for session in sessions] == 3 * [result.comparisons]
    assert questionnaire.questions == ("seen", "wrinkles")
    assert any("8 to 12 screen judges" in notice for notice in result.notices)


def test_the_questions_may_be_chosen_and_are_known(wrinkled, tmp_path):
    words = {"rigs": ["sun"], "judges": 1, "width": 120}
    both = cases(wrinkled, ["fits", "eased"])
    asked = seatlook.export_jury(both, tmp_path, questions=["preference"], **words)
    assert asked.questionnaire.questions == ("preference",)
    with pytest.raises(InputError, match="got 'beauty', expected one of seen, wrinkles, pref"):
        seatlook.export_jury(both, tmp_path, questions=["beauty"], **words)


def test_a_name_that_no_scene_has_leaves_nothing(wrinkled, tmp_path):
    with pytest.raises(InputError, match="dusk"):
        seatlook.export_jury(cases(wrinkled, ["fits"]), tmp_path / "out", rigs=["dusk"])
    with pytest.raises(InputError, match="expected a scene file or more"):
        seatlook.export_jury([], tmp_path / "out")
    assert not (tmp_path / "out").exists()
