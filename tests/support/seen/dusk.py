"""How much less of a wrinkle is seen by dusk, by VWI with several gains of masking."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from seatlook import io
from seatlook.model import Appearance, FloatArray
from seatlook.visibility.heights import amplified, reference_rig
from seatlook.visibility.observer import OBSERVER
from seatlook.visibility.view import View, luminance
from seatlook.visibility.vwi import score

HEIGHTS = (0.0, 0.2, 0.4, 0.6, 0.8, 1.0)  # of the wrinkles as solved
GAINS = (1.0, 0.5, 0.25, 0.1, 0.0)
DUSK, DUSK_MEDIAN = 1e-3, 0.24  # of the daylight; cd/m2


def looks() -> dict[str, Appearance]:
    """Supplied textures, and both leathers without their grain."""
    black, bright, suede = (
        io.read_material(name).appearance for name in ("black-leather", "bright-leather", "suede")
    )
    smooth = replace(bright, texture="none")
    return {
        "black": black,
        "bright": bright,
        "suede": suede,
        "smooth black": replace(black, texture="none"),
        "smooth bright": smooth,
        "bright rough": replace(smooth, roughness=0.85, coat=0.0),
    }


def draw(view: View) -> dict[str, FloatArray]:
    """Luminance (6, h, w) of every look at every height, in the highlight of a high sun."""
    rig = reference_rig(view.camera)
    drawn: dict[str, list[FloatArray]] = {name: [] for name in looks()}
    for height in HEIGHTS:
        studio = view.studio_of(amplified(view, height))
        for name, look in looks().items():
            picture = studio.render(look, rig=rig, camera=view.camera, quality=view.quality)
            drawn[name].append(luminance(picture))
    return {name: np.stack(pictures) for name, pictures in drawn.items()}


def left_by_dusk(view: View, pictures: FloatArray, gain: float) -> list[float]:
    """VWI by day, its share left by dusk and the share of the height, at both kinds of dusk."""
    mask, ppd = view.region.mask, view.camera.pixels_per_degree
    observer = replace(OBSERVER, masking_gain=gain)

    def vwi(k: int, power: float) -> float:
        pair = power * pictures[k], power * pictures[0]
        return score(*pair, pixels_per_degree=ppd, mask=mask, observer=observer).vwi

    day = [vwi(k, 1.0) for k in range(len(HEIGHTS))]
    found = [day[-1]]
    for power in (DUSK, DUSK_MEDIAN / float(np.median(pictures[0][mask]))):
        dusk = vwi(-1, power)
        found += [dusk / day[-1], float(np.interp(dusk, day, HEIGHTS))]
    return found
