"""What went into several scenes and is not the same in all of them, key by key."""

from __future__ import annotations

import dataclasses
import hashlib
from collections.abc import Iterator, Mapping
from types import MappingProxyType
from typing import Any

import numpy as np

from seatlook.io.parameter_text import exact, fields_of, file_key
from seatlook.model import Foam, Hook, Limit, Pattern, Scene, Stage, Thread
from seatlook.model.table import Table, number
from seatlook.report.sections.parameters import written

_FEW = 4  # values of an array that are written out
# Settings of a scene, and those of its parts that are named alike in the files.
_SETTINGS = ("smallest_notch", "seed", "curvature", "c_threshold", "hem", "allowed")
_PARTS = MappingProxyType(
    {"stages": "stage", "hooks": "hook", "frames": "frame", "boxes": "zone", "limits": "accept"}
)
# class of a part -> unit of its lengths or times in the files, and the factor to it
_UNITS = MappingProxyType({Stage: ("_s", 1.0), Thread: ("_mm", 1e3), Hook: ("_mm", 1e3)})
_PULL = ("_n", 1.0)
_MATERIAL, _LENGTH = ": material", ": length_mm"
Entry = tuple[str, str, str]  # key, value for a reader, value with every digit


def different_inputs(scenes: Mapping[str, Scene]) -> Table:
    """Keys with another value in one of the scenes: settings, making, pattern, materials, foam.

    Keys are those of the files. Of a pattern the lengths of edges and the sizes of panels stand for
    its outlines. What all panels have in common is one row. Camera, lights and looks are left out.
    """
    found: dict[str, dict[str, tuple[str, str]]] = {}
    for name, scene in scenes.items():
        for key, value, digits in _entries(scene):
            found.setdefault(key, {})[name] = (value, digits)
    rows = [
        (key, *_texts([values.get(name) for name in scenes]))
        for key, values in found.items()
        if len({values[name][1] if name in values else None for name in scenes}) > 1
    ]
    merged = sorted(_merged(rows, _panels(scenes)), key=_order)
    return Table(heads=("input", *scenes), rows=tuple(merged))


def _order(row: tuple[Any, ...]) -> tuple[int, float]:
    """Another material first; among edges the one that changes most; else as they come."""
    key, *values = row
    if key.endswith(_MATERIAL):
        return 0, 0.0
    if not key.endswith(_LENGTH):
        return 1 if not key.startswith(("foam", "panel", "all panels")) else 3, 0.0
    lengths = [float(value) for value in values if value is not None]
    return 2, min(lengths) - max(lengths)


def _texts(values: list[tuple[str, str] | None]) -> Iterator[str | None]:
    """Values for a reader, with every digit where they would look alike."""
    alike = len({value and value[0] for value in values}) == 1
    for value in values:
        yield None if value is None else value[int(alike)]


def _panels(scenes: Mapping[str, Scene]) -> set[str]:
    return {panel.name for scene in scenes.values() for panel in scene.pattern.panels}


def _merged(rows: list[tuple[Any, ...]], panels: set[str]) -> Iterator[tuple[Any, ...]]:
    """One row for all panels that share a change."""

    def what(row: tuple[Any, ...]) -> tuple[Any, ...]:
        owner, _, key = row[0].partition(": ")
        return (key if owner.startswith("panel ") else row[0], *row[1:])

    alike: dict[tuple[Any, ...], list[str]] = {}
    for row in rows:
        alike.setdefault(what(row), []).append(row[0])
    for (key, *values), keys in alike.items():
        owners = [name.partition(": ")[0].removeprefix("panel ") for name in keys]
        if set(owners) == panels and len(panels) > 1:
            yield (f"all panels: {key}", *values)
        elif len(keys) > 1:
            yield (f"panels {', '.join(owners)}: {key}", *values)
        else:
            yield (keys[0], *values)


def _entries(scene: Scene) -> Iterator[Entry]:
    """All of a scene but what is looked at and how, which a comparison takes from the first."""
    for name in (scene.mesh_asked_by, *_SETTINGS):
        yield _leaf(name, getattr(scene, name), name)
    for field, head in _PARTS.items():
        for count, part in enumerate(getattr(scene, field), 1):
            yield from _part(f"{head}.{getattr(part, 'name', count)}", part)
    yield from _part("thread", scene.thread)
    yield from _pattern(scene.pattern)
    for name, size in scene.element_sizes.items():
        yield _leaf(f"panel {name}: element_size", size, "element_size")
    for name, material in scene.materials.items():
        yield f"panel {name}: material", material.name, material.name
        for part in (material.fabric, material.appearance):
            for key, value in fields_of(part):
                yield _leaf(f"panel {name}: {key}", value, key)
        if material.c_threshold is not None:
            yield _leaf(f"panel {name}: c_threshold", material.c_threshold, "c_threshold")
    for name, pose in scene.placement.items():
        text = f"start pose {_mark(np.append(pose.rotation, pose.translation))}"
        yield f"panel {name}: placement", text, text
    yield from _foam(scene.foam)


