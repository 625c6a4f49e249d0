"""What belongs to an entry: each kind is read as it will be used, and brings what it names."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from seatlook import io
from seatlook.errors import InputError
from seatlook.io.material import materials_dir
from seatlook.io.pattern.seams import READERS as PATTERNS
from seatlook.io.scene.files import SceneFiles
from seatlook.io.scene.keys import scene_keys
from seatlook.io.scene.read import scene_files
from seatlook.io.scene.views import make_rigs
from seatlook.io.schema import read_table, shown
from seatlook.io.surface.formats import READERS as SURFACES
from seatlook.io.surface.formats import named_files
from seatlook.io.texture_maps import map_files
from seatlook.io.toml import Document, Key, read_document
from seatlook.io.toml_edit import add_row, add_table
from seatlook.library.entry import KINDS, Part, content_digest, file_names_below

Paths = Sequence[Path]
RESULT = "result.npz"


@dataclass(frozen=True, slots=True)
class Gathered:
    """Files of an entry to be.

    Parameters
    ----------
    main : the file to begin with
    files : all, with their contents where they are not those of the file
    parts : what they need and do not bring
    """

    main: Path
    files: Mapping[Path, bytes | None]
    parts: tuple[Part, ...] = field(default=())

    @property
    def named(self) -> dict[str, Path | bytes]:
        """Name in the entry -> file or content; folders between them stay as they were."""
        folder = Path(os.path.commonpath([path.parent for path in self.files]))
        return {
            path.relative_to(folder).as_posix(): path if content is None else content
            for path, content in self.files.items()
        }

    @property
    def main_name(self) -> str:
        """Name of the main file in the entry."""
        folder = Path(os.path.commonpath([path.parent for path in self.files]))
        return self.main.relative_to(folder).as_posix()


def gather(paths: Paths, kind: str | None = None) -> tuple[str, Gathered]:
    """Read files as what they are, and find all that they need.

    Parameters
    ----------
    paths : the main file first, or the folder of a run
    kind : one of ``KINDS``; seen from the main file if not given

    Returns
    -------
    kind, gathered

    Raises
    ------
    InputError
        The files cannot be read as this kind; a name in them is bound to this machine.
    """
    given = [Path(os.path.abspath(path)) for path in paths]  # noqa: PTH100 -- links keep their names
    kind = _kind(given[0]) if kind is None else kind
    return kind, _GATHER[kind](given)


def _kind(main: Path) -> str:
    suffix = main.suffix.lower()
    if main.is_dir() or suffix == ".npz":
        return "result"
    if suffix in PATTERNS or suffix in SURFACES:
        return "pattern" if suffix in PATTERNS else "foam"
    data = read_document(main).data if suffix == ".toml" else {}
    if "pattern" in data and "foam" in data:
        return "seat"
    for table, kind in (("fabric", "material"), ("foam", "material"), ("rig", "rig")):
        if table in data:
            return kind
    if "accept" in data:
        return "limits"
    raise InputError.single(
        "kind", got="a file of none", expected=f"one of {', '.join(KINDS)}", file=main,
        hint="say which with --kind",
    )  # fmt: skip


def _seat(paths: Paths) -> Gathered:
    main, supplied = paths[0], materials_dir()
    document = read_document(main)
    _refuse_absolute(document, (), document.data)
    document.finish()
    files = scene_files(main)
    parts = {
        path: Part("material", path.stem, content_digest({path.name: path}))
        for path in files
        if path.parent == supplied
    }
    own = [_plain(path) for path in files if path not in parts]
    return Gathered(main, dict.fromkeys([*own, *paths]), tuple(parts.values()))


def _pattern(paths: Paths) -> Gathered:
    seams = [path for path in paths[1:] if path.suffix.lower() == ".toml"]
    if len(seams) > 1:
        raise InputError.single("files", got=f"{len(seams)} of seams", expected="one")
    if seams:
        io.read_pattern(paths[0], seams[0])
    else:
        io.read_panels(paths[0])
    return Gathered(paths[0], dict.fromkeys(paths))


def _foam(paths: Paths) -> Gathered:
    io.read_foam_surface(paths[0])
    for path in paths[1:]:
        if path.suffix.lower() == ".toml":
            io.read_curves(path)
    return Gathered(paths[0], dict.fromkeys([*paths, *map(_plain, named_files(paths[0]))]))


def _material(paths: Paths) -> Gathered:
    main = paths[0]
    if "foam" in read_document(main).data:
        io.read_foam_material(main)
        return Gathered(main, dict.fromkeys(paths))
    maps = io.read_material(main).appearance.maps
    used = () if maps is None else map_files(main.parent / maps.folder).values()
    return Gathered(main, dict.fromkeys([*paths, *map(_plain, used)]))


def _rig(paths: Paths) -> Gathered:
    main, content = paths[0], None
    document = read_document(main)
    rows = document.data.get("rig")
    if [*document.data] != ["rig"] and isinstance(rows, list):
        text = ""
        for row in rows:
            text = add_row(text, "rig", row)
        content, document.data = text.encode(), {"rig": rows}
    _refuse_absolute(document, ("rig",), document.data.get("rig"))
    files = SceneFiles(document)
    make_rigs(document, read_table(document, {"rig": scene_keys()["rig"]})["rig"], files)
    document.finish()
    return Gathered(main, {main: content, **dict.fromkeys(map(_plain, files.paths))})


def _limits(paths: Paths) -> Gathered:
    main, content = paths[0], None
    document = read_document(main)
    zones = document.data.get("accept")
    if not isinstance(zones, dict) or not zones:
        document.report(("accept",), "nothing", "limits: [accept.A] for boxes of class A")
        document.finish()
        return Gathered(main, {})
    if [*document.data] != ["accept"]:
        text = ""
        for zone, row in zones.items():
            text = add_table(text, ("accept", zone), row)
        content, document.data = text.encode(), {"accept": zones}
    read_table(document, {"accept": scene_keys()["accept"]})
    document.finish()
    return Gathered(main, {main: content})


def _result(paths: Paths) -> Gathered:
    main = paths[0]
    if not main.is_dir():
        io.read_result(main)
        return Gathered(main, dict.fromkeys(paths))
    io.read_result(main / RESULT)
    names = file_names_below(main, main)
    return Gathered(main / RESULT, dict.fromkeys([*(main / name for name in names), *paths[1:]]))


_GATHER: dict[str, Callable[[Paths], Gathered]] = {
    "seat": _seat,
    "pattern": _pattern,
    "foam": _foam,
    "material": _material,
    "rig": _rig,
    "limits": _limits,
    "result": _result,
}


def _plain(path: Path) -> Path:
    return Path(os.path.abspath(path))  # noqa: PTH100 -- links keep their names


def _refuse_absolute(document: Document, key: Key, value: Any) -> None:
    """Report names of files that hold on this machine only."""
    items: Iterable[tuple[str | int, Any]] = ()
    if isinstance(value, Mapping):
        items = value.items()
    elif isinstance(value, list):
        items = enumerate(value)
    for name, one in items:
        _refuse_absolute(document, (*key, name), one)
    if (isinstance(value, str) and value.startswith(("/", "\\\\"))) or _has_drive(value):
        document.report(
            key, shown(value), "a path seen from the file", "others have no such folder"
        )


def _has_drive(value: object) -> bool:
    return isinstance(value, str) and value[1:3] in (":\\", ":/") and value[0].isalpha()
