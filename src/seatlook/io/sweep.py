"""The sweep file: a scene, values to go through, and tolerances to draw from.

See docs/how-to/sweep.md.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import Any, Literal

from seatlook.files import reader
from seatlook.io.schema import Integer, Kind, Number, Rows, Table, Text, Texts, read_table, shown
from seatlook.io.toml import Document, quoted, read_document

# What may be irregular, with its unit; ``of`` names a seam, a curve of the foam, or nothing.
KINDS = ("seam_offset_mm", "ease_percent", "hook_depth_mm", "foam_mm")
Distribution = Literal["normal", "uniform"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Tolerance:
    """One input of the irregularity study.

    Parameters
    ----------
    kind : one of ``KINDS``; the unit of ``spread`` is in its name
    of : name of a seam (offset, ease) or of a curve of the foam (hook depth)
    spread : standard deviation of ``normal`` (cut at 3), half width of ``uniform``
    """

    name: str
    kind: str
    of: str | None
    distribution: Distribution
    spread: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Sweep:
    """What a sweep file says.

    Parameters
    ----------
    variants : name -> (scene file, changes): patterns, foams, whatever is not one key
    axes : key of the scene -> TOML texts of its values
    textures, rigs : what each cell draws; nothing where either is empty
    draws : number of irregular covers per cell, with ``seed``; 0 without [irregularity]
    """

    path: Path
    variants: MappingProxyType[str, tuple[Path, tuple[str, ...]]]
    axes: MappingProxyType[str, tuple[str, ...]]
    textures: tuple[str, ...]
    rigs: tuple[str, ...]
    draws: int
    seed: int
    inputs: tuple[Tolerance, ...]


@dataclass(frozen=True, slots=True)
class _Free:
    """A table under keys of the scene's own; checked when the scene is read."""

    required: bool = False

    def read(self, document: Document, key: Any, value: Any) -> dict[str, Any]:
        if isinstance(value, dict):
            return value
        document.report(key, shown(value), "a table")
        return {}


_KEYS: dict[str, Kind] = {
    "schema": Integer(low=1, high=1, required=True),
    "scene": Text(required=True),
    "variant": Rows(Table({"name": Text(required=True), "scene": Text(), "set": Texts()})),
    "axis": _Free(),
    "draw": Table({"textures": Texts(), "rigs": Texts()}),
    "irregularity": Table(
        {
            "draws": Integer(low=2, high=100_000, required=True),
            "seed": Integer(default=0),
            "input": Rows(
                Table(
                    {
                        "name": Text(required=True),
                        "kind": Text(choices=KINDS, required=True),
                        "of": Text(),
                        "distribution": Text(choices=("normal", "uniform"), default="normal"),
                        "spread": Number(low=1e-9, high=1e3, required=True),
                    }
                ),
                required=True,
            ),
        }
    ),
}


@reader("a sweep file")
def read_sweep(path: Path) -> Sweep:
    """Read a sweep file.

    Raises
    ------
    InputError
        With all problems of the file; those of the scenes it names come when cells are made.
    """
    document = read_document(path)
    row = read_table(document, _KEYS)
    axes = _axes(document, row.get("axis") or {})
    scenes = {name: path.parent / (name or "") for name in _scene_names(row)}
    for name, file in scenes.items():
        if name is not None and not file.is_file():
            document.report(("scene",), shown(name), "a file", f"there is none at {file}")
    irregular = row["irregularity"] if "irregularity" in document.data else None
    inputs = tuple(Tolerance(**values) for values in (irregular["input"] if irregular else ()))
    for number, value in enumerate(inputs):
        if value.kind is not None and (value.of is None) != (value.kind == "foam_mm"):
            expected = "nothing" if value.kind == "foam_mm" else "a seam or curve"
            document.report(("irregularity", "input", number, "of"), shown(value.of), expected)
    document.finish()
    variants = {
        v["name"]: (path.parent / (v["scene"] or row["scene"]), tuple(v["set"] or ()))
        for v in row["variant"]
    }
    return Sweep(
        path=path,
        variants=MappingProxyType(variants or {"": (path.parent / row["scene"], ())}),
        axes=MappingProxyType(axes),
        textures=tuple(row["draw"]["textures"] or ()),
        rigs=tuple(row["draw"]["rigs"] or ()),
        draws=irregular["draws"] if irregular else 0,
        seed=irregular["seed"] if irregular else 0,
        inputs=inputs,
    )


def _scene_names(row: Mapping[str, Any]) -> set[str | None]:
    return {row["scene"], *(v["scene"] for v in row["variant"])}


def _axes(document: Document, table: Mapping[str, Any]) -> dict[str, tuple[str, ...]]:
    """Values of each axis, spelled as TOML."""
    axes = {}
    for key, values in table.items():
        if isinstance(values, list) and values and all(_plain(v) for v in values):
            axes[key] = tuple(_toml(v) for v in values)
        else:
            document.report(
                ("axis", key), shown(values), 'a list of values, as "mesh.seed" = [0, 1]'
            )
    return axes


def _plain(value: Any) -> bool:
    return isinstance(value, str | int | float)


def _toml(value: str | float) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    return quoted(value) if isinstance(value, str) else repr(value)