def _foam(foam: Foam) -> Iterator[Entry]:
    shape = f"{len(foam.faces)} triangles {_mark(foam.vertices, foam.faces)}"
    yield "foam: surface", shape, shape
    for name, curve in foam.curves.items():
        yield _leaf(f"foam curve {name}", curve, "")
    yield "foam: material", foam.material.name, foam.material.name
    for key, value in fields_of(foam.material):
        yield _leaf(f"foam: {key}", value, key)


def _pattern(pattern: Pattern) -> Iterator[Entry]:
    for name in pattern.edges:
        text = f"{1e3 * pattern.edge_length(name):.1f}"
        yield f"edge {name}{_LENGTH}", text, text
    for panel in pattern.panels:
        width, height = 1e3 * np.ptp(panel.outline, axis=0)
        text = f"{width:.1f} x {height:.1f}"
        yield f"panel {panel.name}: size_mm", text, text
    for seam in pattern.seams:
        sewn = f"{seam.a} to {' + '.join(seam.b)}{'' if seam.reverse else ', not reversed'}"
        yield f"seam {seam.name}", sewn, sewn
        yield _leaf(f"seam {seam.name}: pitch_mm", 1e3 * seam.pitch, "")


def _part(head: str, part: Any) -> Iterator[Entry]:
    """A stage, a hook, or what else has a table of its own in a scene."""
    unit = _UNITS.get(type(part), ("_mm", 1e3))
    for field in dataclasses.fields(part):
        value = getattr(part, field.name)
        if field.name == "name" or value is None:
            continue
        measured = isinstance(np.asarray(value).flat[0] if np.size(value) else None, float)
        suffix, factor = _PULL if field.name == "limit" else unit
        if not measured or isinstance(part, Limit) or field.name == "colour":
            suffix, factor = "", 1.0
        yield _leaf(
            f"{head}.{field.name}{suffix}", value if factor == 1.0 else _scaled(value, factor), ""
        )


def _scaled(value: Any, factor: float) -> Any:
    return tuple(factor * v for v in value) if isinstance(value, tuple) else factor * value


def _leaf(key: str, value: Any, name: str) -> Entry:
    """One value under the key that files have for it; ``name`` is the end of the key."""
    known, factor = file_key(name)
    key = key.removesuffix(name) + known
    if isinstance(value, np.ndarray | tuple) and np.size(value) > _FEW:
        text = f"{np.size(value)} values {_mark(np.asarray(value))}"
        return key, text, text
    if isinstance(value, tuple):
        text = ", ".join(map(_item, value)) or "none"
        return key, text, text
    if isinstance(value, float):
        return key, f"{factor * value:.6g}", exact(value, factor)
    return key, written(value, factor), exact(value, factor)


def _item(value: Any) -> str:
    return number(value) if isinstance(value, float) else str(value)


def _mark(*arrays: np.ndarray) -> str:
    """A sign by which a reader tells long rows of numbers apart."""
    digest = hashlib.sha256(b"".join(np.ascontiguousarray(a).tobytes() for a in arrays))
    return f"({digest.hexdigest()[:6]})"


def in_words(table: Table, count: int = 3) -> str:
    """Say in a sentence what differs between two scenes.

    Parameters
    ----------
    table : of two scenes, see :func:`different_inputs`
    count : of the keys that are named; what comes with another material is not
    """
    swapped = {key.removesuffix("material") for key, *_ in _plain(table) if key.endswith(_MATERIAL)}
    named = [
        f"{key.removesuffix(_LENGTH)} {before} → {after}{' mm' if key.endswith(_LENGTH) else ''}"
        for key, before, after in _plain(table)
        if key.endswith((_MATERIAL, "size_mm"))
        or not any(key.startswith(owner) for owner in swapped)
    ]
    if not named:
        return "Nothing that goes in is different."
    more = len(named) - count
    return f"Changed: {'; '.join(named[:count])}{f'; and {more} more' if more > 0 else ''}."


def _plain(table: Table) -> Iterator[tuple[str, str, str]]:
    for key, before, after in table.rows:
        yield str(key), "none" if before is None else str(before), str(after or "none")
