"""Lights and rigs in photometric units."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from types import MappingProxyType

import numpy as np

from seatlook.errors import InputError
from seatlook.model._check import FARTHEST, FloatArray, floats, in_range, positive
from seatlook.model.colour import TO_SRGB

# Linear sRGB of direct sun (ASTM G173, 5233 K), scaled so that its luminance is 1.
SUN_COLOUR = (1.159, 0.974, 0.788)
BRIGHTEST = 1e9  # lux, cd, cd/m2; ten thousand suns


@dataclass(frozen=True, slots=True, kw_only=True)
class Light:
    """One light: far away (a direction) or near (a position), there a bulb or a rectangle.

    Parameters
    ----------
    intensity : float           [lux] on a facing plane when far, [cd] when near: of a bulb in every
        direction, of a rectangle before its middle
    vector : (3,) float64       unit vector towards the light when far, position [m] when near
    near : bool
    colour : (3,) float64       linear sRGB of luminance 1
    size : float                angular diameter [rad] when far, radius [m] when near
    sides : (2, 3) float64      halves [m] of a rectangle's sides, from its middle, at right angles,
        the longer first; it shines towards their vector product. All 0: a disc or a bulb
    two_sided : bool            whether a rectangle shines backwards as well
    """

    name: str
    intensity: float
    vector: FloatArray
    near: bool
    colour: FloatArray = field(default_factory=lambda: np.ones(3))
    size: float = 0.0
    sides: FloatArray = field(default_factory=lambda: np.zeros((2, 3)))
    two_sided: bool = False

    def __post_init__(self) -> None:
        floats(self, "vector", 3, most=FARTHEST)
        floats(self, "sides", 2, 3, most=FARTHEST)
        floats(self, "colour", 3)
        positive(self, "intensity")
        in_range(self, "intensity", 0.0, BRIGHTEST)
        in_range(self, "size", 0.0, 3.2)
        long, short = np.linalg.norm(self.sides, axis=1)
        slant = abs(float(self.sides[0] @ self.sides[1]))
        if long > 0 and not (
            self.near and 1.000001 * long >= short > 0 and slant <= 1e-9 * long**2
        ):
            raise InputError.single(
                "Light.sides",
                got=self.sides.tolist(),
                expected="sides at right angles of a near light, the longer first",
            )

    @property
    def is_rectangle(self) -> bool:
        """Whether this is a rectangle, not a disc or a bulb."""
        return bool(self.sides.any())


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


def rectangle(
    *,
    lumen: float = 4000.0,
    position_mm: tuple[float, float, float],
    target_mm: tuple[float, float, float] = (0.0, 0.0, 100.0),
    along: tuple[float, float, float] = (1.0, 0.0, 0.0),
    size_mm: tuple[float, float] = (600.0, 600.0),
    temperature_k: float = 5000.0,
    name: str = "rectangle",
) -> Light:
    """Even panel that faces ``target_mm``, equally bright from every side (Lambert).

    ``along`` is where its first side points, as far as it lies across the line to the target.

    Examples
    --------
    >>> panel = rectangle(lumen=np.pi, position_mm=(0, 0, 900), size_mm=(300, 400))
    >>> round(panel.intensity, 6), np.abs(panel.sides).round(3).tolist()
    (1.0, [[0.0, 0.2, 0.0], [0.15, 0.0, 0.0]])
    """
    where = np.asarray(position_mm, dtype=float) / 1000
    ahead = np.asarray(target_mm, dtype=float) / 1000 - where
    ahead = ahead / max(float(np.linalg.norm(ahead)), 1e-12)
    first = np.asarray(along, dtype=float)
    first = first - (first @ ahead) * ahead
    if not np.linalg.norm(ahead) > 0.5:
        got = np.asarray(target_mm).tolist()
        raise InputError.single("target_mm", got=got, expected="not where the light is")
    if not np.linalg.norm(first) > 1e-6:
        got = np.asarray(along).tolist()
        expected = "a direction across the line to the target"
        raise InputError.single("along", got=got, expected=expected)
    size = np.asarray(size_mm, dtype=float)
    if not ((size >= 1.0) & (size <= 1000.0 * FARTHEST)).all():
        raise InputError.single("size_mm", got=size.tolist(), expected="two sides of 1 to 1e+06")
    first = first / np.linalg.norm(first)
    sides = size[:, None] * np.array([first, np.cross(ahead, first)]) / 2000
    return Light(
        name=name,
        intensity=lumen / np.pi,
        vector=where,
        near=True,
        colour=planck_colour(temperature_k),
        sides=np.array([sides[1], -sides[0]]) if size[1] > size[0] else sides,
    )


def two_sided_rectangle(
    *,
    lumen: float = 4000.0,
    position_mm: tuple[float, float, float],
    target_mm: tuple[float, float, float] = (0.0, 0.0, 100.0),
    along: tuple[float, float, float] = (1.0, 0.0, 0.0),
    size_mm: tuple[float, float] = (600.0, 600.0),
    temperature_k: float = 5000.0,
    name: str = "rectangle",
) -> Light:
    """Rectangle that sends half of its light backwards."""
    forward = rectangle(
        lumen=lumen / 2,
        position_mm=position_mm,
        target_mm=target_mm,
        along=along,
        size_mm=size_mm,
        temperature_k=temperature_k,
        name=name,
    )
    return replace(forward, two_sided=True)


def strip(
    *,
    lumen: float = 4000.0,
    position_mm: tuple[float, float, float],
    target_mm: tuple[float, float, float] = (0.0, 0.0, 100.0),
    along: tuple[float, float, float] = (1.0, 0.0, 0.0),
    size_mm: tuple[float, float] = (1500.0, 100.0),
    temperature_k: float = 5000.0,
    name: str = "strip",
) -> Light:
    """Long narrow panel, as over an inspection table: a rectangle of another size."""
    return rectangle(
        lumen=lumen,
        position_mm=position_mm,
        target_mm=target_mm,
        along=along,
        size_mm=size_mm,
        temperature_k=temperature_k,
        name=name,
    )


# Elevations [deg] of the strips of a tunnel, across its axis.
_TUNNEL = (20.0, 55.0, 90.0, 125.0, 160.0)


def tunnel(
    *,
    lumen: float = 20_000.0,
    radius_mm: float = 1200.0,
    middle_mm: tuple[float, float, float] = (0.0, 0.0, 100.0),
    azimuth_deg: float = 0.0,
    size_mm: tuple[float, float] = (1500.0, 100.0),
    temperature_k: float = 5000.0,
    name: str = "tunnel",
) -> tuple[Light, ...]:
    """Five strips on an arch over the seat, along ``azimuth_deg``; ``lumen`` of all together.

    Examples
    --------
    >>> [light.vector[[0, 2]].round(2).tolist() for light in tunnel()][:2]
    [[1.13, 0.51], [0.69, 1.08]]
    """
    a, b, c = direction(azimuth_deg, 0.0).tolist()
    lights = []
    for number, elevation in enumerate(_TUNNEL, 1):
        # From one side over the top to the other.
        beside, up = np.cos(np.radians(elevation)), np.sin(np.radians(elevation))
        away = beside * direction(azimuth_deg + 90.0, 0.0) + [0.0, 0.0, up]
        x, y, z = (np.asarray(middle_mm, dtype=float) + radius_mm * away).tolist()
        lights.append(
            strip(
                lumen=lumen / len(_TUNNEL),
                position_mm=(x, y, z),
                target_mm=middle_mm,
                along=(a, b, c),
                size_mm=size_mm,
                temperature_k=temperature_k,
                name=f"{name} {number}",
            )
        )
    return tuple(lights)


LIGHTS: dict[str, Callable[..., Light | tuple[Light, ...]]] = {
    "sun": sun,
    "bulb": bulb,
    "booth": booth,
    "strip": strip,
    "rectangle": rectangle,
    "two_sided_rectangle": two_sided_rectangle,
    "tunnel": tunnel,
}


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
    # Below about 1900 K blue leaves the sRGB triangle; a display cannot show it.
    return np.asarray(np.maximum(TO_SRGB @ np.array([x / y, 1.0, (1 - x - y) / y]), 0.0))


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
