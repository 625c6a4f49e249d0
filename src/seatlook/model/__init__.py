"""The core types: frozen, checked when made, SI units inside."""

from seatlook.model._check import FloatArray, IntArray
from seatlook.model.cover import (
    Anchor,
    Cover,
    Hem,
    Points,
    Solution,
    Stitching,
    Strains,
    WrinkleMap,
)
from seatlook.model.criteria import Criteria, CurvatureMode, StrainMeasure, criteria_of
from seatlook.model.fastenings import SeamKind, Thread, Wire
from seatlook.model.light.camera import VIEWS, Camera, framed_view, named_view, sphere_distance
from seatlook.model.light.lamps import (
    LIGHTS,
    Light,
    Rig,
    booth,
    bulb,
    direction,
    rectangle,
    strip,
    sun,
    tunnel,
    two_sided_rectangle,
)
from seatlook.model.light.surroundings import SURROUNDINGS, Surroundings, surroundings_named
from seatlook.model.material import (
    Appearance,
    Curve,
    Fabric,
    Foam,
    FoamMaterial,
    Hysteresis,
    Material,
)
from seatlook.model.pattern import Edge, Notch, Panel, Pattern, Seam
from seatlook.model.scene import Border, Design, Frame, Hook, Limit, Pose, Scene, Verdict, ZoneBox
from seatlook.model.shells import ShellResult, Shells, ShellState
from seatlook.model.stage import Stage, stage_units
from seatlook.model.table import Field
from seatlook.model.texture import TextureMaps

__all__ = [
    "LIGHTS",
    "SURROUNDINGS",
    "VIEWS",
    "Anchor",
    "Appearance",
    "Border",
    "Camera",
    "Cover",
    "Criteria",
    "CurvatureMode",
    "Curve",
    "Design",
    "Edge",
    "Fabric",
    "Field",
    "FloatArray",
    "Foam",
    "FoamMaterial",
    "Frame",
    "Hem",
    "Hook",
    "Hysteresis",
    "IntArray",
    "Light",
    "Limit",
    "Material",
    "Notch",
    "Panel",
    "Pattern",
    "Points",
    "Pose",
    "Rig",
    "Scene",
    "Seam",
    "SeamKind",
    "ShellResult",
    "ShellState",
    "Shells",
    "Solution",
    "Stage",
    "Stitching",
    "StrainMeasure",
    "Strains",
    "Surroundings",
    "TextureMaps",
    "Thread",
    "Verdict",
    "Wire",
    "WrinkleMap",
    "ZoneBox",
    "booth",
    "bulb",
    "criteria_of",
    "direction",
    "framed_view",
    "named_view",
    "rectangle",
    "sphere_distance",
    "stage_units",
    "strip",
    "sun",
    "surroundings_named",
    "tunnel",
    "two_sided_rectangle",
]
