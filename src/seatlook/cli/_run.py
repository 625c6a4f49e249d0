"""Commands that take a scene through the chain, whole or link by link."""

from __future__ import annotations

from dataclasses import astuple, fields, replace
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Annotated, Any, Literal

from cyclopts import Parameter

from seatlook.cli._output import Json, note, progress, say, table
from seatlook.errors import InputError, did_you_mean

if TYPE_CHECKING:
    from collections.abc import Iterable

    from seatlook.assembly.ease import SeamEase
    from seatlook.chain.evaluation import Evaluation
    from seatlook.model import Camera, Scene, Solution
    from seatlook.report import Check
    from seatlook.wrinkle import ZoneRow

SceneFile = Annotated[Path, Parameter(help="Scene file (TOML).")]
ResultFile = Annotated[Path, Parameter(help='Result file of "seatlook solve" (.npz).')]
Out = Annotated[Path, Parameter(help="Folder to write to.")]
Seed = Annotated[
    int | None, Parameter(help="Seed of mesh jitter and imperfection, instead of the scene's.")
]
ElementSize = Annotated[
    float | None, Parameter(help="Mean edge length of the mesh, instead of the scene's.")
]
Resume = Annotated[
    bool,
    Parameter(negative=(), help="Take the result in the folder if it is of this very scene."),
]
SingleFile = Annotated[
    bool, Parameter(negative=(), help="Put the images into index.html, to send it as one file.")
]
DryRun = Annotated[bool, Parameter(negative=(), help="List what would be made, and make nothing.")]
Changes = Annotated[
    tuple[str, ...],
    Parameter(
        name="--set",
        negative=(),
        help="KEY=VALUE over the scene's, such as mesh.seed=3; may be given more than once.",
    ),
]
Scored = Annotated[
    bool, Parameter(help="Score how visible the wrinkles are, always where [accept] limits it.")
]
Names = Annotated[tuple[str, ...], Parameter(negative=())]
_NO_SCENES = (".dxf", ".obj", ".stl", ".ply", ".npz")


def check(
    scene: SceneFile,
    /,
    *,
    seed: Seed = None,
    element_size_mm: ElementSize = None,
    changes: Changes = (),
    json: Json = False,
) -> None:
    """Read a scene with all its files, mesh it, and say what would be solved; solve nothing.

    Example: seatlook check seat.toml
    """
    from seatlook.assembly import assemble
    from seatlook.assembly.ease import seam_ease
    from seatlook.solver.foam.contact import foam_wavelength

    read = load(scene, seed, element_size_mm, changes)
    cover = assemble(read)
    wave = min(foam_wavelength(m.fabric, read.foam.material) for m in cover.materials)
    eases = [seam_ease(read.pattern, seam) for seam in read.pattern.seams]
    seams = [_seam_row(ease) for ease in sorted(eases, key=lambda ease: -abs(ease.share))]
    table(
        ("what", "value"),
        [
            ("scene", read.name),
            ("panels", len(cover.panel_names)),
            ("seams", len(cover.stitchings)),
            ("hooks_and_frames", len(cover.anchors)),
            ("vertices", len(cover.rest)),
            ("triangles", len(cover.faces)),
            ("element_size_mm", 1e3 * cover.element_size),
            ("wavelength_mm", 1e3 * wave),
            ("wavelength_over_element_size", wave / cover.element_size),
            *([("ease", seams)] if json else ()),
        ],
        json=json,
    )
    if seams and not json:
        table(tuple(seams[0]), [tuple(map(_short, row.values())) for row in seams], json=False)
    note(f"nothing wrong; to solve and draw it: seatlook evaluate {scene} --out FOLDER")


def _short(value: Any) -> Any:
    """A figure of a seam for a reader: to a hundredth of a millimetre or percent."""
    return f"{round(value, 2) + 0.0:.2f}" if isinstance(value, float) else value


def _seam_row(ease: SeamEase) -> dict[str, Any]:
    """Figures of one seam; "matched" is whether both sides have as many notches."""
    return {
        "seam": ease.name,
        "length_a_mm": 1e3 * ease.length_a,
        "length_b_mm": 1e3 * ease.length_b,
        "ease_mm": 1e3 * ease.ease,
        "ease_percent": 100 * ease.share,
        "most_between_notches_percent": 100 * ease.extreme,
        "notches_a": len(ease.notches_a),
        "notches_b": len(ease.notches_b),
        "matched": ease.matched,
    }


def evaluate(
    scene: SceneFile,
    /,
    *,
    out: Out,
    seed: Seed = None,
    element_size_mm: ElementSize = None,
    changes: Changes = (),
    resume: Resume = False,
    score: Scored = True,
    single_file: SingleFile = False,
    dry_run: DryRun = False,
    json: Json = False,
) -> int:
    """Solve a scene, judge its wrinkles, draw it, and write the gallery page.

    Leaves index.html, result.npz, zones.csv, images and maps in the folder. Ends with 1 if a
    limit of [accept] is missed, and names zone and value.

    Example: seatlook evaluate seat.toml --out out/seat
    """
    read = load(scene, seed, element_size_mm, changes)
    if dry_run:
        return _list_cells(read, out, json=json)
    return evaluate_scene(read, out, resume=resume, score=score, single_file=single_file, json=json)


