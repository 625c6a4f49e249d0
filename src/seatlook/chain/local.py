"""Solve to a tolerance: on a mesh that is fine where the cover wrinkles, begun from a coarser one.

The coarser one is solved as ever, or to a larger tolerance, in turn. Its wrinkles tell where the
finer one is fine, and the difference between both tells the error. Where that is more than was
asked for, a still finer mesh is made.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType

import numpy as np
import shapely

from seatlook import io
from seatlook.assembly import assemble, with_mesh
from seatlook.assembly.grading import Grading
from seatlook.chain.assess import assess
from seatlook.chain.companions import SEEDS, ZoneMean, scatter, with_companions
from seatlook.chain.files import earlier_result
from seatlook.chain.timeline import solve_in_stages
from seatlook.errors import InputError
from seatlook.model import Cover, Criteria, FloatArray, Scene, Solution, criteria_of
from seatlook.model.progress import Progress, silent
from seatlook.model.scene import FIRST_SIZE, TOLERANCES
from seatlook.model.zones import FREE_EDGE
from seatlook.results.needed_sizes import SMALL, needed_sizes, zone_sizes
from seatlook.results.resolution import ASKED, CURVATURE_ERROR, REACHED
from seatlook.solver import SolverSettings, foam_wavelength, solve

BEFORE = "0-coarser.npz"  # beside the stages: what the mesh was made from
_TWICE = 2.0  # as large are the elements of the mesh before
_COARSEST = 0.014  # m; the shape of a seat needs no finer
_APART = 1.3  # times as large elements, from which a difference of two meshes is one of sizes
_ORDER = 1.5  # at which means converge: 2 where there are waves, 1 at the kink of a hooked seam
_BEFORE = 0.35  # of the work is done on the meshes before, as an estimate
_MESHES = 3  # are made for a tolerance at most, each finer by as much as the one before missed it
_AIM = 0.9  # times the tolerance is what a mesh is made for where one missed it
_FINER = 0.5  # times the tolerance that sized a mesh sizes the next one at least
SIZED = "w2_sized"  # figure of a coarser mesh: share of the tolerance that the next is made for
_SECONDS, _MANY = 1e-3, 4000.0  # CPU seconds for a vertex on meshes of so many, and
_SLOWER = 0.3  # the power of their number by which it takes longer: docs/charts/tolerance.csv
_ADDED = ("steps", "iterations", "cpu_seconds")


def finest_size(scene: Scene) -> float:
    """Element size [m] where a cover wrinkles that is to keep the scene's tolerance.

    Never so large that no coarser mesh could tell its error.
    """
    return _wavelength(scene) * math.sqrt(_sizing(scene) / CURVATURE_ERROR)


def coarsest_size(scene: Scene) -> float:
    """Element size [m] where nothing wrinkles, and of the first mesh."""
    return float(np.clip(_TWICE * finest_size(scene), FIRST_SIZE, _COARSEST))


@dataclass(frozen=True, slots=True, kw_only=True)
class Forecast:
    """What a tolerance takes, before it is known how much of the cover wrinkles.

    Parameters
    ----------
    tolerance : float [1]
    finest, coarsest : float [m]     element size where it wrinkles, and where it does not
    vertices : of the last mesh if nothing wrinkles, and if everything does
    cpu_seconds : likewise, of all meshes, as an estimate
    """

    tolerance: float
    finest: float
    coarsest: float
    vertices: tuple[int, int]
    cpu_seconds: tuple[float, float]

    @property
    def sentence(self) -> str:
        """What is to be expected, in words."""
        fewest, most = self.vertices
        least, longest = self.cpu_seconds
        return (
            f"for {100 * self.tolerance:g} %: elements of {1e3 * self.finest:.2g} mm where it "
            f"wrinkles, {1e3 * self.coarsest:.2g} mm elsewhere; {fewest:,} to {most:,} vertices, "
            f"about {least:.0f} to {longest:.0f} CPU seconds, as much of it wrinkles"
        )


def forecast(scene: Scene) -> Forecast:
    """Say what a scene's tolerance takes, from its area and wavelength alone.

    Raises
    ------
    InputError   the scene names no tolerance
    """
    area = sum(shapely.Polygon(panel.outline).area for panel in scene.pattern.panels)
    finest, coarsest = finest_size(scene), coarsest_size(scene)
    sizes = coarsest, min(finest, coarsest)
    fewest, most = (round(area / (size**2 * math.sqrt(0.75))) for size in sizes)
    first, all_fine = (n * _SECONDS * (n / _MANY) ** _SLOWER for n in (fewest, most))
    return Forecast(
        tolerance=_asked(scene),
        finest=sizes[1],
        coarsest=coarsest,
        vertices=(fewest, most),
        cpu_seconds=(first + 0.5 * first, first + all_fine),
    )


def coarser(scene: Scene) -> Scene:
    """The scene of the mesh before: of one size, or of four times the tolerance."""
    first, looser = coarsest_size(scene), _TWICE**2 * _asked(scene)
    if _TWICE * _APART * finest_size(scene) < first and looser <= TOLERANCES[1]:
        return with_mesh(scene, tolerance=looser)
    return with_mesh(scene, element_size=first)


def solve_scene(
    scene: Scene,
    cover: Cover | None = None,
    *,
    settings: SolverSettings | None = None,
    progress: Progress = silent,
) -> Solution:
    """Solve a scene with zone means of W2 to its tolerance, or at its element size.

    Parameters
    ----------
    cover : of the scene at its element size, if there is one already

    Returns
    -------
    Solution
        On the last mesh. The mesh error of zones is among the figures; history and cost are those
        of all meshes.

    Raises
    ------
    InputError, SolverError   as ``assemble`` and ``solve``
    """
    chosen = settings or SolverSettings()
    if scene.tolerance is None:
        return _solved(cover or assemble(scene), None, chosen, progress)
    return _refined(scene, chosen, progress, _MESHES)


def solve_scene_in_stages(
    scene: Scene,
    cover: Cover,
    folder: Path,
    *,
    again_from: str | None = None,
    resume: bool = False,
    progress: Progress = silent,
) -> Solution:
    """Solve as ``solve_in_stages`` does, on the mesh that a tolerance asks for if there is one.

    The stages are those of the last mesh, which is sewn and hooked from its start. What it was
    made from is kept beside them. A mesh that misses the tolerance is left for a finer one, and the
    stages are made again. A stage that is done again keeps the mesh.

    Parameters
    ----------
    cover : of the scene at its element size
    folder, again_from, resume : see ``chain.timeline``
    """
    if scene.tolerance is None:
        return _in_stages(cover, folder, again_from, resume, progress)
    path = folder / BEFORE
    before = earlier_result(coarser(scene), path)
    if before is None:
        before = _before(scene, SolverSettings(), _part(progress, 0.0, _BEFORE))
    made_from = before
    if again_from is not None and path.exists():
        made_from = io.read_result(path)
    elif not resume:
        made_from = _sized(before, 1.0)
    for show in _parts(progress, _MESHES):
        io.write_result(made_from, path)
        cover = local_cover(scene, made_from)
        fine = with_error(scene, _in_stages(cover, folder, again_from, resume, show), before)
        if again_from is not None or _done(scene, fine):
            break
        made_from = _stricter(scene, made_from, fine)
    return fine


def local_cover(scene: Scene, before: Solution) -> Cover:
    """Mesh a scene as fine as a result on a coarser mesh says that its tolerance asks for."""
    cover = before.cover
    # Free edges are left out of every statement.
    inner = ~np.isin(cover.zone, [k for k, z in enumerate(cover.zone_names) if z == FREE_EDGE])
    w2 = np.where(inner, _w2(scene, before), 0.0)
    sizes = needed_sizes(cover, w2, _share(before) * _sizing(scene), coarsest_size(scene))
    gradings = {}
    for panel, name in enumerate(cover.panel_names):
        own = np.unique(cover.faces[cover.panel == panel])
        gradings[name] = Grading(cover.uv[own], sizes[own])
    return assemble(scene, sizes=gradings)


def with_error(scene: Scene, fine: Solution, coarse: Solution) -> Solution:
    """Measure the mesh error of a result by one on a coarser mesh, and keep it among its figures.

    A zone errs by the difference of its means, extrapolated. Where both meshes are alike, as they
    are where little wrinkles, it errs by the estimate that sized them. A mean that falls errs by no
    more than itself, since W2 is nowhere below zero. The tolerance is set against
    the error over all zones but free edges: the root mean square of their errors over their means,
    or over 0.02 if that is more, weighted by area.
    """
    rows, before = (
        {row.zone: row for row in assess(solution, _criteria(scene, solution)).zones}
        for solution in (fine, coarse)
    )
    size, estimate = zone_sizes(fine.cover, _w2(scene, fine))
    size_before, _ = zone_sizes(coarse.cover, _w2(scene, coarse))
    zones = []
    for name, row in rows.items():
        error = estimate[name] * row["w2_mean"]
        ratio = size_before.get(name, 0.0) / size[name]
        if ratio >= _APART:
            rise = (row["w2_mean"] - before[name]["w2_mean"]) / (ratio**_ORDER - 1.0)
            error = rise if rise >= 0.0 else min(-rise, row["w2_mean"])
        zones.append(ZoneMean(name, row["w2_mean"], error))
    inner = [zone for zone in zones if zone.zone != FREE_EDGE]
    area = np.array([rows[zone.zone].area for zone in inner])
    share = np.array([zone.error / max(zone.w2_mean, SMALL) for zone in inner])
    reached = math.sqrt(float(area @ share**2 / area.sum())) if len(inner) else 0.0
    figures = {**fine.figures, ASKED: _asked(scene), REACHED: reached}
    return with_companions(replace(fine, figures=MappingProxyType(figures)), zones)


def with_scatter(
    scene: Scene, solution: Solution, *, seeds: int = SEEDS, progress: Progress = silent
) -> Solution:
    """Measure what other seeds would give, and keep it among the figures of a result.

    They are solved from their start, on the first mesh: begun from a shape at rest, a cover stays
    in the folds that it has. The share of the means by which they scatter there counts.

    Parameters
    ----------
    solution : of ``solve_scene``
    seeds : 2 or more

    Raises
    ------
    InputError, SolverError   fewer seeds, and as ``solve_scene``
    """
    if seeds < 2:
        raise InputError.single("seeds", got=seeds, expected="2 or more")
    while scene.tolerance is not None:
        scene = coarser(scene)
    others = []
    for k in range(seeds):
        show = _part(progress, k / seeds, (k + 1) / seeds)
        other = solve_scene(with_mesh(scene, seed=scene.seed + k), progress=show)
        others.append(assess(other, _criteria(scene, other)).zones)
    own = assess(solution, _criteria(scene, solution)).zones
    zones = [
        ZoneMean(
            row.zone,
            row["w2_mean"],
            math.nan if row.w2_mesh_error is None else row.w2_mesh_error,
            scatter(others, row),
        )
        for row in own
    ]
    return with_companions(solution, zones, seeds)


def _refined(scene: Scene, settings: SolverSettings, progress: Progress, meshes: int) -> Solution:
    """Solve on so many meshes at most, after the coarser ones, until the tolerance is kept."""
    last = before = _before(scene, settings, _part(progress, 0.0, _BEFORE))
    for show in _parts(progress, meshes):
        fine = _solved(local_cover(scene, before), last, settings, show)
        last = _together(last, with_error(scene, fine, before))
        if _done(scene, last):
            break
        before = _stricter(scene, before, last)
    return last


def _before(scene: Scene, settings: SolverSettings, progress: Progress) -> Solution:
    """Solve on the coarser mesh, which need not keep the larger tolerance that it was made for."""
    first = coarser(scene)
    if first.tolerance is None:
        return _solved(assemble(first), None, settings, progress)
    return _refined(first, settings, progress, meshes=1)


def _done(scene: Scene, solution: Solution) -> bool:
    """Whether no finer mesh would help: the tolerance is kept, or the solver did not converge."""
    return solution.status != "converged" or solution.figures[REACHED] <= _asked(scene)


def _share(before: Solution) -> float:
    """Share of the tolerance that the mesh made from a result is made for."""
    return before.figures.get(SIZED, 1.0)


def _sized(before: Solution, share: float) -> Solution:
    return replace(before, figures=MappingProxyType({**before.figures, SIZED: share}))


def _stricter(scene: Scene, before: Solution, missed: Solution) -> Solution:
    """Have a finer mesh made, by as much as the last one missed the tolerance."""
    share = max(_AIM * _asked(scene) / missed.figures[REACHED], _FINER)
    return _sized(before, share * _share(before))


def _solved(
    cover: Cover, start: Solution | None, settings: SolverSettings, progress: Progress
) -> Solution:
    size = f"{len(cover.rest)} vertices:"
    return solve(
        cover,
        settings=settings,
        start=start,
        progress=lambda **figures: progress("solve", mesh=size, **figures),
    )


def _in_stages(
    cover: Cover, folder: Path, again_from: str | None, resume: bool, progress: Progress
) -> Solution:
    return solve_in_stages(
        cover,
        folder,
        again_from=again_from,
        resume=resume,
        progress=lambda **figures: progress("solve", **figures),
    )


def _together(before: Solution, last: Solution) -> Solution:
    """Put history and cost of the meshes before in front of those of the last one."""
    history = {
        name: np.concatenate([before.history[name], column])
        for name, column in last.history.items()
    }
    added = {name: before.figures[name] + last.figures[name] for name in _ADDED}
    history["cpu_seconds"][len(before.history["cpu_seconds"]) :] += before.figures["cpu_seconds"]
    return replace(
        last,
        history=MappingProxyType(history),
        figures=MappingProxyType({**last.figures, **added}),
    )


def _part(progress: Progress, begin: float, end: float) -> Progress:
    """Progress that counts as a part of all the work."""

    def show(name: str, /, **figures: float | str) -> None:
        step, steps = figures.get("step"), figures.get("steps")
        if isinstance(step, float | int) and isinstance(steps, float | int):
            figures |= {"step": 100.0 * (begin + (end - begin) * step / steps), "steps": 100.0}
        progress(name, **figures)

    return show


def _parts(progress: Progress, meshes: int) -> Iterator[Progress]:
    """Progress of each mesh after the coarser ones: half of what is left, as more may follow."""
    begin = _BEFORE
    for left in reversed(range(meshes)):
        end = 0.5 * (begin + 1.0) if left else 1.0
        yield _part(progress, begin, end)
        begin = end


def _criteria(scene: Scene, solution: Solution) -> Criteria:
    return criteria_of(solution.cover.materials, scene.curvature, default=scene.c_threshold)


def _w2(scene: Scene, solution: Solution) -> FloatArray:
    return assess(solution, _criteria(scene, solution)).values("w2")


def _wavelength(scene: Scene) -> float:
    return min(foam_wavelength(m.fabric, scene.foam.material) for m in scene.materials.values())


def _sizing(scene: Scene) -> float:
    """Tolerance that sizes a mesh: the scene's, or that of half the coarsest elements."""
    coarse = CURVATURE_ERROR * (_COARSEST / _TWICE / _wavelength(scene)) ** 2
    return min(_asked(scene), coarse)


def _asked(scene: Scene) -> float:
    if scene.tolerance is None:
        raise InputError.single(
            "tolerance", got="nothing", expected="a share of the zone means", file=scene.path
        )
    return scene.tolerance
