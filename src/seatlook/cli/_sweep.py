"""The command that goes through many cells."""

from __future__ import annotations

import sys
from collections import defaultdict
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from seatlook.cli._options import DryRun, Out
from seatlook.cli._output import Json, note, progress, say, show_json, table
from seatlook.errors import InputError

if TYPE_CHECKING:
    from seatlook.sweeps.cell import Cell


def sweep(
    spec: Annotated[Path, Parameter(help="Sweep file (TOML).")],
    /,
    *,
    out: Out,
    workers: int = 1,
    shard: str = "1/1",
    scheduler: str | None = None,
    dry_run: DryRun = False,
    json: Json = False,
) -> int:
    """Go through materials, patterns, seeds, tolerances; finished cells are not done again.

    Each cell is solved, judged and drawn on its own and kept under a name that stands for its
    content, so a sweep that was stopped goes on where it was. Leaves cells/, sweep.csv and, where
    the file has [irregularity], inputs.csv and map and table of the probability that W2 is above
    1. Ends with 3 if a cell failed, and lists those.

    Example: seatlook sweep sweep.toml --out out/sweep --workers 2

    Parameters
    ----------
    workers
        Processes of this machine, one thread each.
    shard
        i/n: do only every n-th cell, from the i-th; several machines share a folder.
    scheduler
        Address of a Dask scheduler whose workers do the cells; needs the extra
        seatlook[cluster].
    """
    from seatlook.io.sweep import read_sweep
    from seatlook.sweeps import cell as study
    from seatlook.sweeps import run as runs

    planned = study.plan(read_sweep(spec))
    folder = out / "cells"
    left = runs.unfinished(runs.shard(planned, shard), folder)
    if dry_run:
        waiting = {cell.name for cell in left}
        table(
            ("cell", "state", "of"),
            [(c.name, "to do" if c.name in waiting else "done", _words(c)) for c in planned],
            json=json,
        )
        return 0
    if scheduler is not None and workers != 1:
        raise InputError.single("--workers", got=workers, expected="none with --scheduler")
    run = (
        runs.run_local(left, folder, workers=workers)
        if scheduler is None
        else runs.run_cluster(left, folder, scheduler=scheduler)
    )
    failed = _watch(run, len(left))
    note(f"{len(planned) - len(left)} done before, {len(left) - len(failed)} done now")
    if len(runs.unfinished(planned, folder)) < len(planned):
        _summarise(planned, out, json=json)
    say(*(f"failed: {cell.name} ({_words(cell)}): {what}" for cell, what in failed))
    return 3 if failed else 0


def _watch(run: Iterator[tuple[Cell, str]], count: int) -> list[tuple[Cell, str]]:
    """Show how many cells are done; return those that failed."""
    failed = []
    with progress() as show:
        show("cells", step=0, steps=max(count, 1))
        for number, (cell, what) in enumerate(run, 1):
            if what:
                failed.append((cell, what))
            show("cells", step=number, steps=count, failed=len(failed))
    return failed


def _summarise(cells: Sequence[Cell], out: Path, *, json: bool) -> None:
    from seatlook.io import write_table
    from seatlook.sweeps import summary

    rows = summary.rows(cells, out / "cells")
    heads = list(dict.fromkeys(key for row in rows for key in row))
    columns = [[row.get(head) for head in heads] for row in rows]
    write_table(out / "sweep.csv", heads, columns)
    chances = [
        {"of": words, **row}
        for number, (words, group) in enumerate(_groups(cells).items())
        for row in _irregular(words, group, out, f"-{number}" if number else "")
    ]
    if json:
        show_json({"cells": rows, "probability": chances})
        return
    table(heads, columns, json=False)
    if chances:
        sys.stdout.write("\n")
        table(list(chances[0]), [list(row.values()) for row in chances], json=False)


def _irregular(
    words: str, cells: Sequence[Cell], out: Path, ending: str
) -> list[dict[str, str | int | float]]:
    """Leave the probability of wrinkles and its causes; return its zones, and say what counts."""
    from seatlook.io import write_table
    from seatlook.sweeps import summary
    from seatlook.sweeps.probability import chance, draw_chance

    try:
        chances = chance(cells, out / "cells")
    except InputError as error:
        say(f"{words}: {error}")
        return []
    zones = draw_chance(cells, chances, out / f"probability{ending}.png")
    write_table(
        out / f"probability{ending}.csv", list(zones[0]), [list(row.values()) for row in zones]
    )
    if chances.left_out:
        say(
            f"{words}: {chances.left_out} of {chances.covers} covers are left out of the "
            "probability, because they did not converge; they are often the most wrinkled. What "
            "they could "
            f"change stands beside it in probability{ending}.csv"
        )
    if chances.converged < summary.FEWEST:
        say(f"{words}: {chances.converged} covers are too few to tell which input matters")
        return zones
    causes = summary.causes(cells, out / "cells")
    write_table(
        out / f"inputs{ending}.csv",
        ["input", "rank_correlation", "rank_correlation_of_size", "noise"],
        [[c.input, c.correlation, c.of_size, c.noise] for c in causes],
    )
    strongest = causes[0]
    rank = "matters most" if strongest.matters else "is strongest, but not above the noise"
    note(
        f"{words}: {chances.converged} of {chances.covers} covers converged; "
        f"{strongest.input} {rank} "
        f"(rank correlation {strongest.strength:.2f} in size, noise {strongest.noise:.2f})"
    )
    return zones


def _groups(cells: Sequence[Cell]) -> dict[str, list[Cell]]:
    """Cells with irregular inputs, by what else they are of."""
    groups = defaultdict(list)
    for cell in cells:
        if cell.settings["values"] is not None:
            groups[_words(cell, values=False)].append(cell)
    return groups


def _words(cell: Cell, *, values: bool = True) -> str:
    """Say what a cell is of."""
    settings = cell.settings
    words = [settings["variant"], *settings["set"]]
    if values:
        pairs = zip(settings["inputs"], settings["values"] or (), strict=False)
        words += [f"{i['name']}={value:.3g}" for i, value in pairs]
    return " ".join(word for word in words if word) or "the scene"
