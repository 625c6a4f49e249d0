"""One folder at work: what it holds, who changes it, and that nothing is lost."""

from __future__ import annotations

import threading
from collections.abc import Mapping, Sequence
from typing import Any

from seatlook.errors import InputError
from seatlook.files import write_bytes
from seatlook.studio.edits.draft import Draft, Gone
from seatlook.studio.edits.kinds import make
from seatlook.studio.folder import Folder, etag
from seatlook.studio.reading import Reading, read
from seatlook.studio.state import state_values


class Clash(Exception):  # noqa: N818 -- it says what happened
    """A change of what somebody else has changed; asks which one counts."""

    def __init__(self, reason: str, mine: object, theirs: object) -> None:
        super().__init__(reason)
        self.reason, self.mine, self.theirs = reason, mine, theirs


class Session:
    """A folder that several tabs look at and change."""

    def __init__(self, folder: Folder) -> None:
        self.folder = folder
        self._lock = threading.Lock()
        self._state: dict[str, Any] = {}
        self._reading: Reading | None = None

    def state(self) -> Mapping[str, Any]:
        """What the page shows; read again only where a file changed."""
        with self._lock:
            return self._now()

    def edit(self, base: object, edits: Sequence[Any]) -> Mapping[str, Any]:
        """Make edits of the state ``base`` and return the new one.

        Raises
        ------
        Clash
            The files are not what they were.
        InputError
            The edits cannot be made.
        """
        with self._lock:
            before, scene = self.folder.contents(), self.folder.scene
            if scene is None:
                raise InputError.single("edit", got="no scene", expected="a folder with one")
            now = self._now()
            if base != now["etag"]:
                raise Clash("the files were changed meanwhile", list(edits), now)
            draft = Draft(self.folder, dict(before), scene, self._reading)
            try:
                make(draft, edits)
            except Gone as gone:
                raise Clash(str(gone), list(edits), now) from gone
            for name, content in draft.contents.items():
                if before.get(name) != content:
                    write_bytes(self.folder.inside(name), content)
            return self._now(draft.reading)

    def _now(self, reading: Reading | None = None) -> Mapping[str, Any]:
        contents, scene = self.folder.contents(), self.folder.scene
        if self._state.get("etag") != etag(contents):
            self._reading = reading or read(self.folder, contents, scene)
            self._state = state_values(self.folder, contents, scene, self._reading)
        return {**self._state, "undo": False, "redo": False}
