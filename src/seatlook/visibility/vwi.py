"""VWI, the visible wrinkle index: how much a wrinkle changes what an eye receives.

Both pictures are split into octaves by a binomial pyramid (Burt and Adelson 1983). The change in
contrast of each octave is divided by its threshold: the reciprocal of the eye's sensitivity
(castleCSF), raised by the pattern that both pictures share in this octave and in the next two
(masking after Foley 1994). Octaves and pixels are pooled by a Minkowski sum over square degrees: 1
is the threshold of the observer. What lies above the threshold is seen as contrast less the
threshold (Kulikowski 1976). Fits and misses: ``docs/measurements/score.md``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from seatlook.errors import InputError
from seatlook.model import FloatArray
from seatlook.visibility.bands import Response, responses
from seatlook.visibility.kernels.pyramid import expand, reduce
from seatlook.visibility.observer import OBSERVER, Observer
from seatlook.visibility.region import check_luminance, check_mask, weighted_mean

Mask = npt.NDArray[np.bool_]
Map = npt.NDArray[np.float32] | FloatArray
Numbers = npt.NDArray[np.int32] | npt.NDArray[np.int64]


@dataclass(frozen=True, slots=True, kw_only=True)
class Band:
    """Share of one octave: its frequency [cycles/deg]; VWI and apparent contrast [%] alone."""

    frequency: float
    vwi: float
    apparent_contrast: float


@dataclass(frozen=True, slots=True, kw_only=True)
class VisibilityScore:
    """How visible the difference is; all figures over the mask.

    Parameters
    ----------
    vwi : float >= 0               Minkowski sum of D over square degrees, in thresholds of the
        observer; exactly 0 for equal pictures
    apparent_contrast : float [%]  what is seen above threshold: a grating of 10 % that fills the
        mask, far above its threshold, has 10
    p995 : float                   99.5th percentile of D
    visible_share : (float, float) share of the region with D above the two values of the observer
    visible_area : the same in [m2], None where no pixel area was given
    bands : finest first
    map : (h, w) float32           D of every pixel, masked or not: the VWI of one square degree of
        such pixels
    contrast_map : (h, w) float32  apparent contrast [%] of every pixel
    """

    vwi: float
    apparent_contrast: float
    p995: float
    visible_share: tuple[float, float]
    visible_area: tuple[float, float] | None
    bands: tuple[Band, ...]
    map: npt.NDArray[np.float32]
    contrast_map: npt.NDArray[np.float32]


def detectability(
    test_luminance: FloatArray, reference_luminance: FloatArray, pixels_per_degree: float
) -> float:
    """How far a difference between two pictures lies above the threshold of the eye.

    Parameters
    ----------
    test_luminance, reference_luminance : (h, w) float [cd/m2] >= 0
    pixels_per_degree : float

    Returns
    -------
    float
        d in thresholds: 1 where the observer just sees it; the VWI of the whole picture.

    Raises
    ------
    InputError
        As :func:`score`.

    Examples
    --------
    A patch of a grating of 4 cycles/deg, 1 deg wide, on 30 cd/m2: seen from 0.9 % contrast on.

    >>> x = (np.arange(128) - 63.5) / 40
    >>> patch = np.exp(-2 * (x**2 + x[:, None] ** 2)) * np.cos(2 * np.pi * 4 * x)
    >>> flat = np.full((128, 128), 30.0)
    >>> float(round(detectability(flat * (1 + 0.009 * patch), flat, 40.0), 1))
    1.0
    """
    return score(test_luminance, reference_luminance, pixels_per_degree=pixels_per_degree).vwi


def score(
    test_luminance: FloatArray,
    reference_luminance: FloatArray,
    *,
    pixels_per_degree: float,
    mask: Mask | None = None,
    pixel_area: float | Map | None = None,
    highest_frequency: float = np.inf,
    observer: Observer = OBSERVER,
) -> VisibilityScore:
    """Score how visible the difference between two pictures of one view is.

    Parameters
    ----------
    test_luminance, reference_luminance : (h, w) float [cd/m2] >= 0
        The same pixels must show the same point: a texture that moves by one pixel outscores a
        wrinkle.
    pixels_per_degree : float
    mask : (h, w) bool             pixels the figures are taken over; None = all
    pixel_area : [m2]              of the surface that a pixel shows, a number or (h, w)
    highest_frequency : [cycles/deg]    see :func:`seatlook.visibility.bands.responses`

    Returns
    -------
    VisibilityScore

    Raises
    ------
    InputError
        Shapes that differ, fewer than 16 x 16 pixels, nan, inf or negative luminance, an empty
        mask.

    Examples
    --------
    >>> reference = np.full((64, 64), 100.0)
    >>> test = reference * (1 + 0.05 * np.sin(np.arange(64) / 3))
    >>> score(test, reference, pixels_per_degree=45).vwi > 1
    True
    >>> score(test, test, pixels_per_degree=45).vwi
    0.0
    """
    test, reference = check_luminance(test_luminance, reference_luminance)
    region = check_mask(mask, test.shape)
    if not (np.isfinite(pixels_per_degree) and pixels_per_degree > 0):
        raise InputError.single("pixels_per_degree", got=pixels_per_degree, expected="above 0")
    area = None if pixel_area is None else np.broadcast_to(pixel_area, test.shape) * region
    octaves = responses(test, reference, pixels_per_degree, observer, highest_frequency)
    root = 1 / observer.pooling
    visibility = _collapse([octave.visible for octave in octaves], test.shape) ** root
    contrast = _collapse([octave.contrast for octave in octaves], test.shape) ** root
    contrast = _percent(contrast, observer)
    inside = visibility[region]
    return VisibilityScore(
        vwi=region_visibility(
            visibility, pixels_per_degree=pixels_per_degree, mask=region, observer=observer
        ),
        apparent_contrast=region_contrast(contrast, mask=region, observer=observer),
        p995=float(np.quantile(inside, 0.995)),
        visible_share=_each(observer, lambda limit: (inside > limit).mean()),
        visible_area=None
        if area is None
        else _each(observer, lambda limit: area[limit < visibility].sum()),
        bands=_band_scores(octaves, region, pixels_per_degree, observer),
        map=visibility.astype(np.float32),
        contrast_map=contrast.astype(np.float32),
    )


def region_visibility(
    visibility: Map,
    *,
    pixels_per_degree: float,
    mask: Mask | None = None,
    weight: FloatArray | None = None,
    observer: Observer = OBSERVER,
) -> float:
    """VWI of a region of the map D, or of a cause: pixels weighted by W_stretch, for instance.

    With weights it is the VWI of their weighted mean on the area over which they are spread,
    (sum w)^2 / sum w^2: where they are 0 and 1, the VWI of the pixels of 1.

    Parameters
    ----------
    visibility : (h, w)    ``VisibilityScore.map``
    mask : (h, w) bool; weight : (h, w) float64 >= 0

    Examples
    --------
    >>> region_visibility(
    ...     np.array([[0.0, 2.0]]), pixels_per_degree=1.0, weight=np.array([[0.0, 5.0]])
    ... )
    2.0
    """
    region = check_mask(mask, visibility.shape)
    share = region.astype(float) if weight is None else region * weight
    mean = weighted_mean(_power(visibility, observer), share)
    area = share.sum() ** 2 / np.square(share).sum() / pixels_per_degree**2
    return float((mean * area) ** (1 / observer.pooling))


def region_contrast(
    contrast: Map,
    *,
    mask: Mask | None = None,
    weight: FloatArray | None = None,
    observer: Observer = OBSERVER,
) -> float:
    """Apparent contrast [%] of a region of ``VisibilityScore.contrast_map``, or of a cause.

    Examples
    --------
    >>> region_contrast(np.array([[0.0, 2.0]]), weight=np.array([[0.0, 5.0]]))
    2.0
    """
    region = check_mask(mask, contrast.shape)
    share = region if weight is None else region * weight
    return float(weighted_mean(_power(contrast, observer), share) ** (1 / observer.pooling))


def zone_visibility(
    visibility: Map,
    zone: Numbers,
    count: int,
    *,
    pixels_per_degree: float,
    observer: Observer = OBSERVER,
) -> FloatArray:
    """VWI of every zone of the map D at once, (count,); nan for a zone without a pixel.

    Parameters
    ----------
    visibility : (h, w)    ``VisibilityScore.map``
    zone : (h, w) int    number of the zone, -1 outside all of them

    Examples
    --------
    >>> zone_visibility(np.array([[0.0, 2.0]]), np.array([[-1, 1]]), 2, pixels_per_degree=1.0)
    array([nan,  2.])
    """
    total, pixels = _zone_sums(_power(visibility, observer), zone, count)
    total[pixels == 0] = np.nan
    return np.asarray((total / pixels_per_degree**2) ** (1 / observer.pooling))


def zone_contrast(
    contrast: Map,
    zone: Numbers,
    count: int,
    *,
    observer: Observer = OBSERVER,
) -> FloatArray:
    """Apparent contrast [%] of every zone at once, (count,); nan for a zone without a pixel.

    Examples
    --------
    >>> zone_contrast(np.array([[0.0, 2.0]]), np.array([[-1, 1]]), 2)
    array([nan,  2.])
    """
    total, pixels = _zone_sums(_power(contrast, observer), zone, count)
    return np.asarray((total / np.where(pixels > 0, pixels, np.nan)) ** (1 / observer.pooling))


def _zone_sums(values: FloatArray, zone: Numbers, count: int) -> tuple[FloatArray, FloatArray]:
    """Sum of the values and number of pixels of every zone."""
    inside = zone >= 0
    total = np.bincount(zone[inside], values[inside], minlength=count).astype(float)
    return total, np.bincount(zone[inside], minlength=count).astype(float)


def _power(values: Map, observer: Observer) -> FloatArray:
    """Values to the power of the pooling exponent, in double precision."""
    return np.power(values, observer.pooling, dtype=np.float64)


def _percent(contrast: FloatArray, observer: Observer) -> FloatArray:
    """Per cent of a grating whose pixels have this Minkowski mean, so that phase does not count."""
    phase = np.arange(64) * np.pi / 64
    grating = np.mean(np.abs(np.cos(phase)) ** observer.pooling) ** (1 / observer.pooling)
    return np.asarray(contrast * (100.0 / grating))


def _collapse(energies: list[FloatArray], shape: tuple[int, ...]) -> FloatArray:
    """Bring all bands to full size and add them; the finest ones may be missing."""
    sizes, of_size = [shape], {energy.shape: energy for energy in energies}
    while sizes[-1] != energies[-1].shape:
        sizes.append(tuple(-(-side // 2) for side in sizes[-1]))
    total = energies[-1]
    for size in sizes[-2::-1]:
        grown = np.empty(size)
        expand(total, grown)
        if size in of_size:
            grown += of_size[size]
        total = grown
    return total


def _band_scores(
    octaves: list[Response], region: Mask, pixels_per_degree: float, observer: Observer
) -> tuple[Band, ...]:
    """Pool every band at its own size; the mask shrinks with it."""
    share, root = region.astype(float), 1 / observer.pooling
    area = float(region.sum()) / pixels_per_degree**2
    bands = []
    for octave in octaves:
        while share.shape != octave.visible.shape:
            share = reduce(share)
        contrast = np.asarray(weighted_mean(octave.contrast, share) ** root)
        bands.append(
            Band(
                frequency=octave.frequency,
                vwi=float((weighted_mean(octave.visible, share) * area) ** root),
                apparent_contrast=float(_percent(contrast, observer)),
            )
        )
    return tuple(bands)


def _each(observer: Observer, measure: Callable[[float], float]) -> tuple[float, float]:
    """Take a measure at both values of D that count as visible."""
    low, high = observer.visible
    return float(measure(low)), float(measure(high))
