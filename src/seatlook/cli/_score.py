"""The command that says how visible the wrinkles of a result are."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import Parameter

from seatlook.cli._options import Names, ResultFile, SceneFile, solved_seat
from seatlook.cli._output import Json, progress, say, show_json, table
from seatlook.errors import InputError

if TYPE_CHECKING:
    from seatlook.model import Camera
    from seatlook.visibility.light_search import WorstLight
    from seatlook.visibility.scoring import SceneScore

    Lights = dict[str, dict[str, WorstLight]]


def score(
    scene: SceneFile,
    result: ResultFile = None,
    /,
    *,
    out: Annotated[
        Path | None, Parameter(help="Folder for maps of visibility and charts of lights.")
    ] = None,
    texture: Names = (),
    rig: Names = (),
    view: str | None = None,
    reference: Literal["view-ray", "normals", "design"] = "view-ray",
    cutoff_mm: float = 100.0,
    search_light: Annotated[bool, Parameter(negative=())] = False,
    json: Json = False,
) -> int:
    """Say how visible the wrinkles of a result are, for every texture under every rig.

    Ends with 1 if a limit of [accept] on the score is missed, and with 2 where no score can be
    given because a cover without wrinkles would score as well.

    Example: seatlook score out/demo/scene.toml

    Example: seatlook score seat.toml seat.npz --texture suede --search-light --out score

    Parameters
    ----------
    texture
        Texture of the scene's gallery; may be given more than once. All of them if not given.
    rig
        Rig of the scene; may be given more than once. All of them if not given.
    view
        Camera of the scene. The first if not given.
    reference
        What the cover is compared with: itself smoothed along the camera's rays, itself with
        smoothed shading only, or the surface that was designed.
    cutoff_mm
        Waves up to this length are wrinkles.
    search_light
        Find the sun direction and the bulb position that show the wrinkles of each texture most,
        about a minute for each; needs --out for the charts.
    """
    from seatlook.pbr import offscreen_backend
    from seatlook.report.sections.score import score_checks
    from seatlook.seat import missed

    if search_light and out is None:
        raise InputError.single("--search-light", got="no --out", expected="a folder for charts")
    offscreen_backend()
    seat = solved_seat(scene, result)
    with progress() as show:
        scored = seat.score(
            textures=texture, rigs=rig, camera=view, mode=reference, cutoff=cutoff_mm / 1e3,
            progress=show,
        )  # fmt: skip
        lights = {}
        if search_light:
            lights = seat.worst_lights(textures=texture, camera=view, mode=reference, progress=show)
    _write(scored, lights, seat.camera(view), out)
    _print(scored, lights, json=json)
    sentences = missed(score_checks(scored))
    say(*sentences)
    return int(bool(sentences))


def _write(scored: SceneScore, lights: Lights, camera: Camera, out: Path | None) -> None:
    """Leave score.json, maps of visibility and charts of the lights."""
    if out is None:
        return
    from json import dumps

    from seatlook import files
    from seatlook.chain.run_folder import run_folder
    from seatlook.report.light_chart import write_light_chart
    from seatlook.report.sections.score import draw_maps, score_values

    names = files.file_names(lights)
    with run_folder(out):
        draw_maps(scored, scored.grid.sights, out)
        for texture, kinds in lights.items():
            for kind, worst in kinds.items():
                title = f"Visibility of wrinkles by place of the {kind}: {texture}"
                path = out / f"light-{kind}-{names[texture]}.svg"
                write_light_chart(worst, camera, path, title=title)
        text = dumps(score_values(scored, lights), indent=1) + "\n"
        files.write_text(out / "score.json", text)
    say(f"score: {out / 'score.json'}, maps: {out / 'maps'}")


def _print(scored: SceneScore, lights: Lights, *, json: bool) -> None:
    from seatlook.report.sections.score import (
        cause_table,
        grid_table,
        score_values,
        sentences,
        zone_table,
    )

    if json:
        show_json(score_values(scored, lights))
        return
    for part in (grid_table(scored), zone_table(scored), cause_table(scored)):
        table(part.heads, part.rows, json=False)
        table((), (), json=False)
    rows = [
        (name, kind, worst.azimuth_deg, worst.elevation_deg, worst.vwi, len(worst.tried))
        for name, kinds in lights.items()
        for kind, worst in kinds.items()
    ]
    if rows:
        heads = ("texture", "worst", "azimuth_deg", "elevation_deg", "vwi", "lights_tried")
        table(heads, rows, json=False)
        table((), (), json=False)
    say(*sentences(scored))
