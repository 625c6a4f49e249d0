"""What neighbouring points of a surface gather of light, shared among them.

Few rays that meet a highlight by chance would let single points glow. A point trusts those beside
it as far as they see the same: where what surrounds it is far and the surface is not bent.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from scipy import sparse

from seatlook.model import FloatArray, IntArray

# Share of the distance to what surrounds a point within which others see the same, power of the
# cosine between normals, and how often the distances are shared first; judgement.
_NEAR, _UNBENT, _ROUGH = 0.7, 8, 3


@dataclass(frozen=True, slots=True)
class Neighbours:
    """Points that lie side by side: ``pairs`` (e, 2), and ``trust`` (n, n) between them, 0 to 1."""

    pairs: IntArray
    trust: sparse.csr_array

    def trimmed(self, values: FloatArray) -> FloatArray:
        """Values (n, d) held between the least and the greatest of those beside them."""
        a, b = self.pairs.T
        low, high = np.full(values.shape, np.inf), np.full(values.shape, -np.inf)
        for here, there in ((a, b), (b, a)):
            np.minimum.at(low, here, values[there])
            np.maximum.at(high, here, values[there])
        alone = ~np.isfinite(low)
        low[alone], high[alone] = values[alone], values[alone]
        return np.clip(values, low, high)

    def shared(self, values: FloatArray, *, times: int) -> FloatArray:
        """Means (n, d) of the values and those beside them, again and again."""
        weight = 1.0 + self.trust @ np.ones((len(values), 1))
        for _ in range(times):
            values = (values + self.trust @ values) / weight
        return np.asarray(values)


def neighbours(
    points: FloatArray, normals: FloatArray, pairs: IntArray, around: FloatArray
) -> Neighbours:
    """Trust between points that lie side by side.

    Parameters
    ----------
    points, normals : (n, 3); pairs : (e, 2)
    around : (n,) [m]    how far what a point sees is, as a harmonic mean; inf where it sees nothing
    """
    n, (a, b) = len(points), pairs.T
    places = (np.concatenate([a, b]), np.concatenate([b, a]))
    beside = sparse.csr_array((np.ones(2 * len(a)), places), shape=(n, n))
    # Few rays know roughly how far it is: what those beside know counts as well.
    close, count = 1.0 / around, 1.0 + np.bincount(pairs.ravel(), minlength=n)
    for _ in range(_ROUGH):
        close = (close + np.asarray(beside @ close)) / count
    apart = np.linalg.norm(points[a] - points[b], axis=1)
    near = np.maximum(0.0, 1.0 - apart * np.maximum(close[a], close[b]) / _NEAR)
    bent = np.maximum(0.0, (normals[a] * normals[b]).sum(axis=1)) ** _UNBENT
    trust = np.concatenate([near * bent] * 2)
    return Neighbours(pairs, sparse.csr_array((trust, places), shape=(n, n)))
