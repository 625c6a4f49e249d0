"""From votes to strengths: known truths come back, odd judges and broken designs are reported."""

from dataclasses import replace

import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.jury.bradley_terry import STEP, fit_strengths
from seatlook.jury.fit import fit_votes
from seatlook.jury.judges import judge_records
from seatlook.jury.plan import plan_jury
from support.seen.juries import ballots, make_questionnaire, without

NINE = 0.36 * STEP * np.arange(9)


@pytest.fixture(scope="module")
def questionnaire():
    return make_questionnaire(9, 4)


def coverage(strengths_of_judges, questionnaire, simulations, *, resamples):
    """Share of neighbour differences inside both intervals, and mean half-width [steps]."""
    names = questionnaire.names
    inside, widths = [], []
    for seed in range(simulations):
        given = ballots(questionnaire, strengths_of_judges(seed), seed=seed)
        fit = fit_votes(given, "wrinkles", resamples=resamples, seed=seed).everyone
        for k in range(len(names) - 1):
            # Neighbours in truth, so the truth is known whatever the fitted order.
            low, high = (fit.strengths[names[k + s]].value for s in (0, 1))
            error = abs(high - low - 0.36)
            spread = fit.difference(names[k + 1], names[k])
            inside.append((error <= spread.fisher_half_width, error <= spread.half_width))
            widths.append((spread.fisher_half_width, spread.half_width))
    return np.mean(inside, axis=0), np.mean(widths, axis=0)


@pytest.mark.validate
def test_intervals_cover_the_truth():
    """2,000 juries of 20 judges and 9 stimuli: 95 % intervals hold 92 to 97 % of the truths."""
    questionnaire = make_questionnaire(9, 0, questions=("wrinkles",), repeat_share=0.0)
    shares, widths = coverage(lambda _: [NINE] * 20, questionnaire, 2000, resamples=200)
    assert (shares > 0.92).all(), shares
    assert (shares < 0.97).all(), shares
    assert widths[0] == pytest.approx(plan_jury(20, 9).half_width, rel=0.03)


@pytest.mark.validate
def test_judges_who_differ_need_the_interval_of_resampled_judges():
    def people(seed):
        return NINE + np.random.default_rng(seed).normal(0, 0.8, (20, 9))

    questionnaire = make_questionnaire(9, 0, questions=("wrinkles",), repeat_share=0.0)
    (fisher, resampled), widths = coverage(people, questionnaire, 400, resamples=200)
    assert resampled > fisher + 0.03
    assert widths[1] > 1.1 * widths[0]
    assert 0.92 < resampled < 0.98


def test_a_small_jury_of_simulations_covers():
    questionnaire = make_questionnaire(9, 0, questions=("wrinkles",), repeat_share=0.0)
    shares, _ = coverage(lambda _: [NINE] * 20, questionnaire, 40, resamples=100)
    # 320 differences, partly tied to each other: 4 standard errors below and above 0.95.
    assert (shares > 0.89).all(), shares
    assert (shares < 0.999).all(), shares


def test_figures_of_a_fit(questionnaire):
    result = fit_votes(ballots(questionnaire, [NINE] * 12, seed=3), "wrinkles", resamples=200)
    fit = result.everyone
    assert fit.votes == 12 * 36
    assert fit.tie_share == 0
    assert sum(e.value for e in fit.strengths.values()) == pytest.approx(0, abs=1e-9)
    values = [e.value for e in fit.strengths.values()]
    assert values == sorted(values, reverse=True)
    for pair in fit.neighbours:
        upper, lower = (fit.strengths[name].value for name in (pair.upper, pair.lower))
        assert pair.steps.value == pytest.approx(upper - lower)
        assert pair.steps == fit.difference(pair.upper, pair.lower)
    assert result.screened is None
    assert fit.agreement.u > 0.1
    assert fit.agreement.p_value < 1e-6
    left, spread = result.side_bias
    assert abs(left - 0.5) < 1.5 * spread


def test_drawing_again_with_one_seed_gives_the_same_intervals(questionnaire):
    given = ballots(questionnaire, [NINE] * 5, seed=3)
    first, again = (fit_votes(given, "wrinkles", resamples=50, seed=9).everyone for _ in range(2))
    assert first == again


def test_coin_flippers_are_named_and_left_out(questionnaire):
    given = ballots(questionnaire, [2 * NINE] * 8 + [None] * 3, seed=1)
    result = fit_votes(given, "wrinkles", resamples=50)
    out = {r.judge: r.excluded for r in result.records if r.excluded}
    assert set(out) == {"judge 8", "judge 9", "judge 10"}
    assert all("catch pairs wrong" in reason for reason in out.values())
    assert result.everyone.votes == 11 * 36
    assert result.screened.votes == 8 * 36
    # Coins pull strengths together; without them the spread grows.
    spread = [
        next(iter(fit.strengths.values())).value for fit in (result.everyone, result.screened)
    ]
    assert spread[1] > 1.15 * spread[0]


