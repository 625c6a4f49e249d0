"""The command that draws a result; nothing is solved."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import Parameter

from seatlook.cli._options import Names, Out, ResultFile, SceneFile, solved_seat
from seatlook.cli._output import progress
from seatlook.errors import InputError

if TYPE_CHECKING:
    from seatlook.model import Camera, Rig

Place = tuple[float, float, float]


def render(
    scene: SceneFile,
    result: ResultFile = None,
    /,
    *,
    out: Out,
    texture: Names = (),
    rig: Names = (),
    view: str | None = None,
    position_mm: Place | None = None,
    target_mm: Place | None = None,
    maps: Annotated[bool, Parameter(help="Draw the wrinkle maps as well.")] = True,
    quality: str = "standard",
    tone: Literal["clamp", "neutral"] = "clamp",
    white: Literal["exposure", "card"] = "exposure",
    adaptation: float = 1.0,
    radiance: Literal["npy", "exr"] | None = None,
    panorama_azimuth_deg: float | None = None,
    surroundings: Literal["plain", "sweep", "cabin", "transparent"] | None = None,
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
    position_mm
        Look from this place instead, x y z. The viewer of the page writes it for what it shows.
    target_mm
        Look at this place instead, x y z.
    quality
        draft, standard or high, or a tier from T0 to T4.
    tone
        How light above white is shown: cut off, or rolled off (Khronos neutral).
    white
        What is shown as white: what the exposure says, or a white card that faces the light. With
        "card" a facing surface shows the colour that was typed.
    adaptation
        How far the eye has adapted to the colour of the light: 1 shows a white card white, 0 shows
        it in the colour of the lamp.
    radiance
        Save what is seen, in cd/m2, beside each picture; exr needs the extra "exr".
    panorama_azimuth_deg
        Turn the sky pictures of the rigs by so much more, counter-clockwise seen from above.
    surroundings
        What is around the seat: nothing (plain), a bright floor with a valance over the hem
        (sweep), a dark one (cabin), or light from a floor that is not seen (transparent). Those of
        the scene if not given.
    """
    from seatlook.chain.draw import Canvas, Exposures, draw_maps, draw_pictures
    from seatlook.chain.files import picture_paths
    from seatlook.chain.run_folder import run_folder
    from seatlook.pbr import offscreen_backend

    offscreen_backend()
    seat = solved_seat(scene, result)
    part, solution = seat.narrowed(texture, rig), seat.solution
    if panorama_azimuth_deg is not None:
        part = replace(part, rigs=_turned(part.rigs, panorama_azimuth_deg))
    if surroundings is not None:
        part = replace(part, surroundings=surroundings)
    camera = _camera(seat.camera(view), position_mm, target_mm)
    canvas = Canvas(solution=solution, camera=camera, out=out, run=solution.cover.scene_digest)
    if not 0.0 <= adaptation <= 1.0:
        raise InputError.single("--adaptation", got=adaptation, expected="0 to 1")
    exposures = Exposures(
        quality=quality, tone=tone, white=white, adaptation=adaptation, radiance=radiance
    )
    with run_folder(out), progress() as show:
        draw_pictures(part, canvas, show, exposures=exposures, paths=picture_paths(seat.scene))
        if maps:
            draw_maps(seat.assessment, canvas, show)


def _camera(camera: Camera, position_mm: Place | None, target_mm: Place | None) -> Camera:
    """The camera, moved to where the command line says."""
    import numpy as np

    from seatlook.model.light.camera import upright

    if position_mm is None and target_mm is None:
        return camera
    position = camera.position if position_mm is None else np.array(position_mm) / 1e3
    target = camera.target if target_mm is None else np.array(target_mm) / 1e3
    return upright(camera, position, target)


def _turned(rigs: tuple[Rig, ...], azimuth_deg: float) -> tuple[Rig, ...]:
    """Rigs whose panoramas are turned."""
    from seatlook.model.light.lamps import turned

    name = "--panorama-azimuth-deg"
    if not -360 <= azimuth_deg <= 360:
        raise InputError.single(name, got=azimuth_deg, expected="-360 to 360")
    if all(rig.panorama is None for rig in rigs):
        names = ", ".join(rig.name for rig in rigs)
        raise InputError.single(name, got=f"no panorama in {names}", expected="a rig with one")
    return tuple(turned(rig, azimuth_deg) for rig in rigs)
