"""What is seen beside all faces of a picture."""

from __future__ import annotations

import numpy as np

from seatlook.model import FloatArray, Rig, Surroundings
from seatlook.pbr.kernels.light import Indirect
from seatlook.pbr.light.rig import illuminance, white_of
from seatlook.pbr.shading.surface import Surface

# A grey card of 18 % fills the background where nothing is around the seat.
_CARD = 0.18


def backdrop(
    surface: Surface, around: Surroundings | None, rig: Rig, ev: float, indirect: Indirect
) -> FloatArray:
    """Radiance (3,) [cd/m2] beside all faces: a grey card, or the floor as it is far away.

    So no horizon is seen: the wall behind a floor without end has the floor's own radiance there.
    """
    if around is None or surface.ground is None:
        return np.asarray(_CARD * 2.5 * 2.0**ev / np.pi * white_of(rig))
    if not around.shown:
        return np.zeros(3)
    rim = surface.vertices + surface.ground.rim
    lux = np.zeros(3)
    for light in rig.lights:
        for point in surface.mesh.vertices[rim]:
            lux += illuminance(light, point) * light.colour / len(rim)
    return np.asarray(around.albedo * (indirect.diffuse[rim].mean(axis=0) + lux / np.pi))
