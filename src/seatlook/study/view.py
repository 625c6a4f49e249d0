"""One solved cover beside its reference, seen by one camera: every score starts here."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Any

import numpy as np

from seatlook.errors import InputError
from seatlook.model import Appearance, Camera, FloatArray, Rig, Solution, WrinkleMap
from seatlook.pbr import Image, Studio
from seatlook.pbr.exposure import saturation_luminance
from seatlook.sensory.cross_check import Measures, dissimilarity, log_ratio
from seatlook.sensory.vwi import VisibilityScore, region_visibility, score
from seatlook.solver.distance import distance_field
from seatlook.study.reference import CUTOFF, Region, region, smooth_reference

Looks = Appearance | Mapping[str, Appearance] | None
NULL_LIMIT = 0.1
# Luminance of linear sRGB (IEC 61966-2-1).
_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


@dataclass(frozen=True, slots=True, kw_only=True)
class Sight:
    """What one appearance under one rig gives.

    Parameters
    ----------
    score : over all zones that count
    zones : zone -> VWI of its pixels
    stretch, compression : VWI weighted by W_stretch and W_compression; None without indices, or
        where the index is 0 everywhere in view
    measures : the score beside its cross-checks
    picture : the test picture, for the page
    """

    score: VisibilityScore
    zones: MappingProxyType[str, float]
    stretch: float | None
    compression: float | None
    measures: Measures
    picture: Image


class View:
    """A solved cover and the same without its wrinkles, from one camera.

    Studios keep shadows per light and faces per camera, so further textures cost only shading.
    """

    def __init__(
        self,
        solution: Solution,
        camera: Camera,
        *,
        cutoff: float = CUTOFF,
        zones: tuple[str, ...] | None = None,
        quality: str = "standard",
    ) -> None:
        """Smooth the reference; see :func:`smooth_reference` and :func:`region`."""
        self.solution, self.camera = solution, camera
        self.cutoff, self.quality = cutoff, quality
        self.reference = smooth_reference(solution, camera, cutoff=cutoff)
        self.test_studio, self.reference_studio = Studio(solution), Studio(self.reference)
        self.region: Region = region(self.test_studio, camera, zones=zones)

    def sight(self, looks: Looks, rig: Rig, *, indices: WrinkleMap | None = None) -> Sight:
        """Draw both covers and score the difference.

        Parameters
        ----------
        looks : one appearance for all panels, one per panel, or None for the panels' own
        indices : of the solution, to split the score by cause
        """
        picture, reference = self._draw(looks, rig)
        pair = luminance(picture), luminance(reference)
        found = self._score(*pair)
        mask = self.region.mask
        measures = Measures(
            vwi=found.vwi,
            log_ratio=log_ratio(*pair, mask=mask),
            dissimilarity=dissimilarity(
                *pair, white=saturation_luminance(picture.ev100), mask=mask
            ),
        )
        names = self.solution.cover.zone_names
        zones = {
            names[k]: region_visibility(found.map, mask=self.region.zone == k)
            for k in np.unique(self.region.zone[mask])
        }
        return Sight(
            score=found,
            zones=MappingProxyType(zones),
            stretch=None if indices is None else self._cause(found, indices.w_stretch),
            compression=None if indices is None else self._cause(found, indices.w_compression),
            measures=measures,
            picture=picture,
        )

    def vwi(self, looks: Looks, rig: Rig) -> float:
        """VWI alone, for searches."""
        picture, reference = self._draw(looks, rig)
        return self._score(luminance(picture), luminance(reference)).vwi

    def null_score(self, looks: Looks, rig: Rig) -> float:
        """VWI of the foam's own surface, with seams and texture, against its reference.

        Raises
        ------
        InputError
            No foam, or a score of 0.1 or more: then pictures and references do not lie on each
            other, and no score of this view may be believed.
        """
        null = View(on_foam(self.solution), self.camera, cutoff=self.cutoff, quality=self.quality)
        found = null.vwi(looks, rig)
        if not found < NULL_LIMIT:
            raise InputError.single(
                f"camera {self.camera.name}",
                got=f"VWI {found:.3g} of a cover without wrinkles",
                expected=f"below {NULL_LIMIT:g}, or no score can be given",
            )
        return found

    def _draw(self, looks: Looks, rig: Rig) -> tuple[Image, Image]:
        """Draw the cover and its reference."""
        options: dict[str, Any] = {"rig": rig, "camera": self.camera, "quality": self.quality}
        return (
            self.test_studio.render(looks, **options),
            self.reference_studio.render(looks, **options),
        )

    def _score(self, test: FloatArray, reference: FloatArray) -> VisibilityScore:
        return score(
            test,
            reference,
            pixels_per_degree=self.camera.pixels_per_degree,
            mask=self.region.mask,
            pixel_area=self.region.area,
        )

    def _cause(self, found: VisibilityScore, index: FloatArray) -> float | None:
        """VWI weighted by an index (m,) of the faces in view."""
        weight = np.where(self.region.mask, index[self.region.face], 0.0)
        if not weight.any():
            return None
        return region_visibility(found.map, mask=self.region.mask, weight=weight)


def on_foam(solution: Solution) -> Solution:
    """Lay the cover on the foam's surface, half its thickness above it: no wrinkle, no sag.

    Raises
    ------
    InputError
        No foam.
    """
    cover = solution.cover
    if cover.foam is None:
        raise InputError.single("foam", got="none", expected="the surface the cover was made for")
    field = distance_field(cover.foam.vertices, cover.foam.faces)
    half = np.zeros(len(cover.rest))
    np.maximum.at(half, cover.faces.ravel(), np.repeat(cover.thickness / 2, 3))
    x = np.array(solution.positions)
    for _ in range(8):
        height, normal = field.at(x)
        known = np.isfinite(height)
        x[known] -= (height - half)[known, None] * normal[known]
    return replace(solution, positions=x)


def luminance(image: Image) -> FloatArray:
    """Luminance (h, w) [cd/m2] of a picture."""
    return np.asarray(image.radiance.astype(np.float64) @ _LUMINANCE)
