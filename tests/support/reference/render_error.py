"""How far pictures are from the path tracer: the scene, the protocol, FLIP and block error.

Protocol: object pixels, 67 pixels per degree, 640 x 360, 2 x 2 samples per pixel, exposure such
that the reference's median is 18 % display grey. FLIP (Andersson et al. 2020, BSD-3 package
``flip-evaluator``) on sRGB without dither; block error = mean |difference| of 8 x 8 blocks over
their mean.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numba import njit

from seatlook.io.material import read_material
from seatlook.model import Appearance, Camera, Rig, Solution, bulb, named_view, sun
from seatlook.model.colour import srgb_encode
from seatlook.pbr.kernels.grain import stroke
from seatlook.pbr.light.rig import LUMINANCE, white_of
from seatlook.pbr.reflectance.relief import load_textures
from seatlook.pbr.shading.look import pack_materials
from support.reference.lit_sheets import sheet
from support.reference.path_tracer import Relief

SUN = sun(elevation_deg=45, azimuth_deg=300)
BULB = bulb(position_mm=(-250, -100, 250))
DIRECT = {
    "sun": Rig(name="sun", lights=(SUN,)),
    "bulb": Rig(name="bulb", lights=(BULB,)),
}
# A bulb as bright as a studio lamp: beside 97 klx an 800 lm bulb would not count.
LAMP = bulb(lumen=60_000, position_mm=(250, 200, 250))
FULL = {"sun, bulb, sky": Rig(name="full", lights=(SUN, LAMP), ambient=5000.0)}
_EDGE = 0.1


def scene() -> Solution:
    """Two cushions with a seam trench between them and three wrinkles across one."""

    def height(x, y):
        crown = 0.03 * np.sqrt(np.maximum(0.02, 1 - (np.abs(x) / 0.05 - 1) ** 2))
        wrinkle = 0.0025 * np.cos(2 * np.pi * y / 0.035) * np.exp(-((y / 0.05) ** 2))
        return crown + np.where(x > 0, wrinkle, 0.0)

    return sheet(height, size=2 * _EDGE, panels=2, steps=60)


def camera(size: tuple[int, int] = (640, 360)) -> Camera:
    """Three-quarter view of the scene at 67 pixels per degree."""
    horizontal = np.radians(size[0] / 67)
    vertical = 2 * np.arctan(np.tan(horizontal / 2) * size[1] / size[0])
    view = named_view("front_34", target=np.array([0.0, 0.0, 0.015]), size=size, distance=0.75)
    return replace(view, vertical_fov_deg=float(np.degrees(vertical)))


def look(name: str, *, textured: bool) -> Appearance:
    """Appearance of a supplied material, with or without its grain."""
    appearance = read_material(name).appearance
    return appearance if textured else replace(appearance, texture="none", texture_depth=0.0)


def relief_of(appearance: Appearance) -> Relief | None:
    """Finest level of an appearance's relief, for the path tracer to resolve."""
    if appearance.texture == "none":
        return None
    material = pack_materials([appearance])[0]
    textures = load_textures(int(material["texture"]))
    n = textures.size
    finest = textures.texels[int(material["texture"]), : n * n].reshape(n, n, 4)
    steep = appearance.texture_depth / appearance.texture_scale
    values = finest[..., [0, 1, 3]] * [steep, steep, 1.0]
    tone = np.empty((200, 200))
    _tones(material, _EDGE * ((np.arange(200) + 0.5) / 100 - 1), tone)
    return Relief(values, textures.cells * appearance.texture_scale, tone, _EDGE)


@njit
def _tones(material, u, tone):
    for j in range(len(u)):
        for i in range(len(u)):
            tone[j, i] = stroke(material, u[i], u[j])


@dataclass(frozen=True)
class Difference:
    """FLIP and block error of a picture against its reference."""

    flip: float
    block: float


def compare(
    reference: np.ndarray, picture: np.ndarray, *, rig: Rig, cover: np.ndarray
) -> Difference:
    """Difference of two radiances (h, w, 3) over the pixels with ``cover`` 1."""
    from flip_evaluator import evaluate

    covered = cover == 1.0
    reference, picture = reference / white_of(rig), picture / white_of(rig)
    gain = 0.18 / np.median((reference @ LUMINANCE)[covered])
    shown = [
        srgb_encode(np.clip(np.where(covered[..., None], gain * x, 0.18), 0, 1)).astype(np.float32)
        for x in (reference, picture)
    ]
    errors, _, _ = evaluate(*shown, "LDR", applyMagma=False, parameters={"ppd": 67.0})
    errors = np.asarray(errors).reshape(*covered.shape, -1)[..., 0]
    return Difference(float(errors[covered].mean()), block_error(reference, picture, covered))


def block_error(reference: np.ndarray, picture: np.ndarray, covered: np.ndarray) -> float:
    """Mean |difference| of the 8 x 8 blocks that lie wholly on the object, over their mean."""
    h, w = (8 * (n // 8) for n in covered.shape)

    def blocks(x):
        return x[:h, :w].reshape(h // 8, 8, w // 8, 8).mean(axis=(1, 3))

    whole = blocks(covered.astype(float)) == 1.0
    a, b = (blocks(x @ LUMINANCE)[whole] for x in (reference, picture))
    return float(np.abs(a - b).mean() / a.mean())
