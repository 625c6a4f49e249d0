"""Twin of the relief beside a seam: heights written down one by one, slopes by differences."""

from __future__ import annotations

import numpy as np

from seatlook.pbr.kernels import sewn
from seatlook.pbr.kernels.noise import even


def _rows(thread, rows):
    return [thread.offset + k * thread.gauge for k in range(int(rows))]


def height(thread, rows, distance, arc):
    """Height [m] of the cloth beside a seam, without thread, as a fine sample sees it."""
    out = -sewn.ROLL_DEPTH * np.exp(-distance / sewn.ROLL_WIDTH)
    if rows < 1 or thread.width == 0:
        return out
    offsets = np.array(_rows(thread, rows))
    row = int(np.abs(offsets - distance).argmin())
    x, number = distance - offsets[row], int(np.floor(arc / thread.pitch))
    out -= sewn.PRESS_DEPTH * np.exp(-0.5 * (x / sewn.PRESS_WIDTH) ** 2)
    middle, holes = (number + 0.5) * thread.pitch, np.array([number, number + 1]) * thread.pitch
    high = sewn.PUCKER_HEIGHT * (1 + sewn.UNEVEN * (2 * even(number, row, 5) - 1))
    wave = 0.5 + 0.5 * np.cos(2 * np.pi * (arc - middle) / thread.pitch)
    out += high * wave * np.exp(-0.5 * (x / sewn.PUCKER_WIDTH) ** 2)
    r2 = x * x + (arc - holes) ** 2
    return out - sewn.DIMPLE_DEPTH * np.exp(-0.5 * r2 / sewn.DIMPLE_WIDTH**2).sum()


def slopes(thread, rows, distance, arc, step=1e-7):
    """Slopes away from the seam and along it, by central differences."""
    return (
        (height(thread, rows, distance + step, arc) - height(thread, rows, distance - step, arc))
        / (2 * step),
        (height(thread, rows, distance, arc + step) - height(thread, rows, distance, arc - step))
        / (2 * step),
    )


def covered(thread, rows, distance, arc):
    """Whether a point lies on a stitch."""
    half = 0.5 * thread.width
    z = (arc / thread.pitch - np.floor(arc / thread.pitch) - 0.5) * thread.pitch
    over = max(0.0, abs(z) - (0.5 * thread.length - half))
    return any(np.hypot(distance - offset, over) < half for offset in _rows(thread, rows))
