"""What commands write: tables and JSON on stdout, progress and sentences on stderr."""

from __future__ import annotations

import json as json_module
import os
import sys
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from typing import Annotated, Any, Protocol

from cyclopts import Parameter

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
    """Show a bar with the time left on stderr; nothing where nobody watches or with ``--quiet``."""
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        Progress,
        TextColumn,
        TimeElapsedColumn,
        TimeRemainingColumn,
    )

    console = Console(stderr=True)
    with Progress(
        TextColumn("{task.description}"),
        BarColumn(bar_width=24),
        TimeElapsedColumn(),
        TextColumn("left"),
        TimeRemainingColumn(),
        TextColumn("{task.fields[figures]}"),
        console=console,
        disable=manner.quiet or not console.is_terminal,
        transient=True,
    ) as bar:
        task = bar.add_task("", total=None, figures="")

        def show(name: str, /, **figures: float | str) -> None:
            words = [name, *(v for v in figures.values() if isinstance(v, str))]
            numbers = {k: v for k, v in figures.items() if not isinstance(v, str)}
            bar.update(
                task,
                description=" ".join(words),
                completed=numbers.pop("step", 0),
                total=numbers.pop("steps", None),
                figures="  ".join(f"{k} {v:.2g}" for k, v in numbers.items()),
            )

        yield show


def _text(cell: Any) -> str:
    if cell is None:
        return "-"
    return f"{cell:.4g}" if isinstance(cell, float) else str(cell)
