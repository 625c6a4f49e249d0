"""Edits of the scene and of the files it names: stages, hooks, poses, lights, materials."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import PurePosixPath
from typing import Any

from seatlook.errors import InputError
from seatlook.files import read_text
from seatlook.io.material import material_path
from seatlook.io.toml import Key
from seatlook.io.toml_edit import add_row, drop, put
from seatlook.studio.edits.draft import Draft, Edit, Gone, wanted
from seatlook.studio.folder import MATERIALS, REFUSED, SCENE, parsed

Kind = Callable[[Draft, Edit], None]


def set_in_table(table: str) -> Kind:
    """Kind of edit that sets a key of a table: ``key``, or a path of keys, and ``value``."""

    def made(draft: Draft, edit: Edit) -> None:
        _put(draft, (table, *_path(edit)), edit.get("value"))

    return made


def set_in_row(table: str) -> Kind:
    """Kind of edit that sets a key of a row, called by its ``index`` from 0 or its ``name``."""

    def made(draft: Draft, edit: Edit) -> None:
        number, path, value = _row(draft, table, edit), _path(edit), edit.get("value")
        if path == ("name",) and isinstance(value, str):
            _rename(draft, table, draft.data[table][number].get("name"), value)
        _put(draft, (table, number, *path), value)

    return made


def add_to(table: str) -> Kind:
    """Kind of edit that adds a row of ``values``."""

    def made(draft: Draft, edit: Edit) -> None:
        values = wanted(edit, "values", dict)
        draft.change(draft.scene, lambda text: add_row(text, table, values))

    return made


def remove_from(table: str) -> Kind:
    """Kind of edit that takes a row out, called by its ``index`` or ``name``."""

    def made(draft: Draft, edit: Edit) -> None:
        draft.put((table, _row(draft, table, edit)), None)

    return made


def set_panel(draft: Draft, edit: Edit) -> None:
    """Set a key of a panel, such as its material."""
    _put(draft, ("panel", wanted(edit, "panel", str), *_path(edit)), edit.get("value"))


def set_pose(draft: Draft, edit: Edit) -> None:
    """Set where a panel starts."""
    name = wanted(edit, "panel", str)
    for key in ("rotation", "translation_mm"):
        if key in edit:
            draft.put(("placement", name, key), wanted(edit, key, list))
    if "rotation" in edit and "axes" in draft.data["placement"][name]:
        draft.put(("placement", name, "axes"), None)


def set_wire(draft: Draft, edit: Edit) -> None:
    """Set the points of a curve: a wire, or one that edges are pulled to; null takes it out."""
    name, points = wanted(edit, "name", str), edit.get("points_mm")
    file = draft.named("foam", "curves")
    if points is None:
        draft.change(file, lambda text: drop(text, ("curve", name)))
    else:
        draft.change(file, lambda text: put(text, ("curve", name, "points_mm"), points))


def refuse_guess(draft: Draft, edit: Edit) -> None:
    """Note that a guess is wrong, so that it is not shown again."""
    name = wanted(edit, "id", str)
    known = parsed(draft.contents.get(REFUSED, b"")).get("refused", [])
    draft.change(REFUSED, lambda text: put(text, ("refused",), sorted({*known, name})))


def copy_material(draft: Draft, edit: Edit) -> None:
    """Copy a material into the folder, where it can be changed; ``panel`` takes it at once."""
    source, name = wanted(edit, "material", str), wanted(edit, "name", str)
    file = f"{MATERIALS}/{name}.toml"
    if PurePosixPath(name).name != name or name.startswith(".") or file in draft.contents:
        raise InputError.single(
            "material.copy.name", got=repr(name), expected="a new name for a file"
        )
    text = read_text(
        draft.folder.inside(source) if source.endswith(".toml") else material_path(source)
    )
    draft.change(file, lambda _: text)
    for key, value in edit.get("values", {}).items():
        draft.change(file, lambda text, k=key, v=value: put(text, tuple(k.split(".")), v))  # type: ignore[misc]
    if "panel" in edit:
        draft.put(("panel", wanted(edit, "panel", str), "material"), file)


def copy_scene(draft: Draft, edit: Edit) -> None:
    """Keep the scene as it is now in a file beside it, to compare with."""
    name = wanted(edit, "name", str)
    file = f"{name}.toml"
    plain = PurePosixPath(name).name == name and not name.startswith(".")
    if not plain or file in draft.contents or draft.folder.inside(file).exists():
        raise InputError.single("scene.copy.name", got=repr(name), expected="a new name for a file")
    if draft.scene != SCENE:
        raise InputError.single(
            "scene.copy", got=draft.scene, expected=f"a scene in {SCENE}",
            hint="of two scenes with other names neither would be that of the folder",
        )  # fmt: skip
    draft.contents[file] = draft.contents[draft.scene]


def set_material(draft: Draft, edit: Edit) -> None:
    """Set a key of a material of the folder, such as ``["appearance", "roughness"]``."""
    file, path, value = wanted(edit, "file", str), _path(edit), edit.get("value")
    if not file.startswith(f"{MATERIALS}/") or file not in draft.contents:
        raise InputError.single(
            "material.set.file", got=repr(file), expected=f"a file in {MATERIALS}/ of the folder",
            hint="copy the material first",
        )  # fmt: skip
    if value is None:
        draft.change(file, lambda text: drop(text, path))
    else:
        draft.change(file, lambda text: put(text, path, value))


def _put(draft: Draft, key: Key, value: object) -> None:
    """Set or take out a key; to take out what is not there is no fault."""
    if value is None and not _has(draft.data, key):
        return
    draft.put(key, value)


def _has(data: Any, key: Key) -> bool:
    for part in key:
        try:
            data = data[part]
        except (KeyError, IndexError, TypeError):
            return False
    return True


def _path(edit: Edit) -> Key:
    key = edit.get("key")
    parts = key if isinstance(key, list) else [key]
    if not parts or not all(isinstance(p, str | int) and not isinstance(p, bool) for p in parts):
        raise InputError.single(f"{edit['kind']}.key", got=repr(key), expected="a key")
    return tuple(parts)


def _row(draft: Draft, table: str, edit: Edit) -> int:
    rows = draft.data.get(table, [])
    if "name" in edit:
        names = [row.get("name") for row in rows]
        if edit["name"] not in names:
            raise Gone(f"there is no {table} {edit['name']!r} any more")
        return names.index(edit["name"])
    number = wanted(edit, "index", int)
    if not 0 <= number < len(rows):
        raise Gone(f"there is no {table} {number} any more")
    return int(number)


def _rename(draft: Draft, table: str, old: object, new: str) -> None:
    """Change the name of a stage wherever hooks and frames name it."""
    for ties in ("hook", "frame") if table == "stage" else ():
        for k, row in enumerate(draft.data.get(ties, [])):
            if row.get("stage") == old:
                draft.put((ties, k, "stage"), new)
