"""From a design surface to flat patterns that fit it."""

from seatlook.flattening.cutting import cut_along
from seatlook.flattening.excess import Excess
from seatlook.flattening.flatten import Flattened, PanelStrain, SeamLengths, flatten
from seatlook.flattening.surface import DesignSurface

__all__ = [
    "DesignSurface",
    "Excess",
    "Flattened",
    "PanelStrain",
    "SeamLengths",
    "cut_along",
    "flatten",
]
