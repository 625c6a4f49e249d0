"""What is left for a jury: a page that names nothing, and the key beside it."""

from __future__ import annotations

import json

import pytest

from jury.test_stimuli import stimuli
from seatlook.errors import InputError
from seatlook.report.jury_page import KEY, PAGE, read_jury, write_jury
from visibility.test_view import view, wrinkled

pytestmark = pytest.mark.render
__all__ = ["stimuli", "view", "wrinkled"]  # the fixtures


@pytest.fixture(scope="module")
def folder(stimuli, tmp_path_factory):
    folder = tmp_path_factory.mktemp("jury")
    write_jury(stimuli, folder, title="Covers", judges=2, seed=5)
    return folder


def test_page_and_pictures_lie_together_and_the_key_beside_them(folder, stimuli):
    files = {str(p.relative_to(folder)) for p in folder.rglob("*") if p.is_file()}
    pictures = {f"{PAGE}/{one.path}" for one in stimuli.shown}
    assert files == {KEY, f"{PAGE}/index.html"} | pictures


def test_the_page_names_no_cover_and_no_score(folder, stimuli):
    text = (folder / PAGE / "index.html").read_text(encoding="utf-8")
    for one in stimuli.shown:
        assert one.code in text
        assert one.label not in text
    assert not any(word in text for word in ("vwi", "log_ratio", "black", "rough"))


def test_the_key_comes_back(folder, stimuli):
    questionnaire, pictures = read_jury(folder / KEY)
    assert questionnaire == stimuli.questionnaire(title="Covers")
    assert pictures == json.loads(json.dumps(stimuli.key))


def test_a_page_for_nobody_is_refused(stimuli, tmp_path):
    with pytest.raises(InputError, match="judges: got 0, expected 1 or more"):
        write_jury(stimuli, tmp_path, title="Covers", judges=0, seed=5)
    assert list(tmp_path.iterdir()) == []
