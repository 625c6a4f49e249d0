"""Compiled loops over samples and rays: numpy and numba only, nothing checked or raised."""

from __future__ import annotations

import functools

from numba import njit

# For functions that allocate nothing: without it every array read from a named tuple is counted
# in and out, which took two thirds of the time of a picture.
leaf = functools.partial(njit, cache=True, _nrt=False, error_model="numpy")
