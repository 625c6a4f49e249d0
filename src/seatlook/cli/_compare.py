"""The command that puts variants side by side."""

from __future__ import annotations

from pathlib import Path
from types import MappingProxyType
from typing import Annotated

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
from seatlook.cli._output import Json, note, progress, table
from seatlook.errors import InputError


def compare(
    scenes: Annotated[tuple[Path, ...], Parameter(help="Scene files (TOML), two or more.")],
    /,
    *,
    out: Out,
    result: Annotated[tuple[str, ...], Parameter(negative=())] = (),
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
    """
    from seatlook.comparison.compare import variant_names
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
    with progress() as show:
        outcome = compare_into(
            dict(zip(names, seats, strict=True)), out, results=_results(result, names),
            score=score, single_file=single_file, progress=show,
        )  # fmt: skip
    differences = outcome.comparison.table()
    table(differences.heads, differences.rows, json=json)
    note(f"gallery: {outcome.page}")
    found = outcome.resolutions
    return exit_code_of(*found.values(), names=tuple(found), preview=preview)


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
