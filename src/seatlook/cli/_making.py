"""Commands that show how a cover was made: its stages in pictures, its hooks ring by ring."""

from __future__ import annotations

from dataclasses import astuple, fields
from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from seatlook.cli._options import Out, ResultFile, SceneFile, result_file, result_of, solved_seat
from seatlook.cli._output import Json, say, table
from seatlook.errors import InputError


def timeline(
    scene: SceneFile,
    result: ResultFile = None,
    /,
    *,
    out: Out,
    rig: str | None = None,
    view: str | None = None,
    width: int = 480,
    seconds: float = 5.0,
) -> None:
    """Draw a cover in the making: timeline.png, a picture per stage, and timeline.gif.

    The result must have been solved with --stages: what lies beside it is drawn.

    Example: seatlook timeline seat.toml seat.npz --out pictures

    Parameters
    ----------
    rig
        Rig of the scene to render the picture per stage in, in the panels' own materials. Without
        it that is a preview, like the animation.
    view
        Camera of the scene. The first if not given; it steps back until all panels are in view.
    width
        Of one picture, in pixels.
    seconds
        How long the animation lasts.
    """
    from seatlook.chain.run_folder import run_folder
    from seatlook.pbr import offscreen_backend

    offscreen_backend()
    seat, path = solved_seat(scene, result), result_file(scene, result)
    with run_folder(out):
        paths = seat.timeline(
            path.with_suffix(".stages"), out, rig=rig, camera=view, width=width, seconds=seconds
        )
    say(*(f"wrote {path}" for path in paths))


def hooks(
    file: Annotated[Path, Parameter(help="Result file (.npz), or the scene it lies beside.")],
    /,
    *,
    csv: Annotated[Path | None, Parameter(help="File for the table as CSV.")] = None,
    json: Json = False,
) -> int:
    """Print what every hog ring pulls with; ends with 1 if one pulls harder than its limit.

    Example: seatlook hooks seat.npz --csv hooks.csv
    """
    from seatlook import io
    from seatlook.results.ring_pulls import RingPull, overpulled, ring_pulls

    result = result_of(file)
    solution = io.read_result(result)
    rings = ring_pulls(solution)
    if not rings and any(anchor.kind == "hook" for anchor in solution.cover.anchors):
        raise InputError.single(
            "result", got="hooks without pulls", expected="a result of this version",
            file=result, hint="solve it again",
        )  # fmt: skip
    units = {"at": ("at_mm", 1e3), "gap": ("gap_mm", 1e3), "pull": ("pull_n", 1.0)}
    units |= {"per_length": ("pull_n_per_mm", 1e-3), "limit": ("limit_n", 1.0)}
    units |= {k: (f"{k}_mm", 1e3) for k in "xyz"}
    names = [f.name for f in fields(RingPull)]
    heads = [units.get(name, (name, 1.0))[0] for name in names]
    rows = [
        tuple(
            value * units[name][1] if name in units and value is not None else value
            for name, value in zip(names, astuple(ring), strict=True)
        )
        for ring in rings
    ]
    table(heads, rows, json=json)
    if csv is not None:
        io.write_table(csv, heads, rows)
    over = overpulled(solution)
    say(*over)
    return int(bool(over))
