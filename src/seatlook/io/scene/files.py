"""The one door to the files that a scene names: here each is looked for, opened and counted."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass, field
from pathlib import Path

from seatlook.errors import InputError
from seatlook.files import opened, state_of
from seatlook.io.schema import shown
from seatlook.io.toml import Document, Key


@dataclass(slots=True)
class SceneFiles:
    """Files in the order in which the scene names them, and the digest of scene and files.

    Parameters
    ----------
    document : the scene file itself; it counts first
    """

    document: Document
    _digests: dict[Path, bytes] = field(default_factory=dict)
    _states: dict[Path, object] = field(default_factory=dict)

    def find(self, key: Key, name: str | None, path: Path | None = None) -> Path | None:
        """Count a file that the scene names and return its path, or report why it cannot be read.

        Parameters
        ----------
        key, name : where the scene names it, and how; without a name there is no file
        path : where it is; by default its name is seen from the folder of the scene
        """
        if name is None:
            return None
        path = self.document.file.parent / name if path is None else path
        try:
            self.count(path)
        except InputError as error:
            for p in error.problems:
                got = "there is none" if p.got == "no such file" else p.got
                self.document.report(key, shown(name), p.expected, f"{got} at {path}")
            return None
        return path

    def count(self, path: Path) -> None:
        """Count a file that another file names, once.

        Raises
        ------
        InputError
            There is no such file, it is none that can be read, or is being written.
        """
        if path in self._digests:
            return
        with opened(path) as stream:
            self._states[path] = state_of(path)
            content = hashlib.file_digest(stream, "sha256").digest()
        # The name counts as well: it says which texture map a picture is.
        self._digests[path] = hashlib.sha256(path.name.encode() + b"\0" + content).digest()

    @property
    def paths(self) -> tuple[Path, ...]:
        """All files that were counted."""
        return tuple(self._digests)

    def digest(self) -> str:
        """Hash names and contents in the order in which they were counted, not the folders.

        Raises
        ------
        InputError
            A file was changed after it was counted, so that another content may have been read.
        """
        for path, state in self._states.items():
            if state_of(path) != state:
                raise InputError.single(
                    "file", got="a file that changed while the scene was read",
                    expected="one that stays", file=path, hint="try again",
                )  # fmt: skip
        scene = hashlib.sha256(self.document.content).digest()
        return hashlib.sha256(b"".join([scene, *self._digests.values()])).hexdigest()
