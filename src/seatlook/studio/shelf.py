"""The library beside a folder: what it holds, and how an entry comes into the folder."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from seatlook.errors import InputError
from seatlook.files import write_bytes
from seatlook.library.entry import Entry, inside
from seatlook.library.library import Library, open_library
from seatlook.library.taking import contents, take
from seatlook.studio.folder import MATERIALS, Folder, parsed
from seatlook.studio.session import Session
from seatlook.studio.starting import UPLOADS
from seatlook.studio.state import problem_values

_THUMBNAIL = "/api/library/thumbnail?place="


class Shelf:
    """A library that a session takes from; it is read only.

    Parameters
    ----------
    root : folder of the library; None: there is none
    """

    def __init__(self, session: Session, root: Path | None) -> None:
        self._session, self.root = session, root

    def values(self) -> Mapping[str, Any]:
        """What the library holds, and what in it cannot be read."""
        if self.root is None:
            return {"library": None, "entries": [], "errors": []}
        library = open_library(self.root)
        return {
            "library": str(self.root),
            "entries": [_values(library, entry) for entry in library.entries],
            "errors": [problem_values(self._session.folder, one) for one in library.problems],
        }

    def picture(self, place: str) -> Path | None:
        """File of an entry's thumbnail; None: it has none."""
        library = self._library()
        entry = library.get(place)
        if entry.thumbnail is None:
            return None
        return inside(library.root / entry.place / entry.thumbnail, library.root)

    def use(self, asked: Mapping[str, Any]) -> Mapping[str, Any]:
        """Put an entry into the folder, as one change that can be taken back.

        Returns
        -------
        values
            ``files`` of a pattern or foam are what a start may name.

        Raises
        ------
        InputError
            There is no such entry, or other files of its names are there.
        """
        place = asked.get("place")
        if not isinstance(place, str):
            raise InputError.single("place", got=repr(place), expected="the place of an entry")
        library = self._library()
        entry = library.get(place)
        ways: dict[str, Callable[[Library, Entry, bool], Mapping[str, Any]]] = {
            "seat": self._seat, "material": self._material, "pattern": self._uploaded,
            "foam": self._uploaded, "rig": self._rig, "limits": self._limits,
        }  # fmt: skip
        if entry.kind not in ways:
            raise InputError.single(
                "place", got=f"a {entry.kind}", expected=f"one of {', '.join(ways)}",
                hint="take it out with: seatlook library take",
            )  # fmt: skip
        return ways[entry.kind](library, entry, bool(asked.get("force")))

    def _library(self) -> Library:
        if self.root is None:
            raise InputError.single(
                "library", got="none", expected="one", hint="start with --library FOLDER"
            )
        return open_library(self.root)

    def _seat(self, library: Library, entry: Entry, force: bool) -> Mapping[str, Any]:
        folder = self._session.folder
        if folder.scene is not None and not force:
            raise InputError.single(
                "place", got=f"a folder with {folder.scene}", expected="an empty one",
                hint="start in another folder, or replace this scene",
            )  # fmt: skip
        if "/" in entry.main:
            raise InputError.single(
                "place", got=f"a scene in a folder of its own, {entry.main}",
                expected="one beside its files", hint="take it out with: seatlook library take",
            )  # fmt: skip
        return self._taken(library, entry, "", force)

    def _material(self, library: Library, entry: Entry, force: bool) -> Mapping[str, Any]:
        return self._taken(library, entry, MATERIALS, force)

    def _taken(self, library: Library, entry: Entry, where: str, force: bool) -> Mapping[str, Any]:
        folder = self._session.folder
        for name in entry.files:
            folder.inside(f"{where}/{name}" if where else name)

        def write(root: Path) -> object:
            return take(library, entry, root / where, force=force)

        return self._session.replace(f"library.{entry.kind}", write)

    def _uploaded(self, library: Library, entry: Entry, force: bool) -> Mapping[str, Any]:
        """Lay files where uploaded ones lie, for a start to take."""
        folder: Folder = self._session.folder
        for name, content in contents(library, entry).items():
            write_bytes(folder.inside(f"{UPLOADS}/{name}"), content)
        others = [name for name in entry.files if name.endswith(".toml")]
        more = {"pattern": "seams", "foam": "wires"}[entry.kind]
        files = {entry.kind: entry.main, **({more: others[0]} if others else {})}
        named = {what: f"{UPLOADS}/{name}" for what, name in files.items()}
        return {**self._session.state(), "files_to_start": named}

    def _rig(self, library: Library, entry: Entry, force: bool) -> Mapping[str, Any]:
        if len(entry.files) > 1:
            raise InputError.single(
                "place", got="a rig with a panorama", expected="one of lights alone",
                hint="take it out with: seatlook library take",
            )  # fmt: skip
        rows = parsed(contents(library, entry)[entry.main])["rig"]
        return self._edited([{"kind": "rig.add", "values": row} for row in rows])

    def _limits(self, library: Library, entry: Entry, force: bool) -> Mapping[str, Any]:
        zones = parsed(contents(library, entry)[entry.main])["accept"]
        return self._edited(
            [
                {"kind": "accept.set", "key": [zone, measure], "value": value}
                for zone, row in zones.items()
                for measure, value in row.items()
            ]
        )

    def _edited(self, edits: list[dict[str, Any]]) -> Mapping[str, Any]:
        return self._session.edit(self._session.state()["etag"], edits)


def _values(library: Library, entry: Entry) -> dict[str, Any]:
    picture = entry.thumbnail and f"{_THUMBNAIL}{entry.place}"
    return {
        "name": entry.name, "label": library.label(entry), "kind": entry.kind,
        "place": entry.place, "digest": entry.digest, "words": list(entry.words),
        "note": entry.note, "files": list(entry.files), "thumbnail": picture,
    }  # fmt: skip
