"""What no curve of a cloth or a foam looks like: swapped axes, other units, falls, five points."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from seatlook.errors import InputError
from seatlook.io.laboratory.types import Specimen
from seatlook.model import FloatArray

FEWEST = 10  # points of a specimen
_FALL = 0.1  # of the peak, while strain goes on rising: the piece has torn
_STEADY = 3  # points in a row
_APART = 8.0  # times, between a strip and the base


@dataclass(frozen=True, slots=True)
class Range:
    """Sizes that a quantity has in any test of a cover or a foam, SI."""

    low: float
    high: float

    def holds(self, value: float) -> bool:
        """Whether the largest reading of a curve may be this."""
        return self.low <= value <= self.high


@dataclass(frozen=True, slots=True)
class Sizes:
    """Ranges of the largest x, of the largest y, and of the one over the other."""

    x: Range
    y: Range
    slope: Range
    rising: bool = True


_ANY = Range(0.0, np.inf)
# Softest knit to stiffest coated cloth: secants of 400 N/m to 1 MN/m.
_SIZES: MappingProxyType[str, Sizes] = MappingProxyType(
    {
        "tensile": Sizes(Range(0.002, 1.5), Range(3.0, 1e5), Range(400.0, 1e6)),
        "shear": Sizes(Range(0.009, 1.2), Range(0.2, 1e4), Range(5.0, 5e4)),
        "bias-extension": Sizes(Range(5e-4, 0.5), Range(0.05, 1e4), Range(1.0, 1e6)),
        "bending": Sizes(Range(5.0, 2000.0), Range(1e-5, 10.0), Range(1e-7, 0.1)),
        "foam": Sizes(Range(0.1, 0.99), Range(100.0, 1e6), Range(300.0, 5e6)),
        "hanging-strip": Sizes(Range(0.005, 2.0), Range(5e-4, 2.0), _ANY),
        "compression": Sizes(Range(10.0, 1e6), Range(1e-5, 0.03), _ANY, rising=False),
        "surface": Sizes(_ANY, Range(0.0, 0.01), _ANY, rising=False),
    }
)


def check_specimen(
    kind: str,
    specimen: Specimen,
    columns: Sequence[str],
    units: Sequence[str],
    factors: Sequence[float],
) -> None:
    """Refuse a curve that no test of this kind gives.

    Parameters
    ----------
    columns : what messages call the columns of x and y
    units : that the file of tests names for them
    factors : from the numbers of the file to SI

    Raises
    ------
    InputError
        Too few points; a size that points to swapped columns or another unit; a curve that falls.
    """
    sizes = _SIZES[kind]
    x, y = np.abs(specimen.x), np.abs(specimen.y)
    if len(x) < FEWEST:
        raise _refusal(specimen, 0, "file", f"{len(x)} points", f"at least {FEWEST}")
    top = float(x.max()), float(y.max())
    at = int(x.argmax()), int(y.argmax())
    for axis, allowed in enumerate((sizes.x, sizes.y)):
        if not allowed.holds(top[axis]):
            other = top[1] / factors[1] * factors[0], top[0] / factors[0] * factors[1]
            swapped = sizes.x.holds(other[0]) and sizes.y.holds(other[1])
            raise _refusal(
                specimen, at[axis], columns[axis],
                f"{top[axis]:.4g} in SI at most, read in {units[axis]}",
                f"{allowed.low:g} to {allowed.high:g} for {kind}",
                "are the columns swapped?" if swapped else _other_unit(units[axis]),
            )  # fmt: skip
    if not sizes.slope.holds(top[1] / top[0]):
        raise _refusal(
            specimen, at[1], columns[1],
            f"{top[1]:.4g} at {top[0]:.4g} in SI, a stiffness of {top[1] / top[0]:.4g}",
            f"{sizes.slope.low:g} to {sizes.slope.high:g} for {kind}",
            f"is {units[1]} right, and are the columns in their order?",
        )  # fmt: skip
    if sizes.rising:
        _check_rise(specimen, columns[1])


def check_secant(
    specimen: Specimen, column: str, unit: str, strain: float, expected: float
) -> None:
    """Refuse a strip that is far from its base, which is most often a width forgotten.

    Parameters
    ----------
    strain, expected : largest strain [1], and the force per width [N/m] of the base there

    Raises
    ------
    InputError
        Over 8 times stiffer or softer; a strip of 50 mm makes 20 of N for N/m.
    """
    at = int(np.abs(specimen.y).argmax())
    ratio = float(np.abs(specimen.y[at])) / expected
    if not 1.0 / _APART < ratio < _APART:
        raise _refusal(
            specimen, at, column, f"{expected * ratio:.4g} N/m at a strain of {strain:.3g}",
            f"{expected / _APART:.4g} to {expected * _APART:.4g}, by the base",
            f"is it in {unit}, and the width right? Else name a base that is nearer, "
            "or say unusual = true",
        )  # fmt: skip


def _check_rise(specimen: Specimen, column: str) -> None:
    """Refuse a curve whose way out falls: the piece has torn or slipped."""
    x, y = specimen.x, specimen.y
    sign = np.sign(x[int(np.abs(x).argmax())])
    out = slice(0, int((sign * x).argmax()) + 1)
    x, y = sign * x[out], sign * y[out]
    if ((x - x.mean()) * (y - y.mean())).sum() < 0.0:
        y = -y  # an instrument that counts the other way
    smooth = _smoothed(y)
    peak = np.maximum.accumulate(smooth)
    drop = peak - smooth > _FALL * np.ptp(y)
    runs = np.convolve(drop, np.ones(_STEADY, dtype=int), "valid") >= _STEADY
    if len(y) >= FEWEST // 2 and runs.any():
        first = int(runs.argmax())
        raise _refusal(
            specimen, first, column, f"{y[first]:.4g} in SI, after a peak of {peak[first]:.4g}",
            "a curve that rises to its largest strain", "cut it where the piece tears or slips",
        )  # fmt: skip


def _smoothed(y: FloatArray) -> FloatArray:
    padded = np.concatenate([y[:1], y, y[-1:]])
    return np.asarray(np.median(np.stack([padded[:-2], padded[1:-1], padded[2:]]), axis=0))


def _other_unit(unit: str) -> str:
    """Name the unit that is most often mistaken for another one."""
    mistaken = {"1": "%", "%": "1", "N/m": "N or gf/cm", "N": "N/m", "gf/cm": "N/m", "deg": "rad",
                "rad": "deg", "1/m": "1/cm", "1/cm": "1/m", "Pa": "kPa", "kPa": "Pa"}  # fmt: skip
    return f"is it in {mistaken[unit]}?" if unit in mistaken else ""


def _refusal(
    specimen: Specimen, row: int, column: str, got: str, expected: str, hint: str = ""
) -> InputError:
    return InputError.single(
        column, got=got, expected=expected, file=specimen.file, line=int(specimen.lines[row]),
        hint=hint,
    )  # fmt: skip
