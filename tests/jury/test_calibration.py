"""A score that people follow wins over one they do not, on covers it never saw."""

from dataclasses import replace

import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.jury.calibration import CHANCE, Link, calibrate
from seatlook.visibility.cross_check import Measures
from support.seen.juries import ballots, make_questionnaire

COUNT = 9


@pytest.fixture(scope="module")
def questionnaire():
    questionnaire = make_questionnaire(COUNT, 0)
    covers = [replace(s, geometry=f"cover {k % 3}") for k, s in enumerate(questionnaire.stimuli)]
    return replace(questionnaire, stimuli=tuple(covers))


def visible(seed=0):
    rng = np.random.default_rng(seed)
    return np.sort(rng.uniform(0.5, 40, COUNT)), rng.uniform(0.01, 0.2, COUNT)


def measured(questionnaire, vwi, other):
    return {
        s.name: Measures(vwi=vwi[k], log_ratio=other[k], dissimilarity=float(other[k] / 3))
        for k, s in enumerate(questionnaire.stimuli)
    }


def people(questionnaire, truth, judges=25, seed=0):
    return ballots(questionnaire, [truth] * judges, seed=seed)


def test_gain_and_exponent_come_back(questionnaire):
    vwi, other = visible()
    result = calibrate(
        people(questionnaire, 1.5 * vwi**0.5, 120), measured(questionnaire, vwi, other)
    )
    link = result.links["vwi"]
    assert link.exponent == pytest.approx(0.5, abs=0.08)
    lead = link.gain * (vwi[-1] ** link.exponent - vwi[0] ** link.exponent)
    assert lead == pytest.approx(1.5 * (vwi[-1] ** 0.5 - vwi[0] ** 0.5), rel=0.08)


def test_the_score_people_follow_wins(questionnaire):
    vwi, other = visible()
    result = calibrate(people(questionnaire, 1.5 * vwi**0.5), measured(questionnaire, vwi, other))
    assert result.held_out["vwi"] > max(result.held_out["log_ratio"], CHANCE)
    assert result.advantage[1] > 0
    assert result.verdict == "VWI predicts better than the log ratio"
    assert result.geometries == ("cover 0", "cover 1", "cover 2")
    # 36 pairs: 9 within a cover are predicted once, 27 across twice.
    assert result.votes == 25 * (9 + 2 * 27)


def test_a_failure_is_reported(questionnaire):
    vwi, other = visible()
    truth = 20 * other
    result = calibrate(people(questionnaire, truth), measured(questionnaire, vwi, other))
    assert result.verdict != "VWI predicts better than the log ratio"
    assert result.advantage[2] < 0
    result = calibrate(people(questionnaire, -0.2 * vwi), measured(questionnaire, vwi, other))
    assert result.verdict == "VWI predicts no better than a coin"


def test_the_held_out_figure_by_hand(questionnaire):
    """Votes that follow the truth exactly: its own likelihood is the best one can expect."""
    vwi, other = visible()
    truth = 1.5 * vwi**0.5
    given = people(questionnaire, truth, 200)
    result = calibrate(given, measured(questionnaire, vwi, other))
    p = 1 / (1 + np.exp(truth[None, :] - truth[:, None]))
    cover = np.arange(COUNT) % 3
    weight = np.where(cover[:, None] == cover[None, :], 1, 2) * ~np.eye(COUNT, dtype=bool)
    entropy = -p * np.log(p)
    best = -(weight * entropy).sum() / (weight.sum() / 2)
    assert result.held_out["vwi"] == pytest.approx(best, abs=0.01)


def test_preference_expects_the_smoother_one(questionnaire):
    vwi, other = visible()
    result = calibrate(
        people(questionnaire, -1.5 * vwi**0.5),
        measured(questionnaire, vwi, other),
        question="preference",
    )
    assert result.held_out["vwi"] > CHANCE


def test_link_at_its_ends():
    link = Link(gain=2.0, exponent=1.0)
    far, near = link.log_likelihood(np.array([1e4, 3.0]), np.array([0.0, 3.0]))
    assert far == 0
    assert near == CHANCE


def test_refuses_what_it_cannot_fit(questionnaire):
    vwi, other = visible()
    measures = measured(questionnaire, vwi, other)
    missing = {k: v for k, v in measures.items() if k != "s3"}
    with pytest.raises(InputError, match="stimulus s3: got no measures"):
        calibrate(people(questionnaire, vwi, 1), missing)
    bare = make_questionnaire(COUNT, 0)
    with pytest.raises(InputError, match="stimulus s0: got no geometry, expected the cover"):
        calibrate(people(bare, vwi, 1), measures)
    one = replace(
        questionnaire, stimuli=tuple(replace(s, geometry="x") for s in questionnaire.stimuli)
    )
    with pytest.raises(InputError, match="geometries: got 1, expected two or more covers"):
        calibrate(people(one, vwi, 1), measures)
    empty = replace(people(questionnaire, vwi, 1), votes=())
    with pytest.raises(InputError, match="votes: got none on 'wrinkles'"):
        calibrate(empty, measures)
    with pytest.raises(InputError, match="measures: got 0 for every stimulus"):
        calibrate(people(questionnaire, vwi, 2), measured(questionnaire, 0 * vwi, other))
