"""Triangle meshes as plain arrays; no core types, so that every other layer may use it."""

from seatlook.mesh.intersection import intersecting_pairs
from seatlook.mesh.outline import (
    MAX_HEXAGONAL_BIAS,
    MIN_ANGLE_DEG,
    QUANTILE_ANGLE_DEG,
    triangulate,
)
from seatlook.mesh.polyline import arc_length, length, nearest_place, resample, segment_lengths
from seatlook.mesh.surface import (
    angles,
    boundary_loops,
    boundary_sides,
    edge_lengths,
    edges,
    face_areas,
    face_normals,
    face_vectors,
    hexagonal_bias,
    vertex_normals,
)

__all__ = [
    "MAX_HEXAGONAL_BIAS",
    "MIN_ANGLE_DEG",
    "QUANTILE_ANGLE_DEG",
    "angles",
    "arc_length",
    "boundary_loops",
    "boundary_sides",
    "edge_lengths",
    "edges",
    "face_areas",
    "face_normals",
    "face_vectors",
    "hexagonal_bias",
    "intersecting_pairs",
    "length",
    "nearest_place",
    "resample",
    "segment_lengths",
    "triangulate",
    "vertex_normals",
]
