"""From radiance to a display: one exposure per rig, tone curve, sRGB, dither."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from seatlook.errors import InputError, did_you_mean
from seatlook.model import FloatArray, Rig
from seatlook.model.colour import srgb_encode
from seatlook.pbr.light.rig import SEAT, lux_at_seat

Radiance = npt.NDArray[np.float32]
# Lines of a picture that are shown at once.
_LINES = 256


def ev100(rig: Rig, point: tuple[float, float, float] | FloatArray = SEAT) -> float:
    """Exposure value at ISO 100 of a rig.

    The rig's own ``ev100`` where given, else from the illuminance E [lux] on a grey card lying
    face up at ``point``: ``EV100 = log2(E / 2.5)``, the incident-light equation with C = 250
    (ISO 2720). It knows neither camera, geometry nor material. To move a bulb at a fixed
    exposure, give the rig the value once found.

    Raises
    ------
    InputError
        No light of the rig reaches the card.

    Examples
    --------
    >>> from seatlook.model import bulb
    >>> round(ev100(Rig(name="lamp", lights=(bulb(lumen=800, position_mm=(0, 0, 600)),))), 2)
    6.67
    """
    if rig.ev100 is not None:
        return rig.ev100
    lux = lux_at_seat(rig, point)["total"]
    if not lux > 0:
        raise InputError.single(
            f"rig {rig.name}", got="0 lux on the grey card", expected="a light above the seat"
        )
    return float(np.log2(lux / 2.5))


def saturation_luminance(ev: float) -> float:
    """Luminance [cd/m2] that just becomes white: 1.2 * 2^EV100 (ISO 12232, saturation based)."""
    return float(1.2 * 2.0**ev)


def exposure_of(luminance: float) -> float:
    """EV100 at which a luminance [cd/m2] just becomes white.

    Examples
    --------
    >>> round(exposure_of(saturation_luminance(7.5)), 6)
    7.5
    """
    return float(np.log2(luminance / 1.2))


def clamp(x: FloatArray) -> FloatArray:
    """Linear up to white, then white: what is compared keeps its contrast."""
    return np.clip(x, 0.0, 1.0)


def neutral(x: FloatArray) -> FloatArray:
    """Khronos PBR Neutral 2024: linear below 0.8, highlights rolled off and desaturated."""
    low = x.min(axis=-1, keepdims=True)
    x = x - np.where(low < 0.08, low - 6.25 * low**2, 0.04)
    peak = x.max(axis=-1, keepdims=True)
    start, rest = 0.76, 0.24
    rolled = 1 - rest**2 / np.maximum(peak + rest - start, 1e-9)
    scaled = x * (rolled / np.maximum(peak, 1e-9))
    grey = 1 - 1 / (0.15 * (peak - rolled) + 1)
    bright = scaled * (1 - grey) + rolled * grey
    return np.clip(np.where(peak < start, x, bright), 0.0, 1.0)


TONE_CURVES: dict[str, Callable[[FloatArray], FloatArray]] = {"clamp": clamp, "neutral": neutral}


def to_display(
    radiance: Radiance, ev: float, *, white: FloatArray | None = None, tone: str = "clamp"
) -> npt.NDArray[np.uint8]:
    """Eight-bit sRGB (h, w, 3) of a radiance [cd/m2] at an exposure.

    ``white`` (3,) of luminance 1 is shown neutral (von Kries on linear sRGB); None: D65.

    A fixed dither of one code value hides the steps of smooth dark gradients; it is the same for
    every picture of a size, so pictures can still be subtracted.
    """
    if tone not in TONE_CURVES:
        raise InputError.single(
            "tone",
            got=repr(tone),
            expected=f"one of {', '.join(TONE_CURVES)}",
            hint=did_you_mean(tone, TONE_CURVES),
        )
    out = np.empty(radiance.shape, dtype=np.uint8)
    # By some lines: in doubles a large picture would take gigabytes.
    for top in range(0, len(radiance), _LINES):
        exposed = radiance[top : top + _LINES].astype(np.float64) / saturation_luminance(ev)
        if white is not None:
            exposed /= white
        code = 255.0 * srgb_encode(TONE_CURVES[tone](exposed))
        code += _dither(top, *exposed.shape[:2])
        out[top : top + _LINES] = np.floor(np.clip(code, 0.0, 255.0))
    return out


def _dither(top: int, height: int, width: int) -> FloatArray:
    """Interleaved gradient noise in (0, 1), one value per pixel; Jimenez 2014."""
    x, y = np.meshgrid(np.arange(width, dtype=float), top + np.arange(height, dtype=float))
    noise = np.modf(52.9829189 * np.modf(0.06711056 * x + 0.00583715 * y)[0])[0]
    # Short of both ends, so that white stays white where 255 comes out as 254.999.
    return np.asarray(0.002 + 0.996 * noise[..., None])
