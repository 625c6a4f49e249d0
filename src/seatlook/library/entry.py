"""One entry of a library: a folder with ``entry.toml``, and its files in ``files`` beside it."""

from __future__ import annotations

import hashlib
import os
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from seatlook.errors import InputError
from seatlook.files import opened
from seatlook.io.schema import Integer, Kind, Rows, Table, Text, Texts, read_table, shown
from seatlook.io.toml import Document, quoted, read_document

FORMAT = 1  # of entries and of the library around them
SHEET, FILES = "entry.toml", "files"
KINDS = ("seat", "pattern", "foam", "material", "rig", "limits", "result")
MOST_FILES = 5_000  # of one entry
_DIGEST = re.compile(r"[0-9a-f]{64}")
_PICTURES = (".png", ".jpg", ".jpeg", ".svg")
_PART: Mapping[str, Kind] = {
    "kind": Text(choices=KINDS, required=True),
    "name": Text(required=True),
    "digest": Text(required=True),
}
_KEYS: dict[str, Kind] = {
    "format": Integer(low=FORMAT, high=FORMAT, required=True),
    "kind": Text(choices=KINDS, required=True),
    "name": Text(required=True),
    "main": Text(required=True),
    "words": Texts(default=()),
    "note": Text(default=""),
    "thumbnail": Text(),
    "part": Rows(Table(_PART)),
}


@dataclass(frozen=True, slots=True)
class Part:
    """Another entry that one was made of, by kind, name and digest of its content."""

    kind: str
    name: str
    digest: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Entry:
    """What a library knows of an entry.

    Parameters
    ----------
    place : its folder, seen from the library; no other entry has it
    kind : one of ``KINDS``
    name : as the user wrote it; others may have the same
    main : the file to begin with, seen from the entry's ``files``
    files : all files, seen from there
    digest : of the content; name, words, note and thumbnail do not count
    thumbnail : file of its picture, seen from the entry's folder
    """

    place: str
    kind: str
    name: str
    main: str
    files: tuple[str, ...]
    digest: str
    words: tuple[str, ...] = ()
    note: str = ""
    thumbnail: str | None = None
    parts: tuple[Part, ...] = ()


def read_entry(root: Path, place: str) -> Entry:
    """Read an entry from its files, each of them.

    Parameters
    ----------
    root : folder of the library

    Raises
    ------
    InputError
        With all that is wrong: keys of ``entry.toml``, files that are not there, links that lead
        out of the library.
    """
    folder = root / place
    document = read_document(folder / SHEET)
    row = read_table(document, _KEYS)
    files: tuple[str, ...] = ()
    with document.blame(("files",)):
        files = tuple(sorted(file_names_below(folder / FILES, root)))
    _check(document, row, files, root)
    document.finish()
    return Entry(
        place=place,
        kind=row["kind"],
        name=row["name"],
        main=row["main"],
        files=files,
        digest=content_digest({name: folder / FILES / name for name in files}),
        words=tuple(row["words"]),
        note=row["note"],
        thumbnail=row["thumbnail"],
        parts=tuple(Part(**one) for one in row["part"]),
    )


def _check(document: Document, row: Mapping[str, Any], files: tuple[str, ...], root: Path) -> None:
    """Report what keys alone cannot tell."""
    name, main, thumbnail = row["name"], row["main"], row["thumbnail"]
    if name is not None and (not name.strip() or not name.isprintable()):
        document.report(("name",), shown(name), "a name in printable characters")
    if main is not None and main not in files:
        listed = ", ".join(files[:5]) or f"no file; there is none in {FILES}"
        document.report(("main",), shown(main), f"one of its files: {listed}")
    if thumbnail is not None:
        with document.blame(("thumbnail",)):
            inside(document.file.parent / thumbnail, root)
            if not thumbnail.lower().endswith(_PICTURES):
                document.report(("thumbnail",), shown(thumbnail), f"one of {', '.join(_PICTURES)}")
            elif not (document.file.parent / thumbnail).is_file():
                document.report(("thumbnail",), shown(thumbnail), "a picture beside entry.toml")
    for number, part in enumerate(row["part"]):
        if part["digest"] is not None and not _DIGEST.fullmatch(part["digest"]):
            expected = "64 digits and letters a to f"
            document.report(("part", number, "digest"), shown(part["digest"]), expected)


def inside(path: Path, root: Path) -> Path:
    """Return where a path leads to.

    Raises
    ------
    InputError
        Out of the library, by ".." or by a link, or round in a circle.
    """
    try:
        target = path.resolve()
    except (OSError, RuntimeError, ValueError):
        target = Path("/")
    if root.resolve() not in (target, *target.parents):
        raise InputError.single(
            path.name, got="a link or path out of the library", expected="one inside",
            hint="put a copy in its place",
        )  # fmt: skip
    return target


def file_names_below(folder: Path, root: Path) -> Iterator[str]:
    """Names of the files below a folder, in order; hidden ones are left out.

    Raises
    ------
    InputError
        One leads out of the library, or there are more than ``MOST_FILES``.
    """
    inside(folder, root)
    count = 0
    for at, folders, names in os.walk(folder):
        linked = [one for one in folders if (Path(at) / one).is_symlink()]
        folders[:] = sorted(n for n in folders if not n.startswith(".") and n not in linked)
        for name in (*linked, *sorted(names)):
            if name.startswith("."):
                continue
            path = Path(at) / name
            inside(path, root)
            count += 1
            if count > MOST_FILES:
                raise InputError.single(
                    "files", got=f"more than {MOST_FILES}", expected=f"at most {MOST_FILES}"
                )
            if name in linked:
                raise InputError.single(name, got="a link to a folder", expected="the files")
            yield path.relative_to(folder).as_posix()


def content_digest(files: Mapping[str, Path | bytes]) -> str:
    """Digest of files by name, however they are ordered.

    Of one file it is the SHA-256 of its content, whatever its name is: a copy under another name
    is found. Of several, the SHA-256 of lines "digest  name" in the order of names.

    Examples
    --------
    >>> content_digest({"a.txt": b"abc"})[:16], content_digest({"b.txt": b"abc"})[:16]
    ('ba7816bf8f01cfea', 'ba7816bf8f01cfea')
    """
    digests = {name: _digest(files[name]) for name in sorted(files)}
    if len(digests) == 1:
        return next(iter(digests.values()))
    lines = "".join(f"{digest}  {name}\n" for name, digest in digests.items())
    return hashlib.sha256(lines.encode("utf-8", "surrogateescape")).hexdigest()


def _digest(content: Path | bytes) -> str:
    if isinstance(content, bytes):
        return hashlib.sha256(content).hexdigest()
    with opened(content) as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()


def sheet_text(entry: Entry) -> str:
    """The text of an entry's ``entry.toml``."""
    lines = [
        f"format = {FORMAT}",
        f"kind = {quoted(entry.kind)}",
        f"name = {quoted(entry.name)}",
        f"main = {quoted(entry.main)}",
    ]
    if entry.words:
        lines.append(f"words = [{', '.join(map(quoted, entry.words))}]")
    if entry.note:
        lines.append(f"note = {quoted(entry.note)}")
    if entry.thumbnail is not None:
        lines.append(f"thumbnail = {quoted(entry.thumbnail)}")
    for part in entry.parts:
        lines += ["", "[[part]]", f"kind = {quoted(part.kind)}", f"name = {quoted(part.name)}"]
        lines.append(f"digest = {quoted(part.digest)}")
    return "\n".join(lines) + "\n"
