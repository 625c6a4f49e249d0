"""One solved cover beside its reference, seen by one camera: every score starts here."""

from __future__ import annotations

import functools
import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from types import MappingProxyType
from typing import Any, NamedTuple

import numpy as np

from seatlook.errors import InputError
from seatlook.model import Appearance, Camera, FloatArray, Rig, Solution, WrinkleMap
from seatlook.pbr import Image, Studio
from seatlook.pbr.light.exposure import saturation_luminance
from seatlook.pbr.shading.studio import studio
from seatlook.visibility.bands import PEAK
from seatlook.visibility.concentration import CONCENTRATED, TOP, Concentration, concentration
from seatlook.visibility.cross_check import Measures, cross_checked
from seatlook.visibility.observer import NULL_LIMIT
from seatlook.visibility.pixels import Mask, Region, moving_shadows, region
from seatlook.visibility.reference import (
    CUTOFF,
    Mode,
    design_reference,
    height_over_design,
    on_foam,
    smooth_reference,
    waves,
)
from seatlook.visibility.region import SMALLEST
from seatlook.visibility.vwi import (
    VisibilityScore,
    region_visibility,
    score,
    zone_contrast,
    zone_visibility,
)

Looks = Appearance | Mapping[str, Appearance] | None
# Waves of fewer elements are left out: the cover cannot carry them.
ELEMENTS_PER_WAVE = 3.0
# Luminance of linear sRGB (IEC 61966-2-1).
_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


class Sampling(NamedTuple):
    """How finely a view is drawn: a quality, and a density whatever the size of its picture."""

    quality: str = "score"
    pixels_per_degree: float = 45.0


SAMPLING = Sampling()


