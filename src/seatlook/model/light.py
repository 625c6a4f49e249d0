"""Lights, rigs and cameras in photometric units."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from types import MappingProxyType

import numpy as np

from seatlook.errors import InputError
from seatlook.model._check import FARTHEST, FloatArray, floats, in_range, positive

# Linear sRGB of direct sun (ASTM G173, 5233 K), scaled so that its luminance is 1.
SUN_COLOUR = (1.159, 0.974, 0.788)
DISTANCE = 1.1  # m, of the demo seat
BRIGHTEST = 1e9  # lux, cd, cd/m2; ten thousand suns
_RADIUS = 0.349  # m, of the sphere around the demo's foam
_ROUND = 2  # digits of the ratio to it: 1 for the demo's foam below a cover of any thickness
_MARGIN = 1.01  # room around a seat, from which the sphere's distance is too short
_ROOM = 1.06  # room that it then gets: a cover is larger than its foam


@dataclass(frozen=True, slots=True, kw_only=True)
class Light:
    """One light: far away (a direction) or near (a position).

    Parameters
    ----------
    intensity : float           [lux] on a facing plane when far, [cd] when near
    vector : (3,) float64       unit vector towards the light when far, position [m] when near
    near : bool
    colour : (3,) float64       linear sRGB of luminance 1
    size : float                angular diameter [rad] when far, radius [m] when near
    """

    name: str
    intensity: float
    vector: FloatArray
    near: bool
    colour: FloatArray = field(default_factory=lambda: np.ones(3))
    size: float = 0.0

    def __post_init__(self) -> None:
        floats(self, "vector", 3, most=FARTHEST)
        floats(self, "colour", 3)
        positive(self, "intensity")
        in_range(self, "intensity", 0.0, BRIGHTEST)
        in_range(self, "size", 0.0, 3.2)


def direction(azimuth_deg: float, elevation_deg: float) -> FloatArray:
    """Unit vector (3,) towards azimuth (from -y, counter-clockwise from above) and elevation.

    Examples
    --------
    >>> direction(90.0, 45.0).round(3).tolist()
    [0.707, -0.0, 0.707]
    """
    azimuth, elevation = np.radians([azimuth_deg, elevation_deg])
    level = np.cos(elevation)
    return np.array([level * np.sin(azimuth), -level * np.cos(azimuth), np.sin(elevation)])


def sun(
    *,
    illuminance_lux: float = 97_000.0,
    elevation_deg: float,
    azimuth_deg: float,
    angular_diameter_deg: float = 0.5332,
    name: str = "sun",
) -> Light:
    """Direct sun; 97 klx is ASTM G173 direct normal light on a facing plane."""
    if not -90 <= elevation_deg <= 90:
        raise InputError.single("sun.elevation_deg", got=elevation_deg, expected="-90 to 90")
    return Light(
        name=name,
        intensity=illuminance_lux,
        vector=direction(azimuth_deg, elevation_deg),
        near=False,
        colour=np.array(SUN_COLOUR),
        size=float(np.radians(angular_diameter_deg)),
    )


def bulb(
    *,
    lumen: float = 800.0,
    position_mm: tuple[float, float, float],
    radius_mm: float = 30.0,
    temperature_k: float = 2700.0,
    name: str = "bulb",
) -> Light:
    """Isotropic bulb: ``lumen / (4 pi)`` candela in every direction."""
    return Light(
        name=name,
        intensity=lumen / (4 * np.pi),
        vector=np.asarray(position_mm, dtype=float) / 1000,
        near=True,
        colour=planck_colour(temperature_k),
        size=radius_mm / 1000,
    )


# Chromaticity x, y in CIE 1931 (CIE 15:2018); TL84 is the fluorescent lamp F11.
ILLUMINANTS = MappingProxyType(
    {"D65": (0.31272, 0.32903), "A": (0.44758, 0.40745), "TL84": (0.38052, 0.37713)}
)


def booth(
    *,
    illuminant: str,
    illuminance_lux: float = 1500.0,
    elevation_deg: float = 90.0,
    azimuth_deg: float = 0.0,
    angular_diameter_deg: float = 40.0,
    name: str = "booth",
) -> Light:
    """Diffuser of a light booth, of one of the ``ILLUMINANTS``.

    Colours are seen through three channels: metamerism under the lines of TL84 is not.

    Examples
    --------
    >>> booth(illuminant="D65").colour.round(2).tolist()
    [1.0, 1.0, 1.0]
    """
    if illuminant not in ILLUMINANTS:
        raise InputError.single(
            "booth.illuminant", got=repr(illuminant), expected=f"one of {', '.join(ILLUMINANTS)}"
        )
    return Light(
        name=name,
        intensity=illuminance_lux,
        vector=direction(azimuth_deg, elevation_deg),
        near=False,
        colour=linear_srgb(*ILLUMINANTS[illuminant]),
        size=float(np.radians(angular_diameter_deg)),
    )


LIGHTS: dict[str, Callable[..., Light]] = {"sun": sun, "bulb": bulb, "booth": booth}


def planck_colour(temperature_k: float) -> FloatArray:
    """Linear sRGB (3,) of luminance 1 of a black body, 1667-25000 K.

    Kim et al. 2002 (US 7024034), cubic fit of the Planckian locus in CIE 1931 xy.
    """
    if not 1667 <= temperature_k <= 25000:
        raise InputError.single("temperature_k", got=temperature_k, expected="1667 to 25000")
    t = 1000.0 / temperature_k
    if temperature_k < 4000:
        x = -0.2661239 * t**3 - 0.2343589 * t**2 + 0.8776956 * t + 0.179910
    else:
        x = -3.0258469 * t**3 + 2.1070379 * t**2 + 0.2226347 * t + 0.240390
    if temperature_k < 2222:
        y = -1.1063814 * x**3 - 1.34811020 * x**2 + 2.18555832 * x - 0.20219683
    elif temperature_k < 4000:
        y = -0.9549476 * x**3 - 1.37418593 * x**2 + 2.09137015 * x - 0.16748867
    else:
        y = 3.0817580 * x**3 - 5.87338670 * x**2 + 3.75112997 * x - 0.37001483
    return linear_srgb(x, y)


def linear_srgb(x: float, y: float) -> FloatArray:
    """Linear sRGB (3,) of luminance 1 of a chromaticity (IEC 61966-2-1)."""
    to_rgb = np.array(
        [
            [3.2404542, -1.5371385, -0.4985314],
            [-0.9692660, 1.8760108, 0.0415560],
            [0.0556434, -0.2040259, 1.0572252],
        ]
    )
    # Below about 1900 K blue leaves the sRGB triangle; a display cannot show it.
    return np.asarray(np.maximum(to_rgb @ np.array([x / y, 1.0, (1 - x - y) / y]), 0.0))


@dataclass(frozen=True, slots=True, kw_only=True)
class Rig:
    """A set of lights with one exposure for everything lit by it.

    Parameters
    ----------
    ambient : float [cd/m2]     luminance of a sky that is equal in all directions
    panorama : (h, w, 3) float64 [cd/m2] or None
        sky as a picture of all directions instead, linear sRGB: first row up, columns by azimuth
        counter-clockwise seen from above, beginning at 0
    ev100 : float | None        None: from the lux on a grey card at the seat
    """

    name: str
    lights: tuple[Light, ...]
    ambient: float = 0.0
    ev100: float | None = None
    panorama: FloatArray | None = None

    def __post_init__(self) -> None:
        where = f"rig {self.name}"
        if not self.lights and not self.ambient > 0 and self.panorama is None:
            raise InputError.single(where, got="no light", expected="a light or sky")
        in_range(self, "ambient", 0.0, 1e6)
        if self.ev100 is not None:
            in_range(self, "ev100", -10.0, 30.0)
        if self.panorama is None:
            return
        floats(self, "panorama", None, None, 3)
        if self.ambient > 0:
            raise InputError.single(where, got="ambient and panorama", expected="one of them")
        if self.panorama.max(initial=0.0) > BRIGHTEST**2:
            got = f"a luminance of {self.panorama.max():g} cd/m2"
            raise InputError.single(f"{where}: panorama", got=got, expected="up to 1e18 cd/m2")
        if min(self.panorama.shape[:2]) < 4 or self.panorama.min() < 0:
            raise InputError.single(
                f"{where}: panorama",
                got=f"{self.panorama.shape[:2]} pixels from {self.panorama.min():g}",
                expected="at least 4 x 4 pixels, none below 0",
            )


def turned(rig: Rig, azimuth_deg: float) -> Rig:
    """Rig whose panorama is turned counter-clockwise, seen from above; its lamps stay.

    Between columns of pixels light is shared in proportion: none is lost.

    Examples
    --------
    >>> sky = np.zeros((4, 8, 3))
    >>> sky[1, 0] = 1.0
    >>> turned(Rig(name="sky", lights=(), panorama=sky), 90.0).panorama[1, :, 0].tolist()
    [0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0]
    """
    if rig.panorama is None:
        return rig
    steps = azimuth_deg / 360.0 * rig.panorama.shape[1]
    whole = int(np.floor(steps))
    low, high = (np.roll(rig.panorama, whole + k, axis=1) for k in (0, 1))
    return replace(rig, panorama=low + (steps - whole) * (high - low))


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
