"""The journal of a folder: every change is in it, and on the disk, before it is acknowledged.

A line is one change: which files, what they held before and hold after it. A server that was killed
between journal and files makes the last change again when it starts; what was changed outside since
then is left as it is.
"""

from __future__ import annotations

import base64
import json
import os
import zlib
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

from seatlook.studio.keeping.durable import prepared, put_in_place, sync_folder

Files = Mapping[str, bytes | None]  # name -> content, None where there is no file
_MOST_BYTES = 4 * 2**20  # of a journal; beyond, only the last changes are kept
_KEPT = 100


@dataclass(frozen=True, slots=True, kw_only=True)
class Change:
    """One change.

    Parameters
    ----------
    kind : whether it was made, taken back, or made again
    what : in words
    before, after : contents of the files that it changed
    """

    kind: Literal["edit", "undo", "redo"]
    what: str
    before: Files
    after: Files


class Journal:
    """Changes of a folder, oldest first.

    Parameters
    ----------
    path : of the file; read if it is there
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        self.changes: list[Change] = []
        self.done = True  # whether the last change reached its files
        self._read()

    def append(self, change: Change) -> None:
        """Write a change down.

        Raises
        ------
        OSError
            It could not be written; then the journal is as before.
        """
        self._write(json.dumps(_row(change)))
        self.changes.append(change)
        del self.changes[:-_KEPT]
        self.done = False

    def finish(self) -> None:
        """Note that the last change reached its files."""
        self.done = True
        # On a disk that is full by now it is only read once more at the next start.
        with suppress(OSError):
            self._write("{}")

    def withdraw(self) -> None:
        """Take back the last change, which did not reach its files."""
        lines = self._path.read_bytes().splitlines(keepends=True)
        with self._path.open("rb+") as stream:
            stream.truncate(sum(map(len, lines[:-1])))
            os.fsync(stream.fileno())
        self.changes.pop()
        self.done = True

    def _write(self, text: str) -> None:
        self._path.parent.mkdir(parents=True, exist_ok=True)
        new = not self._path.exists()
        handle = os.open(self._path, os.O_WRONLY | os.O_CREAT | os.O_APPEND, 0o666)
        length, left = os.fstat(handle).st_size, text.encode() + b"\n"
        try:
            while left:
                left = left[os.write(handle, left) :]
            os.fsync(handle)
        except OSError:
            os.ftruncate(handle, length)
            raise
        finally:
            os.close(handle)
        if new:
            sync_folder(self._path.parent)

    def _read(self) -> None:
        if not self._path.exists():
            return
        content = self._path.read_bytes()
        whole = content[: content.rfind(b"\n") + 1]
        for line in whole.splitlines():
            try:
                row = json.loads(line)
                change = _change(row) if row else None
            except (ValueError, KeyError, TypeError, zlib.error):
                continue  # a line of another version; the files are what counts
            self.done = change is None
            if change is not None:
                self.changes.append(change)
        if len(whole) < len(content):
            # A line that was cut short was never acknowledged.
            with self._path.open("rb+") as stream:
                stream.truncate(len(whole))
        if len(content) > _MOST_BYTES and self.done:
            self._shorten()

    def _shorten(self) -> None:
        self.changes = self.changes[-_KEPT:]
        rows = [json.dumps(_row(change)) for change in self.changes] + ["{}"]
        whole: Mapping[Path, bytes | None] = {self._path: "".join(f"{r}\n" for r in rows).encode()}
        with prepared(whole, self._path.parent) as ready:
            put_in_place(whole, ready)


def _row(change: Change) -> dict[str, Any]:
    return {
        "kind": change.kind,
        "what": change.what,
        "before": {name: _packed(content) for name, content in change.before.items()},
        "after": {name: _packed(content) for name, content in change.after.items()},
    }


def _change(row: Mapping[str, Any]) -> Change:
    return Change(
        kind=row["kind"],
        what=row["what"],
        before={name: _unpacked(text) for name, text in row["before"].items()},
        after={name: _unpacked(text) for name, text in row["after"].items()},
    )


def _packed(content: bytes | None) -> str | None:
    return None if content is None else base64.b64encode(zlib.compress(content, 9)).decode()


def _unpacked(text: str | None) -> bytes | None:
    return None if text is None else zlib.decompress(base64.b64decode(text))
