"""Height profile along a line drawn on a panel, as a straight edge laid on it would show."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from seatlook.errors import InputError
from seatlook.model import Cover, FloatArray, IntArray

_STEP = 0.2  # of h between samples
_TOGETHER = 16  # samples that are looked for among the same faces


@dataclass(frozen=True, slots=True, kw_only=True)
class Section:
    """A profile across the cover.

    Parameters
    ----------
    along : (k,) float64 [m]     distance on the flat panel from the middle of the line
    height : (k,) float64 [m]    above the straight edge that rests on the profile, so <= 0
    points : (k, 3) float64 [m]  the same points in space
    faces : (k,) int64           in which they lie
    intended : (k,) float64 [m]  height of the shape that was meant above the same edge, of either
        sign; None where it is not asked for
    """

    along: FloatArray
    height: FloatArray
    points: FloatArray
    faces: IntArray
    intended: FloatArray | None = None

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
    design: FloatArray | None = None,
) -> Section:
    """Cut the solved cover along a straight line of a flat panel.

    Parameters
    ----------
    positions : (n, 3) float64 [m]
    panel : index into ``cover.panel_names``
    middle : (2,) float64 [m]        middle of the line, in ``cover.rest`` coordinates
    direction : (2,) float64         along the line, any length but 0
    half_length : float [m]          to each side; the line ends where it leaves the panel
    design : (n, 3) float64 [m]      the shape that was meant, to be shown beside the solved one

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
    face, weight = located(cover, panel, line)
    if face[count] < 0:
        raise InputError.single(
            "section", got=f"middle {np.asarray(middle).tolist()}",
            expected=f"a point of panel {cover.panel_names[panel]}",
        )  # fmt: skip
    outside = np.flatnonzero(face < 0)
    low = int(outside[outside < count].max(initial=-1)) + 1
    high = int(outside[outside > count].min(initial=len(along)))
    inside = slice(low, high)
    corners = cover.faces[face[inside]]
    points = np.einsum("kc,kcd->kd", weight[inside], positions[corners])
    edge = _StraightEdge.on(points, _normal(cover, positions, face[inside]))
    meant = None if design is None else np.einsum("kc,kcd->kd", weight[inside], design[corners])
    return Section(
        along=along[inside],
        height=np.minimum(edge.height(points), 0.0),
        points=points,
        faces=face[inside],
        intended=None if meant is None else edge.height(meant),
    )


def located(cover: Cover, panel: int, line: FloatArray) -> tuple[IntArray, FloatArray]:
    """Find points (k, 2) of a flat panel: their faces (k,), -1 outside, and weights (k, 3)."""
    rows = _touching(cover, np.flatnonzero(cover.panel == panel), line)
    face, weight = np.full(len(line), -1), np.zeros((len(line), 3))
    for begin in range(0, len(line), _TOGETHER):
        part = slice(begin, begin + _TOGETHER)
        some = _touching(cover, rows, line[part])
        if not len(some):
            continue
        p = cover.rest[cover.faces[some]]
        inverse = np.linalg.inv(np.stack([p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]], axis=2))
        w = np.einsum("fij,kfj->kfi", inverse, line[part, None] - p[None, :, 0])
        shares = np.concatenate([1.0 - w.sum(axis=2, keepdims=True), w], axis=2)
        best = shares.min(axis=2).argmax(axis=1)
        chosen = shares[np.arange(len(best)), best]
        face[part] = np.where(chosen.min(axis=1) >= -1e-9, some[best], -1)
        weight[part] = chosen
    return face, weight


def _touching(cover: Cover, rows: IntArray, line: FloatArray) -> IntArray:
    """Return the faces among some that reach into the box round a line (k, 2)."""
    corner = cover.rest[cover.faces[rows]]
    into = (corner.max(axis=1) >= line.min(axis=0)) & (corner.min(axis=1) <= line.max(axis=0))
    return np.asarray(rows[into.all(axis=1)])


def _normal(cover: Cover, positions: FloatArray, face: IntArray) -> FloatArray:
    """Mean outward normal (3,) of the faces run through."""
    p = positions[cover.faces[face]]
    total = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]).sum(axis=0)
    return np.asarray(total / np.linalg.norm(total))


@dataclass(frozen=True, slots=True)
class _StraightEdge:
    """The upper convex hull of a profile in its own plane: x along it, z above it."""

    origin: FloatArray
    axis: FloatArray
    normal: FloatArray
    x: FloatArray
    z: FloatArray

    @classmethod
    def on(cls, points: FloatArray, normal: FloatArray) -> _StraightEdge:
        """Lay the edge on a profile (k, 3)."""
        chord = points[-1] - points[0]
        axis = chord - (chord @ normal) * normal
        size = float(np.linalg.norm(axis))
        axis = axis / size if size > 0 else axis
        x, z = (points - points[0]) @ axis, (points - points[0]) @ normal
        hull: list[int] = []
        for i in np.argsort(x, kind="stable"):
            while len(hull) > 1 and _turns_up(x, z, hull[-2], hull[-1], int(i)):
                hull.pop()
            hull.append(int(i))
        return cls(points[0], axis, normal, x[hull], z[hull])

    def height(self, points: FloatArray) -> FloatArray:
        """Heights (k,) [m] of points above the edge."""
        step = points - self.origin
        return np.asarray(step @ self.normal - np.interp(step @ self.axis, self.x, self.z))


def _turns_up(x: FloatArray, z: FloatArray, a: int, b: int, c: int) -> bool:
    """Whether b lies on or below the line from a to c."""
    return bool((x[b] - x[a]) * (z[c] - z[a]) >= (z[b] - z[a]) * (x[c] - x[a]))
