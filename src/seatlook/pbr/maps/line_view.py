"""Lines over bodies: a solid one, thin ones that let it show through, and lines before and behind.

Nothing is lit but by a lamp beside the camera, so it takes a fraction of a second.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import numpy.typing as npt
from PIL import Image as Pillow
from PIL import ImageDraw

from seatlook.mesh import arc_length, face_normals, segment_lengths
from seatlook.model import Camera, FloatArray, IntArray
from seatlook.pbr.maps.labels import Colour

FACTOR = 2  # of the size in which lines are drawn
PAPER: Colour = (250, 249, 246)
_AMBIENT = 0.62  # share of light that comes from everywhere
_REVERSE = 0.72  # of the light on the reverse side of a face
_BEHIND = 0.004  # of the viewing distance, from which a line lies behind the solid body
_FAINT = 0.35  # of the paper in a line that lies behind
_DASH = 6.0  # px, of lines behind
_STEP = 3.0  # px, to which it is known where a line goes behind
_MARGIN = 0.05  # of the picture's size, left free round what is shown


@dataclass(frozen=True, slots=True, kw_only=True)
class Body:
    """Triangles: ``vertices`` (n, 3) [m], ``faces`` (m, 3), ``colour`` (m, 3) in [0, 1] sRGB."""

    vertices: FloatArray
    faces: IntArray
    colour: FloatArray


@dataclass(frozen=True, slots=True, kw_only=True)
class Stroke:
    """A line through ``points`` (k, 3) [m], ``width`` px wide."""

    points: FloatArray
    colour: Colour
    width: float = 2.0


def tight(camera: Camera, points: FloatArray) -> Camera:
    """Camera from the same direction and distance in which all points just fill the picture."""
    width, height = camera.size
    for _ in range(3):
        pixels, _ = camera.pixels(points)
        low, high = pixels.min(axis=0), pixels.max(axis=0)
        ahead = camera.target - camera.position
        distance = float(np.linalg.norm(ahead))
        right = np.cross(ahead, camera.up)
        right = right / np.linalg.norm(right)
        down = np.cross(ahead / distance, right)
        step = 2 * distance * np.tan(np.radians(camera.vertical_fov_deg) / 2) / height
        off = (0.5 * (low + high) - 0.5 * np.array([width, height])) * step
        shift = off[0] * right + off[1] * down
        share = float(((high - low) / np.array([width, height])).max()) / (1 - 2 * _MARGIN)
        half = np.tan(np.radians(camera.vertical_fov_deg) / 2) * max(share, 1e-3)
        camera = replace(
            camera,
            position=camera.position + shift,
            target=camera.target + shift,
            vertical_fov_deg=float(np.clip(2 * np.degrees(np.arctan(half)), 1.0, 120.0)),
        )
    return camera


class LineView:
    """One view of a solid and a thin body, on which lines are drawn; ``picture()`` ends it.

    Raises
    ------
    NoOffscreenContext, RenderError
    """

    def __init__(self, camera: Camera, solid: Body | None, thin: Body) -> None:
        self.camera = camera
        self._solid = solid
        width, height = camera.size
        pixels = np.full((height, width, 3), PAPER, dtype=np.uint8)
        self._ids = np.full(pixels.shape[:2], -1, dtype=np.int32)
        if solid is not None:
            self._ids, tones = self._layer(solid)
            pixels = tones[self._ids]
        ids, tones = self._layer(thin)
        # Half of each; where no thin body is, all of what is behind it.
        mixed = (pixels.astype(np.uint16) + tones[ids]) // 2
        pixels = np.where((ids >= 0)[..., None], mixed, pixels).astype(np.uint8)
        # Bodies have no detail finer than a pixel: blended between pixels their edges are smooth.
        large = (FACTOR * width, FACTOR * height)
        self._picture = Pillow.fromarray(pixels).resize(large, Pillow.Resampling.BILINEAR)
        self._draw = ImageDraw.Draw(self._picture)
        self.lines = Pillow.new("L", camera.size, 0)
        self._lines = ImageDraw.Draw(self.lines)

    def _layer(self, body: Body) -> tuple[npt.NDArray[np.int32], npt.NDArray[np.uint8]]:
        """Faces of a body at each pixel, and the tones of all its faces, at last of the paper."""
        from seatlook.pbr._vtk import face_window

        ids = face_window().faces(body.vertices, body.faces, self.camera, self.camera.size)
        towards = self.camera.position - body.vertices[body.faces].mean(axis=1)
        towards /= np.linalg.norm(towards, axis=1, keepdims=True)
        facing = (face_normals(body.vertices, body.faces) * towards).sum(axis=1)
        light = (_AMBIENT + (1.0 - _AMBIENT) * np.abs(facing)) * np.where(facing < 0, _REVERSE, 1.0)
        tones = np.vstack([255 * body.colour * light[:, None], PAPER])
        return ids, np.rint(tones).astype(np.uint8)

    def hidden(self, points: FloatArray) -> npt.NDArray[np.bool_]:
        """Whether each of the points (k, 3) lies behind the solid body."""
        pixels, _ = self.camera.pixels(points)
        height, width = self._ids.shape
        column = np.clip(np.floor(pixels[:, 0]).astype(np.int64), 0, width - 1)
        row = np.clip(np.floor(pixels[:, 1]).astype(np.int64), 0, height - 1)
        face = self._ids[row, column]
        result = np.zeros(len(points), dtype=bool)
        over = np.flatnonzero(face >= 0)
        if self._solid is None or not len(over):
            return result
        corner = self._solid.vertices[self._solid.faces[face[over]]]
        normal = np.cross(corner[:, 1] - corner[:, 0], corner[:, 2] - corner[:, 0])
        ray = points[over] - self.camera.position
        along = (normal * ray).sum(axis=1)
        # 1 at the point itself, less where the body's face lies before it.
        share = ((corner[:, 0] - self.camera.position) * normal).sum(axis=1) / np.where(
            np.abs(along) > 1e-15, along, np.inf
        )
        result[over] = share < 1.0 - _BEHIND
        return result

    def draw(self, strokes: Sequence[Stroke]) -> None:
        """Draw lines: whole where they lie before the solid body, dashed and faint behind."""
        dense = _dense([stroke.points for stroke in strokes], self.camera)
        ends = np.cumsum([len(points) for points in dense])[:-1]
        points = np.concatenate(dense)
        pixels = np.split(self.camera.pixels(points)[0], ends)
        hidden = np.split(self.hidden(points), ends)
        for stroke, own, behind in zip(strokes, pixels, hidden, strict=True):
            self._stroke(stroke, own, behind)

    def _stroke(self, stroke: Stroke, pixels: FloatArray, hidden: npt.NDArray[np.bool_]) -> None:
        odd = (arc_length(pixels) // _DASH) % 2 == 1
        kind = np.where(hidden, 1 + odd, 0)  # 0 before the body, 1 a dash behind it, 2 between
        starts = [0, *(np.flatnonzero(np.diff(kind)) + 1), len(pixels)]
        for begin, end in pairwise(starts):
            piece = pixels[begin : end + 1]
            if kind[begin] == 0:
                self._line(piece, stroke.colour, stroke.width)
            elif kind[begin] == 1:
                self._line(piece, _faint(stroke.colour), max(1.0, 0.7 * stroke.width))

    def _line(self, pixels: FloatArray, colour: Colour, width: float) -> None:
        if len(pixels) < 2:
            return
        flat = [tuple(p) for p in (FACTOR * pixels).tolist()]
        self._draw.line(flat, fill=colour, width=round(FACTOR * width), joint="curve")
        self._lines.line([tuple(p) for p in pixels.tolist()], fill=255, width=max(1, round(width)))

    def ring(self, point: FloatArray, colour: Colour, radius: float = 13.0) -> None:
        """Draw a ring round a place."""
        ((x, y),), _ = self.camera.pixels(point[None])
        for grow, tone, width in ((1.5, PAPER, 6.0), (0.0, colour, 3.0)):
            r = FACTOR * (radius + grow)
            box = (FACTOR * x - r, FACTOR * y - r, FACTOR * x + r, FACTOR * y + r)
            self._draw.ellipse(box, outline=tone, width=round(FACTOR * width))

    def picture(self) -> Pillow.Image:
        """What has been drawn, in the camera's size."""
        return self._picture.resize(self.camera.size, Pillow.Resampling.BOX)


def _dense(lines: Sequence[FloatArray], camera: Camera) -> list[FloatArray]:
    """Lines with places about ``_STEP`` apart: they may go behind the solid body halfway."""
    ends = np.cumsum([len(points) for points in lines])[:-1]
    dense = []
    for points, pixels in zip(
        lines, np.split(camera.pixels(np.concatenate(lines))[0], ends), strict=True
    ):
        counts = np.clip(np.ceil(segment_lengths(pixels) / _STEP), 1, 2000)
        at = np.concatenate([[0.0], np.cumsum(counts)])
        places = np.arange(at[-1] + 1)
        dense.append(np.column_stack([np.interp(places, at, column) for column in points.T]))
    return dense


def _faint(colour: Colour) -> Colour:
    mixed = [round((1 - _FAINT) * c + _FAINT * p) for c, p in zip(colour, PAPER, strict=True)]
    return mixed[0], mixed[1], mixed[2]
