"""The command that compares a finished shape with its design surface."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from seatlook.cli._options import ResultFile, SceneFile, solved_seat
from seatlook.cli._output import Json, note, table


def shape(
    scene: SceneFile,
    result: ResultFile = None,
    /,
    *,
    seams: Annotated[bool, Parameter(negative=())] = False,
    out: Path | None = None,
    view: str | None = None,
    json: Json = False,
) -> None:
    """Print how far a result is from the scene's design surface, zone by zone, in mm.

    Example: seatlook shape seat.toml seat.npz --seams

    Parameters
    ----------
    seams
        Print instead how far every sewn seam lies from its line on the design.
    out
        Folder for shape.csv, seam-lines.csv and maps/deviation.png; nothing is written without.
    view
        Camera of the scene for the map. The first if not given.
    """
    from seatlook.chain.draw import Canvas, draw_distance
    from seatlook.chain.evaluation import DEVIATION
    from seatlook.chain.files import gap_rows, seam_line_rows, write_shape

    seat = solved_seat(scene, result)
    assessment, solution = seat.assessment, seat.solution
    zones = seat.shape()
    rows = seam_line_rows(assessment.seam_lines) if seams else gap_rows(zones)
    if out is not None:
        write_shape(assessment, out)
        run = solution.cover.scene_digest
        canvas = Canvas(solution=solution, camera=seat.camera(view), out=out, run=run)
        drawn = draw_distance("deviation", assessment.deviation, canvas, DEVIATION)
        note(f"map: {out / drawn.path}")
    table(list(rows[0]) if rows else (), [tuple(row.values()) for row in rows], json=json)
