"""The family of seats that seatlook brings along, by formula."""

from seatlook.seats.cushion import Cushion
from seatlook.seats.demo import demo_design, demo_foam_mesh
from seatlook.seats.family import SHAPES, shaped
from seatlook.seats.files import write_demo
from seatlook.seats.meshing import FoamMesh, design_surface, foam_mesh

__all__ = [
    "SHAPES",
    "Cushion",
    "FoamMesh",
    "demo_design",
    "demo_foam_mesh",
    "design_surface",
    "foam_mesh",
    "shaped",
    "write_demo",
]
