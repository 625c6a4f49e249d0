"""Triangle meshes as plain arrays; no core types, so that every other layer may use it."""

from __future__ import annotations

from typing import TYPE_CHECKING

from seatlook._door import door

if TYPE_CHECKING:
    from seatlook.mesh.intersection import (
        intersecting_pairs as intersecting_pairs,
    )
    from seatlook.mesh.outline import (
        MAX_HEXAGONAL_BIAS as MAX_HEXAGONAL_BIAS,
    )
    from seatlook.mesh.outline import (
        MIN_ANGLE_DEG as MIN_ANGLE_DEG,
    )
    from seatlook.mesh.outline import (
        QUANTILE_ANGLE_DEG as QUANTILE_ANGLE_DEG,
    )
    from seatlook.mesh.outline import (
        triangulate as triangulate,
    )
    from seatlook.mesh.polyline import (
        arc_length as arc_length,
    )
    from seatlook.mesh.polyline import (
        directions_at as directions_at,
    )
    from seatlook.mesh.polyline import (
        even_places as even_places,
    )
    from seatlook.mesh.polyline import (
        is_closed as is_closed,
    )
    from seatlook.mesh.polyline import (
        length as length,
    )
    from seatlook.mesh.polyline import (
        nearest_place as nearest_place,
    )
    from seatlook.mesh.polyline import (
        nearest_places as nearest_places,
    )
    from seatlook.mesh.polyline import (
        points_at as points_at,
    )
    from seatlook.mesh.polyline import (
        resample as resample,
    )
    from seatlook.mesh.polyline import (
        resampled_steps as resampled_steps,
    )
    from seatlook.mesh.polyline import (
        segment_lengths as segment_lengths,
    )
    from seatlook.mesh.surface import (
        angles as angles,
    )
    from seatlook.mesh.surface import (
        boundary_loops as boundary_loops,
    )
    from seatlook.mesh.surface import (
        boundary_sides as boundary_sides,
    )
    from seatlook.mesh.surface import (
        edge_lengths as edge_lengths,
    )
    from seatlook.mesh.surface import (
        edges as edges,
    )
    from seatlook.mesh.surface import (
        face_areas as face_areas,
    )
    from seatlook.mesh.surface import (
        face_normals as face_normals,
    )
    from seatlook.mesh.surface import (
        face_vectors as face_vectors,
    )
    from seatlook.mesh.surface import (
        hexagonal_bias as hexagonal_bias,
    )
    from seatlook.mesh.surface import (
        inner_sides as inner_sides,
    )
    from seatlook.mesh.surface import (
        vertex_normals as vertex_normals,
    )

# name -> module; SciPy and Shapely are loaded by what needs them.
_PUBLIC: dict[str, str] = {
    "MAX_HEXAGONAL_BIAS": "seatlook.mesh.outline",
    "MIN_ANGLE_DEG": "seatlook.mesh.outline",
    "QUANTILE_ANGLE_DEG": "seatlook.mesh.outline",
    "angles": "seatlook.mesh.surface",
    "arc_length": "seatlook.mesh.polyline",
    "boundary_loops": "seatlook.mesh.surface",
    "boundary_sides": "seatlook.mesh.surface",
    "directions_at": "seatlook.mesh.polyline",
    "edge_lengths": "seatlook.mesh.surface",
    "edges": "seatlook.mesh.surface",
    "even_places": "seatlook.mesh.polyline",
    "face_areas": "seatlook.mesh.surface",
    "face_normals": "seatlook.mesh.surface",
    "face_vectors": "seatlook.mesh.surface",
    "hexagonal_bias": "seatlook.mesh.surface",
    "inner_sides": "seatlook.mesh.surface",
    "intersecting_pairs": "seatlook.mesh.intersection",
    "is_closed": "seatlook.mesh.polyline",
    "length": "seatlook.mesh.polyline",
    "nearest_place": "seatlook.mesh.polyline",
    "nearest_places": "seatlook.mesh.polyline",
    "points_at": "seatlook.mesh.polyline",
    "resample": "seatlook.mesh.polyline",
    "resampled_steps": "seatlook.mesh.polyline",
    "segment_lengths": "seatlook.mesh.polyline",
    "triangulate": "seatlook.mesh.outline",
    "vertex_normals": "seatlook.mesh.surface",
}

__all__ = [
    "MAX_HEXAGONAL_BIAS",
    "MIN_ANGLE_DEG",
    "QUANTILE_ANGLE_DEG",
    "angles",
    "arc_length",
    "boundary_loops",
    "boundary_sides",
    "directions_at",
    "edge_lengths",
    "edges",
    "even_places",
    "face_areas",
    "face_normals",
    "face_vectors",
    "hexagonal_bias",
    "inner_sides",
    "intersecting_pairs",
    "is_closed",
    "length",
    "nearest_place",
    "nearest_places",
    "points_at",
    "resample",
    "resampled_steps",
    "segment_lengths",
    "triangulate",
    "vertex_normals",
]

if not TYPE_CHECKING:
    __getattr__, __dir__ = door(__name__, _PUBLIC)
