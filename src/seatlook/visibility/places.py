"""Where wrinkles show: the worst wrinkles and the zones of a scored result, each as it is seen."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np
import numpy.typing as npt

from seatlook.model import FloatArray
from seatlook.visibility.observer import VISIBLE
from seatlook.visibility.scoring import SceneScore
from seatlook.visibility.view import View
from seatlook.visibility.vwi import region_visibility
from seatlook.wrinkle import Wrinkle

SHOWS = VISIBLE  # VWI of a place from which it counts as seen
FLAT = 1.0  # [1/m] curvature of a valley below which there is none, a radius of 1 m
_LEAST = 0.010  # [m] round the deepest point of a wrinkle that is looked at, however short it is

Mask = npt.NDArray[np.bool_]


@dataclass(frozen=True, slots=True, kw_only=True)
class Place:
    """A place of a cover as it is seen under every light of a score.

    Parameters
    ----------
    rank : of the wrinkle there, from 1; None for a zone without one
    zone : name
    position : (3,) float64 [m]
    vwi : (texture, rig) -> VWI of its pixels
    """

    rank: int | None
    zone: str
    position: FloatArray
    vwi: MappingProxyType[tuple[str, str], float]

    @property
    def worst(self) -> tuple[str, str]:
        """Texture and rig that show it most."""
        return max(self.vwi, key=lambda cell: self.vwi[cell])

    @property
    def shows(self) -> bool:
        """Whether it is seen in any texture under any rig."""
        return self.vwi[self.worst] >= SHOWS

    @property
    def hidden_by(self) -> tuple[str, ...]:
        """Textures in which no rig shows it."""
        textures = dict.fromkeys(texture for texture, _ in self.vwi)
        return tuple(t for t in textures if max(self._of(t)) < SHOWS)

    def _of(self, texture: str) -> Iterator[float]:
        return (value for (name, _), value in self.vwi.items() if name == texture)


def places(score: SceneScore, wrinkles: Sequence[Wrinkle], valley: FloatArray) -> tuple[Place, ...]:
    """Wrinkles in view, and zones that show without one of them, the most visible first.

    A zone shows only if it has valleys: where 95 % of its faces are flatter than a radius of 1 m,
    what is seen is no wrinkle.

    Parameters
    ----------
    wrinkles : of the same result, ranked; what lies at ties and corners does not count
    valley : (m,) float64 [1/m]     curvature of valleys, 0 on crowns
    """
    ranked = [place for place in _wrinkles(score, wrinkles) if place is not None]
    with_one = {place.zone for place in ranked if place.shows}
    zones = (place for place in _zones(score, valley) if place.shows and place.zone not in with_one)
    return tuple(sorted((*ranked, *zones), key=lambda place: -place.vwi[place.worst]))


def _wrinkles(score: SceneScore, wrinkles: Sequence[Wrinkle]) -> Iterator[Place | None]:
    for rank, wrinkle in enumerate(wrinkles, 1):
        if wrinkle.kind != "wrinkle":
            continue
        pixels = _pixels(score.view, wrinkle)
        # Moving shadows leave out more under one light than under another.
        counted = {cell: pixels & sight.mask for cell, sight in score.grid.sights.items()}
        vwi = {
            cell: region_visibility(
                score.grid.sights[cell].score.map,
                pixels_per_degree=score.view.camera.pixels_per_degree,
                mask=mask,
            )
            for cell, mask in counted.items()
            if mask.any()
        }
        if vwi:
            yield Place(
                rank=rank,
                zone=wrinkle.zone,
                position=wrinkle.position,
                vwi=MappingProxyType(vwi),
            )


def _pixels(view: View, wrinkle: Wrinkle) -> Mask:
    """Pixels that count and show the panel no farther from the wrinkle than it is long."""
    cover = view.solution.cover
    centre = cover.rest[cover.faces].mean(axis=1)
    near = np.linalg.norm(centre - wrinkle.rest, axis=1) <= max(0.5 * wrinkle.length, _LEAST)
    near &= cover.panel == cover.panel_names.index(wrinkle.panel)
    return np.asarray(view.region.mask & near[view.region.face])


def _zones(score: SceneScore, valley: FloatArray) -> Iterator[Place]:
    """Every zone in view with valleys, at the pixel that is seen most in its worst cell."""
    view, sights = score.view, score.grid.sights
    cover, region = view.solution.cover, view.region
    for zone in dict.fromkeys(name for sight in sights.values() for name in sight.zones):
        number = cover.zone_names.index(zone)
        if np.quantile(valley[cover.zone == number], 0.95) < FLAT:
            continue
        vwi = {cell: s.zones[zone] for cell, s in sights.items() if zone in s.zones}
        worst = max(vwi, key=lambda cell: vwi[cell])
        inside = sights[worst].mask & (region.zone == number)
        seen = np.where(inside, sights[worst].score.map, -1.0)
        face = region.face[np.unravel_index(int(seen.argmax()), seen.shape)]
        yield Place(
            rank=None,
            zone=zone,
            position=view.solution.positions[cover.faces[face]].mean(axis=0),
            vwi=MappingProxyType(vwi),
        )
