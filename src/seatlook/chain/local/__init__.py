"""Solve to a tolerance: fine where it wrinkles, the error measured by a coarser mesh."""

from seatlook.chain.local.errors import with_error
from seatlook.chain.local.seeds import with_scatter
from seatlook.chain.local.sizes import coarser, coarsest_size, finest_size, forecast
from seatlook.chain.local.solve import (
    BEFORE,
    SIZED,
    local_cover,
    solve_scene,
    solve_scene_in_stages,
)

__all__ = [
    "BEFORE",
    "SIZED",
    "coarser",
    "coarsest_size",
    "finest_size",
    "forecast",
    "local_cover",
    "solve_scene",
    "solve_scene_in_stages",
    "with_error",
    "with_scatter",
]
