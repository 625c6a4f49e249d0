"""The command that takes a scene through the whole chain, to its page."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from seatlook.cli._options import (
    Changes,
    DryRun,
    ElementSize,
    Force,
    Out,
    Preview,
    Resume,
    SceneFile,
    Scored,
    Seed,
    SingleFile,
    TolerancePercent,
    exit_code_of,
    note_coarse,
    seat_of,
)
from seatlook.cli._output import Json, note, progress, say, show_json, table

if TYPE_CHECKING:
    from collections.abc import Sequence

    from seatlook.results.resolution import Resolution
    from seatlook.seat import Seat
    from seatlook.wrinkle import ZoneRow


def evaluate(
    scene: SceneFile,
    /,
    *,
    out: Out,
    seed: Seed = None,
    element_size_mm: ElementSize = None,
    tolerance_percent: TolerancePercent = None,
    changes: Changes = (),
    resume: Resume = False,
    score: Scored = True,
    single_file: SingleFile = False,
    dry_run: DryRun = False,
    force: Force = False,
    preview: Preview = False,
    json: Json = False,
) -> int:
    """Solve a scene, assess its wrinkles, draw it, and write the gallery page.

    Leaves index.html, result.npz, zones.csv, images and maps in the folder. Ends with 1 if a
    limit of [accept] is missed, and names zone and value; with 3, which goes before, if the result
    is not converged or not resolved by its mesh.

    Example: seatlook evaluate seat.toml --out out/seat
    """
    seat = seat_of(scene, seed, element_size_mm, changes, tolerance_percent)
    if dry_run:
        return _list_cells(seat, out, json=json)
    missed = run_evaluation(
        seat, out, resume=resume, score=score, single_file=single_file, force=force, json=json
    )
    return exit_code_of(seat.resolution, preview=preview) or missed


def _list_cells(seat: Seat, out: Path, *, json: bool) -> int:
    """Print what evaluating a scene would draw; the same names as when it does."""
    from seatlook.chain.files import picture_paths
    from seatlook.pbr import ev100

    seat.check()
    exposure = {rig.name: ev100(rig) for rig in seat.scene.rigs}
    table(
        ("texture", "rig", "ev100", "image"),
        [
            (texture, rig, exposure[rig], str(out / path))
            for (texture, rig), path in picture_paths(seat.scene).items()
        ],
        json=json,
    )
    return 0


def run_evaluation(
    seat: Seat,
    out: Path,
    *,
    resume: bool,
    score: bool,
    json: bool,
    single_file: bool = False,
    force: bool = False,
) -> int:
    """Evaluate a seat, print its zones and return 1 if a limit is missed."""
    note_coarse(seat)
    with progress() as show:
        outcome = seat.evaluate(
            out, resume=resume, score=score, single_file=single_file, force=force, progress=show
        )
    print_zones(seat.assessment.zones, seat.resolution, json=json)
    note(*outcome.answer, f"gallery: {outcome.page}")
    if outcome.score and outcome.score.refused:
        say(f"no score: {outcome.score.refused}")
    say(*outcome.missed)
    return int(bool(outcome.missed))


def print_zones(zones: Sequence[ZoneRow], found: Resolution | None, *, json: bool) -> None:
    """Print the table of zones: as JSON whole, for a reader what the page shows as well."""
    from seatlook.wrinkle import INDICES

    if json and found is not None:
        rows = [row.values() | {"status": found.status, "reason": found.reason} for row in zones]
        show_json(rows)
        return
    figures = [figure for index in INDICES.values() for figure, _, _ in index.columns]
    table(
        (
            "zone",
            "area_cm2",
            *figures,
            "w2_mesh_error",
            "w2_scatter",
            "stretch_share",
            "element_size_mm",
            "criterion",
        ),
        [
            (
                row.zone,
                1e4 * row.area,
                *(row[figure] for figure in figures),
                row.w2_mesh_error,
                row.w2_scatter,
                row.stretch_share,
                1e3 * row.element_size,
                row.criterion,
            )
            for row in zones
        ],
        json=False,
    )
