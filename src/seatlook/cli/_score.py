"""The command that says how visible the wrinkles of a result are."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, Literal

from cyclopts import Parameter

from seatlook.cli._output import Json, Say, progress, say, show_json, table
from seatlook.cli._run import Names, SceneFile, camera_of, load, narrowed, result_of, say_missed
from seatlook.errors import InputError

if TYPE_CHECKING:
    from seatlook.model import Camera, Scene, Solution
    from seatlook.visibility.light_search import WorstLight
    from seatlook.visibility.scoring import SceneScore

# Of the pictures of a search, against those of the score: a quarter of the pixels will do.
_SEARCH_SCALE = 2


def score(
    scene: SceneFile,
    result: Annotated[
        Path | None,
        Parameter(help='Result file (.npz); "result.npz" beside the scene if not given.'),
    ] = None,
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
    from seatlook.chain.evaluation import wrinkle_map
    from seatlook.pbr import offscreen_backend
    from seatlook.report.sections.score import score_checks
    from seatlook.visibility.scoring import score_scene
    from seatlook.visibility.view import View

    if search_light and out is None:
        raise InputError.single("--search-light", got="no --out", expected="a folder for charts")
    offscreen_backend()
    read = narrowed(load(scene), texture, rig)
    camera = camera_of(read, view)
    solution = result_of(read, _result_file(scene, result))
    with progress() as show:
        show("score", what="reference")
        scene_view = View(solution, camera, mode=reference, cutoff=cutoff_mm / 1e3)
        found = score_scene(read, scene_view, wrinkle_map(read, solution), progress=show)
        searches = {}
        if search_light and out is not None:
            searches = _searches(read, solution, camera, out, show, mode=reference)
    _write(found, searches, out)
    _print(found, searches, json=json)
    return int(not say_missed(score_checks(found)))


def _result_file(scene: Path, result: Path | None) -> Path:
    """Return the result's path; say how to make one where there is none."""
    path = result or scene.with_name("result.npz")
    if not path.is_file():
        raise InputError.single(
            str(path),
            got="no such file",
            expected=f"a result; make it with: seatlook solve {scene} --out {path}",
        )
    return path


def _searches(
    scene: Scene, solution: Solution, camera: Camera, out: Path, show: Say, *, mode: Any
) -> dict[str, dict[str, WorstLight]]:
    """Search the worst sun and the worst bulb of every texture, and draw their charts."""
    from dataclasses import replace

    from seatlook.report.light_chart import write_light_chart
    from seatlook.visibility.light_search import bulb_rig, search_light, sun_rig
    from seatlook.visibility.view import View

    width, height = camera.size
    small = replace(camera, size=(width // _SEARCH_SCALE, height // _SEARCH_SCALE))
    view = View(solution, small, mode=mode, quality="draft")
    searches: dict[str, dict[str, WorstLight]] = {}
    for name, looks in scene.textures.items():
        searches[name] = {}
        for kind, rig_at in (("sun", sun_rig()), ("bulb", bulb_rig(camera))):
            show("search light", texture=name, kind=kind)
            found = search_light(view, looks, rig_at)
            write_light_chart(
                found,
                camera,
                out / f"light-{kind}-{name.replace(' ', '-')}.svg",
                title=f"Visibility of wrinkles by place of the {kind}: {name}",
            )
            searches[name][kind] = found
    return searches


def _write(found: SceneScore, searches: dict[str, dict[str, WorstLight]], out: Path | None) -> None:
    if out is None:
        return
    from json import dumps

    from seatlook import files
    from seatlook.report.sections.score import draw_maps, score_values

    draw_maps(found, found.grid.sights, out)
    files.write_text(out / "score.json", dumps(score_values(found, searches), indent=1) + "\n")
    say(f"score: {out / 'score.json'}, maps: {out / 'maps'}")


def _print(found: SceneScore, searches: dict[str, dict[str, WorstLight]], *, json: bool) -> None:
    from seatlook.report.sections.score import (
        cause_table,
        grid_table,
        score_values,
        sentences,
        zone_table,
    )

    if json:
        show_json(score_values(found, searches))
        return
    for part in (grid_table(found), zone_table(found), cause_table(found)):
        table(part.heads, part.rows, json=False)
        table((), (), json=False)
    rows = [
        (name, kind, worst.azimuth_deg, worst.elevation_deg, worst.vwi, len(worst.tried))
        for name, kinds in searches.items()
        for kind, worst in kinds.items()
    ]
    if rows:
        heads = ("texture", "worst", "azimuth_deg", "elevation_deg", "vwi", "lights_tried")
        table(heads, rows, json=False)
        table((), (), json=False)
    say(*sentences(found))
