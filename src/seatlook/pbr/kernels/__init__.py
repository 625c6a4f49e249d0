"""Compiled loops over samples and rays: numpy and numba only, nothing checked or raised."""

from __future__ import annotations

import functools

from numba import njit

# For functions that allocate nothing. Counting in and out every array read from a named tuple took
# two thirds of the time of a picture, then handing such tuples to functions, field by field on the
# stack, half of the rest.
leaf = functools.partial(njit, cache=True, _nrt=False, error_model="numpy", forceinline=True)
