"""What is sewn, hooked and framed, as it starts: lines of a drawing before anything is solved."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from seatlook.model import Cover, FloatArray, Points, Scene


@dataclass(frozen=True, slots=True, kw_only=True)
class StartLine:
    """A seam, hook or frame: pairs of places that are pulled onto each other.

    Parameters
    ----------
    number : such as "3" of a seam, "H1" of a hook, "F2" of a frame; from 1, in the scene's order
    name : of the seam, hook or frame
    target : name of the wire or curve; "" for a seam
    start, end : (s, 3) float64 [m]   on the cover, and on the other side, the wire or the curve
    length : (s,) float64 [m]         that each pair stands for
    """

    kind: Literal["seam", "hook", "frame"]
    number: str
    name: str
    target: str
    start: FloatArray
    end: FloatArray
    length: FloatArray

    @property
    def gaps(self) -> FloatArray:
        """Way (s,) [m] of each pair."""
        return np.asarray(np.linalg.norm(self.start - self.end, axis=1))

    @property
    def gap(self) -> float:
        """Mean way [m]."""
        return float(np.average(self.gaps, weights=self.length))

    @property
    def middle(self) -> FloatArray:
        """Place (3,) [m] halfway along, between both sides."""
        halfway = int(np.searchsorted(np.cumsum(self.length), 0.5 * self.length.sum()))
        return np.asarray(0.5 * (self.start[halfway] + self.end[halfway]))


def start_lines(scene: Scene, cover: Cover) -> tuple[StartLine, ...]:
    """Seams, then hooks, then frames of a cover at its start, numbered each from 1."""
    lines = [
        StartLine(
            kind="seam",
            number=str(number),
            name=seam.name,
            target="",
            start=_at(seam.a, cover),
            end=_at(seam.b, cover),
            length=seam.length,
        )
        for number, seam in enumerate(cover.stitchings, start=1)
    ]
    for kind, targets in (
        ("hook", {hook.name: hook.wire for hook in scene.hooks}),
        ("frame", {frame.name: frame.curve for frame in scene.frames}),
    ):
        anchors = [anchor for anchor in cover.anchors if anchor.kind == kind]
        lines += [
            StartLine(
                kind=anchor.kind,
                number=f"{kind[0].upper()}{number}",
                name=anchor.name,
                target=targets[anchor.name],
                start=_at(anchor.points, cover),
                end=anchor.target,
                length=anchor.length,
            )
            for number, anchor in enumerate(anchors, start=1)
        ]
    return tuple(lines)


def _at(points: Points, cover: Cover) -> FloatArray:
    return points.at(cover.positions)
