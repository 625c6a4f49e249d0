"""One folder at work: what it holds, who changes it, and that nothing is lost."""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, Literal

from seatlook.errors import InputError
from seatlook.studio.edits.draft import Draft, Gone
from seatlook.studio.edits.kinds import make
from seatlook.studio.folder import OWN, Contents, Folder, etag
from seatlook.studio.keeping.durable import prepared, put_in_place
from seatlook.studio.keeping.journal import Change, Files, Journal
from seatlook.studio.keeping.merge import changed, merged, touching
from seatlook.studio.reading import Reading, read
from seatlook.studio.state import state_values

_UNDONE = 100  # edits that can be taken back
_REMEMBERED = 64  # states that a tab may still look at


class Clash(Exception):  # noqa: N818 -- it says what happened
    """A change of what somebody else has changed; asks which one counts."""

    def __init__(self, reason: str, mine: object, theirs: object) -> None:
        super().__init__(reason)
        self.reason, self.mine, self.theirs = reason, mine, theirs


class Session:
    """A folder that several tabs look at and change, and programs outside as well.

    What is acknowledged is in the journal and in the files, both on the disk.
    """

    def __init__(self, folder: Folder) -> None:
        self.folder = folder
        self._lock = threading.RLock()
        self._state: dict[str, Any] = {}
        self._reading: Reading | None = None
        self._known: OrderedDict[str, Contents] = OrderedDict()
        self._own = folder.inside(OWN)
        self._journal = Journal(self._own / "journal.jsonl")
        self._undo: list[Change] = []
        self._redo: list[Change] = []
        self._recover()

    def state(self) -> Mapping[str, Any]:
        """What the page shows; read again only where a file changed."""
        with self._lock:
            return self._now()

    def tag(self) -> str:
        """What tells this state of the files from another."""
        with self._lock:
            return etag(self.folder.contents(), self.folder.signature)

    def reading(self) -> Reading:
        """What the files say."""
        return self.now()[2]

    def now(self) -> tuple[str, Contents, Reading]:
        """What tells this state, what the files hold, and what they say."""
        with self._lock:
            tag = str(self._now()["etag"])
            if self._reading is None:
                raise InputError.single("folder", got="nothing", expected="a scene")
            return tag, self._known[tag], self._reading

    def edit(self, base: object, edits: Sequence[Any]) -> Mapping[str, Any]:
        """Make edits of the state ``base`` and return the new one.

        Edits of a state that is not the last one are made to the last, if nothing they are about
        was changed in between.

        Raises
        ------
        Clash
            What the edits are about was changed meanwhile.
        InputError
            The edits cannot be made; nothing is written.
        OSError
            They cannot be written; all is as before.
        """
        with self._lock:
            now, before = self._now(), self.folder.contents()
            draft = self._draft(before, self._reading)
            try:
                if base != now["etag"]:
                    self._check_base(base, before, edits, now)
                make(draft, edits)
            except Gone as gone:
                raise Clash(str(gone), list(edits), now) from gone
            what = ", ".join(str(edit["kind"]) for edit in edits)
            change = _change("edit", what, before, draft.contents)
            if change.after:
                self._write(change)
                self._undo.append(change)
                del self._undo[:-_UNDONE]
                self._redo.clear()
            return self._now(draft.reading)

    def undo(self, base: object) -> Mapping[str, Any]:
        """Take back the last edit.

        Raises
        ------
        Clash
            The files are not what the page shows, or what is taken back was changed outside.
        """
        with self._lock:
            return self._again(base, "undo", self._undo, self._redo)

    def redo(self, base: object) -> Mapping[str, Any]:
        """Make the edit again that was taken back last; raises as ``undo``."""
        with self._lock:
            return self._again(base, "redo", self._redo, self._undo)

    def replace(self, what: str, write: Callable[[Path], object]) -> Mapping[str, Any]:
        """Let a writer leave files in the folder, as one change that can be taken back."""
        with self._lock:
            before = self.folder.contents()
            write(self.folder.root)
            change = _change("edit", what, before, self.folder.contents())
            if change.after:
                self._journal.append(change)
                self._journal.finish()
                self._undo.append(change)
                self._redo.clear()
            return self._now()

    def _draft(self, contents: Contents, reading: Reading | None) -> Draft:
        scene = self.folder.scene
        if scene is None:
            raise InputError.single("edit", got="no scene", expected="a folder with one")
        return Draft(self.folder, dict(contents), scene, reading)

    def _check_base(
        self, base: object, now: Contents, edits: Sequence[Any], state: Mapping[str, Any]
    ) -> None:
        """Refuse edits of an old state that are not the same made to the one that is."""
        old = self._known.get(str(base))
        if old is None:
            raise Clash("this page shows an old state of the files", list(edits), state)
        own = self._draft(old, None)
        make(own, edits)
        mine, theirs = changed(old, own.contents), changed(old, now)
        both = touching(mine, theirs)
        renewed = self._draft(now, None)
        if not both:
            make(renewed, edits)
        if both or changed(now, renewed.contents) != mine:
            named = ", ".join(sorted({".".join(map(str, path[1:3])) for path in both}))
            raise Clash(f"changed elsewhere meanwhile: {named or 'the same lines'}", edits, state)

    def _again(
        self, base: object, kind: Literal["undo", "redo"], source: list[Change], to: list[Change]
    ) -> Mapping[str, Any]:
        now, before = self._now(), self.folder.contents()
        if not source:
            raise InputError.single(kind, got="nothing", expected="an edit before")
        if base != now["etag"]:
            raise Clash("this page shows an old state of the files", kind, now)
        change = source[-1]
        old, new = (
            (change.after, change.before) if kind == "undo" else (change.before, change.after)
        )
        after: dict[str, bytes | None] = dict(before)
        try:
            for name in new:
                after[name] = merged(old.get(name), new[name], before.get(name))
        except ValueError as error:
            raise Clash(f"{name} was changed outside since: {error}", kind, now) from error
        self._write(_change(kind, change.what, before, after))
        source.pop()
        to.append(change)
        return self._now()

    def _write(self, change: Change) -> None:
        """Put a change on the disk: temporary files, the journal, then the files themselves."""
        paths = {self.folder.inside(name): content for name, content in change.after.items()}
        with prepared(paths, self._own / "tmp") as ready:
            # Whoever writes outside has not waited for us.
            if _change("edit", "", change.before, self.folder.contents()).after.keys() & (
                change.before.keys()
            ):
                raise Clash("a file was changed in this moment", change.what, self._now())
            self._journal.append(change)
            try:
                put_in_place(paths, ready)
            except OSError:
                self._journal.withdraw()
                raise
        self._journal.finish()

    def _recover(self) -> None:
        """Finish a change that the journal holds and the files do not, and know what to undo."""
        for temporary in (self._own / "tmp").glob("*"):
            temporary.unlink(missing_ok=True)
        if self._journal.changes and not self._journal.done:
            last, now = self._journal.changes[-1], self.folder.contents()
            left = {n: c for n, c in last.after.items() if now.get(n) == last.before.get(n) != c}
            paths = {self.folder.inside(name): content for name, content in left.items()}
            with prepared(paths, self._own / "tmp") as ready:
                put_in_place(paths, ready)
            self._journal.finish()
        for change in self._journal.changes:
            if change.kind == "edit":
                self._undo.append(change)
                self._redo.clear()
            elif change.kind == "undo" and self._undo:
                self._redo.append(self._undo.pop())
            elif change.kind == "redo" and self._redo:
                self._undo.append(self._redo.pop())

    def _now(self, reading: Reading | None = None) -> Mapping[str, Any]:
        contents, scene = self.folder.contents(), self.folder.scene
        tag = etag(contents, self.folder.signature)
        if self._state.get("etag") != tag:
            self._reading = reading or read(self.folder, contents, scene)
            values = state_values(self.folder, contents, scene, self._reading)
            self._state = {**values, "etag": tag}
        self._known[tag] = contents
        self._known.move_to_end(tag)
        while len(self._known) > _REMEMBERED:
            self._known.popitem(last=False)
        return {
            **self._state,
            "undo": self._undo[-1].what if self._undo else False,
            "redo": self._redo[-1].what if self._redo else False,
        }


def _change(
    kind: Literal["edit", "undo", "redo"], what: str, before: Files, after: Files
) -> Change:
    """Of all files, those that are not the same before and after."""
    names = [n for n in {**before, **after} if before.get(n) != after.get(n)]
    return Change(
        kind=kind,
        what=what,
        before={name: before.get(name) for name in names},
        after={name: after.get(name) for name in names},
    )
