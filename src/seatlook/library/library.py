"""A library: its entries, read from their files, and how one is found."""

from __future__ import annotations

import os
import unicodedata
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from seatlook.errors import InputError, Problem, did_you_mean
from seatlook.io.material import materials_dir
from seatlook.io.schema import Integer, read_table, shown
from seatlook.io.toml import read_document
from seatlook.library.entry import FORMAT, SHEET, Entry, Part, content_digest, inside, read_entry
from seatlook.library.index import indexed, known_entry, read_index, signature, write_index

MARK = "library.toml"  # makes a folder a library
_DEEPEST = 8  # folders in each other
_MOST = 20_000  # entries
_SHORTEST = 8  # characters of a digest by which an entry is found


@dataclass(frozen=True, slots=True)
class Library:
    """All entries of a folder.

    Parameters
    ----------
    root : its folder
    entries : by place
    problems : what is wrong with entries that are left out, with file and line
    """

    root: Path
    entries: tuple[Entry, ...]
    problems: tuple[Problem, ...] = ()

    def find(
        self, words: Sequence[str] = (), *, kind: str | None = None, digest: str | None = None
    ) -> tuple[Entry, ...]:
        """Entries that have all words in name, words, note, kind or place, as capitals or not.

        Parameters
        ----------
        digest : of the content, or how it begins (8 letters or more)

        Returns
        -------
        entries, those first that have all words in their names
        """
        if digest is not None and len(digest) < _SHORTEST:
            raise InputError.single(
                "--digest", got=shown(digest), expected=f"{_SHORTEST} letters or more"
            )
        sought = [_folded(word) for word in words]
        found = [
            one
            for one in self.entries
            if (kind is None or one.kind == kind)
            and (digest is None or one.digest.startswith(digest.lower()))
            and all(word in _text(one) for word in sought)
        ]
        return tuple(
            sorted(found, key=lambda one: not all(word in _folded(one.name) for word in sought))
        )

    def get(self, name: str, *, kind: str | None = None) -> Entry:
        """The entry of a place, or the only one of a name, read from its files again.

        Raises
        ------
        InputError
            There is none, or several have the name: then it says their places.
        """
        entries = [one for one in self.entries if kind is None or one.kind == kind]
        found = [one for one in entries if one.place == name.strip("/")]
        found = found or [one for one in entries if _folded(one.name) == _folded(name)]
        if len(found) == 1:
            return read_entry(self.root, found[0].place)
        if found:
            places = ", ".join(one.place for one in found)
            raise InputError.single(
                "entry", got=f"{shown(name)}, which {len(found)} entries are called",
                expected=f"one of their places: {places}", file=self.root,
            )  # fmt: skip
        wrong = [one for one in self.problems if one.file == self.root / name / SHEET]
        if wrong:
            raise InputError(wrong)
        names = [word for one in entries for word in (one.name, one.place)]
        raise InputError.single(
            "entry", got=shown(name), expected="name or place of an entry", file=self.root,
            hint=did_you_mean(name, names),
        )  # fmt: skip

    def part(self, part: Part) -> Entry | None:
        """The entry that a part of another one is: of its content, its name if several have that.

        A part that was renamed is found, and of two with one name the one that was meant. One of
        the name with another content is another part.
        """
        same = [one for one in self.entries if (one.kind, one.digest) == (part.kind, part.digest)]
        same.sort(key=lambda one: one.name != part.name)
        return same[0] if same else None

    def label(self, entry: Entry) -> str:
        """Name of an entry, with its place where others are called the same."""
        same = Counter(_folded(one.name) for one in self.entries)
        alone = same[_folded(entry.name)] < 2
        return entry.name if alone else f"{entry.name} ({entry.place})"


def is_supplied(part: Part) -> bool:
    """Whether a part is a material that comes with seatlook, with the same content."""
    path = materials_dir() / f"{part.name}.toml"
    plain = part.kind == "material" and path.parent == materials_dir() and path.is_file()
    return plain and content_digest({path.name: path}) == part.digest


def open_library(root: Path) -> Library:
    """Read a library, of entries that did not change what the index holds of them.

    Raises
    ------
    InputError
        The folder is no library. Entries that are wrong are left out and named in ``problems``.
    """
    _check_mark(root)
    known, fresh = read_index(root), {}
    entries, problems = [], list[Problem]()
    for place in _places(root, problems):
        try:
            now = signature(root, place)
            entry = known_entry(known.get(place), now)
            if entry is None or entry.place != place:
                entry = read_entry(root, place)
        except InputError as error:
            problems += [_placed(one, root / place / SHEET) for one in error.problems]
            continue
        entries.append(entry)
        fresh[place] = indexed(entry, now)
    if fresh != known:
        write_index(root, fresh)
    return Library(root, tuple(entries), tuple(problems))


def _check_mark(root: Path) -> None:
    if not (root / MARK).is_file():
        raise InputError.single(
            "library", got=f"no {MARK}" if root.is_dir() else "no such folder",
            expected="a library", file=root,
            hint="make one with: seatlook library add FILE --library FOLDER",
        )  # fmt: skip
    document = read_document(root / MARK)
    read_table(document, {"format": Integer(low=FORMAT, high=FORMAT, required=True)})
    document.finish()


def _places(root: Path, problems: list[Problem]) -> list[str]:
    """Folders with an ``entry.toml``, in order; nothing is looked for inside them."""
    found: list[str] = []
    for at, folders, names in os.walk(root):
        place = Path(at).relative_to(root)
        if SHEET in names and place.parts:
            found.append(place.as_posix())
            folders.clear()
            continue
        deeper = len(place.parts) < _DEEPEST
        kept = sorted(one for one in folders if deeper and not one.startswith("."))
        for one in [one for one in kept if (Path(at) / one).is_symlink()]:
            kept.remove(one)
            problems += _link_problems(Path(at) / one, root)
        folders[:] = kept
        if len(found) > _MOST:
            raise InputError.single("library", got=f"more than {_MOST} entries", expected="fewer")
    return sorted(found)


def _link_problems(path: Path, root: Path) -> list[Problem]:
    """A link to a folder is not followed; one that leads out is said."""
    try:
        inside(path, root)
    except InputError as error:
        return [_placed(one, path) for one in error.problems]
    return []


def _placed(problem: Problem, file: Path) -> Problem:
    if problem.file is not None:
        return problem
    return Problem(
        key=problem.key, got=problem.got, expected=problem.expected, file=file, hint=problem.hint
    )


def _text(entry: Entry) -> str:
    return _folded("\n".join((entry.name, *entry.words, entry.note, entry.kind, entry.place)))


def _folded(text: str) -> str:
    """A text as it is compared: whatever its capitals, and however its accents are written."""
    return unicodedata.normalize("NFKC", text).casefold().strip()
