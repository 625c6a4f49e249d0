"""The verdict on a result, and the figures it rests on."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from seatlook.errors import InvertedElementError
from seatlook.solver.foam.foundation import Foundation
from seatlook.solver.process.coverage import coverage
from seatlook.solver.process.crossing import (
    crossing_pairs,
    hem_crossings,
    visible_crossings,
    zone_crossings,
)
from seatlook.solver.process.process import RESIDUAL, Process, Record

SEAM_GAP = 1e-4  # m
ANCHOR_GAP = 5e-4  # m, hooked and framed points from their targets
KINETIC = 1e-4  # of the elastic energy of sheet and foam
COMPRESSION = 0.6  # of the local foam thickness
RESULTANT = 0.01
_COLLAPSED = 1e-3  # of the rest area


def reasons(process: Process, record: Record) -> list[str]:
    """Reasons why a result cannot be trusted; none where it can.

    Raises
    ------
    InvertedElementError   a triangle has lost its area
    """
    _check_faces(process)
    causes = unrest(process, record)
    if process.foundation is not None:
        causes += _contact_reasons(process, process.foundation)
        causes += coverage(process.cover, process.x, process.foundation).reasons()
    return causes


def unrest(process: Process, record: Record) -> list[str]:
    """Reasons that more rounds may remove: forces out of balance, movement, gaps."""
    causes = []
    if not record.residual <= RESIDUAL:
        causes.append(f"out-of-balance force {record.residual:.2g} of the mean elastic force")
    if record.kinetic > KINETIC * (record.elastic + record.foam):
        causes.append("the cover still moves")
    if record.seam_gap >= SEAM_GAP:
        causes.append(f"a seam is open by {1e3 * record.seam_gap:.2g} mm")
    for kind in ("hook", "frame"):
        gap = process.ties.largest_gap(process.x, kind)
        if gap >= ANCHOR_GAP:
            causes.append(f"a {kind} is off by {1e3 * gap:.2g} mm")
    return causes


def figures(process: Process, records: Sequence[Record]) -> dict[str, float]:
    """Final values that go with a Solution; SI units."""
    record = records[-1]
    result = {
        "residual": record.residual,
        "kinetic_ratio": record.kinetic / max(record.elastic + record.foam, 1e-300),
        "elastic_energy": record.elastic,
        "foam_energy": record.foam,
        "potential_energy": record.energy,
        "iterations": float(sum(r.iterations for r in records)),
        "steps": float(len(records)),
        **process.ties.figures(process.x),
        **_crossings(process),
    }
    for name, force in process.resultants().items():
        result |= {f"{name}_{axis}": float(f) for axis, f in zip("xyz", force, strict=True)}
    if process.foundation is not None:
        result |= process.foundation.figures(process.state)
        result["contact_resultant_error"] = _resultant_error(process)
        result |= coverage(process.cover, process.x, process.foundation).figures()
        result["wavelength"] = process.foundation.wavelength
        result["wavelength_over_h"] = process.foundation.wavelength / process.cover.element_size
    return result


def _crossings(process: Process) -> dict[str, float]:
    """Pairs of triangles that pass through each other, where it shows and in every zone."""
    pairs = crossing_pairs(process.cover, process.x)
    zones = zone_crossings(process.cover, pairs)
    hem = {}
    if process.cover.hem is not None:
        hem["hem_crossing_pairs"] = float(len(hem_crossings(process.cover, process.x)))
    return {
        **hem,
        "intersecting_pairs": float(visible_crossings(process.cover, pairs)),
        **{f"zone/{name}/intersecting_pairs": float(count) for name, count in zones.items()},
    }


def _check_faces(process: Process) -> None:
    p = process.x[process.cover.faces]
    area = 0.5 * np.linalg.norm(np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), axis=1)
    faces = np.flatnonzero(area < _COLLAPSED * process.cover.rest_area)
    if faces.size:
        name = process.cover.panel_names[process.cover.panel[faces[0]]]
        raise InvertedElementError(
            f"{faces.size} triangles have lost their area, the first is {faces[0]} in panel {name}"
        )


def _contact_reasons(process: Process, foundation: Foundation) -> list[str]:
    """Reasons in the foam: pressed beyond its curve, or by too much of its thickness."""
    causes = []
    figures = foundation.figures(process.state)
    pressure, highest = figures["contact_column_pressure_max"], foundation.material.stress[-1]
    if pressure > highest:
        causes.append(
            f"pressure {pressure:.3g} Pa on the foam, whose curve ends at {highest:.3g} Pa"
        )
    compression = figures["contact_compression_max"]
    if compression >= COMPRESSION:
        causes.append(f"foam compressed by {100 * compression:.0f} % of its thickness")
    error = _resultant_error(process)
    # Without contact there is no pressure to compare: then it is said that nothing touches.
    if error > RESULTANT and figures["contact_vertices"]:
        causes.append(f"foam pressure and resultant differ by {100 * error:.2g} %")
    return causes


def _resultant_error(process: Process) -> float:
    """Sum of all forces on the cover over what the foam has to carry."""
    forces = process.resultants()
    rest = forces["ties"] + forces["weight"]
    total = rest + forces["contact"] + forces["friction"]
    size = float(np.linalg.norm(rest))
    return float(np.linalg.norm(total)) / size if size > 0 else 0.0
