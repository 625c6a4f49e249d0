"""Cameras: named views that frame a seat of any size, and a user's own."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from types import MappingProxyType

import numpy as np

from seatlook.errors import InputError
from seatlook.model._check import FARTHEST, FloatArray, floats, in_range
from seatlook.model.light.lamps import direction

DISTANCE = 1.1  # m, of the demo seat
_RADIUS = 0.349  # m, of the sphere around the demo's foam
_ROUND = 2  # digits of the ratio to it: 1 for the demo's foam below a cover of any thickness
_MARGIN = 1.01  # room around a seat, from which the sphere's distance is too short
_ROOM = 1.06  # room that it then gets: a cover is larger than its foam


@dataclass(frozen=True, slots=True, kw_only=True)
class Camera:
    """A perspective camera.

    Parameters
    ----------
    position, target, up : (3,) float64 [m]
    vertical_fov_deg : float
    size : (width, height) in pixels
    """

    name: str
    position: FloatArray
    target: FloatArray
    up: FloatArray = field(default_factory=lambda: np.array([0.0, 0.0, 1.0]))
    vertical_fov_deg: float = 16.2
    size: tuple[int, int] = (1280, 720)

    def __post_init__(self) -> None:
        for name in ("position", "target", "up"):
            floats(self, name, 3, most=FARTHEST)
        if not np.linalg.norm(self.target - self.position) > 1e-3:
            raise InputError.single(
                "Camera.target", got="the camera's own position", expected="a place away from it"
            )
        if not np.linalg.norm(self.up) > 1e-6:
            raise InputError.single("Camera.up", got=self.up.tolist(), expected="a direction")
        in_range(self, "vertical_fov_deg", 1.0, 120.0)
        if min(self.size) < 1:
            raise InputError.single("Camera.size", got=self.size, expected="at least 1 x 1 pixels")

    @property
    def pixels_per_degree(self) -> float:
        """Mean over the horizontal field of view."""
        half = np.radians(self.vertical_fov_deg) / 2
        horizontal = 2 * np.arctan(np.tan(half) * self.size[0] / self.size[1])
        return float(self.size[0] / np.degrees(horizontal))

    def pixel(self, point: FloatArray) -> tuple[float, float]:
        """Where a point (3,) [m] in front of the camera is seen: (x, y) from the top left.

        Examples
        --------
        >>> side = Camera(name="side", position=np.array([1.0, 0, 0]), target=np.zeros(3))
        >>> side.pixel(np.zeros(3))
        (640.0, 360.0)
        """
        ((x, y),), _ = self.pixels(np.asarray(point)[None])
        return float(x), float(y)

    def pixels(self, points: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Where points (k, 3) [m] in front of the camera are seen (k, 2), and how deep (k,) [m]."""
        ahead = self.target - self.position
        ahead = ahead / np.linalg.norm(ahead)
        right = np.cross(ahead, self.up)
        right = right / np.linalg.norm(right)
        away = points - self.position
        focal = self.size[1] / 2 / np.tan(np.radians(self.vertical_fov_deg) / 2)
        depth = away @ ahead
        x = self.size[0] / 2 + focal * (away @ right) / depth
        y = self.size[1] / 2 - focal * (away @ np.cross(right, ahead)) / depth
        return np.column_stack([x, y]), np.asarray(depth)


def upright(camera: Camera, position: FloatArray, target: FloatArray) -> Camera:
    """Return a camera that looks from another place [m] at another, its upper edge up.

    Raises
    ------
    InputError
        Places above each other: which side is up is then not known.

    Examples
    --------
    >>> top = named_view("top", target=np.zeros(3))
    >>> upright(top, np.array([1.0, 0.0, 0.0]), np.zeros(3)).up.tolist()
    [0.0, 0.0, 1.0]
    """
    up = np.array([0.0, 0.0, 1.0])
    sight = np.asarray(target) - position
    if np.linalg.norm(np.cross(sight, up)) < 1e-6 * np.linalg.norm(sight):
        raise InputError.single(
            "position", got="right above or below the target", expected="a place beside that"
        )
    return replace(camera, name="free", position=position, target=target, up=up)


