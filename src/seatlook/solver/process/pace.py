"""Whether a search that goes in rounds will arrive in those that are left."""

from __future__ import annotations

import math
from collections.abc import Sequence

_WINDOW = 4  # rounds; the best residual of one window against that of the one before


def too_slow(residuals: Sequence[float], goal: float, rounds: float) -> bool:
    """Whether residuals fall so slowly that the goal is out of reach.

    Single rounds go up and down while folds form, so windows of four rounds are compared. Before
    there are two of them nothing is said.

    Parameters
    ----------
    residuals : at the end of every round so far
    goal : residual at rest
    rounds : how many are left

    Examples
    --------
    >>> too_slow([0.5**k for k in range(8)], 1e-3, 10.0)
    False
    >>> too_slow([0.5**k for k in range(8)], 1e-3, 1.0)
    True
    """
    if len(residuals) < 2 * _WINDOW:
        return False
    before, now = (min(residuals[a:b]) for a, b in ((-2 * _WINDOW, -_WINDOW), (-_WINDOW, None)))
    if now <= goal:
        return False
    gained = math.log(before / now)
    return gained <= 0.0 or math.log(now / goal) / gained * _WINDOW > rounds
