"""The demo seat, and flat patterns from design surfaces."""

from seatlook.design.cushion import Cushion
from seatlook.design.cutting import cut_along
from seatlook.design.demo import FoamMesh, demo_design, demo_foam_mesh
from seatlook.design.flattening import Flattened, PanelStrain, SeamLengths, flatten
from seatlook.design.surface import DesignSurface

__all__ = [
    "Cushion",
    "DesignSurface",
    "Flattened",
    "FoamMesh",
    "PanelStrain",
    "SeamLengths",
    "cut_along",
    "demo_design",
    "demo_foam_mesh",
    "flatten",
]
