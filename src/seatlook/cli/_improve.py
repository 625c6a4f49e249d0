"""The command that says how a pattern is to be corrected."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from seatlook.cli._options import Preview, SceneFile, exit_code_of, seat_of
from seatlook.cli._output import Json, note, print_rows, progress, say, show_json
from seatlook.errors import InputError


def improve(
    scene: SceneFile,
    /,
    *,
    propose: Annotated[
        bool, Parameter(negative=(), help="Say what would help most, without a loop.")
    ] = False,
    result: Annotated[
        Path | None, Parameter(help="Result file (.npz); by default the one beside the scene.")
    ] = None,
    out: Annotated[
        Path | None, Parameter(help="Folder for the corrected pattern, seams and table.")
    ] = None,
    count: Annotated[int, Parameter(help="How many corrections at most.")] = 3,
    preview: Preview = False,
    json: Json = False,
) -> int:
    """Say which corrections of the pattern, the hooks or the foam help most, in millimetres.

    What may change stands in [improve] of the scene. Each correction counts on those before it.
    The amounts are checked on the mesh at hand; prove them by evaluating the corrected pattern.

    Example: seatlook improve seat.toml --propose --out corrected
    """
    from seatlook.chain.run_folder import run_folder
    from seatlook.improvement.corrected import WRITTEN, rows_of, write_corrected

    if not propose:
        raise InputError.single("improve", got="no task", expected="--propose")
    seat = seat_of(scene)
    with progress() as show:
        if not seat.reuse(result or scene.with_name("result.npz")):
            seat.solve(progress=show)
        show("propose")
        found = seat.propose(count=count)
    if json:
        show_json(rows_of(found))
    else:
        print_rows([{"correction": p.sentence} for p in found.proposals])
    if not found.proposals:
        say("nothing that may change would help by more than 3 %")
    if out is not None:
        with run_folder(out, writes=WRITTEN):
            files = write_corrected(seat.scene, seat.solution, found, out)
        note(f"written into {out}: {', '.join(files)}")
    return exit_code_of(seat.resolution, preview=preview)
