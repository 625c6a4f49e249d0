"""Which points of a surface are seen from a place: rays to them that nothing cuts."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

_END = 1e-9  # share of a ray at its ends that cuts nothing


def is_seen(
    points: FloatArray, eye: FloatArray, vertices: FloatArray, faces: IntArray
) -> npt.NDArray[np.bool_]:
    """Whether no triangle cuts the straight way from ``eye`` (3,) to each point (k,).

    Points on a surface must be lifted off it a little, to the side from which they shall be seen.
    Every ray is tried against every triangle (Möller and Trumbore 1997).

    Parameters
    ----------
    points : (k, 3); eye : (3,); vertices : (n, 3); faces : (m, 3), all in one unit

    Examples
    --------
    >>> wall = np.array([[0.0, -1.0, -1.0], [0.0, 2.0, -1.0], [0.0, -1.0, 2.0]])
    >>> places = np.array([[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0], [-1.0, 9.0, 0.0]])
    >>> is_seen(places, np.array([2.0, 0.0, 0.0]), wall, np.array([[0, 1, 2]])).tolist()
    [False, True, True]
    """
    a, b, c = (vertices[corner] for corner in faces.T)
    u, v = b - a, c - a
    from_eye = eye - a
    q = np.cross(from_eye, u)
    seen = np.ones(len(points), dtype=bool)
    for k, point in enumerate(points):
        ray = point - eye
        p = np.cross(ray, v)
        volume = np.einsum("md,md->m", u, p)
        crossed = np.abs(volume) > 0
        inverse = np.divide(1.0, volume, out=np.zeros_like(volume), where=crossed)
        first = np.einsum("md,md->m", from_eye, p) * inverse
        second = (q @ ray) * inverse
        at = np.einsum("md,md->m", v, q) * inverse
        inside = (first >= 0) & (second >= 0) & (first + second <= 1)
        seen[k] = not (crossed & inside & (at > _END) & (at < 1 - _END)).any()
    return seen
