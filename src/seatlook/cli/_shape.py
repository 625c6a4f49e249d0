"""The command that compares a finished shape with its design surface."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from seatlook.cli._output import Json, note, table
from seatlook.cli._run import ResultFile, SceneFile, camera_of, load, result_of
from seatlook.errors import InputError


def shape(
    scene: SceneFile,
    result: ResultFile,
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
    from seatlook.chain.evaluation import draw_distance, seam_line_rows, shape_rows, write_shape
    from seatlook.results.deviation import deviation, seam_lines
    from seatlook.results.gap import zone_gaps

    read = load(scene)
    if read.design is None:
        raise InputError.single(
            "design", got="nothing", expected="a table [design] with a file", file=read.path
        )
    camera, solution = camera_of(read, view), result_of(read, result)
    off = deviation(solution, read.design)
    if out is not None:
        write_shape(solution, read.design, off, out)
        note(f"map: {out / draw_distance('deviation', solution, off, camera, out)[0]}")
    rows = (
        seam_line_rows(seam_lines(solution, read.design))
        if seams
        else shape_rows(zone_gaps(solution, off))
    )
    table(list(rows[0]) if rows else (), [tuple(row.values()) for row in rows], json=json)
