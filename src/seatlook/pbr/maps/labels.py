"""Labels of a drawing, put where they hide neither each other nor its lines."""

from __future__ import annotations

import functools
from dataclasses import dataclass
from pathlib import Path

import matplotlib
import numpy as np
import numpy.typing as npt
from PIL import Image as Pillow
from PIL import ImageDraw, ImageFont

Colour = tuple[int, int, int]
Box = tuple[float, float, float, float]  # left, top, right, bottom [px]
PAPER_WHITE: Colour = (255, 255, 255)
_PAD = 4  # px round the text
_RADII = (0, 18, 28, 40, 54, 70, 90, 115, 145, 180, 220)  # px from where it belongs
_TURNS = 16
_COVERED = 0.06  # cost per pixel of a line that a label would hide
_CROSSED = 60.0  # cost of a leader through another label


@dataclass(frozen=True, slots=True, kw_only=True)
class Label:
    """A text that belongs to a pixel.

    Parameters
    ----------
    head : short text in white on the colour, such as a number
    text : in ink behind it
    at : (x, y) [px] where it belongs
    """

    colour: Colour
    head: str = ""
    text: str = ""
    at: tuple[float, float] = (0.0, 0.0)


@functools.cache
def font(size: int, *, bold: bool = False) -> ImageFont.FreeTypeFont:
    """Font with Latin, Greek and Cyrillic letters."""
    name = "DejaVuSans-Bold.ttf" if bold else "DejaVuSans.ttf"
    return ImageFont.truetype(Path(matplotlib.get_data_path()) / "fonts" / "ttf" / name, size)


def width_of(text: str, size: int, *, bold: bool = False) -> float:
    """Width of a text [px]."""
    return float(font(size, bold=bold).getlength(text)) if text else 0.0


def draw_labels(
    picture: Pillow.Image, labels: list[Label], lines: npt.NDArray[np.bool_], *, size: int = 15
) -> tuple[Box, ...]:
    """Draw labels near where they belong, with a leader where that is aside.

    Parameters
    ----------
    lines : (h, w) pixels that had better stay free

    Returns
    -------
    The boxes, one per label, that were taken; no two overlap unless the picture is full.
    """
    boxes = place_boxes(
        [label.at for label in labels],
        [_size_of(label, size) for label in labels],
        lines,
    )
    draw = ImageDraw.Draw(picture)
    for label, box in zip(labels, boxes, strict=True):
        foot = _nearest_on(box, label.at)
        if np.hypot(foot[0] - label.at[0], foot[1] - label.at[1]) > 2.0:
            draw.line((*label.at, *foot), fill=label.colour, width=1)
    for label, box in zip(labels, boxes, strict=True):
        draw_label(draw, label, (box[0], box[1]), size)
    return tuple(boxes)


def draw_label(
    draw: ImageDraw.ImageDraw, label: Label, corner: tuple[float, float], size: int
) -> None:
    """Draw one label with its top left corner at a pixel."""
    left, top = corner
    width, height = _size_of(label, size)
    middle = top + 0.5 * height
    box = (left, top, left + width, top + height)
    draw.rounded_rectangle(box, radius=4, fill=PAPER_WHITE, outline=label.colour, width=1)
    if label.head:
        edge = left + width_of(label.head, size, bold=True) + 2 * _PAD
        draw.rounded_rectangle((left, top, edge, top + height), radius=4, fill=label.colour)
        draw.text(
            (left + _PAD, middle),
            label.head,
            font=font(size, bold=True),
            fill=PAPER_WHITE,
            anchor="lm",
        )
        left = edge
    draw.text((left + _PAD, middle), label.text, font=font(size), fill=(30, 30, 30), anchor="lm")


def place_boxes(
    anchors: list[tuple[float, float]],
    sizes: list[tuple[float, float]],
    lines: npt.NDArray[np.bool_],
) -> list[Box]:
    """Place boxes one after the other: inside, over no other box, near, and over few lines."""
    height, width = lines.shape
    total = np.zeros((height + 1, width + 1))
    total[1:, 1:] = lines.cumsum(axis=0).cumsum(axis=1)
    offsets = [
        (radius * np.cos(turn), radius * np.sin(turn), float(radius))
        for radius in _RADII
        for turn in 2 * np.pi * np.arange(_TURNS if radius else 1) / _TURNS
    ]
    placed: list[Box] = []
    for (x, y), (w, h) in zip(anchors, sizes, strict=True):
        x, y = min(max(x, 0.0), float(width)), min(max(y, 0.0), float(height))
        best, least = (x - w / 2, y - h / 2, x + w / 2, y + h / 2), np.inf
        for dx, dy, radius in offsets:
            if radius >= least:  # every other is farther away still
                break
            # At the same angle a wide box has to go farther aside than a high one upward.
            mx, my = x + dx + np.sign(round(dx)) * w / 2, y + dy + np.sign(round(dy)) * h / 2
            left = min(max(mx - w / 2, 1.0), width - w - 1.0)
            top = min(max(my - h / 2, 1.0), height - h - 1.0)
            box = (left, top, left + w, top + h)
            cost = radius + 1e4 * sum(_overlap(box, other) for other in placed)
            if cost >= least:
                continue
            cost += _COVERED * _count(total, box)
            foot = _nearest_on(box, (x, y))
            cost += _CROSSED * sum(_crosses((x, y), foot, other) for other in placed)
            cost += 10.0 * sum(_inside(box, other) for other in anchors if other != (x, y))
            if cost < least:
                best, least = box, cost
        placed.append(best)
    return placed


def _size_of(label: Label, size: int) -> tuple[float, float]:
    head = width_of(label.head, size, bold=True) + 2 * _PAD if label.head else 0.0
    text = width_of(label.text, size) + 2 * _PAD if label.text else 0.0
    return head + text, size + 2.0 * _PAD


def _overlap(one: Box, two: Box) -> float:
    """Area [px2] of two boxes, with a pixel between them."""
    across = min(one[2], two[2]) - max(one[0], two[0]) + 2.0
    along = min(one[3], two[3]) - max(one[1], two[1]) + 2.0
    return max(across, 0.0) * max(along, 0.0)


def _count(total: npt.NDArray[np.float64], box: Box) -> float:
    """How many pixels of a box are marked, from their sums over rows and columns."""
    left, top, right, bottom = (round(v) for v in box)
    top, bottom = (min(max(v, 0), total.shape[0] - 1) for v in (top, bottom))
    left, right = (min(max(v, 0), total.shape[1] - 1) for v in (left, right))
    return float(total[bottom, right] - total[top, right] - total[bottom, left] + total[top, left])


def _inside(box: Box, point: tuple[float, float]) -> bool:
    return box[0] <= point[0] <= box[2] and box[1] <= point[1] <= box[3]


def _nearest_on(box: Box, point: tuple[float, float]) -> tuple[float, float]:
    return min(max(point[0], box[0]), box[2]), min(max(point[1], box[1]), box[3])


def _crosses(start: tuple[float, float], end: tuple[float, float], box: Box) -> bool:
    return any(
        _inside(box, (start[0] + t * (end[0] - start[0]), start[1] + t * (end[1] - start[1])))
        for t in np.linspace(0.0, 1.0, 12)
    )
