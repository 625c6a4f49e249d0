"""What scores and cross-checks ask of their pictures and masks."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from seatlook.errors import InputError, Problem
from seatlook.model import FloatArray

SMALLEST = 16


def check_luminance(test: FloatArray, reference: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Both pictures as contiguous float64; every reason to refuse them at once."""
    pictures = {"test_luminance": test, "reference_luminance": reference}
    problems = []
    for name, picture in pictures.items():
        values = np.asarray(picture)
        if values.ndim != 2 or min(values.shape) < SMALLEST:
            expected = f"(h, w), at least {SMALLEST} x {SMALLEST}"
            problems.append(Problem(key=name, got=f"shape {values.shape}", expected=expected))
        bad = int(np.count_nonzero(~np.isfinite(values)))
        negative = int(np.count_nonzero(values < 0))
        if bad:
            problems.append(Problem(key=name, got=f"{bad} pixels nan or inf", expected="finite"))
        if negative:
            problems.append(
                Problem(key=name, got=f"{negative} pixels below 0", expected="cd/m2 from 0 up")
            )
    if not problems and np.shape(test) != np.shape(reference):
        problems.append(
            Problem(
                key="reference_luminance",
                got=f"shape {np.shape(reference)}",
                expected=f"shape {np.shape(test)}, as the test",
            )
        )
    if problems:
        raise InputError(problems)
    return tuple(np.ascontiguousarray(p, dtype=np.float64) for p in pictures.values())  # type: ignore[return-value]


def check_mask(mask: npt.NDArray[np.bool_] | None, shape: tuple[int, ...]) -> npt.NDArray[np.bool_]:
    """Return the mask, all true where None; refuse another shape, another type or an empty one."""
    if mask is None:
        return np.ones(shape, dtype=bool)
    if mask.dtype != bool or mask.shape != shape:
        raise InputError.single(
            "mask", got=f"{mask.dtype} of shape {mask.shape}", expected=f"bool of shape {shape}"
        )
    if not mask.any():
        raise InputError.single("mask", got="no pixel inside", expected="at least one")
    return mask


def weighted_mean(values: npt.NDArray[Any], weight: npt.NDArray[Any]) -> float:
    """Mean of ``values`` under ``weight`` >= 0, which must not be 0 everywhere."""
    total = float(weight.sum())
    if not total > 0:
        raise InputError.single("weight", got="0 everywhere", expected="above 0 somewhere")
    return float(np.multiply(values, weight).sum()) / total
