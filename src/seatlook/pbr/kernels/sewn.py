"""Relief beside a seam as it is built: groove, pressed rows, pucker, needle dimples, plied thread.

What is wider than the drawn triangles, as the allowance below, is in their places.
"""

from __future__ import annotations

import numpy as np

from seatlook.pbr.kernels import leaf
from seatlook.pbr.kernels.noise import even

# Depth [m] and width [m] of the roll into the seam.
ROLL_DEPTH, ROLL_WIDTH = 0.0008, 0.0011
# Of the line that a row of stitches presses in.
PRESS_DEPTH, PRESS_WIDTH = 0.0002, 0.0012
# Of the cloth that bulges between two holes, and of the dimple that a needle leaves.
PUCKER_HEIGHT, PUCKER_WIDTH = 0.00016, 0.0019
DIMPLE_DEPTH, DIMPLE_WIDTH = 0.00016, 0.0006
HOLE = 0.00025
# Share by which pucker and place of a stitch differ from one to the next.
UNEVEN = 0.35
# Plies of a thread: length along it from one to the next [m], how many cross its width, height [m]
# of one over the valley beside it, and how dark that is.
PLY_LENGTH, PLY_ACROSS, PLY_HEIGHT, PLY_DARK = 0.0011, 1.6, 0.00006, 0.4
# Slope [1] of a thread's flank, and how far along the row a sample is blurred, of its width.
_STEEPEST, _BLUR = 0.9, 2.0


@leaf()
def overlap(x, half, width):
    """Share of a sample of a ``width`` around x that lies within ``half`` of 0."""
    low, high = max(x - 0.5 * width, -half), min(x + 0.5 * width, half)
    return max(0.0, high - low) / width


@leaf()
def below(t):
    """Share of a normal distribution that lies below t, within 0.0003 (Page 1977)."""
    return 0.5 + 0.5 * np.tanh(0.7978846 * t * (1.0 + 0.044715 * t * t))


@leaf()
def row_of_stitches(thread, rows, distance):
    """Offset [m] and number of the row that is next."""
    second = rows > 1.5 and distance > thread.offset + 0.5 * thread.gauge
    return (thread.offset + thread.gauge, 1) if second else (thread.offset, 0)


@leaf()
def sewn_relief(thread, rows, distance, arc, width):
    """Relief beside a seam for a sample ``width`` [m] wide.

    Returns slope away from the seam, slope along it, share of the base colour left, share of the
    sample covered by thread, and how bright that thread is beside an even one.
    """
    width = max(width, 1e-6)
    away = ROLL_DEPTH / ROLL_WIDTH * np.exp(-distance / ROLL_WIDTH)
    left, onward = 1.0 - 0.65 * np.exp(-distance / 0.0006), 0.0
    if rows < 0.5 or thread.width == 0.0:
        return away, onward, left, 0.0, 1.0
    pitch, half = thread.pitch, 0.5 * thread.width
    offset, row = row_of_stitches(thread, rows, distance)
    x = distance - offset
    number = int(np.floor(arc / pitch))
    y = arc - (number + 0.5) * pitch
    t = x / PRESS_WIDTH
    away += PRESS_DEPTH / PRESS_WIDTH * t * np.exp(-0.5 * t * t)
    # Stitches are regular and would beat with the pixels: along the row they are blurred.
    blur = _BLUR * width
    t, turn = x / PUCKER_WIDTH, 2.0 * np.pi / pitch
    seen = np.exp(-0.5 * (turn * blur) ** 2)
    high = seen * PUCKER_HEIGHT * (1.0 + UNEVEN * (2.0 * even(number, row, 5) - 1.0))
    bell = np.exp(-0.5 * t * t)
    away -= 0.5 * high * (1.0 + np.cos(turn * y)) * bell * t / PUCKER_WIDTH
    onward -= 0.5 * high * turn * np.sin(turn * y) * bell
    # The holes to both sides of this place, and their dimples.
    wide, hole = DIMPLE_WIDTH * DIMPLE_WIDTH + blur * blur, HOLE * HOLE + blur * blur
    deep = DIMPLE_DEPTH * DIMPLE_WIDTH * DIMPLE_WIDTH / wide
    dark = 0.75 * HOLE * HOLE / hole
    for k in range(-1, 2, 2):
        z = y - 0.5 * k * pitch
        r = x * x + z * z
        dimple = deep * np.exp(-0.5 * r / wide)
        away += dimple * x / wide
        onward += dimple * z / wide
        left *= 1.0 - dark * np.exp(-0.5 * r / hole)
    # Thread: a capsule; what a sample sees of it is its share of the sample.
    fine = np.exp(-2.5 * (width / half) ** 2)
    over = max(0.0, abs(y) - (0.5 * thread.length - half))
    across = half - fine * (half - np.sqrt(max(0.1 * half * half, half * half - over * over)))
    far = min(1.0, max(0.0, 2.0 * width / pitch - 0.5))
    onto = 0.0
    for k in range(-1, 2):
        onto += below((y - k * pitch + 0.5 * thread.length) / blur)
        onto -= below((y - k * pitch - 0.5 * thread.length) / blur)
    onto += far * (thread.length / pitch - onto)
    covered = overlap(x, across, width) * onto
    if covered < 1e-6:
        return away, onward, left, 0.0, 1.0
    r = min(1.0, np.sqrt(x * x + over * over) / half)
    steep = fine * _STEEPEST * r / np.sqrt(1.0 - 0.75 * r * r)
    size = max(r * half, 1e-9)
    ends = np.exp(-0.5 * (np.pi * blur / thread.width) ** 2)
    slope_x, slope_y = -steep * x / size, -ends * steep * np.copysign(over, y) / size
    # Plies run slantwise over it.
    seen = np.exp(-0.5 * (2.0 * np.pi * blur / PLY_LENGTH) ** 2)
    phase = 2.0 * np.pi * (y / PLY_LENGTH + PLY_ACROSS * x / thread.width)
    wave = -np.pi * seen * PLY_HEIGHT * np.sin(phase)
    slope_x += wave * PLY_ACROSS / thread.width
    slope_y += wave / PLY_LENGTH
    valley = 0.5 - 0.5 * np.cos(phase)
    bright = 1.0 - PLY_DARK * (seen * valley * valley + 0.375 * (1.0 - seen))
    away += covered * (slope_x - away)
    onward += covered * (slope_y - onward)
    return away, onward, left + covered * (bright - left), covered, bright
