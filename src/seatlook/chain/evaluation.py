"""The whole chain, readable top to bottom: scene -> cover -> solution -> indices -> pictures."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, replace
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING

from seatlook import io, pbr
from seatlook.assembly import assemble
from seatlook.errors import InputError
from seatlook.model import Camera, Design, FloatArray, Limit, Scene, Solution, WrinkleMap
from seatlook.model.progress import Progress, silent
from seatlook.model.scene import SCORE_MEASURES, Verdict
from seatlook.results.deviation import SeamLine, deviation, seam_lines
from seatlook.results.gap import ZoneGap, gap, zone_gaps
from seatlook.solver import solve
from seatlook.wrinkle import (
    Surface,
    ZoneRow,
    map_top,
    surface_of,
    surface_strains,
    thresholds,
    w2_net,
    wrinkle_indices,
    zone_table,
)

if TYPE_CHECKING:
    from seatlook.pbr import Picture

RESULT = "result.npz"
MAPS: Mapping[str, str] = MappingProxyType(
    {
        "w1": "curvature over the threshold: crowns above 0, valleys below",
        "w2": "valleys only: 1 is a wrinkle as deep as the threshold",
        "w_stretch": "the part of W2 where the fabric is stretched one way",
        "w_compression": "the part of W2 where there is too much fabric",
    }
)
# Maps in mm, about 0.
DISTANCES: Mapping[str, str] = MappingProxyType(
    {
        "gap": "from the drawn foam to the cover: below 0 the foam is pressed in",
        "deviation": "distance from the design surface: above 0 outside, below 0 inside",
    }
)
_DISTANCE_RANGE_MM = 5.0  # the same on every page, so that pages compare


@dataclass(frozen=True, slots=True, kw_only=True)
class Evaluation:
    """What ``evaluate`` found, and where it left the pictures (paths relative to ``folder``)."""

    scene: Scene
    folder: Path
    solution: Solution
    indices: WrinkleMap
    zones: tuple[ZoneRow, ...]
    gap: FloatArray
    deviation: FloatArray | None
    camera: Camera
    pictures: MappingProxyType[tuple[str, str], str]
    maps: MappingProxyType[str, tuple[str, Picture]]
    verdicts: tuple[Verdict, ...]

    @property
    def accepted(self) -> bool:
        """Whether every limit on the indices is kept; ``study.scoring`` judges the others."""
        return all(v.kept for v in self.verdicts)


def evaluate(
    scene: Scene, out: Path, *, resume: bool = False, progress: Progress | None = None
) -> Evaluation:
    """Sew, hook and cover a scene, judge its wrinkles, and draw it.

    Parameters
    ----------
    scene : Scene
    out : folder for ``result.npz``, ``zones.csv``, ``images/`` and ``maps/``
    resume : take ``out/result.npz`` instead of solving, if it is of this very scene

    Raises
    ------
    NoOffscreenContext
        Before anything is solved, if nothing could be drawn afterwards.
    InputError, SolverError, RenderError
    """
    say = progress or silent
    pbr.offscreen_backend()
    solution = _earlier_result(scene, out) if resume else None
    if solution is None:
        say("mesh")
        cover = assemble(scene)
        solution = solve(cover, progress=lambda **figures: say("solve", **figures))
        io.write_result(solution, out / RESULT)
    indices = wrinkle_map(scene, solution)
    zones = zone_table(solution, indices, w2_net(surface(scene, solution, indices)))
    write_zones(zones, out / "zones.csv")
    off = {"gap": gap(solution)}
    if scene.design is not None:
        off["deviation"] = deviation(solution, scene.design)
        write_shape(solution, scene.design, off["deviation"], out)
    camera = scene.cameras[0]
    return Evaluation(
        scene=scene,
        folder=out,
        solution=solution,
        indices=indices,
        zones=zones,
        gap=off["gap"],
        deviation=off.get("deviation"),
        camera=camera,
        pictures=draw_pictures(scene, solution, camera, out, say),
        maps=MappingProxyType(
            {
                **draw_maps(solution, indices, camera, out, say),
                **{n: draw_distance(n, solution, d, camera, out) for n, d in off.items()},
            }
        ),
        verdicts=tuple(
            _judge(limit, scene, zones)
            for limit in scene.limits
            if limit.measure not in SCORE_MEASURES
        ),
    )


def wrinkle_map(scene: Scene, solution: Solution) -> WrinkleMap:
    """Evaluate the indices with the scene's curvature mode and thresholds."""
    return wrinkle_indices(
        *surface_strains(solution),
        solution.cover.thickness,
        thresholds(solution.cover, scene.curvature, scene.c_threshold),
        curvature=scene.curvature,
    )


def surface(scene: Scene, solution: Solution, indices: WrinkleMap) -> Surface:
    """Collect what the measures beside the paper's look at."""
    return surface_of(
        solution, indices, thresholds(solution.cover, scene.curvature, scene.c_threshold)
    )


