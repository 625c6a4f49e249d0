"""Threads that share the lines of a picture, or the points of a surface, among themselves."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from itertools import pairwise
from typing import TypeVar

import numba

Result = TypeVar("Result")

# Parts per thread: lines of the sky are done sooner than those of the seat.
_PARTS = 6


def in_parts(count: int, work: Callable[[int, int], Result], *, least: int = 1) -> list[Result]:
    """Results of ``work(first, last)`` on parts of ``range(count)``, in their order.

    As many threads as Numba may use (``NUMBA_NUM_THREADS``, without it all cores): one in the
    workers of a pool. ``least``: size of a part below which it is not worth a thread. What a part
    writes must not depend on where it begins.
    """
    threads = min(numba.config.NUMBA_NUM_THREADS, count // least)  # type: ignore[attr-defined]
    if threads < 2:
        return [work(0, count)]
    parts = min(_PARTS * threads, count // least)
    ends = [count * part // parts for part in range(parts + 1)]
    with ThreadPoolExecutor(threads) as pool:
        return list(pool.map(lambda ends: work(*ends), pairwise(ends)))
