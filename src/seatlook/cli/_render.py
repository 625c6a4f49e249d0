"""The command that draws a result; nothing is solved."""

from __future__ import annotations

from typing import Annotated, Literal

from cyclopts import Parameter

from seatlook.cli._options import Names, Out, ResultFile, SceneFile, solved_seat
from seatlook.cli._output import progress


def render(
    scene: SceneFile,
    result: ResultFile = None,
    /,
    *,
    out: Out,
    texture: Names = (),
    rig: Names = (),
    view: str | None = None,
    maps: Annotated[bool, Parameter(help="Draw the wrinkle maps as well.")] = True,
    quality: str = "standard",
    tone: Literal["clamp", "neutral"] = "clamp",
    radiance: Literal["npy", "exr"] | None = None,
) -> None:
    """Draw a result under the lights of a scene; nothing is solved.

    Example: seatlook render seat.toml seat.npz --out pictures --texture suede --rig sun

    Example: seatlook render seat.toml seat.npz --out pictures --quality high --radiance exr

    Parameters
    ----------
    texture
        Texture of the scene's gallery; may be given more than once. All of them if not given.
    rig
        Rig of the scene; may be given more than once. All of them if not given.
    view
        Camera of the scene, or a named view. The first of the scene if not given.
    quality
        draft, standard or high, or a tier from T0 to T4.
    tone
        How light above white is shown: cut off, or rolled off (Khronos neutral).
    radiance
        Save what is seen, in cd/m2, beside each picture; exr needs the extra "exr".
    """
    from seatlook.chain.draw import Canvas, Exposures, draw_maps, draw_pictures
    from seatlook.chain.files import picture_paths
    from seatlook.chain.run_folder import run_folder
    from seatlook.pbr import offscreen_backend

    offscreen_backend()
    seat = solved_seat(scene, result)
    part, solution = seat.narrowed(texture, rig), seat.solution
    canvas = Canvas(
        solution=solution, camera=seat.camera(view), out=out, run=solution.cover.scene_digest
    )
    exposures = Exposures(quality=quality, tone=tone, radiance=radiance)
    with run_folder(out), progress() as show:
        draw_pictures(part, canvas, show, exposures=exposures, paths=picture_paths(seat.scene))
        if maps:
            draw_maps(seat.assessment, canvas, show)
