"""How much of a score lies in few pixels, and where: wrinkles are spread, faults are not."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from seatlook.model import Cover
from seatlook.visibility.observer import OBSERVER
from seatlook.visibility.pixels import Region
from seatlook.visibility.vwi import Map

TOP = 0.001  # share of the pixels that is looked at
CONCENTRATED = 0.3  # share of the energy in them above which no score is given
_PLACES = 3  # named at most


@dataclass(frozen=True, slots=True, kw_only=True)
class Concentration:
    """Share of a score's energy in the most visible 0.1 % of its pixels.

    Parameters
    ----------
    share : float, 0 to 1
    places : zone and middle of these pixels in it, where the pattern has them, the heaviest first
    """

    share: float
    places: tuple[str, ...]


def concentration(visibility: Map, region: Region, cover: Cover) -> Concentration:
    """Say what share of the energy of the map D (h, w) the most visible pixels of a region have."""
    energy = visibility[region.mask].astype(np.float64) ** OBSERVER.pooling
    count = max(1, round(TOP * energy.size))
    top = np.argpartition(energy, -count)[-count:]
    total, here = float(energy.sum()), energy[top]
    if not total > 0:
        return Concentration(share=0.0, places=())
    zone, face = region.zone[region.mask][top], region.face[region.mask][top]
    weight = np.bincount(zone, here, minlength=len(cover.zone_names))
    places = []
    for k in np.argsort(-weight)[:_PLACES]:
        if weight[k] > 0:
            inside = zone == k
            spots = cover.uv[cover.faces[face[inside]]].mean(axis=1)
            u, v = 1e3 * np.average(spots, axis=0, weights=here[inside])
            places.append(f"{cover.zone_names[k]} at {u:.0f}, {v:.0f} mm")
    return Concentration(share=float(here.sum()) / total, places=tuple(places))
