"""The folder of a seat: which of its files are changed by clicks, and what lies inside it."""

from __future__ import annotations

import hashlib
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from seatlook.errors import InputError
from seatlook.files import LARGEST_TEXT, read_file, state_of

OWN = ".seatlook"  # folder of the journal and of what was refused
REFUSED = f"{OWN}/refused.toml"
SCENE = "scene.toml"
MATERIALS = "materials"  # of the folder, in their own folder

_MOST_FILES = 100

Contents = Mapping[str, bytes]  # path seen from the folder -> what the file holds


class Folder:
    """A folder on disk; paths go by what links lead to, and never out of it.

    Parameters
    ----------
    root : Path     it may be empty, or not be there yet
    """

    def __init__(self, root: Path) -> None:
        self.root = root.resolve()

    def inside(self, name: str) -> Path:
        """Path of a file seen from the folder.

        Raises
        ------
        InputError
            It is outside, or a link leads out.
        """
        try:
            path = (self.root / name).resolve()
        except (OSError, ValueError, RuntimeError) as error:
            raise InputError.single("path", got=repr(name), expected="a path") from error
        if path != self.root and self.root not in path.parents:
            raise InputError.single("path", got=repr(name), expected="one inside the folder")
        return path

    @property
    def scene(self) -> str | None:
        """Name of the scene's file: ``scene.toml``, or the only TOML with pattern and foam."""
        if (self.root / SCENE).is_file():
            return SCENE
        found = [path.name for path in sorted(self.root.glob("*.toml")) if _is_scene(path)]
        return found[0] if len(found) == 1 else None

    @property
    def variants(self) -> list[str]:
        """Names of the other scenes beside the folder's own."""
        scene = self.scene
        names = [path.name for path in sorted(self.root.glob("*.toml")) if _is_scene(path)]
        return [name for name in names if name != scene][:_MOST_FILES]

    def contents(self) -> dict[str, bytes]:
        """What the files that can be changed hold now: scenes, seams, curves, refused guesses."""
        scene = self.scene
        names = [] if scene is None else [scene, *self._named(scene), *self.variants]
        found = {}
        for name in [*names, REFUSED]:
            try:
                found[name] = read_file(self.inside(name), at_most=LARGEST_TEXT)
            except InputError:
                continue
        return found

    @property
    def signature(self) -> str:
        """What tells whether files that are read, but not changed by clicks, are others now."""
        own = [state_of(path) for path in sorted(self.root.glob("*.toml"))[:_MOST_FILES]]
        return self.signature_of("pattern", "foam", "design") + repr(own)

    def signature_of(self, *tables: str) -> str:
        """The same for the files of these tables of the scene."""
        scene = self.scene
        if scene is None:
            return ""
        data = parsed(read_file(self.root / scene, at_most=LARGEST_TEXT))
        names = [_text(data, table, "file") for table in tables]
        return repr([state_of(self.root / name) for name in names if name is not None])

    def _named(self, scene: str) -> list[str]:
        """Files of seams and curves that a scene names, of those inside the folder."""
        data = parsed(read_file(self.root / scene, at_most=LARGEST_TEXT))
        names = [_text(data, "pattern", "seams"), _text(data, "foam", "curves")]
        own = sorted((self.root / MATERIALS).glob("*.toml"))
        return [
            *(name for name in names if name is not None),
            *(path.relative_to(self.root).as_posix() for path in own[:_MOST_FILES]),
        ]


def parsed(content: bytes) -> dict[str, Any]:
    """A TOML content as plain values; nothing where it is none."""
    try:
        return tomllib.loads(content.decode("utf-8-sig"))
    except (ValueError, RecursionError):
        return {}


def etag(contents: Contents, more: str = "") -> str:
    """What tells one state of the files from another."""
    digest = hashlib.sha256(more.encode())
    for name, content in sorted(contents.items()):
        digest.update(f"{len(name)} {name} {len(content)} ".encode())
        digest.update(content)
    return digest.hexdigest()[:24]


def _is_scene(path: Path) -> bool:
    try:
        data = parsed(read_file(path, at_most=LARGEST_TEXT))
    except InputError:
        return False
    return isinstance(data.get("pattern"), dict) and isinstance(data.get("foam"), dict)


def _text(data: Mapping[str, Any], table: str, key: str) -> str | None:
    values = data.get(table)
    value = values.get(key) if isinstance(values, dict) else None
    return value if isinstance(value, str) else None
