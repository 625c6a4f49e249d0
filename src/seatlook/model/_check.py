"""Checks that every core type runs on its arrays when it is made."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from seatlook.errors import InputError

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]


FARTHEST = 1e3  # [m] no seat reaches beyond, and squares of it are still exact
LARGEST_STRAIN = 1e3  # a thousandfold length is no cloth


def floats(
    owner: object, name: str, *shape: int | None, finite: bool = True, most: float = np.inf
) -> None:
    """Make field ``name`` a read-only float64 array of ``shape`` (None = any length).

    Its entries are finite and at most ``most`` from 0, but for those that may be nan.
    """
    _array(owner, name, np.float64, shape)
    value = getattr(owner, name)
    if value.size and np.abs(value[np.isfinite(value)]).max(initial=0.0) > most:
        farthest = value.flat[np.nanargmax(np.where(np.isfinite(value), np.abs(value), 0.0))]
        raise InputError.single(
            _key(owner, name), got=f"{farthest:g}", expected=f"{-most:g} to {most:g}"
        )
    if finite and not np.isfinite(value).all():
        bad = int(np.count_nonzero(~np.isfinite(value)))
        raise InputError.single(_key(owner, name), got=f"{bad} nan or inf", expected="finite")


def ints(owner: object, name: str, *shape: int | None, below: int | None = None) -> None:
    """Make field ``name`` a read-only int64 array with entries in [0, below)."""
    _array(owner, name, np.int64, shape)
    value = getattr(owner, name)
    if below is not None and value.size and (value.min() < 0 or value.max() >= below):
        raise InputError.single(
            _key(owner, name),
            got=f"index range {value.min()}..{value.max()}",
            expected=f"0..{below - 1}",
        )


def in_range(owner: object, name: str, low: float, high: float) -> None:
    """Refuse a number (or array) outside [low, high]; nan is outside."""
    value = np.asarray(getattr(owner, name))
    if not bool(((value >= low) & (value <= high)).all()):
        raise InputError.single(
            _key(owner, name), got=getattr(owner, name), expected=f"{low:g} to {high:g}"
        )


def positive(owner: object, *names: str) -> None:
    """Refuse a number that is not finite and above zero."""
    for name in names:
        value = getattr(owner, name)
        if not (np.isfinite(value) and value > 0):
            raise InputError.single(_key(owner, name), got=value, expected="a number above 0")


def _key(owner: object, name: str) -> str:
    return f"{type(owner).__name__}.{name}"


def _array(owner: object, name: str, dtype: Any, shape: tuple[int | None, ...]) -> None:
    given = np.asarray(getattr(owner, name))
    value = np.array(given, dtype=dtype, order="C")
    if dtype is np.int64 and given.dtype.kind == "f" and not (value == given).all():
        raise InputError.single(_key(owner, name), got="fractions", expected="whole numbers")
    expected = tuple("n" if n is None else n for n in shape)
    if value.ndim != len(shape) or any(
        n is not None and n != m for n, m in zip(shape, value.shape, strict=True)
    ):
        raise InputError.single(
            _key(owner, name), got=f"shape {value.shape}", expected=f"shape {expected}"
        )
    value.setflags(write=False)
    object.__setattr__(owner, name, value)
