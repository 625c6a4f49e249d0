"""What other seeds would give."""

from __future__ import annotations

import math

from seatlook.assembly import with_mesh
from seatlook.chain.assess import assess
from seatlook.chain.companions import SEEDS, ZoneMean, scatter, with_companions
from seatlook.chain.local.errors import criteria_for
from seatlook.chain.local.progress import part
from seatlook.chain.local.sizes import coarser
from seatlook.chain.local.solve import solve_scene
from seatlook.errors import InputError
from seatlook.model import Scene, Solution
from seatlook.model.progress import Progress, silent


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
        show = part(progress, k / seeds, (k + 1) / seeds)
        other = solve_scene(with_mesh(scene, seed=scene.seed + k), progress=show)
        others.append(assess(other, criteria_for(scene, other)).zones)
    own = assess(solution, criteria_for(scene, solution)).zones
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
