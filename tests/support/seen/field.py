"""A crowned patch with nine creases, drawn without the renderer: the scene the score is tried on.

Height field z(x, y) seen from above, Lambert + GGX + a sheen lobe, shadows marched along the
light, ambient occlusion with its bounces (Jimenez et al. 2016). Absolute luminance in cd/m2.
"""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numba import njit
from scipy.ndimage import gaussian_filter

PIXEL = 0.4e-3
PIXELS_PER_DEGREE = 45.0


@dataclass(frozen=True, kw_only=True)
class Look:
    albedo: float
    roughness: float
    sheen: float = 0.0
    f0: float = 0.04
    texture: float = 0.0  # rms of fine albedo noise, over albedo


GLOSSY, ROUGH = 0.3, 0.85
LOOKS = {
    "black glossy": Look(albedo=0.03, roughness=GLOSSY),
    "bright glossy": Look(albedo=0.6, roughness=GLOSSY),
    "black rough": Look(albedo=0.03, roughness=ROUGH),
    "bright rough": Look(albedo=0.6, roughness=ROUGH),
    "suede": Look(albedo=0.3, roughness=0.95, sheen=0.3),
    "textured suede": Look(albedo=0.3, roughness=0.95, sheen=0.3, texture=0.1),
}


@dataclass(frozen=True, kw_only=True)
class Lamp:
    """Sun (lux on a level plane) or bulb (candela at a distance), with a sky of equal luminance."""

    elevation: float
    azimuth: float = 0.0  # 0 = across the creases
    lux: float = 20_000.0
    candela: float = 0.0
    distance: float = 0.8
    sky_lux: float = 2_000.0

    @property
    def direction(self):
        e, a = np.radians([self.elevation, self.azimuth])
        return np.array([np.cos(e) * np.cos(a), np.cos(e) * np.sin(a), np.sin(e)])

    @property
    def near(self):
        return self.candela > 0

    @property
    def radius(self):
        """Half the angle that the lamp's disc fills [rad]."""
        return 0.03 / self.distance if self.near else np.radians(0.27)

    def at(self, z, pixel):
        """Unit directions to the lamp (h, w, 3) and the lux on a plane facing it (h, w)."""
        if not self.near:
            ray = np.broadcast_to(self.direction, (*z.shape, 3)).copy()
            return ray, np.full(z.shape, self.lux / self.direction[2])
        x, y = grid(z.shape[::-1], pixel)
        ray = self.distance * self.direction - np.stack([x, y, z], axis=-1)
        distance = np.linalg.norm(ray, axis=-1)
        return ray / distance[..., None], self.candela / distance**2

    def scaled(self, power):
        return replace(
            self,
            lux=self.lux * power,
            candela=self.candela * power,
            sky_lux=self.sky_lux * power,
        )


def sun(elevation, azimuth=0.0):
    return Lamp(elevation=elevation, azimuth=azimuth)


def bulb(elevation, azimuth=0.0):
    return Lamp(elevation=elevation, azimuth=azimuth, lux=0.0, candela=150.0, sky_lux=50.0)


def grid(size, pixel=PIXEL):
    width, height = size
    x = (np.arange(width) - (width - 1) / 2) * pixel
    y = (np.arange(height) - (height - 1) / 2) * pixel
    return np.meshgrid(x, y)


def dome(size, pixel=PIXEL):
    x, y = grid(size, pixel)
    return -(x**2 / (2 * 0.6) + y**2 / (2 * 0.4))


def creases(size, pixel=PIXEL, seed=3):
    """Nine valleys across x, 0.25 to 0.5 mm deep, at 1/e of it 4 to 9 mm from the middle; [m]."""
    rng = np.random.default_rng(seed)
    x, y = grid(size, pixel)
    z = np.zeros_like(x)
    for place in np.linspace(-0.8, 0.8, 9):
        depth, width = rng.uniform(0.25e-3, 0.5e-3), rng.uniform(4e-3, 9e-3)
        bow, phase = rng.uniform(-8e-3, 8e-3), rng.uniform(0, 6.3)
        middle = place * x.max() + bow * np.cos(y / 0.04 + phase)
        z -= depth * np.exp(-(((x - middle) / width) ** 2))
    return z


@njit(cache=True)
def _height(z, u, v):
    """Bilinear height at column u, row v; nan outside."""
    rows, columns = z.shape
    if not (0 <= u < columns - 1 and 0 <= v < rows - 1):
        return np.nan
    i, j = int(v), int(u)
    a, b = v - i, u - j
    top = z[i, j] * (1 - b) + z[i, j + 1] * b
    return top * (1 - a) + (z[i + 1, j] * (1 - b) + z[i + 1, j + 1] * b) * a