def named_view(
    name: str,
    *,
    target: FloatArray,
    size: tuple[int, int] = (1280, 720),
    distance: float = DISTANCE,
) -> Camera:
    """Camera of a named view, looking at ``target`` [m] from ``distance`` [m].

    Examples
    --------
    >>> round(named_view("top", target=np.zeros(3)).pixels_per_degree)
    45
    """
    if name not in VIEWS:
        raise InputError.single("camera.view", got=name, expected=f"one of {', '.join(VIEWS)}")
    azimuth, elevation, share = VIEWS[name]
    up = np.array([0.0, 1.0, 0.0]) if elevation > 89 else np.array([0.0, 0.0, 1.0])
    return Camera(
        name=name,
        position=np.asarray(target) + distance * share * direction(azimuth, elevation),
        target=target,
        up=up,
        size=size,
    )


def framed_view(name: str, points: FloatArray, *, size: tuple[int, int] = (1280, 720)) -> Camera:
    """Camera of a named view that shows all of ``points`` (n, 3) [m], looking at their middle.

    The distance goes with the radius of the sphere around the middle of their bounding box.
    A long or tall seat that would still reach out of the picture is seen from farther away;
    ``detail`` shows a part and is left as it is.

    Raises
    ------
    InputError
        An unknown view.

    Examples
    --------
    >>> corners = np.array([[-1.0, -1.0, -1.0], [1.0, 1.0, 1.0]])
    >>> views = [framed_view("top", scale * corners) for scale in (1.0, 2.0)]
    >>> [round(float(view.position[2]), 2) for view in views]
    [10.91, 21.85]
    """
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    distance = sphere_distance(points)
    camera = named_view(name, target=middle, size=size, distance=distance)
    reach, share = _MARGIN * _whole(camera, points), VIEWS[name][2]
    if share < 1.0 or reach <= distance * share:
        return camera
    return named_view(name, target=middle, size=size, distance=_ROOM / _MARGIN * reach / share)


def stepped_back(camera: Camera, points: FloatArray) -> Camera:
    """Camera that stands as far back on its line of sight as it takes to see all points (n, 3) [m].

    Examples
    --------
    >>> near = Camera(name="near", position=np.array([0.0, -1.0, 0.0]), target=np.zeros(3))
    >>> far = stepped_back(near, np.array([[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]]))
    >>> round(float(-far.position[1]), 2)
    4.19
    """
    away = camera.position - camera.target
    distance = float(np.linalg.norm(away))
    reach = _ROOM * _whole(camera, points)
    return replace(camera, position=camera.target + max(1.0, reach / distance) * away)


def sphere_distance(points: FloatArray) -> float:
    """Viewing distance [m], in the ratio of the sphere around ``points`` (n, 3) to the demo's."""
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    radius = float(np.linalg.norm(points - middle, axis=1).max())
    return DISTANCE * max(round(radius / _RADIUS, _ROUND), 10.0**-_ROUND)


def _whole(camera: Camera, points: FloatArray) -> float:
    """Least distance [m] from the target at which the camera sees all points."""
    toward = camera.position - camera.target
    toward = toward / np.linalg.norm(toward)
    right = np.cross(camera.up, toward)
    right = right / np.linalg.norm(right)
    upward = np.cross(toward, right)
    half = np.tan(np.radians(camera.vertical_fov_deg) / 2)
    away = points - camera.target
    aside = np.abs(away @ right) / (half * camera.size[0] / camera.size[1])
    above = np.abs(away @ upward) / half
    return float((away @ toward + np.maximum(aside, above)).max())


# azimuth, elevation [deg], share of the viewing distance
VIEWS: MappingProxyType[str, tuple[float, float, float]] = MappingProxyType(
    {
        "driver_door": (75.0, 38.0, 1.75),
        "front_34": (35.0, 40.0, 1.9),
        "rear_34": (215.0, 40.0, 1.9),
        "top": (0.0, 90.0, 2.0),
        "detail": (35.0, 45.0, 0.6),
    }
)
