"""How much a cover wrinkles, where and why."""

from seatlook.wrinkle.advice import Advice, advice_on, advise
from seatlook.wrinkle.distortion import (
    DISTORTIONS,
    Distortion,
    DistortionRow,
    distortion,
    distortion_table,
)
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
    TENSION_STATES,
    excess_strain,
    isotropic_membrane,
    signed_ratio,
    tension_state,
    w2_net,
    wrinkle_strain,
)
from seatlook.wrinkle.recovery import (
    DESIGN_WAVELENGTH,
    low_passed,
    recover,
    recovery_error,
    shape_curvature,
)
from seatlook.wrinkle.registry import INDICES, STATISTICS, Index, figure_names, register
from seatlook.wrinkle.seam_excess import SeamStretch, seam_excess
from seatlook.wrinkle.section import Section, section
from seatlook.wrinkle.surface import Surface
from seatlook.wrinkle.worst import Wrinkle, beside_sections, section_across, worst_wrinkles
from seatlook.wrinkle.zone import ZoneRow, map_top, zone_table

__all__ = [
    "DEAD_BAND",
    "DESIGN_WAVELENGTH",
    "DISTORTIONS",
    "INDICES",
    "STATISTICS",
    "STRAIN_MEASURES",
    "TENSION_STATES",
    "Advice",
    "Distortion",
    "DistortionRow",
    "Index",
    "SeamStretch",
    "Section",
    "Surface",
    "Wrinkle",
    "ZoneRow",
    "advice_on",
    "advise",
    "beside_sections",
    "compression_wrinkle",
    "curvature_index",
    "curvature_tensor",
    "distortion",
    "distortion_table",
    "excess_strain",
    "figure_names",
    "isotropic_membrane",
    "low_passed",
    "map_top",
    "recover",
    "recovery_error",
    "register",
    "relative_curvature",
    "seam_excess",
    "section",
    "section_across",
    "shape_curvature",
    "signed_ratio",
    "stretch_ratio",
    "stretch_wrinkle",
    "surface_strains",
    "tension_state",
    "w2_net",
    "worst_wrinkles",
    "wrinkle_index",
    "wrinkle_indices",
    "wrinkle_strain",
    "zone_table",
]