@njit(cache=True)
def _horizon(z, i, j, du, dv, pixel, reach):
    """Largest rise over run seen from a pixel along (du, dv), steps growing by a third."""
    best, run = -1e9, 1.5 * pixel
    while run < reach:
        height = _height(z, j + du * run / pixel, i + dv * run / pixel)
        if np.isnan(height):
            break
        best = max(best, (height - z[i, j]) / run)
        run *= 1.35
    return best


@njit(cache=True)
def _sky_share(z, pixel, directions, out):
    """Cosine-weighted share of a level sky that a pixel sees."""
    for i in range(z.shape[0]):
        for j in range(z.shape[1]):
            hidden = 0.0
            for k in range(directions):
                a = 2 * np.pi * (k + 0.5) / directions
                t = max(_horizon(z, i, j, np.cos(a), np.sin(a), pixel, 0.04), 0.0)
                hidden += t * t / (1 + t * t)
            out[i, j] = 1 - hidden / directions


@njit(cache=True)
def _lit(z, pixel, to_light, radius, out):
    """Share of the lamp's disc (angular radius) above the horizon towards it."""
    for i in range(z.shape[0]):
        for j in range(z.shape[1]):
            lx, ly, lz = to_light[i, j]
            level = np.sqrt(lx * lx + ly * ly) + 1e-12
            rise = _horizon(z, i, j, lx / level, ly / level, pixel, 0.1)
            share = 0.5 + (np.arctan2(lz, level) - np.arctan(rise)) / (2 * radius)
            out[i, j] = min(max(share, 0.0), 1.0)


def _brdf(look, NoL, NoV, NoH, LoH):
    """Lambert below a GGX coat, plus a sheen lobe, without the cosine."""
    a2 = look.roughness**4
    D = a2 / (np.pi * (NoH**2 * (a2 - 1) + 1) ** 2)
    smith = NoL * np.sqrt(NoV**2 * (1 - a2) + a2) + NoV * np.sqrt(NoL**2 * (1 - a2) + a2)
    F = look.f0 + (1 - look.f0) * (1 - LoH) ** 5 if look.f0 else 0.0
    specular = D * F * 0.5 / np.maximum(smith, 1e-9)
    sine = np.sqrt(np.maximum(1 - NoH**2, 0.0))
    nap = (
        look.sheen * (2 + 2) * sine**2 / (2 * np.pi) / np.maximum(4 * (NoL + NoV - NoL * NoV), 1e-9)
    )
    return look.albedo * (1 - F) / np.pi + specular + nap


def bounced(share, albedo):
    """Occlusion with the light its own walls send back (Jimenez et al. 2016, eq. 15)."""
    a, b, c = 2.0404 * albedo - 0.3324, -4.7951 * albedo + 0.6417, 2.7552 * albedo + 0.6903
    return np.maximum(share, ((share * a + b) * share + c) * share)


def noise(size, shift=0, seed=11):
    """Fine albedo pattern of mean 0 and rms 1; ``shift`` moves it by whole pixels."""
    pattern = gaussian_filter(np.random.default_rng(seed).normal(size=size[::-1]), 0.7, mode="wrap")
    return np.roll(pattern / pattern.std(), shift, axis=1)


class Patch:
    """A height field; what depends on its shape alone is worked out once per lamp direction."""

    def __init__(self, z, pixel=PIXEL):
        self.z, self.pixel = z, pixel
        slope_y, slope_x = np.gradient(z, pixel)
        normal = np.stack([-slope_x, -slope_y, np.ones_like(z)], axis=-1)
        self.normal = normal / np.linalg.norm(normal, axis=-1, keepdims=True)
        self._lit = {}

    @cached_property
    def sky_share(self):
        share = np.empty_like(self.z)
        _sky_share(self.z, self.pixel, 8, share)
        return share

    def lit(self, lamp, ray):
        key = (lamp.elevation, lamp.azimuth, lamp.near)
        if key not in self._lit:
            self._lit[key] = np.empty_like(self.z)
            _lit(self.z, self.pixel, ray, lamp.radius, self._lit[key])
        return self._lit[key]

    def draw(self, look, lamp, *, interreflection=True, shift=0):
        """Luminance (h, w) [cd/m2] seen from above."""
        ray, facing_lux = lamp.at(self.z, self.pixel)
        half = ray + np.array([0.0, 0.0, 1.0])
        half /= np.linalg.norm(half, axis=-1, keepdims=True)
        NoL = np.maximum((self.normal * ray).sum(-1), 0.0)
        NoH, NoV = np.maximum((self.normal * half).sum(-1), 0.0), self.normal[..., 2]
        share = bounced(self.sky_share, look.albedo) if interreflection else self.sky_share
        lux = NoL * facing_lux * self.lit(lamp, ray)
        sky = (look.albedo + look.f0 + look.sheen * (1 - NoV)) * share * lamp.sky_lux / np.pi
        luminance = _brdf(look, NoL, NoV, NoH, half[..., 2]) * lux + sky
        if look.texture:
            luminance = luminance * (1 + look.texture * noise(self.z.shape[::-1], shift))
        return luminance
