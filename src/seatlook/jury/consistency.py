"""Does a judge agree with himself, and do judges agree (Kendall and Babington Smith 1940).

A tie stands as 1/2 on both sides; figures are then the mean over all ways of breaking the ties.
"""

from __future__ import annotations

import functools
from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2

from seatlook.errors import InputError
from seatlook.model import FloatArray

# Below this number of stimuli a coin often looks consistent, so zeta cannot screen.
FEWEST_TO_SCREEN = 8
_COINS = 20_000


@dataclass(frozen=True, slots=True, kw_only=True)
class Agreement:
    """Kendall's u over m judges: 1 = all alike, about 0 = by chance; p of "by chance"."""

    u: float
    p_value: float


def circular_triads(wins: FloatArray) -> FloatArray:
    """Return d (...), the number of circles a > b > c > a in complete sets of choices.

    Parameters
    ----------
    wins : (..., n, n)   1 where i was chosen over j

    Examples
    --------
    >>> float(circular_triads(np.array([[0, 1, 0], [0, 0, 1], [1, 0, 0]])))
    1.0
    """
    n = wins.shape[-1]
    score = wins.sum(axis=-1)
    # The second sum is the variance that broken ties add to the scores.
    squares = (score**2).sum(axis=-1) + (wins * (1 - wins)).sum(axis=(-1, -2))
    return np.asarray(n * (n - 1) * (2 * n - 1) / 12 - squares / 2)


def consistence(wins: FloatArray) -> FloatArray:
    """Coefficient of consistence zeta (...): 1 = no circle, 0 = as many as there can be.

    Parameters
    ----------
    wins : (..., n, n)   as in :func:`circular_triads`, n >= 3, every pair judged once
    """
    n = wins.shape[-1]
    if n < 3 or not np.allclose(wins + np.swapaxes(wins, -1, -2), 1 - np.eye(n)):
        raise InputError.single(
            "wins", got="an incomplete set", expected="every pair of three or more judged once"
        )
    most = (n**3 - n) / 24 if n % 2 else (n**3 - 4 * n) / 24
    return np.asarray(1 - circular_triads(wins) / most)


@functools.lru_cache(maxsize=32)
def coin_consistence(stimuli: int, share: float = 0.95) -> float:
    """Return the zeta that a share of judges who flip a coin stay at or below (simulated, seeded).

    Examples
    --------
    >>> round(coin_consistence(8), 1)
    0.6
    """
    rng = np.random.default_rng(stimuli)
    upper = np.triu(rng.integers(0, 2, (_COINS, stimuli, stimuli)).astype(float), 1)
    lower = np.swapaxes(np.triu(1 - upper, 1), -1, -2)
    return float(np.quantile(consistence(upper + lower), share))


def agreement(wins: FloatArray) -> Agreement:
    """Kendall's coefficient of agreement of m >= 3 judges who judged every pair once.

    Parameters
    ----------
    wins : (m, n, n)   as in :func:`circular_triads`

    Notes
    -----
    The p value is Kendall's chi-square approximation.
    """
    m, n = len(wins), wins.shape[-1]
    if m < 3:
        raise InputError.single("judges", got=m, expected="three or more")
    total = wins.sum(axis=0)
    pairs, doubles = n * (n - 1) / 2, m * (m - 1) / 2
    off = total[~np.eye(n, dtype=bool)]
    sigma = float((off * (off - 1) / 2).sum() + (wins * (1 - wins)).sum() / 2)
    u = 2 * sigma / (doubles * pairs) - 1
    statistic = 4 / (m - 2) * (sigma - pairs * doubles * (m - 3) / (2 * (m - 2)))
    freedom = pairs * m * (m - 1) / (m - 2) ** 2
    return Agreement(u=u, p_value=float(chi2.sf(statistic, freedom)))
