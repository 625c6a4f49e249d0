"""How much a cover wrinkles, where and why."""

from seatlook.wrinkle.equations import (
    STRAIN_MEASURES,
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
from seatlook.wrinkle.measures import (
    DEAD_BAND,
    INDICES,
    MEASURES,
    TENSION_STATES,
    Surface,
    isotropic_membrane,
    signed_ratio,
    surface_of,
    tension_state,
    threshold_of_radius,
    thresholds,
    w2_net,
    wrinkle_strain,
)
from seatlook.wrinkle.recovery import low_passed, recover, recovery_error, shape_curvature
from seatlook.wrinkle.section import Section, section
from seatlook.wrinkle.shells import ShellWrinkles, shell_indices
from seatlook.wrinkle.texture import (
    DISTORTIONS,
    Distortion,
    DistortionRow,
    distortion,
    distortion_table,
)
from seatlook.wrinkle.worst import Wrinkle, section_across, worst_wrinkles
from seatlook.wrinkle.zone import ZoneRow, map_top, zone_table
from seatlook.zones import quantile

__all__ = [
    "DEAD_BAND",
    "DISTORTIONS",
    "INDICES",
    "MEASURES",
    "STRAIN_MEASURES",
    "TENSION_STATES",
    "Distortion",
    "DistortionRow",
    "Section",
    "ShellWrinkles",
    "Surface",
    "Wrinkle",
    "ZoneRow",
    "compression_wrinkle",
    "curvature_index",
    "curvature_tensor",
    "distortion",
    "distortion_table",
    "isotropic_membrane",
    "low_passed",
    "map_top",
    "quantile",
    "recover",
    "recovery_error",
    "relative_curvature",
    "section",
    "section_across",
    "shape_curvature",
    "shell_indices",
    "signed_ratio",
    "stretch_ratio",
    "stretch_wrinkle",
    "surface_of",
    "surface_strains",
    "tension_state",
    "threshold_of_radius",
    "thresholds",
    "w2_net",
    "worst_wrinkles",
    "wrinkle_index",
    "wrinkle_indices",
    "wrinkle_strain",
    "zone_table",
]