def draw_pictures(
    scene: Scene,
    solution: Solution,
    camera: Camera,
    out: Path,
    say: Progress,
    *,
    quality: str = "standard",
    tone: str = "clamp",
    radiance: str | None = None,
) -> MappingProxyType[tuple[str, str], str]:
    """Render every texture under every rig; return (texture, rig) -> path below ``out``.

    ``radiance``: "npy" or "exr" to keep what was seen [cd/m2] beside each picture.
    """
    pictures: dict[tuple[str, str], str] = {}
    steps = len(scene.rigs) * len(scene.textures)
    for rig in scene.rigs:
        for name, appearance in scene.textures.items():
            say("render", rig=rig.name, texture=name, step=len(pictures), steps=steps)
            path = picture_path(name, rig.name)
            image = pbr.render(solution, appearance, rig=rig, camera=camera, quality=quality)
            replace(image, tone=tone).save(out / path)
            if radiance is not None:
                image.save((out / path).with_suffix(f".{radiance}"))
            pictures[name, rig.name] = path
    return MappingProxyType(pictures)


def picture_path(texture: str, rig: str) -> str:
    """Path of a picture, relative to the folder of its evaluation.

    Examples
    --------
    >>> picture_path("Suede 2", "bulb left")
    'images/bulb-left/suede-2.png'
    """
    return f"images/{_slug(rig)}/{_slug(texture)}.png"


def draw_maps(
    solution: Solution,
    indices: WrinkleMap,
    camera: Camera,
    out: Path,
    say: Progress,
    *,
    top: float | None = None,
) -> MappingProxyType[str, tuple[str, Picture]]:
    """Draw the four maps from one camera; the causes share the range of W2 they add up to.

    ``top`` is the upper end of that range, to be given where several covers are to share it.
    """
    top = top or map_top(indices)
    maps = {}
    for name, title in MAPS.items():
        say("map", name=name)
        low = -top if name == "w1" else 0.0
        picture = pbr.render_map(
            solution,
            getattr(indices, name),
            camera=camera,
            title=f"{label(name)}: {title}",
            unit="1",
            value_range=(low, top),
        )
        path = f"maps/{name}.png"
        picture.save(out / path)
        maps[name] = (path, picture)
    return MappingProxyType(maps)


def draw_distance(
    name: str, solution: Solution, off: FloatArray, camera: Camera, out: Path
) -> tuple[str, Picture]:
    """Draw one of ``DISTANCES`` (m,) [m]; faces where it is not known stay grey."""
    path = f"maps/{name}.png"
    picture = pbr.render_map(
        solution,
        1e3 * off,
        camera=camera,
        title=f"{label(name)}: {DISTANCES[name]}",
        unit="mm",
        value_range=(-_DISTANCE_RANGE_MM, _DISTANCE_RANGE_MM),
    )
    picture.save(out / path)
    return path, picture


def write_shape(solution: Solution, design: Design, off: FloatArray, out: Path) -> None:
    """Write ``shape.csv``, the deviation (m,) [m] by zone, and ``seam-lines.csv``, both in mm."""
    for name, rows in (
        ("shape.csv", shape_rows(zone_gaps(solution, off))),
        ("seam-lines.csv", seam_line_rows(seam_lines(solution, design))),
    ):
        if rows:
            io.write_table(out / name, list(rows[0]), [tuple(row.values()) for row in rows])


def shape_rows(zones: tuple[ZoneGap, ...]) -> list[dict[str, object]]:
    """Zones and their distances, in mm and cm2."""
    return [
        {
            "zone": z.zone,
            "area_cm2": 1e4 * z.area,
            "measured_percent": 100 * z.measured,
            **{f"{n}_mm": 1e3 * getattr(z, n) for n in ("mean", "rms", "p95", "lowest", "highest")},
        }
        for z in zones
    ]


def seam_line_rows(seams: tuple[SeamLine, ...]) -> list[dict[str, object]]:
    """Seams and how far they lie from the design's, in mm."""
    return [
        {
            "seam": s.seam,
            "length_mm": 1e3 * s.length,
            "mean_mm": None if s.mean is None else 1e3 * s.mean,
            "largest_mm": None if s.largest is None else 1e3 * s.largest,
        }
        for s in seams
    ]


def label(index: str) -> str:
    """Return the index as it is written: ``w_stretch`` is W_stretch.

    Examples
    --------
    >>> label("w_stretch")
    'W_stretch'
    """
    return index[0].upper() + index[1:]


def _earlier_result(scene: Scene, out: Path) -> Solution | None:
    """Return the stored solution if it is converged and of this very scene."""
    path = out / RESULT
    if not path.exists():
        return None
    solution = io.read_result(path)
    same = solution.cover.scene_digest == scene.digest and solution.cover.seed == scene.seed
    return solution if same and solution.status == "converged" else None


def _judge(limit: Limit, scene: Scene, zones: tuple[ZoneRow, ...]) -> Verdict:
    """Compare a limit with the worst of the zones it names (a zone, or a visibility class)."""
    classes = {box.name: box.visibility for box in scene.boxes}
    rows = [r for r in zones if limit.zone in (r.zone, classes.get(r.zone))]
    if not rows:
        raise InputError.single(
            "accept",
            got=f"zone {limit.zone!r} without a face",
            expected=f"one of {', '.join(r.zone for r in zones)}",
            file=scene.path,
        )
    return Verdict(limit=limit, value=max(getattr(r, limit.measure) for r in rows))


def write_zones(zones: tuple[ZoneRow, ...], path: Path) -> None:
    """Write the zone table as CSV, one row per zone."""
    io.write_table(path, list(asdict(zones[0])), [tuple(asdict(row).values()) for row in zones])


def _slug(name: str) -> str:
    """Make a file name of a name."""
    return "".join(c if c.isalnum() else "-" for c in name.lower()).strip("-")
