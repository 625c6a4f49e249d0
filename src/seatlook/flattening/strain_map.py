"""The strain that flattening leaves in the panels, drawn on them as they are cut."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt
from PIL import Image, ImageDraw
from scipy.spatial import cKDTree

from seatlook.files import write_bytes
from seatlook.flattening import DesignSurface, Flattened
from seatlook.flattening.surface import Patch
from seatlook.mesh import arc_length
from seatlook.model import FloatArray
from seatlook.model.colour import srgb_encode
from seatlook.pbr.maps.face_map import PAPER, colour_table, with_bar
from seatlook.pbr.picture import png

_WIDTH, _HEIGHT = 900, 640  # px
_ROOM = 150  # px on the right, for the bar
_EDGE, _TOP = 24, 56  # px around the panel
_DASH = 7  # px
_FACTOR = 2  # samples per pixel and axis
_ROUND = 0.005  # the range ends at a multiple of this


def write_strain_maps(surface: DesignSurface, flat: Flattened, out: Path) -> tuple[Path, ...]:
    """Write one picture per panel: the larger of the two principal strains, in one range for all.

    Above 0 the form stretches the panel there, below 0 there is too much of it. The dart that a
    warning proposes is a dashed line.
    """
    size = np.abs(flat.strain).argmax(axis=1)
    strain = flat.strain[np.arange(len(size)), size]
    top = _ROUND * max(1.0, float(np.ceil(np.quantile(np.abs(strain), 0.995) / _ROUND)))
    paths = []
    for i, patch in enumerate(surface.patches()):
        path = out / f"strain-{_slug(patch.name)}.png"
        darts = [_flat_line(patch, flat, e.dart) for e in flat.excess if e.panel == patch.name]
        x, of_panel = flat.flat[patch.name], strain[surface.panel == i]
        picture = _panel(x, patch.faces, of_panel, top, darts)
        table = colour_table("diverging")
        title = f"{patch.name}: strain left when laid onto the design; warp upward"
        write_bytes(path, png(with_bar(picture, table, (-100 * top, 100 * top), title, "%")))
        paths.append(path)
    return tuple(paths)


def _flat_line(patch: Patch, flat: Flattened, line: FloatArray) -> FloatArray:
    """Return where vertices of a patch, given by their place on the form, lie in the flat panel."""
    return np.asarray(flat.flat[patch.name][cKDTree(patch.vertices).query(line)[1]])


def _panel(
    x: FloatArray,
    faces: npt.NDArray[np.int64],
    value: FloatArray,
    top: float,
    darts: Sequence[FloatArray],
) -> npt.NDArray[np.uint8]:
    """Pixels of one panel, warp upward, as large as there is room, with lines (k, 2) in it."""
    low, high = x.min(axis=0), x.max(axis=0)
    room = np.array([_WIDTH - _ROOM - 2 * _EDGE, _HEIGHT - _TOP - _EDGE])
    scale = float((room / (high - low)).min())
    centre = np.array([_EDGE, _TOP]) + 0.5 * room
    place = (x - 0.5 * (low + high)) * [scale, -scale] + centre
    table = np.rint(255 * srgb_encode(colour_table("diverging"))).astype(np.uint8)
    row = np.rint((np.clip(value / top, -1, 1) + 1) / 2 * (len(table) - 1)).astype(np.int64)
    picture = Image.new("RGB", (_WIDTH * _FACTOR, _HEIGHT * _FACTOR), (PAPER,) * 3)
    draw = ImageDraw.Draw(picture)
    for corners, colour in zip((_FACTOR * place)[faces].tolist(), table[row].tolist(), strict=True):
        # With an outline of its own colour no seam of paper shows between neighbours.
        draw.polygon([tuple(c) for c in corners], fill=tuple(colour), outline=tuple(colour))
    for line in darts:
        arc = arc_length(line)
        dashes = np.arange(0.0, arc[-1], 2 * _DASH / scale)
        for start in dashes:
            at = np.linspace(start, min(start + _DASH / scale, arc[-1]), 5)
            points = np.column_stack([np.interp(at, arc, column) for column in line.T])
            points = ((points - 0.5 * (low + high)) * [scale, -scale] + centre) * _FACTOR
            draw.line([tuple(p) for p in points.tolist()], fill=(0, 0, 0), width=2 * _FACTOR)
    return np.asarray(picture.resize((_WIDTH, _HEIGHT), Image.Resampling.BOX))


def _slug(name: str) -> str:
    return "".join(c if c.isalnum() else "-" for c in name.lower()).strip("-")
