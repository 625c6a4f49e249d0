"""What instruments would measure on a material: its colour by geometry, its gloss.

And the other way: the albedo and roughness of a material that measures what was typed.
"""

from __future__ import annotations

import functools
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from seatlook.errors import InputError
from seatlook.model import Appearance, FloatArray
from seatlook.model.colour import lab_from_linear, linear_from_lab
from seatlook.pbr.kernels.grain import STROKE, SUEDE
from seatlook.pbr.reflectance import brdf
from seatlook.pbr.reflectance.measured import mean_albedo
from seatlook.pbr.reflectance.relief import load_textures, texture_index

# Linear luminance of sRGB's primaries.
_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
# Nodes over a hemisphere, azimuths of 45/0, points of a gloss meter's receptor and source.
_NODES, _AZIMUTHS, _RECEPTOR, _SOURCE = 96, 24, 40, (3, 5)
# Half the angle of the trap of d/8 with the specular excluded; judgement, spheres differ.
_TRAP = np.radians(5.0)
# ISO 2813, angle -> receptor in and across the plane of incidence; the image of the source [deg].
_APERTURES = {20: (1.8, 3.6), 60: (4.4, 11.7), 85: (4.0, 6.0)}
_IMAGE = (0.75, 2.5)
_GLASS = 1.567
# Roughness that can be met, and how exactly.
_SMOOTHEST, _ROUGHEST, _STEPS = 0.08, 1.0, 24
_CLOSE, _TURNS = 0.1, 8


def reflectance(appearance: Appearance, geometry: str = "45/0") -> FloatArray:
    """Reflectance factor (3,) in linear sRGB that an instrument of a geometry measures.

    Parameters
    ----------
    geometry : ``45/0`` (ring), ``d/8 SCI``, or ``d/8 SCE`` (without 5 degrees about the reflection)

    Raises
    ------
    InputError
        Another geometry.

    Examples
    --------
    >>> grey = Appearance(albedo=np.full(3, 0.18), f0=0.0)
    >>> reflectance(grey, "45/0").round(4).tolist()
    [0.18, 0.18, 0.18]
    """
    if geometry not in GEOMETRIES:
        raise InputError.single(
            "geometry", got=repr(geometry), expected=f"one of {', '.join(GEOMETRIES)}"
        )
    return np.asarray(GEOMETRIES[geometry](seen_from_afar(appearance)))


def gloss(appearance: Appearance, angle_deg: int = 60) -> float:
    """Gloss units at 20, 60 or 85 degrees, by the apertures of ISO 2813.

    100 is black glass of refractive index 1.567.

    Examples
    --------
    >>> matt = Appearance(albedo=np.full(3, 0.5), f0=0.04, roughness=0.9)
    >>> gloss(matt) < 5
    True
    """
    if angle_deg not in _APERTURES:
        raise InputError.single("angle_deg", got=angle_deg, expected="20, 60 or 85")
    plain, theta = seen_from_afar(appearance), np.radians(angle_deg)
    high, wide = np.radians(_APERTURES[angle_deg])
    up, across = (size * _middles(n) for size, n in zip((high, wide), 2 * [_RECEPTOR], strict=True))
    l = _about(theta, up[:, None], across)
    source = [np.radians(size) * _middles(n) for size, n in zip(_IMAGE, _SOURCE, strict=True)]
    cosine = np.cos(across) * np.maximum(l[..., 2], 0.0) * high * wide / _RECEPTOR**2
    seen = 0.0
    for a in source[0]:
        for b in source[1]:
            v = np.broadcast_to(_about(-theta, np.array(a), np.array(b)), l.shape)
            both = (l[..., 2] > 1e-6) & (v[..., 2] > 1e-6)
            value = brdf.evaluate(plain, v[both], l[both]) @ _LUMINANCE
            seen += float((value * cosine[both]).sum())
    return 100.0 * seen / (len(source[0]) * len(source[1])) / _fresnel(_GLASS, theta)


def lab(appearance: Appearance, geometry: str = "45/0") -> FloatArray:
    """CIE L*a*b* (3,) under D65 that an instrument measures; see :func:`reflectance`.

    Examples
    --------
    >>> lab(Appearance(albedo=np.array([0.2, 0.1, 0.05]), f0=0.0)).round(1).tolist()
    [40.8, 10.8, 20.5]
    """
    return lab_from_linear(reflectance(appearance, geometry))


