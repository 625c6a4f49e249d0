"""Take an entry out of a library into a folder, which then needs the library no more."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from seatlook.errors import InputError, Problem
from seatlook.files import read_file, write_bytes
from seatlook.library.entry import FILES, Entry, content_digest
from seatlook.library.library import Library


def contents(library: Library, entry: Entry) -> Mapping[str, bytes]:
    """Files of an entry, by the names that they have in a folder.

    Raises
    ------
    InputError
        A file was changed since the entry was read.
    """
    folder = library.root / entry.place / FILES
    found = {name: read_file(folder / name) for name in entry.files}
    if content_digest(found) != entry.digest:
        raise InputError.single(
            "entry", got="files that changed meanwhile", expected="files that stay",
            file=library.root / entry.place, hint="try again",
        )  # fmt: skip
    return found


def take(library: Library, entry: Entry, out: Path, *, force: bool = False) -> tuple[Path, ...]:
    """Copy the files of an entry into a folder, the main one last.

    Raises
    ------
    InputError
        Other files with these names are there, and ``force`` is not set; nothing is written.
    """
    found = contents(library, entry)
    names = sorted(found, key=lambda name: name == entry.main)
    paths = {out / name: found[name] for name in names}
    others = [
        Problem(
            key="--out", got="another file of this name", expected="an empty place", file=path,
            hint="take --force to replace it",
        )
        for path, content in paths.items()
        if path.exists() and not force and (path.is_dir() or read_file(path) != content)
    ]  # fmt: skip
    if others:
        raise InputError(others)
    for path, content in paths.items():
        write_bytes(path, content)
    return tuple(paths)
