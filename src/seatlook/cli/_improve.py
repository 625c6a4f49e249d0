"""The command that corrects a pattern, or says how."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from seatlook.cli._options import Preview, SceneFile, exit_code_of, seat_of
from seatlook.cli._output import Json, note, print_rows, progress, say, show_json
from seatlook.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from seatlook.improvement.changes import Changes
    from seatlook.improvement.loop import Iteration
    from seatlook.improvement.proof import Proof
    from seatlook.seat import Seat


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
    count: Annotated[
        int | None, Parameter(help="How many corrections --propose names at most; 3 if not given.")
    ] = None,
    preview: Preview = False,
    json: Json = False,
) -> int:
    """Correct the pattern, the hooks or the foam in millimetres, and prove that it is better.

    What may change stands in [improve] of the scene. Corrections are made one after the other, and
    adjusted, until nothing helps any more. Then both seats are solved anew with three seeds.
    Ends with 1 if it is not proven better, or misses [accept]; the best that was found is written.

    Example: seatlook improve seat.toml --out corrected
    """
    if not propose and out is None:
        raise InputError.single(
            "improve", got="no task", expected="--propose, or --out with a folder"
        )
    if count is not None and not propose:
        raise InputError.single(
            "--count", got="no --propose", expected="improve.corrections in the scene"
        )
    seat = seat_of(scene)
    with progress() as show:
        if not seat.reuse(result or scene.with_name("result.npz")):
            seat.solve(progress=show)
    if not propose:
        assert out is not None
        return _loop(seat, out, preview=preview, json=json)
    return _propose(seat, out, 3 if count is None else count, preview=preview, json=json)


def _propose(seat: Seat, out: Path | None, count: int, *, preview: bool, json: bool) -> int:
    """Say what one adjoint says."""
    from seatlook.chain.run_folder import run_folder
    from seatlook.improvement.corrected import WRITTEN, rows_of, write_corrected

    with progress() as show:
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


def _loop(seat: Seat, out: Path, *, preview: bool, json: bool) -> int:
    """Improve until it ends, prove it, and write all of it."""
    from seatlook.chain.run_folder import run_folder
    from seatlook.improvement.corrected import WRITTEN_BY_LOOP
    from seatlook.report.improvement_page import PAGE, PICTURES
    from seatlook.report.pattern_drawing import CHANGES_PNG, CHANGES_SVG

    steps: list[Iteration] = []
    files = (*WRITTEN_BY_LOOP, CHANGES_SVG, CHANGES_PNG, *PICTURES, PAGE)
    with run_folder(out, writes=files), progress() as show:
        show("improve")
        for step in seat.improve():
            steps.append(step)
            note(f"{step.number}: {step.value.total:.4f}  {step.ended or step.sentence}")
            show("improve", objective=step.value.total)
        proof = seat.prove(step, progress=show) if step.made else None
        if proof is not None:
            _write(seat, steps, proof, out)
    if json:
        show_json(_summary(seat, steps, proof))
    else:
        print_rows([{"correction": row["sentence"]} for row in _rows(seat, step)])
    if proof is not None:
        say(proof.sentence, *proof.missed)
        note(f"written into {out}: {', '.join(files)}")
    else:
        say("nothing was changed, and nothing is written")
    say(*filter(None, [step.limit]))
    if exit_code_of(seat.resolution, preview=preview) or (proof and proof.unsolved):
        return 3
    if proof is None:
        return 0 if step.good and all(v.kept for v in seat.assessment.verdicts(seat.scene)) else 1
    return 0 if proof.better and not proof.missed else 1


def _rows(seat: Seat, step: Iteration) -> list[dict[str, object]]:
    from seatlook.improvement.changes import Changes
    from seatlook.improvement.corrected import rows_made

    return rows_made(Changes(seat.solution, seat.scene.pattern), step.made, step.chosen)


def _summary(seat: Seat, steps: Sequence[Iteration], proof: Proof | None) -> dict[str, object]:
    """All that was found, for --json."""
    from seatlook.improvement.corrected import course_rows, proof_rows

    return {
        "corrections": _rows(seat, steps[-1]),
        "course": course_rows(steps),
        "limit": steps[-1].limit,
        "better": proof is not None and proof.better,
        "proof": [] if proof is None else proof_rows(proof),
        "sentence": "nothing was changed" if proof is None else proof.sentence,
        "missed": [] if proof is None else list(proof.missed),
    }


def _write(seat: Seat, steps: Sequence[Iteration], proof: Proof, out: Path) -> None:
    """Write pattern, tables, drawing and page."""
    from seatlook.improvement.changes import Changes
    from seatlook.improvement.corrected import length_rows, write_improved
    from seatlook.report.improvement_page import Corrected, write_improvement_page
    from seatlook.report.pattern_drawing import draw_changes

    changes = Changes(seat.solution, seat.scene.pattern)
    write_improved(changes, steps, proof, out)
    after, rows = changes.pattern(steps[-1].made), _rows(seat, steps[-1])
    draw_changes(seat.scene.pattern, after, _by_panel(changes, rows), out)
    assert proof.corrected is not None
    found = Corrected(
        name=seat.scene.name,
        seats=(seat.assessment, proof.corrected),
        steps=steps,
        proof=proof,
        corrections=rows,
        lengths=length_rows(seat.scene.pattern, after),
    )
    write_improvement_page(found, out, camera=seat.camera(None), rig=seat.rig(None))


def _by_panel(changes: Changes, rows: Sequence[Mapping[str, object]]) -> dict[str, list[str]]:
    """Sentences for every panel whose edges are changed."""
    words: dict[str, list[str]] = {}
    for row in rows:
        edge = changes.drawn.edges.get(str(row["names"]))
        if edge is not None:
            words.setdefault(edge.panel, []).append(str(row["sentence"]))
    return words
