"""All that the page shows of a folder, as plain values."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from seatlook.errors import Problem
from seatlook.files import LARGEST_TEXT, read_file
from seatlook.io.material import materials_dir
from seatlook.studio.folder import MATERIALS, REFUSED, Contents, Folder, etag, parsed
from seatlook.studio.pattern_state import (
    Values,
    guess_values,
    millimetres,
    pattern_values,
    seam_values,
)
from seatlook.studio.reading import Reading

_LISTS = {"stages": "stage", "hooks": "hook", "frames": "frame", "rigs": "rig"}


def state_values(folder: Folder, contents: Contents, scene: str | None, reading: Reading) -> Values:
    """Say what is in a folder.

    Parameters
    ----------
    contents : of the files that clicks change
    scene : name of the scene's file, if there is one
    reading : what they say
    """
    pattern = reading.pattern
    refused = parsed(contents.get(REFUSED, b"")).get("refused", [])
    return {
        "folder": str(folder.root),
        "scene": scene,
        "has_scene": scene is not None,
        "variants": [] if scene is None else folder.variants,
        "name": reading.data.get("name", folder.root.name),
        "files": [{"path": name, "etag": etag({name: contents[name]})} for name in contents],
        "errors": [problem_values(folder, one) for one in reading.problems],
        "pattern": {"units": "mm", "panels": []} if pattern is None else pattern_values(pattern),
        "seams": [] if pattern is None else seam_values(pattern),
        "guesses": [] if pattern is None else guess_values(pattern, refused),
        **{name: _rows(reading.data, key) for name, key in _LISTS.items()},
        "wires": _wires(reading),
        "panels": _panels(reading),
        **{key: _table(reading.data, key) for key in ("camera", "gallery", "mesh", "placement")},
    }


def problem_values(folder: Folder, problem: Problem) -> Values:
    """One thing that is wrong, with its place seen from the folder."""
    file = problem.file
    if file is not None and file.is_absolute() and file.is_relative_to(folder.root):
        file = file.relative_to(folder.root)
    said = f"{problem.key}: got {problem.got}, expected {problem.expected}"
    return {
        "file": None if file is None else file.as_posix(),
        "line": problem.line,
        "key": problem.key,
        "text": f"{said} ({problem.hint})" if problem.hint else said,
    }


def material_values(folder: Folder) -> list[Values]:
    """All materials: those that come with seatlook, and those of the folder."""
    supplied = [(path.stem, path) for path in sorted(materials_dir().glob("*.toml"))]
    paths = sorted(folder.inside(MATERIALS).glob("*.toml"))
    own = [(path.relative_to(folder.root).as_posix(), path) for path in paths]
    found = []
    for name, path in [*own, *supplied]:
        values = parsed(read_file(path, at_most=LARGEST_TEXT))
        kind = "foam" if "foam" in values else "cover" if "fabric" in values else "look"
        found.append({"name": name, "kind": kind, "own": (name, path) in own, "values": values})
    return found


def _wires(reading: Reading) -> list[Values]:
    if reading.scene is None:
        return []
    curves = reading.scene.foam.curves.items()
    return [{"name": name, "points_mm": millimetres(points)} for name, points in curves]


def _panels(reading: Reading) -> Values:
    """Panel -> its own keys, and the material that it has at the end."""
    own, default = _table(reading.data, "panel"), _table(reading.data, "pattern").get("material")
    names = () if reading.pattern is None else (panel.name for panel in reading.pattern.panels)
    return {name: {"material": default, **_table(own, name)} for name in names}


def _table(data: Mapping[str, Any], key: str) -> Values:
    value = data.get(key)
    return value if isinstance(value, dict) else {}


def _rows(data: Mapping[str, Any], key: str) -> Sequence[Any]:
    value = data.get(key)
    return value if isinstance(value, list) else []
