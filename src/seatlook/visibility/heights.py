"""Equivalent height: how deep the same wrinkles would be on black leather to look the same."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from types import MappingProxyType

import numpy as np

from seatlook.errors import InputError
from seatlook.model import Appearance, Camera, FloatArray, Rig, Solution, sun
from seatlook.visibility.view import View, luminance

# Heights of the ladder over that of the field; what looks higher than the last reads "above".
LADDER = (0.0, 0.125, 0.25, 0.5, 1.0, 1.5)


def reference_rig(camera: Camera) -> Rig:
    """Sun at 70 deg that gives 20 klx on the seat, and 2 klx from all around the interior.

    It stands opposite the camera, where a crown of black leather shows its highlight.
    """
    elevation = 70.0
    eye = camera.position - camera.target
    azimuth = float(np.degrees(np.arctan2(eye[0], -eye[1]))) + 180.0
    facing = 20_000.0 / float(np.sin(np.radians(elevation)))
    lamp = sun(illuminance_lux=facing, elevation_deg=elevation, azimuth_deg=azimuth)
    return Rig(name="reference", lights=(lamp,), ambient=2_000.0 / np.pi)


@dataclass(frozen=True, slots=True, kw_only=True)
class Ladder:
    """VWI of one wrinkle field on black leather at several amplitudes.

    Parameters
    ----------
    height : float [m]            peak to valley of the field as solved
    heights : (k,) float64 [m]    rising from 0
    vwi : (k,) float64            0 at height 0
    zones : the same of the part of the field in each zone in view
    """

    height: float
    heights: FloatArray
    vwi: FloatArray
    zones: MappingProxyType[str, Ladder] = field(default_factory=lambda: MappingProxyType({}))

    @property
    def top(self) -> float:
        """Largest height [m] that can be read off."""
        return float(self.heights[-1])

    def equivalent(self, vwi: float) -> float:
        """Height [m] on black leather that scores ``vwi``; inf above the ladder.

        Interpolated linearly on the rising envelope, so the lowest height that reaches it.
        """
        envelope = np.maximum.accumulate(self.vwi)
        if vwi > envelope[-1]:
            return float("inf")
        rising = np.append(True, np.diff(envelope) > 0)
        return float(np.interp(vwi, envelope[rising], self.heights[rising]))


def amplitude_ladder(
    view: View,
    black: Appearance,
    *,
    rig: Rig | None = None,
    heights: Sequence[float] | None = None,
) -> Ladder:
    """Score the view's wrinkles on black leather at the heights of the ladder.

    The field keeps its form; vertices move along their camera rays between reference and solved
    cover, and beyond.

    Parameters
    ----------
    heights : [m] rising from 0; ``LADDER`` times that of the field, where none are given

    Raises
    ------
    InputError
        A field without height, or heights that do not rise from 0.
    """
    height = peak_to_valley(view)
    if not height > 0:
        raise InputError.single("wrinkles", got="no height", expected="a field to scale")
    rungs = height * np.asarray(LADDER) if heights is None else np.asarray(heights, dtype=float)
    if rungs[0] != 0 or not (np.diff(rungs) > 0).all():
        raise InputError.single("heights", got=rungs.tolist(), expected="rising from 0")
    rig = rig or reference_rig(view.camera)
    factors = rungs / height
    smooth, seen = _luminance(view, 0.0, black, rig), view.region_under(rig)
    values: list[float] = [0.0]
    zones: dict[str, list[float]] = {}
    for factor in factors[1:]:
        result = view.score(_luminance(view, float(factor), black, rig), smooth, seen)
        values.append(result.vwi)
        for name, vwi in view.by_zone(result, seen)[0].items():
            zones.setdefault(name, [0.0]).append(vwi)
    own = {name: peak_to_valley(view, name) for name in zones}
    ladders = {
        name: Ladder(height=own[name], heights=factors * own[name], vwi=np.array(zone))
        for name, zone in zones.items()
    }
    return Ladder(
        height=height, heights=rungs, vwi=np.array(values), zones=MappingProxyType(ladders)
    )


def amplified(view: View, factor: float) -> Solution:
    """Return the cover with its wrinkles ``factor`` times as high; 0 is the reference."""
    smooth = view.reference.positions
    return replace(view.solution, positions=smooth + factor * (view.solution.positions - smooth))


def peak_to_valley(view: View, zone: str | None = None) -> float:
    """Height [m] between which 95 % of the wrinkled area in view lies, of a zone or of all."""
    shown = np.unique(view.region.face[view.region.mask])
    cover = view.solution.cover
    if zone is not None:
        shown = shown[cover.zone[shown] == cover.zone_names.index(zone)]
    height = view.heights[cover.faces[shown]].ravel()
    weight = np.repeat(cover.rest_area[shown], 3)
    order = np.argsort(height)
    share = np.cumsum(weight[order]) / weight.sum()
    low, high = np.searchsorted(share, [0.025, 0.975])
    return float(height[order][min(high, len(order) - 1)] - height[order][low])


def _luminance(view: View, factor: float, looks: Appearance, rig: Rig) -> FloatArray:
    """Luminance (h, w) [cd/m2] of the cover with its wrinkles ``factor`` times as high."""
    if factor in (0, 1):
        studio = view.test_studio if factor else view.reference_studio
    else:
        studio = view.studio_of(amplified(view, factor))
    return luminance(studio.render(looks, rig=rig, camera=view.camera, quality=view.quality))
