"""What the files of a folder say, by the readers that every command uses."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from seatlook.errors import InputError, Problem
from seatlook.files import standing_in
from seatlook.io.scene.read import load_pattern, load_scene
from seatlook.model import Pattern, Scene
from seatlook.studio.folder import Contents, Folder, parsed


@dataclass(frozen=True, slots=True, kw_only=True)
class Reading:
    """A scene, as far as it can be read.

    Parameters
    ----------
    data : the scene's file as plain values
    pattern : None where there is none, or it cannot be read
    scene : None where anything is wrong
    problems : what is wrong
    """

    data: Mapping[str, Any]
    pattern: Pattern | None
    scene: Scene | None
    problems: tuple[Problem, ...]


def read(folder: Folder, contents: Contents, name: str | None) -> Reading:
    """Read the scene called ``name`` of a folder, with these contents in the place of its files."""
    if name is None or name not in contents:
        return Reading(data={}, pattern=None, scene=None, problems=())
    data, path = parsed(contents[name]), folder.root / name
    with standing_in(on_disk(folder, contents)):
        try:
            scene = load_scene(path)
        except InputError as error:
            return Reading(data=data, pattern=_pattern(path), scene=None, problems=error.problems)
    return Reading(data=data, pattern=scene.pattern, scene=scene, problems=())


def on_disk(folder: Folder, contents: Contents) -> dict[Path, bytes]:
    """Contents by their full paths."""
    return {folder.root / name: content for name, content in contents.items()}


def _pattern(path: Path) -> Pattern | None:
    try:
        return load_pattern(path)
    except InputError:
        return None
