"""Which notches meet when two sides are sewn together."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from seatlook.assembly.seam_guess.outlines import Side
from seatlook.model import FloatArray

_REACH, _MISFIT = 0.002, 0.008  # m and share of the length by which notches that meet may miss


def match_notches(a: Side, b: Sequence[Side]) -> tuple[int, int]:
    """Count notches that meet one on the other side or a joint of it, and those that do not."""
    near = a.notches / a.length
    far, joints = _far_places(b)
    reach = _REACH / a.length + _MISFIT
    free = far.tolist()
    meeting = missing = 0
    for at in near:
        gaps = [abs(at - x) for x in free]
        if gaps and min(gaps) < reach:
            meeting += 1
            free.pop(int(np.argmin(gaps)))
        elif (np.abs(joints - at) < reach).any():
            meeting += 1
        else:
            missing += 1
    return meeting, missing + len(free)


def _far_places(b: Sequence[Side]) -> tuple[FloatArray, FloatArray]:
    """Shares of the far side's length, as it meets the near one, of its notches and joints."""
    total = sum(side.length for side in b)
    starts = np.cumsum([0.0, *(side.length for side in b)])
    notches = np.concatenate([s + side.notches for s, side in zip(starts, b, strict=False)])
    return 1.0 - np.sort(notches)[::-1] / total, 1.0 - starts[1:-1] / total


def notches_at_joints(a: Side, b: Sequence[Side]) -> int:
    """Count notches of one side at which the other goes from one edge to the next."""
    _, joints = _far_places(b)
    gaps = np.abs(a.notches[:, None] / a.length - joints)
    return int((gaps < _REACH / a.length + _MISFIT).sum())
