"""Lines drawn into a triangle mesh, vertex by vertex, and what that leaves narrow made wider."""

from seatlook.mesh.drawing.drawing import FLAT, SAME, Drawing, Edge
from seatlook.mesh.drawing.tidying import tidy

__all__ = ["FLAT", "SAME", "Drawing", "Edge", "tidy"]