def _list_cells(scene: Scene, out: Path, *, json: bool) -> int:
    """Print what evaluating a scene would draw; the same names as when it does."""
    from seatlook.chain.evaluation import picture_path
    from seatlook.pbr import ev100

    table(
        ("texture", "rig", "ev100", "image"),
        [
            (texture, rig.name, ev100(rig), str(out / picture_path(texture, rig.name)))
            for rig in scene.rigs
            for texture in scene.textures
        ],
        json=json,
    )
    return 0


def evaluate_scene(
    scene: Scene,
    out: Path,
    *,
    resume: bool,
    score: bool,
    json: bool,
    single_file: bool = False,
) -> int:
    """Evaluate a scene, print its zones and return the exit code."""
    from seatlook.chain.evaluation import evaluate as run_chain
    from seatlook.model.scene import SCORE_MEASURES
    from seatlook.report.evaluation_page import write_report
    from seatlook.report.sections.score import visibility

    score = score or any(limit.measure in SCORE_MEASURES for limit in scene.limits)
    with progress() as show:
        evaluation = run_chain(scene, out, resume=resume, progress=show)
        visible = visibility(evaluation, show) if score else None
    page = write_report(evaluation, score=visible, single_file=single_file)
    print_zones(evaluation.zones, json=json)
    note(f"gallery: {page}")
    if visible and visible.refused:
        say(f"no score: {visible.refused}")
    kept = say_missed(visible.checks if visible else ())
    return _exit_code(evaluation) or int(not kept)


def say_missed(checks: Iterable[Check]) -> bool:
    """Name every limit that is missed on stderr; return whether all are kept."""
    missed = [check for check in checks if not check.kept]
    for check in missed:
        say(f"{check.name} is {check.value}, the limit is {check.limit}")
    return not missed


def render(
    scene: SceneFile,
    result: ResultFile,
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
        Camera of the scene. The first if not given.
    quality
        draft, standard or high, or a tier from T0 to T4.
    tone
        How light above white is shown: cut off, or rolled off (Khronos neutral).
    radiance
        Keep what is seen, in cd/m2, beside each picture; exr needs the extra "exr".
    """
    from seatlook.chain.evaluation import draw_maps, draw_pictures, wrinkle_map
    from seatlook.pbr import offscreen_backend

    offscreen_backend()
    read = load(scene)
    chosen, camera = narrowed(read, texture, rig), camera_of(read, view)
    solution = result_of(read, result)
    with progress() as show:
        draw_pictures(
            chosen, solution, camera, out, show, quality=quality, tone=tone, radiance=radiance
        )
        if maps:
            draw_maps(solution, wrinkle_map(read, solution), camera, out, show)


def load(
    path: Path,
    seed: int | None = None,
    element_size_mm: float | None = None,
    changes: tuple[str, ...] = (),
) -> Scene:
    """Read a scene, with what the command line overrides and poses for panels that have none."""
    from seatlook import io
    from seatlook.assembly.placing import placed

    if path.suffix.lower() in _NO_SCENES:
        raise InputError.single(
            "scene", got=path.name, expected="a scene file (.toml)",
            hint="make one of a pattern and a foam with: seatlook init",
        )  # fmt: skip
    scene: Scene = placed(io.load_scene(path, changes=changes))
    return replace(
        scene,
        seed=scene.seed if seed is None else seed,
        element_size=scene.element_size if element_size_mm is None else element_size_mm / 1e3,
    )


def result_of(scene: Scene, path: Path) -> Solution:
    """Read a result; say so if it is not of this scene as it now is."""
    from seatlook import io

    solution: Solution = io.read_result(path)
    if solution.cover.scene_digest != scene.digest:
        say(f"{path}: solved for another state of {scene.path}; its shape is shown as it was")
    return solution


def narrowed(scene: Scene, textures: tuple[str, ...], rigs: tuple[str, ...]) -> Scene:
    """Keep the textures and rigs named on the command line; all where none is."""
    known = {rig.name: rig for rig in scene.rigs}
    looks = _chosen("--texture", textures, scene.textures)
    return replace(
        scene,
        rigs=tuple(known[name] for name in _chosen("--rig", rigs, known)),
        textures=MappingProxyType({name: scene.textures[name] for name in looks}),
    )


def camera_of(scene: Scene, view: str | None) -> Camera:
    """Return the camera of a name, the first if none is given."""
    known = {camera.name: camera for camera in scene.cameras}
    return known[_chosen("--view", (view,) if view else (), known)[0]]


def _chosen(option: str, names: tuple[str, ...], known: Iterable[str]) -> tuple[str, ...]:
    """Return the names, or all known ones if none is given; refuse others."""
    known = tuple(known)
    for name in names:
        if name not in known:
            raise InputError.single(
                option,
                got=repr(name),
                expected=f"one of {', '.join(known)}",
                hint=did_you_mean(name, known),
            )
    return names or known


def print_zones(zones: tuple[ZoneRow, ...], *, json: bool) -> None:
    table([f.name for f in fields(zones[0])], [astuple(row) for row in zones], json=json)


def exit_code_of(solution: Solution) -> int:
    if solution.status == "converged":
        return 0
    say(f"not converged: {solution.reason}")
    return 3


def _exit_code(evaluation: Evaluation) -> int:
    """3 if not converged, 1 if a limit is missed, each said on stderr."""
    for verdict in evaluation.verdicts:
        if not verdict.kept:
            limit = verdict.limit
            say(
                f"{limit.zone}: {limit.measure} is {verdict.value:.4g}, "
                f"the limit is {limit.maximum:.4g}"
            )
    return exit_code_of(evaluation.solution) or int(not evaluation.accepted)