def measuring(appearance: Appearance, wanted: FloatArray, geometry: str = "45/0") -> Appearance:
    """Appearance with the albedo at which the material measures ``wanted`` (3,), linear sRGB.

    Coat, sheen, lobe and relief are those of the appearance.

    Raises
    ------
    InputError
        No albedo does: the surface alone reflects more, or a white base less.

    Examples
    --------
    >>> shiny = Appearance(albedo=np.zeros(3), roughness=0.3, coat=1.0)
    >>> green = measuring(shiny, np.array([0.1, 0.3, 0.1]), "d/8 SCI")
    >>> reflectance(green, "d/8 SCI").round(4).tolist()
    [0.1, 0.3, 0.1]
    """
    low, high = np.zeros(3), np.ones(3)
    ends = [reflectance(replace(appearance, albedo=end), geometry) for end in (low, high)]
    if (wanted < ends[0] - 1e-3).any() or (wanted > ends[1] + 1e-3).any():
        least, most = (lab_from_linear(end)[0] for end in ends)
        raise InputError.single(
            "albedo",
            got=f"a measured colour of L* {lab_from_linear(wanted)[0]:.1f}",
            expected=f"what this surface can show by {geometry}: L* {least:.1f} to {most:.1f}",
            hint="its coat, sheen and lobe reflect the rest; change those, or the geometry",
        )
    if appearance.metalness == 0.0:
        albedo = (wanted - ends[0]) / (ends[1] - ends[0])
        return replace(appearance, albedo=np.clip(albedo, 0.0, 1.0))
    for _ in range(_STEPS):
        middle = 0.5 * (low + high)
        above = reflectance(replace(appearance, albedo=middle), geometry) > wanted
        low, high = np.where(above, low, middle), np.where(above, middle, high)
    return replace(appearance, albedo=0.5 * (low + high))


def appearance_of(
    wanted: FloatArray, gloss_60: float, *, geometry: str = "45/0", like: Appearance | None = None
) -> Appearance:
    """Appearance that measures a colour L*a*b* (3,) and ``gloss_60`` gloss units at 60 degrees.

    Albedo and roughness are found; the rest is that of ``like``.

    Raises
    ------
    InputError
        A colour or gloss that no albedo and roughness of this surface have.

    Examples
    --------
    >>> leather = appearance_of(np.array([25.0, 1.0, 2.0]), 3.0)
    >>> lab(leather).round(2).tolist(), round(gloss(leather), 1)
    ([25.0, 1.0, 2.0], 3.0)
    """
    plain = like or Appearance(albedo=np.full(3, 0.1))
    return _fitted(plain, linear_from_lab(np.asarray(wanted)), geometry, gloss_60)


def _fitted(
    appearance: Appearance, wanted: FloatArray, geometry: str, gloss_60: float
) -> Appearance:
    """Appearance of a colour and gloss: in turns, as a bright base adds to what a meter sees."""
    for _ in range(_TURNS):
        appearance = measuring(glossy(appearance, gloss_60), wanted, geometry)
        if abs(gloss(appearance) - gloss_60) < _CLOSE:
            return appearance
    raise InputError.single(
        "gloss_60",
        got=f"{gloss_60:g} GU with a colour of L* {lab_from_linear(wanted)[0]:.1f}",
        expected="a gloss that a surface of this colour can have",
    )


def glossy(appearance: Appearance, gloss_60: float) -> Appearance:
    """Appearance with the roughness at which it has ``gloss_60``, within 0.1; else InputError."""
    ends = (_SMOOTHEST, _ROUGHEST)
    most, least = (gloss(replace(appearance, roughness=end)) for end in ends)
    if not least - 0.1 <= gloss_60 <= most + 0.1:
        raise InputError.single(
            "gloss_60",
            got=f"{gloss_60:g} GU",
            expected=f"{least:.2g} to {most:.3g} GU, which this surface has by its roughness",
        )
    low, high = ends
    for _ in range(_STEPS):
        middle = 0.5 * (low + high)
        rough = gloss(replace(appearance, roughness=middle)) < gloss_60
        low, high = (low, middle) if rough else (middle, high)
    return replace(appearance, roughness=0.5 * (low + high))


def resolved(appearance: Appearance) -> Appearance:
    """Appearance whose albedo and roughness are those of the surface, not of an instrument."""
    if appearance.measured is None and appearance.gloss_60 is None:
        return appearance
    values = (appearance.albedo.tobytes(), appearance.sheen.tobytes())
    return _resolved(_Key(appearance, values))


class _Key:
    """Appearance that equals another one of the same values."""

    def __init__(self, appearance: Appearance, arrays: tuple[bytes, ...]) -> None:
        self.appearance = appearance
        names = [n for n in appearance.__slots__ if n not in ("albedo", "sheen", "maps")]
        self._values = (*arrays, id(appearance.maps), *(getattr(appearance, n) for n in names))

    def __hash__(self) -> int:
        return hash(self._values)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Key) and self._values == other._values


@functools.lru_cache(maxsize=64)
def _resolved(key: _Key) -> Appearance:
    out, geometry, gloss_60 = key.appearance, key.appearance.measured, key.appearance.gloss_60
    out = replace(out, measured=None, gloss_60=None)
    if gloss_60 is None:
        return measuring(out, out.albedo, geometry or "45/0")
    if geometry is None:
        return glossy(out, gloss_60)
    return _fitted(out, out.albedo, geometry, gloss_60)


