"""Pictures for a jury: code names, what a judge must not see, and pairs that nobody can mistake."""

from __future__ import annotations

from dataclasses import replace
from types import MappingProxyType

import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.jury.calibration import MEASURES
from seatlook.jury.stimuli import CATCH_VWI, Stimuli, draw_stimuli
from seatlook.visibility.view import View, luminance
from support import scenes
from support.seen.covers import BLACK, RIG, ROUGH
from visibility.test_view import view, wrinkled

pytestmark = pytest.mark.render
__all__ = ["view", "wrinkled"]  # the fixtures


def scene():
    textures = MappingProxyType({"black": BLACK, "rough": ROUGH})
    return replace(scenes.two_panels(), rigs=(RIG,), textures=textures)


@pytest.fixture(scope="module")
def stimuli(view: View) -> Stimuli:
    return draw_stimuli([("first", scene(), view), ("second", scene(), view)], seed=3)


def test_every_cell_of_every_cover_has_a_code_of_its_own(stimuli):
    labels = [cell.label for cell in stimuli.cells]
    assert labels == [f"{n}, {t}, sun" for n in ("first", "second") for t in ("black", "rough")]
    assert len(stimuli.key) == len(stimuli.shown) == 4 + 2 * len(stimuli.catches)
    assert [cell.geometry for cell in stimuli.cells] == ["first", "first", "second", "second"]
    for cell in stimuli.cells:
        assert set(MEASURES) <= set(stimuli.key[cell.code])
        assert cell.measures.vwi > 0


def test_a_catch_pair_is_drawn_once_and_cannot_be_mistaken(stimuli, view):
    assert 1 <= len(stimuli.catches) <= 2
    for pair in stimuli.catches:
        result = view.score(*(luminance(one.picture) for one in pair), view.region)
        assert result.vwi >= CATCH_VWI


def test_the_questionnaire_reveals_nothing(stimuli):
    questionnaire = stimuli.questionnaire(title="covers", ties=True)
    assert questionnaire.names == tuple(cell.code for cell in stimuli.cells)
    assert {s.geometry for s in questionnaire.stimuli} == {""}
    assert questionnaire.ties
    (pair, *_), (catch, *_) = stimuli.catches, questionnaire.catches
    assert (catch.wrinkled.name, catch.smooth.name) == tuple(one.code for one in pair)


def test_another_seed_gives_other_codes_and_the_same_pictures(stimuli, view):
    other = draw_stimuli([("first", scene(), view)], seed=4)
    assert not set(other.key) & set(stimuli.key)
    for a, b in zip(other.cells, stimuli.cells, strict=False):
        assert np.array_equal(a.picture.radiance, b.picture.radiance)


def test_notices_name_what_is_missing(stimuli):
    assert list(stimuli.notices) == ["4 pictures; 8 to 12 screen judges without tiring them"]
    unscreened = replace(stimuli, catches=(), cells=stimuli.cells * 2)
    (notice,) = unscreened.notices
    assert notice.startswith("no catch pair: even 32 mm high these wrinkles would be missed")


def test_without_a_cover_there_is_nothing_to_compare():
    with pytest.raises(InputError, match="scenes: got none, expected a scene file or more"):
        draw_stimuli([], seed=1)
