"""How much a jury of a given size can tell, before anybody is asked."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy.stats import norm

from seatlook.errors import InputError
from seatlook.jury.bradley_terry import STEP
from seatlook.model import FloatArray

# Spacing of neighbours in steps: .36 is a set of designs that are hard to tell apart.
SPACING = 0.36
SECONDS_PER_TRIAL = 6.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Plan:
    """What to expect of n judges and m stimuli, every pair judged once by each.

    Parameters
    ----------
    half_width : [steps]   of the 95 % interval of a difference between neighbours, mean over them
    right_order : share of neighbours that the jury ranks rightly
    separated : share of neighbours whose interval leaves out 0
    trials : comparisons per judge and question, repeats and catch pairs not counted
    minutes : per judge and question, at 6 s a comparison
    """

    judges: int
    stimuli: int
    spacing: float
    half_width: float
    right_order: float
    separated: float
    trials: int
    minutes: float


def plan_jury(judges: int, stimuli: int, *, spacing: float = SPACING) -> Plan:
    """Expect half-widths from the Fisher information at equally spaced strengths.

    Parameters
    ----------
    judges : 1 or more; stimuli : 3 or more
    spacing : float [steps]   distance of neighbours; 1 step = three of four choices

    Notes
    -----
    Judges who differ in taste widen the interval; the fit's resampled judges will show it.

    Examples
    --------
    >>> [round(plan_jury(judges, 9).half_width, 2) for judges in (5, 20, 80)]
    [0.89, 0.45, 0.22]
    """
    for name, value, least in (("judges", judges, 1), ("stimuli", stimuli, 3)):
        if value < least:
            raise InputError.single(name, got=value, expected=f"{least} or more")
    if not 0 <= spacing < 20:
        raise InputError.single("spacing", got=spacing, expected="0 to 20 steps")
    theta = spacing * STEP * np.arange(stimuli, dtype=float)
    sd = _neighbour_deviation(theta, judges) / STEP
    reach = norm.ppf(0.975) * sd
    pairs = stimuli * (stimuli - 1) // 2
    return Plan(
        judges=judges,
        stimuli=stimuli,
        spacing=spacing,
        half_width=float(reach.mean()),
        right_order=float(norm.cdf(spacing / sd).mean()),
        separated=float(
            (norm.sf((reach - spacing) / sd) + norm.cdf((-reach - spacing) / sd)).mean()
        ),
        trials=pairs,
        minutes=pairs * SECONDS_PER_TRIAL / 60,
    )


def _neighbour_deviation(theta: FloatArray, judges: int) -> FloatArray:
    """Standard deviation of the fitted differences between neighbours, (m - 1,) [logit]."""
    p = 1 / (1 + np.exp(theta[None, :] - theta[:, None]))
    information = -judges * p * (1 - p)
    np.fill_diagonal(information, 0.0)
    np.fill_diagonal(information, -information.sum(axis=1))
    covariance = np.linalg.pinv(information, hermitian=True)
    contrast = np.diff(np.eye(len(theta)), axis=0)
    return np.asarray(np.sqrt(np.einsum("ki,ij,kj->k", contrast, covariance, contrast)))
