"""Derivative tests: halving the step must shrink the error by the power that theory says."""

import numpy as np


def slopes(energy, x, *, seed=0, size=1e-4, halvings=6):
    """Observed orders of E(x + h d) - E - h g.d (2) and g(x + h d) - g - h H d (2)."""
    rng = np.random.default_rng(seed)
    d = rng.normal(size=x.shape)
    d /= np.abs(d).max()
    g = np.zeros_like(x)
    value = energy.value(x, g)
    Hd = (energy.hessian(x) @ d.ravel()).reshape(x.shape)
    first, second = [], []
    steps = size * 0.5 ** np.arange(halvings)
    for h in steps:
        moved = np.zeros_like(x)
        new = energy.value(x + h * d, moved)
        first.append(abs(new - value - h * np.sum(g * d)))
        second.append(np.abs(moved - g - h * Hd).max())
    return _order(steps, first), _order(steps, second)


def _order(steps, errors):
    return np.polyfit(np.log(steps), np.log(errors), 1)[0]