class ScoreRefusedError(InputError):
    """A cover without wrinkles scores: test and reference do not match."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Sight:
    """What one appearance under one rig gives.

    Parameters
    ----------
    score : over all zones that count
    zones, contrasts : zone -> VWI, and apparent contrast [%], of its pixels
    stretch, compression : VWI weighted by W_stretch and W_compression; None without indices, or
        where the index is 0 everywhere in view
    measures : the score beside its cross-checks
    peak : what of the score lies in few pixels, and where
    mask : (h, w) bool   the pixels that it is taken over
    """

    score: VisibilityScore
    zones: MappingProxyType[str, float]
    contrasts: MappingProxyType[str, float]
    stretch: float | None
    compression: float | None
    measures: Measures
    peak: Concentration
    mask: Mask


class View:
    """A solved cover and the same without its wrinkles, from one camera.

    Studios cache shadows per light and faces per camera, so further textures cost only shading.

    Attributes
    ----------
    camera : the one that was given, at the density of pixels of a score
    region : the pixels that count under any light, see :meth:`region_under`
    """

    def __init__(
        self,
        solution: Solution,
        camera: Camera,
        *,
        mode: Mode = "view-ray",
        cutoff: float = CUTOFF,
        sampling: Sampling = SAMPLING,
        element_size: float | None = None,
        like: Studio | None = None,
    ) -> None:
        """Make the reference.

        Parameters
        ----------
        mode : ``view-ray`` (the cover smoothed along the camera's rays), ``normals`` (shading
            smoothed, shape and shadows as they are: a lower bound) or ``design`` (the surface
            that was drawn)
        cutoff : float [m]   see :func:`smooth_reference`; not used by ``design``
        sampling : coarser for a search
        element_size : float [m]   waves shorter than three elements are left out; that of the
            coarsest mesh where several covers are compared, None for the cover's own
        like : of another shape of the same cover, which shares with a view that nobody else draws
        """
        self.solution, self.camera = solution, at_density(camera, sampling.pixels_per_degree)
        self.mode, self.cutoff, self.quality = mode, cutoff, sampling.quality
        self.element_size = element_size or solution.cover.element_size
        self.reference = self._reference()
        # Seams are what they are in both pictures: they are drawn without what lifts and puckers
        # them, which would hide waves beside them.
        self.test_studio = (
            Studio(solution, like=like, built=False) if like else studio(solution, built=False)
        )
        self.reference_studio = self.studio_of(self.reference)
        self.region: Region = region(self.test_studio, self.camera)
        self._under: tuple[Rig, Region] | None = None

    @property
    def highest_frequency(self) -> float:
        """Frequency [cycles/deg] of the shortest wave that the mesh carries, 1/(3 h), as seen."""
        wave = ELEMENTS_PER_WAVE * self.element_size
        return self.camera.pixels_per_degree * self.region.pixel / wave

    @property
    def _left_out(self) -> int:
        """Number of octaves that lie above the highest frequency."""
        finest = PEAK * self.camera.pixels_per_degree
        return max(0, math.ceil(math.log2(finest / self.highest_frequency)))

    def region_under(self, rig: Rig) -> Region:
        """The pixels that count under a rig: those away from edges of shadows that move."""
        if self.mode == "normals":  # both have the shadows of the cover itself
            return self.region
        if self._under is None or self._under[0] is not rig:
            studios = self.test_studio, self.reference_studio
            moving = moving_shadows(*studios, rig, self.camera, self.quality, self.region.side)
            self._under = rig, self.region.without(moving)
        return self._under[1]

    def _reference(self) -> Solution:
        if self.mode == "design":
            return design_reference(self.solution, self.camera)
        crests = None if self.solution.cover.foam is None else self.heights
        return smooth_reference(self.solution, self.camera, cutoff=self.cutoff, crests=crests)

    def studio_of(self, shape: Solution) -> Studio:
        """Make a studio for another shape of the cover, as the mode asks."""
        if self.mode == "normals":
            return Studio(self.solution, shading=shape, seen=self.test_studio, built=False)
        return Studio(shape, seen=self.test_studio, built=False)

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
        return self.compare(*self.draw(looks, rig), rig, indices=indices)

    def compare(
        self, picture: Image, reference: Image, rig: Rig, *, indices: WrinkleMap | None = None
    ) -> Sight:
        """Score the difference of two pictures of :meth:`draw`."""
        pair, seen = (luminance(picture), luminance(reference)), self.region_under(rig)
        result = self.score(*pair, seen)
        vwi, contrast = self.by_zone(result, seen)
        peak = concentration(result.map, seen, self.solution.cover)
        self._refuse(peak, result.vwi, rig)
        return Sight(
            score=result,
            zones=vwi,
            contrasts=contrast,
            stretch=None if indices is None else self._cause(result, seen, indices.w_stretch),
            compression=None
            if indices is None
            else self._cause(result, seen, indices.w_compression),
            measures=cross_checked(
                result.vwi,
                *pair,
                white=saturation_luminance(picture.ev100),
                mask=seen.mask,
                left_out=self._left_out,
            ),
            peak=peak,
            mask=seen.mask,
        )

    def by_zone(
        self, result: VisibilityScore, seen: Region
    ) -> tuple[MappingProxyType[str, float], MappingProxyType[str, float]]:
        """VWI and apparent contrast [%] of every zone that a region shows."""
        names = self.solution.cover.zone_names
        ppd = self.camera.pixels_per_degree
        shown = np.unique(seen.zone[seen.mask])
        vwi = zone_visibility(result.map, seen.zone, len(names), pixels_per_degree=ppd)
        contrast = zone_contrast(result.contrast_map, seen.zone, len(names))
        first, second = ({names[k]: float(v[k]) for k in shown} for v in (vwi, contrast))
        return MappingProxyType(first), MappingProxyType(second)

    def vwi(self, looks: Looks, rig: Rig) -> float:
        """VWI alone, for searches."""
        picture, reference = self.draw(looks, rig)
        return self.score(luminance(picture), luminance(reference), self.region_under(rig)).vwi

    def null_score(self, looks: Looks, rig: Rig, *, null: View | None = None) -> float:
        """VWI of the foam's own surface, with seams and texture, against its reference.

        Parameters
        ----------
        null : of :meth:`without_wrinkles`, where several scores are asked for

        Raises
        ------
        ScoreRefusedError
            A score of ``observer.NULL_LIMIT`` or more: then pictures and references do not match,
            and no score of this view can be trusted.
        InputError
            No foam.
        """
        vwi = (null or self.without_wrinkles()).vwi(looks, rig)
        if not vwi < NULL_LIMIT:
            raise ScoreRefusedError.single(
                f"score of view {self.camera.name} under {rig.name}",
                got=f"VWI {vwi:.3g} of a cover without wrinkles",
                expected=f"below {NULL_LIMIT:g}, or no score can be given",
            )
        return vwi

    def without_wrinkles(self) -> View:
        """The same view of the cover laid on its foam."""
        return View(
            on_foam(self.solution),
            self.camera,
            mode=self.mode,
            cutoff=self.cutoff,
            sampling=Sampling(self.quality, self.camera.pixels_per_degree),
            element_size=self.element_size,
            like=self.test_studio,
        )

    def draw(self, looks: Looks, rig: Rig) -> tuple[Image, Image]:
        """Draw the cover and its reference."""
        options: dict[str, Any] = {"rig": rig, "camera": self.camera, "quality": self.quality}
        return (
            self.test_studio.render(looks, **options),
            self.reference_studio.render(looks, **options),
        )

    def score(self, test: FloatArray, reference: FloatArray, seen: Region) -> VisibilityScore:
        """Score luminances (h, w) [cd/m2] of this view over a region, in the bands that count."""
        return score(
            test,
            reference,
            pixels_per_degree=self.camera.pixels_per_degree,
            mask=seen.mask,
            pixel_area=seen.area,
            highest_frequency=self.highest_frequency,
        )

    def _refuse(self, peak: Concentration, vwi: float, rig: Rig) -> None:
        # Of next to nothing it does not matter where it lies.
        if peak.share > CONCENTRATED and vwi >= NULL_LIMIT:
            raise ScoreRefusedError.single(
                f"score of view {self.camera.name} under {rig.name}",
                got=f"{100 * peak.share:.0f} % of what is visible in {100 * TOP:g} % of the "
                f"pixels: {', '.join(peak.places)}",
                expected=f"at most {100 * CONCENTRATED:g} %, as wrinkles have",
            )

    def _cause(self, result: VisibilityScore, seen: Region, index: FloatArray) -> float | None:
        """VWI weighted by an index (m,) of the faces in view."""
        weight = np.where(seen.mask, index[seen.face], 0.0)
        if not weight.any():
            return None
        ppd = self.camera.pixels_per_degree
        return region_visibility(result.map, pixels_per_degree=ppd, mask=seen.mask, weight=weight)


def at_density(camera: Camera, pixels_per_degree: float) -> Camera:
    """The same view in pixels of another density, to half a pixel of its width.

    Examples
    --------
    >>> at_density(Camera(name="a", position=np.ones(3), target=np.zeros(3)), 22.5).size
    (639, 359)
    """
    factor = pixels_per_degree / camera.pixels_per_degree
    width, height = (max(SMALLEST, round(factor * side)) for side in camera.size)
    return replace(camera, size=(width, height))


def luminance(image: Image) -> FloatArray:
    """Luminance (h, w) [cd/m2] of a picture."""
    return np.asarray(image.radiance.astype(np.float64) @ _LUMINANCE)
