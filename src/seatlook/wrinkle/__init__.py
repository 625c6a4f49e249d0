"""How much a cover wrinkles, where and why."""

from seatlook.wrinkle.equations import (
    compression_wrinkle,
    curvature_index,
    curvature_tensor,
    relative_curvature,
    stretch_ratio,
    stretch_wrinkle,
    surface_strains,
    wrinkle_index,
    wrinkle_indices,
)
from seatlook.wrinkle.zone import ZoneRow, quantile, zone_table

__all__ = [
    "ZoneRow",
    "compression_wrinkle",
    "curvature_index",
    "curvature_tensor",
    "quantile",
    "relative_curvature",
    "stretch_ratio",
    "stretch_wrinkle",
    "surface_strains",
    "wrinkle_index",
    "wrinkle_indices",
    "zone_table",
]
