"""VWI, the visible wrinkle index: how much a wrinkle changes what an eye receives.

Both pictures are split into octaves by a binomial pyramid (Burt and Adelson 1983); the contrast
of each octave is weighed by the sensitivity of the eye to its frequency at its luminance (Barten)
and divided by how much the pattern that both share hides (masking after Foley 1994); octaves and
pixels are pooled by a Minkowski sum. Its unit is the threshold of the model observer, which no
jury has confirmed: see ``Observer.calibrated``.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from seatlook.errors import InputError
from seatlook.model import FloatArray
from seatlook.visibility.kernels.band import contrasts, weigh
from seatlook.visibility.kernels.pyramid import blur, expand, reduce
from seatlook.visibility.observer import (
    LOWEST_OCTAVE,
    NODES_PER_OCTAVE,
    OBSERVER,
    Observer,
    sensitivity_table,
)
from seatlook.visibility.region import check_luminance, check_mask, weighted_mean

Mask = npt.NDArray[np.bool_]


@dataclass(frozen=True, slots=True, kw_only=True)
class Band:
    """Share of one octave: its centre frequency [cycles/deg] and the VWI it has alone."""

    frequency: float
    vwi: float


@dataclass(frozen=True, slots=True, kw_only=True)
class VisibilityScore:
    """How visible the difference is; all figures over the mask, in thresholds of the observer.

    Parameters
    ----------
    vwi : float >= 0               Minkowski mean of D, exactly 0 for equal pictures
    p995 : float                   99.5th percentile of D
    visible_share : (float, float) share of the region with D above the two values of the observer
    visible_area : the same in [m2], None where no pixel area was given
    bands : finest first
    map : (h, w) float64           D of every pixel, masked or not
    """

    vwi: float
    p995: float
    visible_share: tuple[float, float]
    visible_area: tuple[float, float] | None
    bands: tuple[Band, ...]
    map: FloatArray


def score(
    test_luminance: FloatArray,
    reference_luminance: FloatArray,
    *,
    pixels_per_degree: float,
    mask: Mask | None = None,
    pixel_area: float | FloatArray | None = None,
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
    energies, frequencies = _bands(test, reference, pixels_per_degree, observer)
    energy = _collapse(energies)
    D = energy ** (1 / observer.pooling)
    inside = D[region]
    return VisibilityScore(
        vwi=float(energy[region].mean() ** (1 / observer.pooling)),
        p995=float(np.quantile(inside, 0.995)),
        visible_share=_each(observer, lambda limit: (inside > limit).mean()),
        visible_area=None if area is None else _each(observer, lambda limit: area[limit < D].sum()),
        bands=_band_scores(energies, frequencies, region, observer),
        map=D,
    )


def region_visibility(
    visibility: FloatArray,
    *,
    mask: Mask | None = None,
    weight: FloatArray | None = None,
    observer: Observer = OBSERVER,
) -> float:
    """VWI of a region of the map D, or of a cause: pixels weighted by W_stretch, for instance.

    Parameters
    ----------
    visibility : (h, w) float64    ``VisibilityScore.map``
    mask : (h, w) bool; weight : (h, w) float64 >= 0

    Examples
    --------
    >>> region_visibility(np.array([[0.0, 2.0]]), weight=np.array([[0.0, 5.0]]))
    2.0
    """
    region = check_mask(mask, visibility.shape)
    share = region if weight is None else region * weight
    return float(weighted_mean(visibility**observer.pooling, share) ** (1 / observer.pooling))


def zone_visibility(
    visibility: FloatArray,
    zone: npt.NDArray[np.int64],
    count: int,
    *,
    observer: Observer = OBSERVER,
) -> FloatArray:
    """VWI of every zone of the map D at once, (count,); nan for a zone without a pixel.

    Parameters
    ----------
    visibility : (h, w) float64    ``VisibilityScore.map``
    zone : (h, w) int64            number of the zone, -1 outside all of them

    Examples
    --------
    >>> zone_visibility(np.array([[0.0, 2.0]]), np.array([[-1, 1]]), 2)
    array([nan,  2.])
    """
    inside = zone >= 0
    energy = visibility[inside] ** observer.pooling
    total = np.bincount(zone[inside], energy, minlength=count)
    pixels = np.bincount(zone[inside], minlength=count)
    mean = total / np.where(pixels > 0, pixels, np.nan)
    return np.asarray(mean ** (1 / observer.pooling))


def _bands(
    test: FloatArray, reference: FloatArray, pixels_per_degree: float, observer: Observer
) -> tuple[list[FloatArray], list[float]]:
    """Return d^pooling of every band at its own size, and the bands' frequencies."""
    energies: list[FloatArray] = []
    frequencies: list[float] = []
    frequency = pixels_per_degree / (2 * np.sqrt(2))
    while frequency >= observer.lowest_frequency and min(test.shape) >= 4:
        test_next, reference_next = reduce(test), reduce(reference)
        ground, ground_reference = np.empty_like(test), np.empty_like(test)
        expand(test_next, ground)
        expand(reference_next, ground_reference)
        change, shared = np.empty_like(test), np.empty_like(test)
        contrasts(test, reference, ground, ground_reference, observer.darkest, change, shared)
        energies.append(_detect(change, blur(shared), ground, frequency, observer))
        frequencies.append(frequency)
        test, reference, frequency = test_next, reference_next, frequency / 2
    if not energies:
        raise InputError.single(
            "pixels_per_degree",
            got=pixels_per_degree,
            expected=f"at least one octave above {observer.lowest_frequency:g} cycles/deg",
        )
    return energies, frequencies


def _detect(
    change: FloatArray,
    mask: FloatArray,
    adaptation: FloatArray,
    frequency: float,
    observer: Observer,
) -> FloatArray:
    """Return d^pooling with d = change S / (1 + (k mask S)^q)^(1/p); uses up its arguments."""
    table = sensitivity_table(frequency, observer.field_deg)
    weigh(change, mask, adaptation, table, LOWEST_OCTAVE, NODES_PER_OCTAVE)
    mask *= observer.masking_gain
    hidden = 1 + mask**observer.masking_exponent
    change **= observer.pooling
    hidden **= -observer.pooling / observer.masking_root
    change *= hidden
    return change


def _collapse(energies: list[FloatArray]) -> FloatArray:
    """Bring all bands to full size and add them."""
    total = energies[-1]
    for energy in energies[-2::-1]:
        grown = np.empty_like(energy)
        expand(total, grown)
        grown += energy
        total = grown
    return total


def _band_scores(
    energies: list[FloatArray], frequencies: list[float], region: Mask, observer: Observer
) -> tuple[Band, ...]:
    """Pool every band at its own size; the mask shrinks with it."""
    share = region.astype(float)
    bands = []
    for energy, frequency in zip(energies, frequencies, strict=True):
        value = weighted_mean(energy, share) ** (1 / observer.pooling)
        bands.append(Band(frequency=frequency, vwi=float(value)))
        share = reduce(share)
    return tuple(bands)


def _each(observer: Observer, measure: Callable[[float], float]) -> tuple[float, float]:
    """Take a measure at both values of D that count as visible."""
    low, high = observer.visible
    return float(measure(low)), float(measure(high))
