"""Words for where lines lie, by which those of one name are told apart: left, front, top, ..."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from seatlook.mesh.polyline import arc_length, segment_lengths

FloatArray = npt.NDArray[np.float64]

_WORDS = (("right", "left"), ("front", "rear"), ("bottom", "top"))  # low and high x, y, z
_APART = 0.003  # m; centres nearer than this are taken as one place
_AS_WIDE = 0.8  # an axis whose gap is so much of the widest one's comes before it in x, y, z


def place_words(lines: Sequence[FloatArray]) -> tuple[str, ...]:
    """Return a word for the place of each of several lines (k, 3) [m]; none for one alone.

    Lines are parted where the middles of their lengths lie farthest apart along an axis, the parts
    again, with a word for each: ``left``, ``left.front``. Lines that share their middle, as rings
    do, are called ``inner`` and ``outer``. As no word depends on the points that a line was drawn
    with, names made of them stay the same when a surface is meshed anew.

    Examples
    --------
    >>> x = np.array([[0.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    >>> place_words([x, x + [0.5, 0.0, 0.0]])
    ('right', 'left')
    >>> place_words([x])
    ('',)
    """
    words = [""] * len(lines)
    if len(lines) > 1:
        centres = np.array([_centre(line) for line in lines])
        lengths = np.array([arc_length(line)[-1] for line in lines])
        _part(list(range(len(lines))), centres, lengths, words)
    return tuple(words)


def border_names(curves: Sequence[FloatArray]) -> tuple[str, ...]:
    """Names of the free borders of a cover, by their places: ``border``, ``border.left``.

    Examples
    --------
    >>> border_names([np.eye(3)])
    ('border',)
    """
    return tuple(f"border.{word}" if word else "border" for word in place_words(curves))


def _part(group: list[int], centres: FloatArray, lengths: FloatArray, words: list[str]) -> None:
    """Add a word to those of a group, parted at the widest gap of their centres."""
    if len(group) == 1:
        return
    gaps = [np.diff(np.sort(centres[group, axis])).max() for axis in range(3)]
    axis = next(k for k in range(3) if gaps[k] >= _AS_WIDE * max(gaps))
    if gaps[axis] < _APART:
        order = sorted(group, key=lambda k: lengths[k])
        names = ("inner", *("between",) * (len(order) - 2), "outer")
        for number, (k, word) in enumerate(zip(order, names, strict=True)):
            _add(words, k, f"between_{number}" if word == "between" and len(order) > 3 else word)
        return
    order = sorted(group, key=lambda k: centres[k, axis])
    place = centres[order, axis]
    low, high = _WORDS[axis]
    steps = np.diff(place)
    if len(order) == 3 and steps.min() > 0.5 * steps.max():  # evenly spread
        for k, word in zip(order, (low, "middle", high), strict=True):
            _add(words, k, word)
        return
    cut = int(np.argmax(steps)) + 1
    for part, word in ((order[:cut], low), (order[cut:], high)):
        for k in part:
            _add(words, k, word)
        _part(part, centres, lengths, words)


def _add(words: list[str], k: int, word: str) -> None:
    words[k] = f"{words[k]}.{word}" if words[k] else word


def _centre(line: FloatArray) -> FloatArray:
    """Middle (3,) [m] of a line by its length."""
    size = segment_lengths(line)
    return np.asarray(size @ (line[1:] + line[:-1]) / (2 * size.sum()))
