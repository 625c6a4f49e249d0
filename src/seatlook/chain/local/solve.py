"""Solve to a tolerance: on a mesh that is fine where the cover wrinkles, begun from a coarser one.

The coarser one is solved as ever, or to a larger tolerance, in turn. Its wrinkles tell where the
finer one is fine, and the difference between both tells the error. Where that is more than was
asked for, a still finer mesh is made.
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import MappingProxyType

import numpy as np

from seatlook import io
from seatlook._memory import give_back
from seatlook.assembly import assemble
from seatlook.assembly.grading import Grading
from seatlook.chain.files import earlier_result
from seatlook.chain.local import progress as share
from seatlook.chain.local.errors import w2_of, with_error
from seatlook.chain.local.sizes import asked, coarser, coarsest_size, sizing
from seatlook.chain.timeline import solve_in_stages
from seatlook.model import Cover, Scene, Solution
from seatlook.model.progress import Progress, silent
from seatlook.model.zones import FREE_EDGE
from seatlook.results.needed_sizes import needed_sizes
from seatlook.results.resolution import REACHED
from seatlook.solver import SolverSettings, solve

BEFORE = "0-coarser.npz"  # beside the stages: what the mesh was made from
_MESHES = 3  # are made for a tolerance at most, each finer by as much as the one before missed it
_AIM = 0.9  # times the tolerance is what a mesh is made for where one missed it
_FINER = 0.5  # times the tolerance that sized a mesh sizes the next one at least
SIZED = "w2_sized"  # figure of a coarser mesh: share of the tolerance that the next is made for
_ADDED = ("steps", "iterations", "cpu_seconds")


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
        before = _before(scene, SolverSettings(), share.part(progress, 0.0, share.BEFORE))
    made_from = before
    if again_from is not None and path.exists():
        made_from = io.read_result(path)
    elif not resume:
        made_from = _sized(before, 1.0)
    for show in share.parts(progress, _MESHES):
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
    w2 = np.where(inner, w2_of(scene, before), 0.0)
    sizes = needed_sizes(cover, w2, _aim(before) * sizing(scene), coarsest_size(scene))
    gradings = {}
    for panel, name in enumerate(cover.panel_names):
        own = np.unique(cover.faces[cover.panel == panel])
        gradings[name] = Grading(cover.uv[own], sizes[own])
    return assemble(scene, sizes=gradings)


def _refined(scene: Scene, settings: SolverSettings, progress: Progress, meshes: int) -> Solution:
    """Solve on so many meshes at most, after the coarser ones, until the tolerance is kept."""
    last = before = _before(scene, settings, share.part(progress, 0.0, share.BEFORE))
    for show in share.parts(progress, meshes):
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
    return solution.status != "converged" or solution.figures[REACHED] <= asked(scene)


def _aim(before: Solution) -> float:
    """Share of the tolerance that the mesh made from a result is made for."""
    return before.figures.get(SIZED, 1.0)


def _sized(before: Solution, share: float) -> Solution:
    return replace(before, figures=MappingProxyType({**before.figures, SIZED: share}))


def _stricter(scene: Scene, before: Solution, missed: Solution) -> Solution:
    """Have a finer mesh made, by as much as the last one missed the tolerance."""
    stricter = max(_AIM * asked(scene) / missed.figures[REACHED], _FINER)
    return _sized(before, stricter * _aim(before))


def _solved(
    cover: Cover, start: Solution | None, settings: SolverSettings, progress: Progress
) -> Solution:
    size = f"{len(cover.rest)} vertices:"
    solution = solve(
        cover,
        settings=settings,
        start=start,
        progress=lambda **figures: progress("solve", mesh=size, **figures),
    )
    give_back()
    return solution


def _in_stages(
    cover: Cover, folder: Path, again_from: str | None, resume: bool, progress: Progress
) -> Solution:
    solution = solve_in_stages(
        cover,
        folder,
        again_from=again_from,
        resume=resume,
        progress=lambda **figures: progress("solve", **figures),
    )
    give_back()
    return solution


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
