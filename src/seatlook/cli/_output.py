"""What commands write: tables and JSON on stdout, progress and sentences on stderr."""

from __future__ import annotations

import json as json_module
import os
import sys
import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from threading import Event, Thread
from typing import Annotated, Any, Protocol

from cyclopts import Parameter

EVERY = 60.0  # [s] between two lines of a log
Json = Annotated[bool, Parameter(name="--json", negative=(), help="Print JSON, not a table.")]


class Say(Protocol):
    """Tell how far a step is; figures of a step that can be counted are ``step`` and ``steps``."""

    def __call__(self, name: str, /, **figures: float | str) -> None: ...


def table(heads: Sequence[str], rows: Iterable[Sequence[Any]], *, json: bool) -> None:
    """Print rows on stdout: aligned text, or a JSON list of objects.

    A table of ("what", "value") is one JSON object.
    """
    rows = list(rows)
    if json:
        pairs = tuple(heads) == ("what", "value")
        objects = [dict(zip(heads, row, strict=True)) for row in rows]
        data = {row[0]: row[1] for row in rows} if pairs else objects
        show_json(data)
        return
    cells = [list(heads), *([_text(cell) for cell in row] for row in rows)]
    widths = [max(len(row[k]) for row in cells) for k in range(len(heads))]
    lines = [
        "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()
        for row in cells
    ]
    write("\n".join(lines) + "\n")


def print_rows(rows: Sequence[Mapping[str, Any]]) -> None:
    """Print a further table, after an empty line; nothing where there is none."""
    if rows:
        write("\n")
        table(tuple(rows[0]), [tuple(row.values()) for row in rows], json=False)


def show_json(data: Any) -> None:
    """Write data that is no single table to stdout."""
    write(json_module.dumps(data, indent=1) + "\n")


def write(text: str) -> None:
    """Write data to stdout; nothing more once its reader has gone, as behind ``| head``.

    Raises
    ------
    OSError
        It cannot be written, because the disk is full.
    """
    try:
        sys.stdout.write(text)
        sys.stdout.flush()
    except BrokenPipeError:
        drop_output()
    except OSError as error:
        drop_output()
        raise OSError(error.errno, error.strerror, "stdout") from error


def drop_output() -> None:
    """Write nothing to stdout any more, nor what is left in its buffer at the end."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, sys.stdout.fileno())
    os.close(nowhere)


@dataclass
class Manner:
    """How much is said; ``--quiet`` leaves data on stdout and what went wrong on stderr."""

    quiet: bool = False


manner = Manner()


def note(*lines: str) -> None:
    """Write lines to stderr that nobody misses; nothing with ``--quiet``."""
    if not manner.quiet:
        say(*lines)


def say(*lines: str) -> None:
    """Write lines to stderr that must be read."""
    with suppress(BrokenPipeError):
        for line in lines:
            sys.stderr.write(line.rstrip() + "\n")


@contextmanager
def progress() -> Iterator[Say]:
    """Say on stderr how far the work is: a bar to who watches, a line a minute to files and pipes.

    Nothing with ``--quiet``.
    """
    if manner.quiet:
        yield _unsaid
        return
    with _bar() if sys.stderr and sys.stderr.isatty() else _lines() as show:
        yield show


def _unsaid(name: str, /, **figures: float | str) -> None:
    """Say nothing."""


@contextmanager
def _lines() -> Iterator[Say]:
    """Write where the work is once a minute, however long one step takes."""
    begun, last, over = time.monotonic(), _Step("start", "", 0.0, None), Event()

    def show(name: str, /, **figures: float | str) -> None:
        nonlocal last
        last = _Step.of(name, figures)

    def write_on() -> None:
        while not over.wait(EVERY):
            passed = time.monotonic() - begun
            say(f"{passed / 60:.0f} min: {last.sentence}")

    # A daemon: a command that ends by an error does not wait for it.
    writer = Thread(target=write_on, daemon=True)
    writer.start()
    try:
        yield show
    finally:
        over.set()
        writer.join()


@contextmanager
def _bar() -> Iterator[Say]:
    """Show a bar with the time left."""
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        Progress,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )

    with Progress(
        TextColumn("{task.description}"),
        BarColumn(bar_width=24),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
        TextColumn("{task.fields[figures]}"),
        console=Console(stderr=True),
        transient=True,
    ) as bar:
        task = bar.add_task("", total=None, figures="")

        def show(name: str, /, **figures: float | str) -> None:
            step = _Step.of(name, figures)
            bar.update(
                task,
                description=step.name,
                completed=step.done,
                total=step.steps,
                figures=step.figures,
            )

        yield show


@dataclass(frozen=True, slots=True)
class _Step:
    """What the work is at: its name, further figures as text, and how much of it is done."""

    name: str
    figures: str
    done: float
    steps: float | None

    @staticmethod
    def of(name: str, figures: Mapping[str, float | str]) -> _Step:
        words = [name, *(v for v in figures.values() if isinstance(v, str))]
        numbers = {k: v for k, v in figures.items() if not isinstance(v, str)}
        done, steps = numbers.pop("step", 0), numbers.pop("steps", None)
        return _Step(
            " ".join(words), "  ".join(f"{k} {v:.2g}" for k, v in numbers.items()), done, steps
        )

    @property
    def sentence(self) -> str:
        """The same for a reader of a log."""
        of = "" if self.steps is None else f"{self.done:g} of {self.steps:g} done"
        return ", ".join(filter(None, (self.name, of, self.figures)))


def _text(cell: Any) -> str:
    if cell is None:
        return "-"
    return f"{cell:.4g}" if isinstance(cell, float) else str(cell)