def seen_from_afar(appearance: Appearance) -> Appearance:
    """Plain surface of the same colour and gloss: relief is roughness and mean tone."""
    a, tone, variance = appearance, np.ones(3), 0.0
    which = texture_index(a)
    if which >= 0:
        textures = load_textures(which)
        mean = textures.texels[which, textures.start[-1]]
        variance = (a.texture_depth / a.texture_scale) ** 2 * float(mean[2])
        tone = tone * float(mean[3]) * (1.0 - STROKE if which == SUEDE else 1.0)
    if a.maps is not None:
        tone = tone * mean_albedo(a.maps)
    return replace(
        a,
        albedo=np.clip(a.albedo * tone, 0.0, 1.0),
        roughness=min(1.0, (a.roughness**4 + 2.0 * variance) ** 0.25),
        coat_roughness=min(1.0, (a.coat_roughness**4 + 2.0 * variance) ** 0.25),
        texture="none",
        texture_depth=0.0,
        maps=None,
    )


def _ring(appearance: Appearance) -> FloatArray:
    """Lit from all sides at 45 degrees, seen from above."""
    phi = 2 * np.pi * (np.arange(_AZIMUTHS) + 0.5) / _AZIMUTHS
    l = np.column_stack([np.cos(phi), np.sin(phi), np.ones(_AZIMUTHS)]) / np.sqrt(2)
    v = np.broadcast_to([0.0, 0.0, 1.0], l.shape)
    return np.asarray(np.pi * brdf.evaluate(appearance, v, l).mean(axis=0))


def _sphere(appearance: Appearance, trap: float = 0.0) -> FloatArray:
    """Lit from everywhere but a trap about the reflection [rad], seen at 8 degrees."""
    theta, total = np.radians(8.0), np.zeros(3)
    v = np.array([np.sin(theta), 0.0, np.cos(theta)])
    mirror = v * [-1, -1, 1]
    widths = [brdf.alphas(appearance.roughness, appearance.anisotropy)]
    if appearance.coat > 0:
        widths.append(brdf.alphas(appearance.coat_roughness, 0.0))
    ways = [_cosine_ways(), *(_lobe_ways(v, *width) for width in widths)]
    for l in ways:
        l = l[l[:, 2] > 1e-6]
        h = l + v
        h /= np.linalg.norm(h, axis=1, keepdims=True)
        density = l[:, 2] / np.pi
        for ax, ay in widths:
            density = density + brdf.D_GGX(ax, ay, h) * h[:, 2] / (4 * np.maximum(h @ v, 1e-9))
        open_ = l @ mirror < np.cos(trap) if trap else np.ones(len(l), dtype=bool)
        value = brdf.evaluate(appearance, np.broadcast_to(v, l.shape), l)
        weight = np.where(open_, l[:, 2] / density, 0.0)[:, None]
        total += (value * weight).sum(axis=0) / _NODES**2
    return total


def _cosine_ways() -> FloatArray:
    a, phi = _square()
    r = np.sqrt(a)
    return np.stack([r * np.cos(phi), r * np.sin(phi), np.sqrt(1 - a)], axis=-1)


def _lobe_ways(v: FloatArray, ax: float, ay: float) -> FloatArray:
    """Directions mirrored at the half-vectors of a GGX lobe."""
    a, phi = _square()
    slope = np.sqrt(a / (1 - a))
    h = np.stack([ax * slope * np.cos(phi), ay * slope * np.sin(phi), np.ones(len(a))], axis=-1)
    h /= np.linalg.norm(h, axis=1, keepdims=True)
    return np.asarray(2 * (h @ v)[:, None] * h - v)


def _square() -> tuple[FloatArray, FloatArray]:
    a, phi = np.meshgrid((np.arange(_NODES) + 0.5) / _NODES, (np.arange(_NODES) + 0.5) / _NODES)
    return a.ravel(), 2 * np.pi * phi.ravel()


def _middles(count: int) -> FloatArray:
    """Middles of equal parts of an interval of length 1 about 0."""
    return (np.arange(count) + 0.5) / count - 0.5


def _about(theta: float, up: FloatArray, across: FloatArray) -> FloatArray:
    """Directions (..., 3) turned from ``theta`` in the plane of incidence, then across it."""
    side = np.cos(across)
    x, z = np.sin(theta + up) * side, np.cos(theta + up) * side
    return np.stack(np.broadcast_arrays(x, np.sin(across), z), axis=-1)


def _fresnel(index: float, theta: float) -> float:
    """Reflectance of a smooth dielectric, of light that is not polarised."""
    cosine = np.cos(theta)
    inside = np.sqrt(1 - (np.sin(theta) / index) ** 2)
    s = (cosine - index * inside) / (cosine + index * inside)
    p = (index * cosine - inside) / (index * cosine + inside)
    return float(0.5 * (s * s + p * p))


GEOMETRIES: dict[str, Callable[[Appearance], FloatArray]] = {
    "45/0": _ring,
    "d/8 SCI": _sphere,
    "d/8 SCE": functools.partial(_sphere, trap=_TRAP),
}
