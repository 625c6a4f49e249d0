"""The command that puts variants side by side."""

from __future__ import annotations

from pathlib import Path
from types import MappingProxyType
from typing import Annotated

from cyclopts import Parameter

from seatlook.cli._output import Json, note, progress, say, table
from seatlook.cli._run import Changes, DryRun, Out, Scored, SingleFile, load
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
    from seatlook.comparison.compare import compare as run_compare
    from seatlook.comparison.compare import variant_names
    from seatlook.pbr import offscreen_backend
    from seatlook.report.comparison_page import write_comparison

    if len(scenes) < 2:
        raise InputError.single("scenes", got=len(scenes), expected="two or more")
    read = [load(path, changes=changes) for path in scenes]
    names = variant_names(read)
    if dry_run:
        cells = [
            (name, texture, rig.name)
            for name in names
            for texture in read[0].textures
            for rig in read[0].rigs
        ]
        table(("variant", "texture", "rig"), cells, json=json)
        return 0
    offscreen_backend()
    with progress() as show:
        comparison = run_compare(read, results=_results(result, names), keep=out, progress=show)
        scores = comparison.visibility(show) if score else None
        page = write_comparison(
            comparison, out, scores=scores, single_file=single_file, progress=show
        )
    found = comparison.table()
    table(found.heads, found.rows, json=json)
    note(f"gallery: {page}")
    bad = [v for v in comparison.variants.values() if v.solution.status != "converged"]
    say(*(f"{v.name}: not converged: {v.solution.reason}" for v in bad))
    return 3 if bad else 0


def _results(words: tuple[str, ...], names: tuple[str, ...]) -> MappingProxyType[str, Path]:
    """Read NAME=RESULT.npz."""
    found = {}
    for word in words:
        name, equals, path = word.rpartition("=")
        if not equals or name not in names:
            raise InputError.single(
                "--result", got=repr(word), expected=f"NAME=RESULT.npz, NAME of {', '.join(names)}"
            )
        found[name] = Path(path)
    return MappingProxyType(found)
