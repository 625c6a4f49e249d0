"""Cheap measures beside VWI; where they order two designs differently, the order is uncertain."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.ndimage import gaussian_filter

from seatlook.errors import InputError
from seatlook.model import FloatArray
from seatlook.visibility.kernels.pyramid import reduce
from seatlook.visibility.observer import OBSERVER
from seatlook.visibility.region import SMALLEST, check_luminance, check_mask
from seatlook.visibility.vwi import Mask

Verdict = Literal["first", "second", "equal", "not separable"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Measures:
    """One difference in three measures; each is 0 for equal pictures and grows with it.

    Parameters
    ----------
    vwi : float           see :func:`seatlook.visibility.vwi.score`
    log_ratio : float     rms of ln(test / reference)
    dissimilarity : float 1 - SSIM of the two pictures as a display shows them
    """

    vwi: float
    log_ratio: float
    dissimilarity: float


def cross_checked(
    vwi: float,
    test_luminance: FloatArray,
    reference_luminance: FloatArray,
    *,
    white: float,
    mask: Mask,
    left_out: int = 0,
) -> Measures:
    """Take the cheap measures of two pictures beside their VWI.

    Parameters
    ----------
    white : see :func:`dissimilarity`
    left_out : finest octaves that the VWI leaves out; the measures leave them out as well
    """
    pair, share = [test_luminance, reference_luminance], mask.astype(float)
    for _ in range(left_out):
        if min(share.shape) < 2 * SMALLEST:
            break
        pair, share = [reduce(picture) for picture in pair], reduce(share)
    # A region of a few pixels keeps those that it covers most.
    inside = share >= min(0.5, float(share.max()))
    return Measures(
        vwi=vwi,
        log_ratio=log_ratio(pair[0], pair[1], mask=inside),
        dissimilarity=dissimilarity(pair[0], pair[1], white=white, mask=inside),
    )


def log_ratio(
    test_luminance: FloatArray, reference_luminance: FloatArray, *, mask: Mask | None = None
) -> float:
    """Root mean square of ln(test / reference): contrast without an eye.

    Luminance counts from ``Observer.darkest`` on, so that black pixels do not decide.

    Examples
    --------
    >>> flat = np.full((16, 16), 50.0)
    >>> round(log_ratio(np.e * flat, flat), 12)
    1.0
    """
    test, reference = check_luminance(test_luminance, reference_luminance)
    region = check_mask(mask, test.shape)
    floor = OBSERVER.darkest
    ratio = np.maximum(test[region], floor) / np.maximum(reference[region], floor)
    return float(np.sqrt(np.mean(np.log(ratio) ** 2)))


def dissimilarity(
    test_luminance: FloatArray,
    reference_luminance: FloatArray,
    *,
    white: float,
    mask: Mask | None = None,
) -> float:
    """1 - SSIM (Wang et al. 2004, window sigma 1.5 pixels) of the pictures on a display.

    Parameters
    ----------
    white : float [cd/m2]   luminance shown as white, of the rig's exposure; brighter is clipped

    Examples
    --------
    >>> flat = np.full((16, 16), 50.0)
    >>> dissimilarity(flat, flat, white=100.0)
    0.0
    """
    test, reference = check_luminance(test_luminance, reference_luminance)
    region = check_mask(mask, test.shape)
    if not (np.isfinite(white) and white > 0):
        raise InputError.single("white", got=white, expected="a luminance above 0 cd/m2")
    x, y = (np.minimum(picture / white, 1.0) ** (1 / 2.2) for picture in (test, reference))
    mean_x, mean_y = _window(x), _window(y)
    var_x, var_y = _window(x * x) - mean_x**2, _window(y * y) - mean_y**2
    covariance = _window(x * y) - mean_x * mean_y
    c1, c2 = 0.01**2, 0.03**2
    similar = (2 * mean_x * mean_y + c1) * (2 * covariance + c2)
    similar /= (mean_x**2 + mean_y**2 + c1) * (var_x + var_y + c2)
    return float(1 - similar[region].mean())


def more_visible(first: Measures, second: Measures) -> Verdict:
    """Say which of two differences is more visible, if all measures agree; equal: in all of them.

    Examples
    --------
    >>> a = Measures(vwi=8.0, log_ratio=0.02, dissimilarity=0.002)
    >>> b = Measures(vwi=5.0, log_ratio=0.01, dissimilarity=0.001)
    >>> c = Measures(vwi=5.0, log_ratio=0.03, dissimilarity=0.001)
    >>> more_visible(a, b), more_visible(b, a), more_visible(a, c)
    ('first', 'second', 'not separable')
    """
    signs = {
        float(np.sign(getattr(first, name) - getattr(second, name)))
        for name in ("vwi", "log_ratio", "dissimilarity")
    }
    if len(signs) > 1:
        return "not separable"
    verdicts: dict[float, Verdict] = {1.0: "first", -1.0: "second", 0.0: "equal"}
    return verdicts[signs.pop()]


def _window(values: FloatArray) -> FloatArray:
    return np.asarray(gaussian_filter(values, 1.5, truncate=3.5, mode="reflect"))
