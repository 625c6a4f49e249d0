"""A sweep from its file to its tables: cells are solved, then what they say is summed up."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType
from typing import Any, TypedDict, Unpack

from seatlook.errors import InputError
from seatlook.io import write_table
from seatlook.io.sweep import read_sweep
from seatlook.model.progress import Progress, silent
from seatlook.model.table import Table
from seatlook.sweeps.cell import Cell, finished, plan
from seatlook.sweeps.probability import chance, draw_chance
from seatlook.sweeps.run import run_cluster, run_local, shard_of, unfinished
from seatlook.sweeps.summary import FEWEST, Cause, causes, groups, rows

CELLS = "cells"  # folder of the cells, below that of the sweep
Row = dict[str, Any]


class SweepChoices(TypedDict, total=False):
    """How the cells of a sweep are run.

    ``workers``: processes of this machine, one thread each; ``shard``: ``"i/n"``, only every n-th
    cell from the i-th, so that several machines share a folder; ``scheduler``: address of a Dask
    scheduler whose workers run the cells instead; ``progress``: called after every cell.
    """

    workers: int
    shard: str
    scheduler: str | None
    progress: Progress


@dataclass(frozen=True, slots=True, kw_only=True)
class Irregular:
    """What irregular covers of one variant say.

    Parameters
    ----------
    zones : probability that W2 is above 1, one row per zone; none without a converged cover
    causes : inputs with their rank correlations, the strongest first; none from too few covers
    findings : sentences about the causes; notices : sentences about covers that do not count
    """

    zones: tuple[Row, ...] = ()
    causes: tuple[Cause, ...] = ()
    findings: tuple[str, ...] = ()
    notices: tuple[str, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class SweepOutcome:
    """What a sweep left.

    Parameters
    ----------
    cells : all cells of the sweep file
    done_before, done : how many cells earlier runs and this run finished
    failed : cells of this run that ended in an error, with the error
    rows : settings, status and means of every finished cell, as in ``sweep.csv``
    irregular : variant -> what its irregular covers say; empty without [irregularity]
    """

    cells: tuple[Cell, ...]
    done_before: int
    done: int
    failed: tuple[tuple[Cell, str], ...]
    rows: tuple[Row, ...]
    irregular: Mapping[str, Irregular]

    @property
    def table(self) -> Table:
        """The rows with the columns of all of them."""
        return _table(self.rows)

    @property
    def unresolved(self) -> tuple[Row, ...]:
        """Rows of cells that are not resolved by their mesh, or not even converged."""
        return tuple(row for row in self.rows if row["status"] != "resolved")

    @property
    def wanting(self) -> str:
        """How many cells are not resolved, and why the first is not; "" where all are."""
        if not self.unresolved:
            return ""
        first = self.unresolved[0]
        return (
            f"{len(self.unresolved)} of {len(self.rows)} cells are not resolved; the reasons "
            f"are in sweep.csv. {first['cell']} is {first['status']}: {first['reason']}"
        )

    @property
    def probability(self) -> tuple[Row, ...]:
        """Zones of all variants with the probability that W2 is above 1."""
        return tuple(
            {"of": name, **zone} for name, part in self.irregular.items() for zone in part.zones
        )

    @property
    def findings(self) -> tuple[str, ...]:
        """Sentences about what was done, and which input matters."""
        return (
            f"{self.done_before} done before, {self.done} done now",
            *(sentence for part in self.irregular.values() for sentence in part.findings),
        )

    @property
    def notices(self) -> tuple[str, ...]:
        """Sentences that must be read: covers that do not count, cells that failed."""
        return (
            *(sentence for part in self.irregular.values() for sentence in part.notices),
            *(f"failed: {cell.name} ({cell.label}): {error}" for cell, error in self.failed),
        )


def sweep(spec: Path | str, out: Path | str, **choices: Unpack[SweepChoices]) -> SweepOutcome:
    """Solve, assess and draw every cell of a sweep file that is not done yet, and sum up all.

    Leaves ``cells/`` and ``sweep.csv`` and, with [irregularity], ``probability.png``,
    ``probability.csv`` and ``inputs.csv``. A sweep that was stopped goes on where it was.

    Cells run in processes of their own: a script calls this below ``if __name__ == "__main__":``.

    Raises
    ------
    InputError
        Faults of the sweep file or of a scene, found before the first cell is run; a choice that
        cannot be met. A cell that fails raises nothing, see ``SweepOutcome.failed``.

    Examples
    --------
    >>> outcome = sweep("sweep.toml", "out/sweep", workers=2)        # doctest: +SKIP
    >>> [row["w2_mean"] for row in outcome.rows]                     # doctest: +SKIP
    """
    folder, scheduler = Path(out), choices.get("scheduler")
    workers, progress = choices.get("workers", 1), choices.get("progress", silent)
    if scheduler is not None and workers != 1:
        raise InputError.single("workers", got=workers, expected="none with a scheduler")
    cells = plan(read_sweep(Path(spec)))
    before = len(cells) - len(unfinished(cells, folder / CELLS))
    waiting = unfinished(shard_of(cells, choices.get("shard", "1/1")), folder / CELLS)
    run = (
        run_local(waiting, folder / CELLS, workers=workers)
        if scheduler is None
        else run_cluster(waiting, folder / CELLS, scheduler=scheduler)
    )
    failed = tuple(_failures(run, len(waiting), progress))
    outcome = SweepOutcome(
        cells=cells,
        done_before=before,
        done=len(waiting) - len(failed),
        failed=failed,
        rows=tuple(rows(cells, folder / CELLS)),
        irregular=MappingProxyType({}),
    )
    return _summed_up(outcome, folder) if outcome.rows else outcome


def list_cells(spec: Path | str, out: Path | str, *, shard: str = "1/1") -> Table:
    """List the cells of a sweep file with their state: done, to do, or of another shard.

    Raises
    ------
    InputError
        Faults of the sweep file or of a scene.
    """
    cells = plan(read_sweep(Path(spec)))
    own = {cell.name for cell in shard_of(cells, shard)}

    def state(cell: Cell) -> str:
        if finished(cell, Path(out) / CELLS):
            return "done"
        return "to do" if cell.name in own else "of another shard"

    return Table(
        heads=("cell", "state", "of"),
        rows=tuple((cell.name, state(cell), cell.label) for cell in cells),
    )


def _failures(
    run: Iterator[tuple[Cell, str]], count: int, progress: Progress
) -> Iterator[tuple[Cell, str]]:
    """Go through a run; yield cells that failed, with their errors."""
    failed = 0
    progress("cells", step=0, steps=max(count, 1))
    for number, (cell, error) in enumerate(run, 1):
        if error:
            failed += 1
            yield cell, error
        progress("cells", step=number, steps=count, failed=failed)


def _summed_up(outcome: SweepOutcome, folder: Path) -> SweepOutcome:
    """Write the tables of all finished cells."""
    write_table(folder / "sweep.csv", outcome.table.heads, outcome.table.rows)
    return replace(
        outcome,
        irregular=MappingProxyType(
            {
                name: _irregular(name, cells, folder, f"-{number}" if number else "")
                for number, (name, cells) in enumerate(groups(outcome.cells).items())
            }
        ),
    )


def _irregular(name: str, cells: Sequence[Cell], folder: Path, ending: str) -> Irregular:
    """Write map and table of the probability of wrinkles, and the table of its causes."""
    try:
        chances = chance(cells, folder / CELLS)
    except InputError as error:
        return Irregular(notices=(f"{name}: {error}",))
    zones = tuple(draw_chance(cells, chances, folder / f"probability{ending}.png"))
    table = _table(zones)
    write_table(folder / f"probability{ending}.csv", table.heads, table.rows)
    part = Irregular(zones=zones)
    if chances.left_out:
        notice = (
            f"{name}: {chances.left_out} of {chances.covers} covers are left out of the "
            "probability, because they did not converge; they are often the most wrinkled. What "
            f"they could change stands beside it in probability{ending}.csv"
        )
        part = replace(part, notices=(notice,))
    if chances.converged < FEWEST:
        notice = f"{name}: {chances.converged} covers are too few to tell which input matters"
        return replace(part, notices=(*part.notices, notice))
    ranked = causes(cells, folder / CELLS)
    write_table(
        folder / f"inputs{ending}.csv",
        ["input", "rank_correlation", "rank_correlation_of_size", "noise"],
        [[c.input, c.correlation, c.of_size, c.noise] for c in ranked],
    )
    finding = (
        f"{name}: {chances.converged} of {chances.covers} covers converged; {ranked[0].sentence}"
    )
    return replace(part, causes=ranked, findings=(finding,))


def _table(records: Sequence[Row]) -> Table:
    """Rows with the columns of all records; None where a record has no such column."""
    heads = tuple(dict.fromkeys(key for record in records for key in record))
    return Table(
        heads=heads, rows=tuple(tuple(record.get(head) for head in heads) for record in records)
    )
