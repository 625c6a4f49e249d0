"""What other seeds would give."""

from __future__ import annotations

import math

from seatlook.assembly import with_mesh
from seatlook.chain.assess import assess
from seatlook.chain.companions import SEEDS, ZoneMean, scatters, with_companions
from seatlook.chain.local.errors import criteria_for
from seatlook.chain.local.progress import part
from seatlook.chain.local.solve import solve_scene
from seatlook.errors import InputError
from seatlook.model import Scene, Solution
from seatlook.model.progress import Progress, silent


def with_scatter(
    scene: Scene, solution: Solution, *, seeds: int = SEEDS, progress: Progress = silent
) -> Solution:
    """Measure what other seeds would give, and keep it among the figures of a result.

    They are solved to the same tolerance from their start: begun from a shape at rest, a cover
    stays in the folds that it has, and on a coarser mesh it scatters several times as much.

    Parameters
    ----------
    solution : of ``solve_scene``
    seeds : 2 or more, the solution's own among them

    Raises
    ------
    InputError, SolverError   fewer seeds, and as ``solve_scene``
    """
    if seeds < 2:
        raise InputError.single("seeds", got=seeds, expected="2 or more")
    own = assess(solution, criteria_for(scene, solution)).zones
    means = [{row.zone: row["w2_mean"] for row in own}]
    for k in range(1, seeds):
        show = part(progress, (k - 1) / (seeds - 1), k / (seeds - 1))
        other = solve_scene(with_mesh(scene, seed=scene.seed + k), progress=show)
        rows = assess(other, criteria_for(scene, other)).zones
        means.append({row.zone: row["w2_mean"] for row in rows})
    width = scatters({row.zone: row.area for row in own}, means)
    zones = [
        ZoneMean(
            row.zone,
            row["w2_mean"],
            math.nan if row.w2_mesh_error is None else row.w2_mesh_error,
            width[row.zone],
        )
        for row in own
    ]
    return with_companions(solution, zones, seeds)
