"""Files as they are to be: what an edit reads and changes before anything is written."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import InitVar, dataclass, field, replace
from typing import Any

from seatlook.errors import InputError
from seatlook.files import standing_in
from seatlook.io.scene.read import load_pattern
from seatlook.io.toml import Key
from seatlook.io.toml_edit import drop, put
from seatlook.model import Pattern
from seatlook.studio.folder import Folder, parsed
from seatlook.studio.pattern_state import Values, guess_values
from seatlook.studio.reading import Reading, on_disk, read

Edit = Mapping[str, Any]
_MARK = "\ufeff"  # of byte order, as some editors write it


class Gone(Exception):  # noqa: N818 -- it says what happened
    """What an edit is about is not there any more."""


@dataclass
class Draft:
    """Contents of the files of a folder, to which edits are made one after the other.

    Parameters
    ----------
    scene : name of the scene's file
    known : what the files said before the first edit, if they were read
    """

    folder: Folder
    contents: dict[str, bytes]
    scene: str
    known: InitVar[Reading | None] = None
    _reading: Reading | None = field(default=None, init=False)
    _pattern: Pattern | None = field(default=None, init=False)
    _guesses: Mapping[str, Values] | None = field(default=None, init=False)

    def __post_init__(self, known: Reading | None) -> None:
        self._reading = known

    @property
    def reading(self) -> Reading:
        """What the files say now."""
        if self._reading is None:
            self._reading = read(self.folder, self.contents, self.scene)
        return self._reading

    @property
    def pattern(self) -> Pattern:
        """The pattern and its seams, whatever else may be wrong.

        Raises
        ------
        InputError
            It cannot be read.
        """
        if self._reading is not None and self._reading.pattern is not None:
            return self._reading.pattern
        if self._pattern is None:
            with standing_in(on_disk(self.folder, self.contents)):
                self._pattern = load_pattern(self.folder.root / self.scene)
        return self._pattern

    @property
    def guesses(self) -> Mapping[str, Values]:
        """All seams that are guessed, by their names, also those that are sewn by now."""
        if self._guesses is None:
            found = guess_values(replace(self.pattern, seams=()), ())
            self._guesses = {guess["id"]: guess for guess in found}
        return self._guesses

    @property
    def data(self) -> dict[str, Any]:
        """The scene's file as plain values."""
        return parsed(self.contents[self.scene])

    def named(self, table: str, key: str) -> str:
        """Name of a file that the scene names and edits may change.

        Raises
        ------
        InputError
            It is not in the folder, or not there.
        """
        name = self.data.get(table, {}).get(key)
        if name not in self.contents:
            raise InputError.single(
                f"{table}.{key}", got=repr(name), expected="a file inside the folder",
                hint="copy it into the folder, so that it can be changed here",
            )  # fmt: skip
        return str(name)

    def change(self, name: str, edit: Callable[[str], str]) -> None:
        """Change the text of a file; a file that is not there is empty before."""
        content = self.contents.get(name, b"").decode("utf-8")
        mark = _MARK if content.startswith(_MARK) else ""
        self.contents[name] = (mark + edit(content.removeprefix(_MARK))).encode()
        self._reading = self._pattern = None

    def put(self, key: Key, value: object) -> None:
        """Set a key of the scene; None takes it out."""
        if value is not None:
            self.change(self.scene, lambda text: put(text, key, value))
        else:
            self.change(self.scene, lambda text: drop(text, key))


def wanted(edit: Edit, key: str, *kinds: type) -> Any:
    """Value of an edit's key, which has to be of one of these kinds.

    Raises
    ------
    InputError
        It is missing, or of another kind.
    """
    value = edit.get(key)
    if not isinstance(value, kinds) or (isinstance(value, bool) and bool not in kinds):
        expected = " or ".join(kind.__name__ for kind in kinds)
        raise InputError.single(f"{edit.get('kind')}.{key}", got=repr(value), expected=expected)
    return value
