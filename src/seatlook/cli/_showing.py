"""Commands for pictures to show: a seat on a turntable, and a sheet of all looks and lights."""

from __future__ import annotations

from typing import Annotated, Literal

from cyclopts import Parameter

from seatlook.cli._options import Names, Out, ResultFile, SceneFile, solved_seat
from seatlook.cli._output import progress, say

Around = Literal["plain", "sweep", "cabin", "transparent"]
Format = Literal["gif", "apng", "webp", "mp4"]


def turntable(
    scene: SceneFile,
    result: ResultFile = None,
    /,
    *,
    out: Out,
    texture: str | None = None,
    rig: str | None = None,
    view: str | None = None,
    file_format: Annotated[tuple[Format, ...], Parameter(name="--format", negative=())] = ("webp",),
    pictures: int = 36,
    seconds: float = 6.0,
    width: int = 640,
    quality: str = "standard",
    surroundings: Around | None = None,
    lights_turn: Annotated[bool, Parameter(negative=())] = False,
    keep_pictures: Annotated[bool, Parameter(negative=())] = False,
) -> None:
    """Draw a result on a turntable: one moving picture from all sides.

    A run that was stopped goes on with the pictures that are there: give the same command again.

    Example: seatlook turntable seat.toml seat.npz --out pictures --texture suede --rig sun

    Example: seatlook turntable seat.toml seat.npz --out pictures --format gif --format mp4

    Parameters
    ----------
    texture
        Texture of the scene's gallery. The first if not given.
    rig
        Rig of the scene. The first if not given.
    view
        Camera of the scene, or a named view. It steps back as far as the widest side needs.
    file_format
        gif (256 colours), apng (exact, large), webp (small), or mp4, for which ffmpeg must be
        installed. May be given more than once.
    pictures
        How many make one turn.
    seconds
        How long one turn lasts.
    width
        Of the picture, in pixels.
    quality
        draft, standard or high, or a tier from T0 to T4.
    surroundings
        What is around the seat, as for "seatlook render". Those of the scene if not given.
    lights_turn
        Let the lights turn with the seat. Without it they stand still, and highlights run over
        the cover.
    keep_pictures
        Leave the single pictures in a folder beside the file.
    """
    from seatlook.chain.run_folder import run_folder
    from seatlook.chain.showing import Turn, draw_turntable
    from seatlook.files import file_names
    from seatlook.pbr import offscreen_backend

    offscreen_backend()
    seat = solved_seat(scene, result)
    look = texture if texture is not None else next(iter(seat.scene.textures))
    light = seat.rig(rig)
    (appearance,) = seat.narrowed((look,)).textures.values()
    name = "-".join(file_names((look, light.name)).values())
    turn = Turn(
        pictures=pictures,
        seconds=seconds,
        width=width,
        quality=quality,
        surroundings=surroundings or seat.scene.surroundings,
        lights_turn=lights_turn,
        keep=keep_pictures,
    )
    files = [out / f"turntable-{name}.{ending}" for ending in dict.fromkeys(file_format)]
    with run_folder(out), progress() as show:
        written = draw_turntable(
            seat.solution,
            appearance,
            files,
            rig=light,
            camera=seat.camera(view),
            turn=turn,
            progress=show,
        )
    say(*(f"wrote {path}" for path in written))


def sheet(
    scene: SceneFile,
    result: ResultFile = None,
    /,
    *,
    out: Out,
    texture: Names = (),
    rig: Names = (),
    view: Names = (),
    width: int = 480,
    quality: str = "standard",
    surroundings: Around | None = None,
) -> None:
    """Draw a picture sheet: a result in every texture under every rig, in one file sheet.png.

    A run that was stopped goes on with the pictures that are there: give the same command again.

    Example: seatlook sheet seat.toml seat.npz --out pictures

    Example: seatlook sheet seat.toml seat.npz --out pictures --view front_34 --view detail

    Parameters
    ----------
    texture
        Texture of the scene's gallery; may be given more than once. All of them if not given.
    rig
        Rig of the scene; may be given more than once. All of them if not given.
    view
        Camera of the scene, or a named view; may be given more than once. The first of the scene
        if not given.
    width
        Of one picture, in pixels.
    quality
        draft, standard or high, or a tier from T0 to T4.
    surroundings
        What is around the seat, as for "seatlook render". Those of the scene if not given.
    """
    from dataclasses import replace

    from seatlook.chain.run_folder import run_folder
    from seatlook.chain.showing import draw_sheet
    from seatlook.pbr import offscreen_backend

    offscreen_backend()
    seat = solved_seat(scene, result)
    part = seat.narrowed(texture, rig)
    if surroundings is not None:
        part = replace(part, surroundings=surroundings)
    cameras = [seat.camera(name) for name in (view or (None,))]
    with run_folder(out), progress() as show:
        path = draw_sheet(
            seat.solution,
            part,
            out / "sheet.png",
            cameras=cameras,
            width=width,
            quality=quality,
            progress=show,
        )
    say(f"wrote {path}")
