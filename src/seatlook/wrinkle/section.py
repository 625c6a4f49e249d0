"""Height profile along a line drawn on a panel, as a straight edge laid on it would show."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from seatlook.errors import InputError
from seatlook.model import Cover, FloatArray, IntArray

_STEP = 0.2  # of h between samples


@dataclass(frozen=True, slots=True, kw_only=True)
class Section:
    """A profile across the cover.

    Parameters
    ----------
    along : (k,) float64 [m]     distance on the flat panel from the middle of the line
    height : (k,) float64 [m]    above the straight edge that rests on the profile, so <= 0
    points : (k, 3) float64 [m]  the same points in space
    """

    along: FloatArray
    height: FloatArray
    points: FloatArray

    @property
    def depth(self) -> float:
        """Largest gap [m] below the straight edge."""
        return float(-self.height.min())


def section(
    cover: Cover,
    positions: FloatArray,
    *,
    panel: int,
    middle: FloatArray,
    direction: FloatArray,
    half_length: float,
) -> Section:
    """Cut the solved cover along a straight line of a flat panel.

    Parameters
    ----------
    positions : (n, 3) float64 [m]
    panel : index into ``cover.panel_names``
    middle : (2,) float64 [m]        middle of the line, in ``cover.rest`` coordinates
    direction : (2,) float64         along the line, any length but 0
    half_length : float [m]          to each side; the line ends where it leaves the panel

    Raises
    ------
    InputError
        A middle outside the panel, a line without length.
    """
    length = float(np.linalg.norm(direction))
    if not (length > 0 and half_length > 0):
        raise InputError.single(
            "section", got=f"direction {length:g}, half length {half_length:g}", expected="above 0"
        )
    count = int(np.ceil(half_length / (_STEP * cover.element_size)))
    along = np.linspace(-half_length, half_length, 2 * count + 1)
    line = np.asarray(middle) + along[:, None] * np.asarray(direction) / length
    face, weight = _located(cover, panel, line)
    if face[count] < 0:
        raise InputError.single(
            "section", got=f"middle {np.asarray(middle).tolist()}",
            expected=f"a point of panel {cover.panel_names[panel]}",
        )  # fmt: skip
    outside = np.flatnonzero(face < 0)
    low = int(outside[outside < count].max(initial=-1)) + 1
    high = int(outside[outside > count].min(initial=len(along)))
    inside = slice(low, high)
    points = np.einsum("kc,kcd->kd", weight[inside], positions[cover.faces[face[inside]]])
    height = _below_edge(points, _normal(cover, positions, face[inside]))
    return Section(along=along[inside], height=height, points=points)


def _located(cover: Cover, panel: int, line: FloatArray) -> tuple[IntArray, FloatArray]:
    """Return the face (k,) of each point, -1 outside, and barycentric weights (k, 3)."""
    mine = np.flatnonzero(cover.panel == panel)
    p = cover.rest[cover.faces[mine]]
    near = ((p.max(axis=1) >= line.min(axis=0)) & (p.min(axis=1) <= line.max(axis=0))).all(axis=1)
    mine, p = mine[near], p[near]
    if not len(mine):
        return np.full(len(line), -1), np.zeros((len(line), 3))
    inverse = np.linalg.inv(np.stack([p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]], axis=2))
    w = np.einsum("fij,kfj->kfi", inverse, line[:, None] - p[None, :, 0])
    weight = np.concatenate([1.0 - w.sum(axis=2, keepdims=True), w], axis=2)
    best = weight.min(axis=2).argmax(axis=1)
    chosen = weight[np.arange(len(line)), best]
    return np.where(chosen.min(axis=1) >= -1e-9, mine[best], -1), chosen


def _normal(cover: Cover, positions: FloatArray, face: IntArray) -> FloatArray:
    """Mean outward normal (3,) of the faces run through."""
    p = positions[cover.faces[face]]
    total = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]).sum(axis=0)
    return np.asarray(total / np.linalg.norm(total))


def _below_edge(points: FloatArray, normal: FloatArray) -> FloatArray:
    """Heights above the upper convex hull of the profile in its own plane; none is above 0."""
    chord = points[-1] - points[0]
    axis = chord - (chord @ normal) * normal
    size = float(np.linalg.norm(axis))
    if size == 0:
        return np.zeros(len(points))
    x, z = (points - points[0]) @ (axis / size), (points - points[0]) @ normal
    order = np.argsort(x, kind="stable")
    hull: list[int] = []
    for i in order:
        while len(hull) > 1 and _turns_up(x, z, hull[-2], hull[-1], int(i)):
            hull.pop()
        hull.append(int(i))
    return np.asarray(np.minimum(z - np.interp(x, x[hull], z[hull]), 0.0))


def _turns_up(x: FloatArray, z: FloatArray, a: int, b: int, c: int) -> bool:
    """Whether b lies on or below the line from a to c."""
    return bool((x[b] - x[a]) * (z[c] - z[a]) >= (z[b] - z[a]) * (x[c] - x[a]))
