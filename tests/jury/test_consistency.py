"""Kendall's coefficients on small tables known by hand."""

import itertools

import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.jury.consistency import agreement, circular_triads, coin_consistence, consistence


def count_circles(wins):
    return sum(
        wins[a, b] == wins[b, c] == wins[c, a]
        for a, b, c in itertools.combinations(range(len(wins)), 3)
    )


def coin(n, rng):
    upper = np.triu(rng.integers(0, 2, (n, n)).astype(float), 1)
    return upper + np.triu(1 - upper, 1).T


@pytest.mark.parametrize("n", [3, 4, 7, 8])
def test_the_formula_counts_circles(n):
    rng = np.random.default_rng(n)
    for _ in range(20):
        wins = coin(n, rng)
        assert circular_triads(wins) == count_circles(wins)


def test_ranking_is_consistent_and_the_most_circular_set_is_not():
    ranking = np.triu(np.ones((6, 6)), 1)
    assert consistence(ranking) == 1
    # Each of five beats the next two round a circle.
    wheel = np.array([[(j - i) % 5 in (1, 2) for j in range(5)] for i in range(5)], dtype=float)
    assert consistence(wheel) == 0


def broken(wins):
    """Every way of breaking the ties of one set."""
    tied = [(i, j) for i, j in np.argwhere(wins == 0.5) if i < j]
    for bits in itertools.product([0.0, 1.0], repeat=len(tied)):
        out = wins.copy()
        for (i, j), bit in zip(tied, bits, strict=True):
            out[i, j], out[j, i] = bit, 1 - bit
        yield out


def test_ties_give_the_mean_over_all_ways_of_breaking_them():
    rng = np.random.default_rng(0)
    judges = [coin(5, rng) for _ in range(3)]
    for wins, (i, j) in zip(judges, [(0, 1), (2, 4), (1, 3)], strict=True):
        wins[i, j] = wins[j, i] = 0.5
    judges[0][3, 4] = judges[0][4, 3] = 0.5
    circles = [count_circles(way) for way in broken(judges[0])]
    assert circular_triads(judges[0]) == pytest.approx(np.mean(circles))
    ways = itertools.product(*(broken(wins) for wins in judges))
    u = np.mean([agreement(np.array(way)).u for way in ways])
    assert agreement(np.array(judges)).u == pytest.approx(u)


@pytest.mark.parametrize(
    ("stimuli", "zeta"), [(5, 1.0), (6, 0.875), (7, 0.714), (8, 0.6), (9, 0.533)]
)
def test_what_a_coin_reaches(stimuli, zeta):
    assert coin_consistence(stimuli) == pytest.approx(zeta, abs=0.051)


def test_agreement_at_its_ends():
    ranking = np.triu(np.ones((5, 5)), 1)
    alike = agreement(np.repeat(ranking[None], 6, axis=0))
    assert alike.u == pytest.approx(1)
    assert alike.p_value < 1e-10
    split = agreement(np.concatenate([[ranking] * 3, [ranking.T] * 3]))
    assert split.u == pytest.approx(-1 / 5)


def test_coins_agree_by_chance():
    """p is about uniform: the share below 0.05 of 400 juries of coins."""
    rng = np.random.default_rng(4)
    p = [agreement(np.array([coin(6, rng) for _ in range(8)])).p_value for _ in range(400)]
    assert 0.02 < np.mean(np.array(p) < 0.05) < 0.09
    assert 0.4 < np.mean(p) < 0.6


def test_incomplete_sets_are_refused():
    with pytest.raises(InputError, match="got an incomplete set, expected every pair"):
        consistence(np.zeros((4, 4)))
    with pytest.raises(InputError, match="judges: got 2, expected three or more"):
        agreement(np.zeros((2, 4, 4)))
