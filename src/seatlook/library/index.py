"""The index of a library: what was read of entries whose files have not changed since.

It only saves time. Where it is gone, broken or of other files, the files are read again.
"""

from __future__ import annotations

import contextlib
import json
from collections.abc import Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

from seatlook.errors import InputError
from seatlook.files import read_text, state_of, write_text
from seatlook.library.entry import FILES, FORMAT, SHEET, Entry, Part, file_names_below, inside

INDEX = ".index.json"
_LARGEST = 256 * 2**20  # bytes

Known = Mapping[str, Any]


def read_index(root: Path) -> dict[str, Known]:
    """Place -> what the index holds of it; nothing where it cannot be read."""
    try:
        data = json.loads(read_text(root / INDEX, at_most=_LARGEST))
        known = data["entries"] if data["format"] == FORMAT else {}
    except (InputError, ValueError, TypeError, KeyError, RecursionError):
        return {}
    return known if isinstance(known, dict) else {}


def write_index(root: Path, known: Mapping[str, Known]) -> None:
    """Leave the index for the next reader, where the folder may be written."""
    with contextlib.suppress(OSError):
        write_text(root / INDEX, json.dumps({"format": FORMAT, "entries": dict(known)}))


def signature(root: Path, place: str) -> list[Any]:
    """What tells that files of an entry were changed: their names, sizes and times.

    Raises
    ------
    InputError
        A link leads out of the library, or there are too many files.
    """
    folder = root / place
    inside(folder / SHEET, root)
    names = [f"{FILES}/{name}" for name in file_names_below(folder / FILES, root)]
    found: list[Any] = [[name, *(state_of(folder / name) or ())] for name in (SHEET, *names)]
    # A picture may be taken away from beside an entry.
    return [*found, sorted(path.name for path in folder.iterdir())]


def known_entry(known: Known | None, now: list[Any]) -> Entry | None:
    """The entry as the index has it, if its files are the same as then."""
    try:
        if known is None or known["signature"] != now:
            return None
        row = dict(known["entry"])
        parts = tuple(Part(**part) for part in row.pop("parts"))
        for name in ("files", "words"):
            row[name] = tuple(row[name])
        return Entry(**row, parts=parts)
    except (KeyError, TypeError, ValueError):
        return None


def indexed(entry: Entry, now: list[Any]) -> Known:
    """What the index is to hold of an entry."""
    return {"signature": now, "entry": asdict(entry)}
