"""One solved cover beside its reference, seen by one camera: every score starts here."""

from __future__ import annotations

import functools
from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Any

import numpy as np

from seatlook.errors import InputError
from seatlook.model import Appearance, Camera, FloatArray, Rig, Solution, WrinkleMap
from seatlook.pbr import Image, Studio
from seatlook.pbr.light.exposure import saturation_luminance
from seatlook.pbr.shading.studio import studio
from seatlook.visibility.cross_check import Measures, dissimilarity, log_ratio
from seatlook.visibility.reference import (
    CUTOFF,
    Mode,
    Region,
    design_reference,
    field_of,
    foam_of,
    half_thickness,
    height_over_design,
    region,
    smooth_reference,
    waves,
)
from seatlook.visibility.vwi import VisibilityScore, region_visibility, score, zone_visibility

Looks = Appearance | Mapping[str, Appearance] | None
NULL_LIMIT = 0.1
# Luminance of linear sRGB (IEC 61966-2-1).
_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


class ScoreRefusedError(InputError):
    """A cover without wrinkles scores: test and reference do not match."""


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

    Studios cache shadows per light and faces per camera, so further textures cost only shading.
    """

    def __init__(
        self,
        solution: Solution,
        camera: Camera,
        *,
        mode: Mode = "view-ray",
        cutoff: float = CUTOFF,
        zones: tuple[str, ...] | None = None,
        quality: str = "score",
    ) -> None:
        """Make the reference.

        Parameters
        ----------
        mode : ``view-ray`` (the cover smoothed along the camera's rays), ``normals`` (shading
            smoothed, shape and shadows as they are: a lower bound) or ``design`` (the surface
            that was drawn)
        cutoff : float [m]   see :func:`smooth_reference`; not used by ``design``
        zones : see :func:`region`
        """
        self.solution, self.camera = solution, camera
        self.mode, self.cutoff, self.quality = mode, cutoff, quality
        self.reference = self._reference()
        # The studio that pictures of this solution share.
        self.test_studio, self.reference_studio = studio(solution), self.studio_of(self.reference)
        self.region: Region = region(self.test_studio, camera, zones=zones)

    def _reference(self) -> Solution:
        if self.mode == "design":
            return design_reference(self.solution, self.camera)
        return smooth_reference(self.solution, self.camera, cutoff=self.cutoff)

    def studio_of(self, shape: Solution) -> Studio:
        """Make a studio for another shape of the cover, as the mode asks."""
        return Studio(self.solution, shading=shape) if self.mode == "normals" else Studio(shape)

    @functools.cached_property
    def heights(self) -> FloatArray:
        """Height (n,) [m] of every vertex over the reference, along the normal."""
        if self.mode == "design":
            return height_over_design(self.solution)
        return waves(self.solution, cutoff=self.cutoff)

    def sight(self, looks: Looks, rig: Rig, *, indices: WrinkleMap | None = None) -> Sight:
        """Draw both covers and score the difference.

        Parameters
        ----------
        looks : one appearance for all panels, one per panel, or None for the panels' own
        indices : of the solution, to split the score by cause
        """
        picture, reference = self._draw(looks, rig)
        pair = luminance(picture), luminance(reference)
        result = self._score(*pair)
        mask = self.region.mask
        measures = Measures(
            vwi=result.vwi,
            log_ratio=log_ratio(*pair, mask=mask),
            dissimilarity=dissimilarity(
                *pair, white=saturation_luminance(picture.ev100), mask=mask
            ),
        )
        names = self.solution.cover.zone_names
        values = zone_visibility(result.map, self.region.zone, len(names))
        zones = {names[k]: float(values[k]) for k in np.flatnonzero(np.isfinite(values))}
        return Sight(
            score=result,
            zones=MappingProxyType(zones),
            stretch=None if indices is None else self._cause(result, indices.w_stretch),
            compression=None if indices is None else self._cause(result, indices.w_compression),
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
        ScoreRefusedError
            A score of 0.1 or more: then pictures and references do not match, and no score of this
            view can be trusted.
        InputError
            No foam.
        """
        vwi = self._null.vwi(looks, rig)
        if not vwi < NULL_LIMIT:
            raise ScoreRefusedError.single(
                f"score of view {self.camera.name} under {rig.name}",
                got=f"VWI {vwi:.3g} of a cover without wrinkles",
                expected=f"below {NULL_LIMIT:g}, or no score can be given",
            )
        return vwi

    @functools.cached_property
    def _null(self) -> View:
        flat = on_foam(self.solution)
        return View(flat, self.camera, mode=self.mode, cutoff=self.cutoff, quality=self.quality)

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

    def _cause(self, result: VisibilityScore, index: FloatArray) -> float | None:
        """VWI weighted by an index (m,) of the faces in view."""
        weight = np.where(self.region.mask, index[self.region.face], 0.0)
        if not weight.any():
            return None
        return region_visibility(result.map, mask=self.region.mask, weight=weight)


def on_foam(solution: Solution) -> Solution:
    """Lay the cover on the foam's surface, half its thickness above it: no wrinkle, no sag.

    Raises
    ------
    InputError
        No foam.
    """
    cover = solution.cover
    field, half = field_of(foam_of(cover)), half_thickness(cover)
    x = np.array(solution.positions)
    for _ in range(8):
        height, normal = field.at(x)
        known = np.isfinite(height)
        x[known] -= (height - half)[known, None] * normal[known]
    return replace(solution, positions=x)


def luminance(image: Image) -> FloatArray:
    """Luminance (h, w) [cd/m2] of a picture."""
    return np.asarray(image.radiance.astype(np.float64) @ _LUMINANCE)
