"""Pictures of a cover in the making: one for each stage, and moving ones."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt
from PIL import Image, ImageDraw, ImageFont

from seatlook import io, pbr
from seatlook.chain.timeline import shapes_name, stage_order
from seatlook.errors import InputError
from seatlook.files import write_bytes
from seatlook.model import Camera, FloatArray, Rig, Solution
from seatlook.pbr.picture import png

Pixels = npt.NDArray[np.uint8]

AT_REST = "at rest"
_LABEL = 30  # height of a label [px]
_MOST = 30  # pictures in the animation, spread evenly over the run
_PAPER, _INK = 248, (40, 40, 40)
_WHOLE = 1.1  # of the way from the camera to the cover's farthest point


@dataclass(frozen=True, slots=True)
class Shot:
    """One shape of the cover on its way.

    Parameters
    ----------
    stage : the stage it is in; time : float [s]; positions : (n, 3) float64 [m]
    """

    stage: str
    time: float
    positions: FloatArray


def shots(solution: Solution, folder: Path) -> tuple[Shot, ...]:
    """Read the shapes that ``solve_in_stages`` left in ``folder``, and add the finished one.

    Raises
    ------
    InputError
        No stage left shapes there, or they are of another mesh.
    """
    stages = list(_read(solution, folder))
    if not stages:
        raise InputError.single(
            "stages", got="no shapes", expected="the folder of a run that was solved in stages",
            file=folder,
        )  # fmt: skip
    start = Shot("placed", 0.0, solution.cover.positions)
    return (start, *stages, Shot(AT_REST, stages[-1].time, solution.positions))


def ends(taken: tuple[Shot, ...]) -> tuple[Shot, ...]:
    """The last shot of every stage, in order."""
    last = {shot.stage: shot for shot in taken}
    return tuple(last.values())


def draw(
    solution: Solution, taken: tuple[Shot, ...], *, camera: Camera, rig: Rig | None = None
) -> Iterator[Pixels]:
    """Draw shots, each with its stage and time written below, (h, w, 3) uint8.

    As previews; with a rig, rendered in their own materials, which takes some ten times as long.
    """
    view = _far_enough(camera, taken)
    for shot in taken:
        state = dataclasses.replace(solution, positions=shot.positions)
        if rig is None:
            picture = pbr.render_preview(state, camera=view)
        else:
            picture = pbr.render(state, rig=rig, camera=view, quality="draft").to_srgb()
        yield _labelled(picture, f"{shot.stage}, {shot.time:.2f} s")


def strip(pictures: list[Pixels], *, columns: int = 3) -> Pixels:
    """Lay pictures of one size out in rows."""
    height, width, _ = pictures[0].shape
    rows = -(-len(pictures) // columns)
    size = (rows * height, min(columns, len(pictures)) * width, 3)
    sheet = np.full(size, _PAPER, dtype=np.uint8)
    for k, picture in enumerate(pictures):
        y, x = divmod(k, columns)
        sheet[y * height : (y + 1) * height, x * width : (x + 1) * width] = picture
    return sheet


def film(
    solution: Solution,
    folder: Path,
    out: Path,
    *,
    camera: Camera,
    rig: Rig | None = None,
    width: int = 480,
    seconds: float = 5.0,
) -> tuple[Path, Path]:
    """Write ``timeline.png``, a picture per stage, and ``timeline.gif``, and return their paths.

    Parameters
    ----------
    folder : where the stages of the solution were kept
    rig : lights of the picture per stage; without it that is a preview, as the animation is
    width : of one picture [px]; the height follows from the camera
    seconds : the animation lasts
    """
    taken = shots(solution, folder)
    small = dataclasses.replace(
        camera, size=(width, round(width * camera.size[1] / camera.size[0]))
    )
    still, moving = out / "timeline.png", out / "timeline.gif"
    pictures = list(draw(solution, ends(taken), camera=small, rig=rig))
    write_bytes(still, png(strip(pictures)))
    every = np.unique(np.linspace(0, len(taken) - 1, min(_MOST, len(taken))).round().astype(int))
    chosen = tuple(taken[k] for k in every)
    io.write_animation(list(draw(solution, chosen, camera=small)), moving, seconds=seconds)
    return still, moving


def _read(solution: Solution, folder: Path) -> Iterator[Shot]:
    for stage in stage_order(solution.cover):
        path = folder / shapes_name(solution.cover, stage)
        if not path.exists():
            continue  # of stages that begin together only the last has steps of its own
        times, positions = io.read_shapes(path)
        if positions.shape[1] != len(solution.positions):
            raise InputError.single(
                "stages",
                got=f"{positions.shape[1]} vertices",
                expected=f"{len(solution.positions)}, as the result has",
                file=path,
            )
        for time, x in zip(times.tolist(), positions, strict=True):
            yield Shot(stage, time, np.array(x, dtype=np.float64))


def _far_enough(camera: Camera, taken: tuple[Shot, ...]) -> Camera:
    """Step back until the panels, which begin apart, are in the picture."""
    points = np.concatenate([shot.positions for shot in (taken[0], taken[-1])])
    away = camera.target - camera.position
    distance = float(np.linalg.norm(away))
    forward = away / distance
    right = np.cross(forward, camera.up)
    right /= np.linalg.norm(right)
    down = np.cross(forward, right)
    half_height = np.tan(np.radians(camera.vertical_fov_deg) / 2)
    half_width = half_height * camera.size[0] / camera.size[1]
    offset = points - camera.target
    depth = offset @ forward
    needed = np.maximum(np.abs(offset @ right) / half_width, np.abs(offset @ down) / half_height)
    back = max(distance, _WHOLE * float((needed - depth).max()))
    return dataclasses.replace(camera, position=camera.target - back * forward)


def _labelled(picture: Pixels, text: str) -> Pixels:
    """Write a line below a picture."""
    sheet = np.full((picture.shape[0] + _LABEL, *picture.shape[1:]), _PAPER, dtype=np.uint8)
    sheet[: len(picture)] = picture
    image = Image.fromarray(sheet)
    font = ImageFont.load_default(size=16)
    ImageDraw.Draw(image).text((8, len(picture) + 5), text, fill=_INK, font=font)
    return np.asarray(image)
