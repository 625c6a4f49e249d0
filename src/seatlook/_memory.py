"""Memory that is free, but kept by the C library."""

from __future__ import annotations

import ctypes
import functools
from collections.abc import Callable


def give_back() -> None:
    """Give what nothing uses any more back to the system, where the C library keeps it.

    After a large array is freed, glibc serves arrays of that size from a heap that it never
    shrinks, as long as anything lives near its end. The memory of a solved mesh then stays with the
    process beside that of the next one. Other libraries give it back by themselves.
    """
    trim = _trim()
    if trim is not None:
        trim(0)


@functools.cache
def _trim() -> Callable[[int], int] | None:
    """The function of glibc; None without glibc."""
    try:
        trim: Callable[[int], int] = ctypes.CDLL(None).malloc_trim
    except (AttributeError, OSError, TypeError):  # no glibc; on Windows None is no library
        return None
    return trim
