"""The mesh error of a result, measured by one on a coarser mesh."""

from __future__ import annotations

import math
from dataclasses import replace
from types import MappingProxyType

import numpy as np

from seatlook.chain.assess import assess
from seatlook.chain.companions import TwoMeshes, ZoneMean, two_mesh_errors, with_companions
from seatlook.chain.local.sizes import asked
from seatlook.model import Criteria, FloatArray, Scene, Solution, criteria_of
from seatlook.model.zones import FREE_EDGE
from seatlook.results.needed_sizes import SMALL, zone_sizes
from seatlook.results.resolution import ASKED, REACHED


def with_error(scene: Scene, fine: Solution, coarse: Solution) -> Solution:
    """Measure the mesh error of a result by one on a coarser mesh, and keep it among its figures.

    The tolerance is set against the error over all zones but free edges: the root mean square of
    their errors over their means, or over 0.02 if that is more, weighted by area.
    """
    rows, before = (
        {row.zone: row for row in assess(solution, criteria_for(scene, solution)).zones}
        for solution in (fine, coarse)
    )
    size, estimate = zone_sizes(fine.cover, w2_of(scene, fine))
    size_before, _ = zone_sizes(coarse.cover, w2_of(scene, coarse))
    found = [
        TwoMeshes(
            zone=name,
            mean=row["w2_mean"],
            before=before[name]["w2_mean"] if name in before else math.nan,
            ratio=size_before.get(name, 0.0) / size[name],
            estimate=estimate[name],
            area=row.area,
        )
        for name, row in rows.items()
    ]
    errors = two_mesh_errors(found)
    zones = [ZoneMean(row.zone, row["w2_mean"], errors[row.zone]) for row in rows.values()]
    inner = [zone for zone in zones if zone.zone != FREE_EDGE]
    area = np.array([rows[zone.zone].area for zone in inner])
    share = np.array([zone.error / max(zone.w2_mean, SMALL) for zone in inner])
    reached = math.sqrt(float(area @ share**2 / area.sum())) if len(inner) else 0.0
    figures = {**fine.figures, ASKED: asked(scene), REACHED: reached}
    return with_companions(replace(fine, figures=MappingProxyType(figures)), zones)


def criteria_for(scene: Scene, solution: Solution) -> Criteria:
    """Criteria of a scene for a result of it."""
    return criteria_of(solution.cover.materials, scene.curvature, default=scene.c_threshold)


def w2_of(scene: Scene, solution: Solution) -> FloatArray:
    """W2 (m,) [1] of the faces of a result."""
    return assess(solution, criteria_for(scene, solution)).values("w2")
