"""The proof: better only beyond error and scatter, and only with all solves at rest."""

import math

import numpy as np
import pytest
from scipy.stats import t

from seatlook.improvement.objective import Parts
from seatlook.improvement.proof import Proof


def parts(*totals):
    return tuple(Parts(w2=total, strain=0.0, gap=0.0) for total in totals)


def proof(before, after, *, error=0.0, **more):
    seeds = tuple(range(len(before)))
    return Proof(seeds=seeds, before=parts(*before), after=parts(*after), error=error, **more)


def test_the_scatter_is_that_of_the_mean_of_paired_differences():
    found = proof((5.0, 6.0, 9.0), (4.0, 4.0, 6.0))
    assert found.gains == (1.0, 2.0, 3.0)
    width = t.interval(0.95, 2, loc=2.0, scale=np.std([1, 2, 3], ddof=1) / math.sqrt(3))
    assert found.scatter == pytest.approx(2.0 - width[0])
    assert not found.better  # 2.0 is below 2.48


def test_better_means_beyond_error_and_scatter_together():
    before, after = (5.0, 6.0, 9.0), (4.0, 5.05, 7.95)
    gain, scatter = (lambda p: (p.gain, p.scatter))(proof(before, after))
    assert proof(before, after, error=0.99 * (gain - scatter)).better
    assert not proof(before, after, error=1.01 * (gain - scatter)).better
    assert "not proven" in proof(before, after, error=gain).sentence


def test_a_solve_that_is_not_at_rest_proves_nothing():
    found = proof((5.0, 5.0), (1.0, 1.0), unsolved=("the start with seed 1: it moves",))
    assert not found.better
    assert "it moves" in found.sentence


def test_one_seed_proves_nothing():
    assert not proof((5.0,), (1.0,)).better