def test_records_of_a_judge(questionnaire):
    given = ballots(questionnaire, [4 * NINE, None], seed=2)
    steady, coin = judge_records(given, "wrinkles")
    assert (steady.catches, steady.catches_right, steady.repeats) == (4, 4, 4)
    assert steady.zeta > 0.9 > coin.zeta
    assert steady.seconds == 5.0
    assert steady.excluded == ""
    assert steady.votes == 36


def test_one_wrong_catch_pair_needs_a_low_zeta_beside_it(questionnaire):
    def slip(given):
        done = []
        for v in given.votes:
            if v.kind == "catch" and v.judge not in done:
                done.append(v.judge)
                v = replace(v, chosen=v.left if v.chosen == v.right else v.right)
            yield v

    given = ballots(questionnaire, [6 * NINE, 0 * NINE], seed=6)
    given = replace(given, votes=tuple(slip(given)))
    steady, guessing = judge_records(given, "wrinkles")
    assert steady.catches_right == guessing.catches_right == 3
    assert steady.excluded == ""
    assert "1 of 4 catch pairs wrong and zeta" in guessing.excluded


def test_an_item_that_always_wins_is_reported_and_has_no_bound(questionnaire):
    theta = NINE.copy()
    theta[4] = 40.0
    result = fit_votes(ballots(questionnaire, [theta] * 10, seed=1), "wrinkles", resamples=50)
    assert result.everyone.groups[0] == ("s4",)
    assert not result.everyone.strengths["s4"].bounded
    top, *others = result.everyone.neighbours
    assert top.upper == "s4"
    assert not top.steps.bounded
    assert all(pair.steps.bounded for pair in others)
    assert "no vote went against {s4} > {" in result.notices[-1]


def test_stimuli_never_compared_are_named(questionnaire):
    given = ballots(questionnaire, [NINE] * 4)
    few = {"s0", "s1", "s2"}
    given = without(given, lambda v: len({v.left, v.right} & few) != 1)
    with pytest.raises(InputError, match=r"got 2 sets of stimuli that were never compared: s0, s1"):
        fit_votes(given, "wrinkles")
    with pytest.raises(InputError, match="votes: got none on 'preference'"):
        fit_votes(without(given, lambda v: v.question == "wrinkles"), "preference")


def test_one_judge_has_no_interval_over_judges(questionnaire):
    fit = fit_votes(ballots(questionnaire, [0.2 * NINE], seed=4), "wrinkles").everyone
    assert fit.strengths["s0"].half_width is None
    assert fit.strengths["s0"].fisher_half_width > 0
    assert fit.agreement is None


def test_no_catch_pair_no_screening():
    questionnaire = make_questionnaire(5, 0)
    result = fit_votes(ballots(questionnaire, [NINE[:5]] * 3 + [None]), "preference", resamples=20)
    assert result.screened is None
    assert "no catch pair was answered: no judge can be left out" in result.notices


@pytest.mark.parametrize(
    ("stimuli", "spacing", "judges"), [(6, 0.36, 10), (9, 0.36, 20), (9, 1.0, 40)]
)
def test_the_plan_agrees_with_simulated_juries(stimuli, spacing, judges):
    """Spread and order of 1,500 fits; 4 standard errors of the spread are 3 %."""
    rng = np.random.default_rng(stimuli)
    theta = spacing * STEP * np.arange(stimuli)
    p = np.triu(1 / (1 + np.exp(theta[None, :] - theta[:, None])), 1)
    upper = np.triu(rng.binomial(judges, p, (1500, stimuli, stimuli)), 1)
    lower = np.triu(judges - upper, 1).transpose(0, 2, 1)
    steps = np.diff(fit_strengths((upper + lower).astype(float)).theta, axis=1) / STEP
    plan = plan_jury(judges, stimuli, spacing=spacing)
    assert 1.96 * steps.std(axis=0).mean() == pytest.approx(plan.half_width, rel=0.06)
    assert np.mean(steps > 0) == pytest.approx(plan.right_order, abs=0.02)


def test_the_plan_falls_with_the_root_of_the_judges():
    few, many = plan_jury(5, 9), plan_jury(45, 9)
    assert many.half_width == pytest.approx(few.half_width / 3)
    assert few.right_order < many.right_order < 1
    assert (few.trials, few.minutes) == (36, 3.6)
    with pytest.raises(InputError, match="stimuli: got 2, expected 3 or more"):
        plan_jury(5, 2)
