"""The command that goes through many cells."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from seatlook.cli._options import DryRun, Out, Preview
from seatlook.cli._output import Json, note, print_rows, progress, say, show_json, table


def sweep(
    spec: Annotated[Path, Parameter(help="Sweep file (TOML).")],
    /,
    *,
    out: Out,
    workers: int = 1,
    shard: str = "1/1",
    scheduler: str | None = None,
    dry_run: DryRun = False,
    preview: Preview = False,
    json: Json = False,
) -> int:
    """Go through materials, patterns, seeds, tolerances; finished cells are not done again.

    Each cell is solved, judged and drawn on its own and kept under a name that stands for its
    content, so a sweep that was stopped goes on where it was. Leaves cells/, sweep.csv and, where
    the file has [irregularity], inputs.csv and map and table of the probability that W2 is above
    1. Ends with 3 if a cell failed, or is not converged or not resolved, and lists those.

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
    from seatlook.sweeps.summary import at_rest
    from seatlook.sweeps.sweep import list_cells
    from seatlook.sweeps.sweep import sweep as run_sweep

    if dry_run:
        cells = list_cells(spec, out, shard=shard)
        table(cells.heads, cells.rows, json=json)
        return 0
    with progress() as show:
        outcome = run_sweep(
            spec, out, workers=workers, shard=shard, scheduler=scheduler, progress=show
        )
    if json:
        show_json({"cells": outcome.rows, "probability": outcome.probability})
    elif outcome.rows:
        table(outcome.table.heads, outcome.table.rows, json=False)
        print_rows(outcome.probability)
    note(*outcome.findings)
    say(*outcome.notices, *filter(None, [outcome.wanting]))
    wanting = [row for row in outcome.unresolved if not (preview and at_rest(row))]
    return 3 if outcome.failed or wanting else 0
