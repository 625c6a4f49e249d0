"""The command that puts variants side by side."""

from __future__ import annotations

from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from seatlook.cli._options import (
    Changes,
    DryRun,
    Out,
    Preview,
    Scored,
    SingleFile,
    exit_code_of,
    seat_of,
)
from seatlook.cli._output import Json, note, progress, say, show_json, table, write
from seatlook.errors import InputError

if TYPE_CHECKING:
    from seatlook.chain.case import Case
    from seatlook.seat import ComparisonOutcome


def compare(
    scenes: Annotated[tuple[Path, ...], Parameter(help="Scene files (TOML), two or more.")],
    /,
    *,
    out: Out,
    result: Annotated[tuple[str, ...], Parameter(negative=())] = (),
    tolerance: float | None = None,
    changes: Changes = (),
    score: Scored = True,
    single_file: SingleFile = False,
    dry_run: DryRun = False,
    preview: Preview = False,
    json: Json = False,
) -> int:
    """Put several scenes into one gallery: same camera, exposures and ranges, differences first.

    Scenes are solved, and their results kept in the folder, so that a second run only draws.
    Camera, rigs and textures are those of the first scene.

    Example: seatlook compare fits.toml eased.toml --out out/compare

    Parameters
    ----------
    result
        NAME=RESULT.npz: take this result of the scene called NAME; may be given more than once.
    tolerance
        Solve each scene to this relative error of its zone means, such as 0.1, on a mesh that is
        fine where it wrinkles, and once more with another seed, which tells the scatter.
        Materials are compared at equal error, not at equal element size.
    """
    from seatlook.comparison.compare import at_equal_error, variant_names
    from seatlook.pbr import offscreen_backend
    from seatlook.seat import compare_into

    if len(scenes) < 2:
        raise InputError.single("scenes", got=len(scenes), expected="two or more")
    seats = [seat_of(path, changes=changes) for path in scenes]
    names = variant_names(seats)
    if dry_run:
        first = seats[0].scene
        cells = [
            (name, texture, rig.name)
            for name in names
            for texture in first.textures
            for rig in first.rigs
        ]
        table(("variant", "texture", "rig"), cells, json=json)
        return 0
    offscreen_backend()
    variants: dict[str, Case] = dict(zip(names, seats, strict=True))
    with progress() as show:
        if tolerance is not None:
            variants = at_equal_error(variants, tolerance, show)
        outcome = compare_into(
            variants, out, results=_results(result, names),
            score=score, single_file=single_file, progress=show,
        )  # fmt: skip
    _print(outcome, json=json)
    note(f"gallery: {outcome.page}")
    say(*filter(None, [outcome.comparison.unequal_error]))
    found = outcome.resolutions
    return exit_code_of(*found.values(), names=tuple(found), preview=preview)


def _print(outcome: ComparisonOutcome, *, json: bool) -> None:
    """What changed in the inputs, where it got worse, then better; the same for appearance."""
    from seatlook.comparison.changes import difference_tables, sight_changes, zone_changes
    from seatlook.model.table import Table
    from seatlook.report.sections.inputs import different_inputs

    variants, scores = outcome.comparison.variants, outcome.scores
    tables = {
        "What changed": different_inputs({n: case.scene for n, case in variants.items()})
    } | difference_tables(
        outcome.comparison,
        zone_changes(outcome.comparison),
        sight_changes(scores) if scores else (),
    )
    tables["W2 by"] = Table(
        heads=("variant", "criterion"),
        rows=tuple((name, case.assessment.criteria.words()) for name, case in variants.items()),
    )
    if json:
        show_json(
            {
                name: [dict(zip(part.heads, row, strict=True)) for row in part.rows]
                for name, part in tables.items()
            }
        )
        return
    for name, part in tables.items():
        write(f"{name}{'' if part.rows else ': none'}\n")
        if part.rows:
            table(part.heads, part.rows, json=False)
        write("\n")


def _results(words: tuple[str, ...], names: tuple[str, ...]) -> MappingProxyType[str, Path]:
    """Read NAME=RESULT.npz."""
    paths = {}
    for word in words:
        name, equals, path = word.rpartition("=")
        if not equals or name not in names:
            raise InputError.single(
                "--result", got=repr(word), expected=f"NAME=RESULT.npz, NAME of {', '.join(names)}"
            )
        paths[name] = Path(path)
    return MappingProxyType(paths)
