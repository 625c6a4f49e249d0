"""A picture sheet: one cover in every texture under every rig, from every view, on one page."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

from seatlook import pbr
from seatlook.chain.showing.parts import Pixels, digest_of, drawn, of_width, parts_folder
from seatlook.files import file_names, write_bytes
from seatlook.model import Appearance, Camera, Rig, Scene, Solution
from seatlook.model.progress import Progress, silent
from seatlook.pbr.picture import png

_PAPER, _INK = (255, 255, 255), (40, 40, 40)
_GAP, _HEAD, _SIDE = 6, 28, 150  # between pictures, above columns, beside rows [px]


def draw_sheet(
    solution: Solution,
    scene: Scene,
    out: Path,
    *,
    cameras: Sequence[Camera],
    width: int = 480,
    quality: str = "standard",
    progress: Progress = silent,
) -> Path:
    """Draw every texture of a scene under every rig from every camera into one PNG.

    Rows are textures; columns are rigs, or rigs and views. Single pictures are left in
    ``NAME.pictures`` until the sheet is written: a run that was stopped goes on with them.

    Parameters
    ----------
    width : of one picture [pixels]

    Raises
    ------
    NoOffscreenContext, RenderError
    """
    columns = [(rig, of_width(camera, width)) for rig in scene.rigs for camera in cameras]
    heads = [rig.name if len(cameras) == 1 else f"{rig.name}, {c.name}" for rig, c in columns]
    with parts_folder(out.with_suffix(".pictures")) as folder:
        cells = list(_cells(solution, scene, folder, columns, quality, progress))
        rows = [cells[k : k + len(columns)] for k in range(0, len(cells), len(columns))]
        write_bytes(out, png(laid_out(rows, list(scene.textures), heads)))
    return out


def _cells(
    solution: Solution,
    scene: Scene,
    folder: Path,
    columns: Sequence[tuple[Rig, Camera]],
    quality: str,
    progress: Progress,
) -> Iterator[Pixels]:
    """Draw, or read, row after row."""
    names, steps, step = file_names(scene.textures), len(scene.textures) * len(columns), 0
    for texture, appearance in scene.textures.items():
        for k, (rig, camera) in enumerate(columns):
            progress("render", rig=rig.name, texture=texture, step=step, steps=steps)
            step += 1
            what = (appearance, rig, camera, quality, scene.surroundings)

            def draw(
                appearance: Appearance | None = appearance, rig: Rig = rig, camera: Camera = camera
            ) -> pbr.Image:
                return pbr.render(
                    solution,
                    appearance,
                    rig=rig,
                    camera=camera,
                    quality=quality,
                    surroundings=scene.surroundings,
                )

            path = folder / f"{names[texture]}-{k}.png"
            yield drawn(path, digest_of(solution, *what), draw)


def laid_out(
    rows: Sequence[Sequence[Pixels]], names: Sequence[str], heads: Sequence[str]
) -> Pixels:
    """Lay pictures of rows out on white, (h, w, 3), with names beside rows and above columns.

    Examples
    --------
    >>> dark = np.zeros((20, 40, 3), dtype=np.uint8)
    >>> laid_out([[dark, dark], [dark, dark]], ["suede", "black"], ["sun", "bulb"]).shape
    (86, 248, 3)
    """
    widths = [max(row[k].shape[1] for row in rows) for k in range(len(heads))]
    heights = [max(picture.shape[0] for picture in row) for row in rows]
    size = (
        _SIDE + sum(widths) + _GAP * (len(widths) + 1),
        _HEAD + sum(heights) + _GAP * (len(heights) + 1),
    )
    sheet = Image.new("RGB", size, _PAPER)
    ink, font = ImageDraw.Draw(sheet), ImageFont.load_default(size=15)
    y = _HEAD + _GAP
    for row, name, height in zip(rows, names, heights, strict=True):
        x = _SIDE + _GAP
        ink.text((_GAP, y + height // 2), name, fill=_INK, font=font, anchor="lm")
        for picture, head, width in zip(row, heads, widths, strict=True):
            if y == _HEAD + _GAP:
                ink.text((x, _HEAD // 2), head, fill=_INK, font=font, anchor="lm")
            image = Image.fromarray(picture)
            sheet.paste(image, (x, y), image if image.mode == "RGBA" else None)
            x += width + _GAP
        y += height + _GAP
    return np.asarray(sheet)
