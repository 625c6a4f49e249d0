"""Strengths against hand-solved cases, derivatives, an independent program and broken data."""

import choix
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from seatlook.errors import InputError
from seatlook.jury import bradley_terry
from seatlook.jury.bradley_terry import STEP, components, fit_strengths, groups

TINY = 1e-9


def choices(theta, number, seed=0, nu=0.0):
    """Random wins and ties of a full design."""
    rng = np.random.default_rng(seed)
    n = len(theta)
    wins, ties = np.zeros((n, n)), np.zeros((n, n))
    for i in range(n):
        for j in range(i):
            a = (theta[i] - theta[j]) / 2
            p = np.array([np.exp(a), np.exp(-a), nu])
            wins[i, j], wins[j, i], ties[i, j] = rng.multinomial(number, p / p.sum())
    return wins, ties + ties.T


def test_two_items_by_hand():
    wins = np.array([[0, 30], [10, 0]])
    fitted = fit_strengths(wins, penalty=TINY)
    assert np.diff(fitted.theta)[0] == pytest.approx(-STEP)
    difference = np.array([1, -1])
    # Binomial information of the logit: N p q.
    assert difference @ fitted.covariance @ difference == pytest.approx(1 / (40 * 0.75 * 0.25))
    assert fitted.log_tie is None


def test_ties_of_two_items_by_hand():
    """P = 6/10, 2/10 and a tie 2/10: theta differs by ln 3, nu = tie / sqrt(win loss)."""
    fitted = fit_strengths(np.array([[0, 60], [20, 0]]), np.array([[0, 20], [20, 0]]), penalty=TINY)
    assert fitted.theta[0] - fitted.theta[1] == pytest.approx(np.log(3))
    assert np.exp(fitted.log_tie) == pytest.approx(20 / np.sqrt(60 * 20))


@pytest.mark.parametrize("n", [3, 7])
@pytest.mark.parametrize("nu", [0.0, 0.6])
def test_derivatives(n, nu):
    """Taylor: the error of the quadratic model falls with the third power of the step."""
    rng = np.random.default_rng(n)
    wins, ties = choices(rng.normal(size=n), 12, seed=n, nu=nu)
    problem = bradley_terry._Problem(
        difference=(wins - wins.T)[None],
        number=(wins + wins.T + ties)[None],
        ties=np.array([ties.sum() / 2]),
        penalty=0.3,
    )
    x, d = rng.normal(size=(1, n + 1)), rng.normal(size=(1, n + 1))
    value, (gradient, hessian) = problem.value(x), problem.derivatives(x)
    errors = []
    for step in (1e-1, 5e-2, 2.5e-2):
        model = value + step * (gradient * d).sum() - step**2 / 2 * (d @ hessian[0] @ d.T)[0, 0]
        errors.append(abs(problem.value(x + step * d) - model)[0])
    rates = np.diff(np.log2(errors))
    assert (rates < -2.7).all(), rates
    assert errors[0] < 0.1 * wins.sum()


@pytest.mark.parametrize("seed", range(5))
def test_agrees_with_an_independent_program(seed):
    theta = np.random.default_rng(seed).normal(0, 0.8, 9)
    wins, _ = choices(theta, 20, seed)
    assert len(groups(wins)) == 1
    theirs = choix.opt_pairwise(9, [p for p in np.argwhere(wins) for _ in range(int(wins[*p]))])
    ours = fit_strengths(wins, penalty=TINY).theta
    np.testing.assert_allclose(ours, theirs - theirs.mean(), atol=1e-4)


def test_the_penalty_is_felt_by_a_thousandth():
    wins, _ = choices(np.linspace(-1.5, 1.5, 9), 20, 1)
    weak, none = fit_strengths(wins).theta, fit_strengths(wins, penalty=TINY).theta
    np.testing.assert_allclose(weak, none, atol=2e-3)


def test_many_sets_at_once_are_each_alone():
    theta = np.linspace(-1, 1, 5)
    sets = [choices(theta, 10, seed, nu=0.4) for seed in range(6)]
    wins, ties = (np.array(part) for part in zip(*sets, strict=True))
    together = fit_strengths(wins.reshape(2, 3, 5, 5), ties.reshape(2, 3, 5, 5))
    assert together.theta.shape == (2, 3, 5)
    for k, (w, t) in enumerate(sets):
        alone = fit_strengths(w, t, start=theta)
        np.testing.assert_allclose(together.theta.reshape(6, 5)[k], alone.theta, atol=1e-8)
        np.testing.assert_allclose(
            together.covariance.reshape(6, 5, 5)[k], alone.covariance, atol=1e-8
        )


def test_an_item_that_always_wins_stays_finite_and_is_reported():
    wins, _ = choices(np.zeros(5), 10)
    wins[0, 1:], wins[1:, 0] = 10, 0
    assert groups(wins) == [[0], [1, 2, 3, 4]]
    fitted = fit_strengths(wins)
    assert fitted.theta[0] == fitted.theta.max()
    assert np.isfinite(fitted.theta).all()
    # The ridge alone sets the value: a tenth of it moves the strength by more than its rounding.
    assert fit_strengths(wins, penalty=1e-3).theta[0] > fitted.theta[0] + 0.5


def test_a_tie_links_both_ways():
    wins = np.array([[0, 4, 4], [0, 0, 2], [0, 2, 0]])
    ties = np.zeros((3, 3))
    ties[0, 2] = ties[2, 0] = 1
    assert groups(wins) == [[0], [1, 2]]
    assert groups(wins, ties) == [[0, 1, 2]]


def test_a_disconnected_graph_is_seen():
    wins = np.zeros((5, 5))
    wins[0, 1] = wins[1, 0] = wins[3, 4] = wins[4, 2] = 1
    assert components(wins) == [[0, 1], [2, 3, 4]]


@settings(max_examples=40, deadline=None)
@given(st.integers(2, 7), st.integers(0, 10_000), st.floats(0, 3))
def test_renaming_and_exchanging_sides(n, seed, nu):
    """Permuted items permute strengths; reversed choices negate them."""
    rng = np.random.default_rng(seed)
    wins, ties = choices(rng.normal(size=n), 8, seed, nu)
    theta = fit_strengths(wins, ties).theta
    order = rng.permutation(n)
    permuted = fit_strengths(wins[np.ix_(order, order)], ties[np.ix_(order, order)]).theta
    np.testing.assert_allclose(permuted, theta[order], atol=1e-7)
    np.testing.assert_allclose(fit_strengths(wins.T, ties).theta, -theta, atol=1e-7)


@pytest.mark.parametrize(
    ("wins", "ties", "message"),
    [
        (-np.ones((3, 3)), None, "wins: got nan, inf or below 0"),
        (np.eye(3), None, "wins: got an item against itself"),
        (np.zeros((3, 3)), np.triu(np.ones((3, 3)), 1), r"ties\[i, j\] != ties\[j, i\]"),
        (np.zeros((3, 2)), None, r"shapes \(3, 2\), \(3, 2\), expected twice"),
    ],
)
def test_counts_that_are_none(wins, ties, message):
    with pytest.raises(InputError, match=message):
        fit_strengths(wins, ties)
