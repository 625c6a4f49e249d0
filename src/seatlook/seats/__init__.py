"""The family of seats that seatlook brings along, by formula."""

from seatlook.seats.cushion import Cushion
from seatlook.seats.demo import FoamMesh, demo_design, demo_foam_mesh
from seatlook.seats.files import write_demo

__all__ = ["Cushion", "FoamMesh", "demo_design", "demo_foam_mesh", "write_demo"]
