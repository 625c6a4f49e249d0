"""The result file: one ``.npz`` from which a run is drawn, mapped or continued without solving.

Arrays are stored under the path of the field that holds them (``positions``, ``cover.faces``,
``cover.stitchings.0.a.weights``); everything else is one JSON text, ``meta``. Only the core types
listed here are ever built from it, and nothing is unpickled, so a file from elsewhere can do no
harm.
"""

from __future__ import annotations

import dataclasses
import functools
import json
from collections.abc import Mapping
from pathlib import Path
from types import MappingProxyType, UnionType
from typing import Any, Literal, Union, get_args, get_origin, get_type_hints

import numpy as np

from seatlook.errors import InputError
from seatlook.files import reader
from seatlook.io.npz import Arrays, read_npz, write_npz
from seatlook.io.schema import shown
from seatlook.model import (
    Anchor,
    Appearance,
    Cover,
    Criteria,
    Curve,
    Fabric,
    Foam,
    FoamMaterial,
    Hem,
    Hysteresis,
    Material,
    Points,
    SeamKind,
    Solution,
    Stage,
    Stitching,
    TextureMaps,
    Thread,
    Wire,
)

FORMAT = "seatlook result"
FORMAT_VERSION = 1
_WHOLE = "a whole result file of seatlook"

_TYPES: dict[str, type] = {
    t.__name__: t
    for t in (
        Anchor, Appearance, Cover, Criteria, Curve, Fabric, Foam, FoamMaterial, Hem, Hysteresis,
        Material, Points, SeamKind, Solution, Stage, Stitching, TextureMaps, Thread, Wire,
    )
}  # fmt: skip


def write_result(solution: Solution, path: Path | str) -> None:
    """Write a solution, its cover, materials and foam included; the same one, the same bytes.

    Examples
    --------
    >>> write_result(solution, "out/result.npz")                # doctest: +SKIP
    >>> read_result("out/result.npz").status                    # doctest: +SKIP
    'converged'
    """
    arrays: dict[str, Any] = {}
    tree = _packed(solution, "", arrays)
    meta = {"format": FORMAT, "format_version": FORMAT_VERSION, "solution": tree}
    write_npz({"meta": np.array(json.dumps(meta)), **arrays}, Path(path))


@reader("a whole result file of seatlook")
def read_result(path: Path | str) -> Solution:
    """Read a solution back exactly, to the last bit.

    Raises
    ------
    InputError
        When the file is absent, cut short, damaged, no result of seatlook, or of a newer version.
    """
    path = Path(path)
    arrays = read_npz(path, expected=_WHOLE)
    meta = _meta(path, arrays)
    try:
        solution = _unpacked(meta["solution"], arrays, {})
    # What a tree that is no solution ends in; recursion: lists in lists in lists.
    except InputError as error:
        raise InputError(dataclasses.replace(p, file=path) for p in error.problems) from error
    except (KeyError, TypeError, ValueError, AttributeError, RecursionError) as error:
        raise _refusal(path, f"{type(error).__name__}: {error}") from error
    if not isinstance(solution, Solution):
        raise _refusal(path, type(solution).__name__)
    return solution


def _meta(path: Path, arrays: Arrays) -> dict[str, Any]:
    """Take ``meta`` out of the arrays and check whose file it is."""
    try:
        meta: dict[str, Any] = json.loads(str(arrays.pop("meta")))
        name, version = meta["format"], meta["format_version"]
    except (KeyError, TypeError, ValueError, RecursionError) as error:
        raise _refusal(path, f"{type(error).__name__}: {error}") from error
    if name != FORMAT:
        raise _refusal(path, f"format {shown(name)}")
    if isinstance(version, int) and version > FORMAT_VERSION:
        raise InputError.single(
            "format_version", got=version, expected=f"at most {FORMAT_VERSION}", file=path,
            hint="the file was written by a newer seatlook",
        )  # fmt: skip
    if version != FORMAT_VERSION:
        raise _refusal(path, f"version {shown(version)}")
    return meta


def _refusal(path: Path, got: str) -> InputError:
    return InputError.single("file", got=got, expected=_WHOLE, file=path)


def _packed(value: Any, at: str, arrays: dict[str, Any]) -> Any:
    """Turn a value into JSON, moving its arrays to ``arrays`` under their path."""
    here = f"{at}." if at else ""
    if isinstance(value, np.ndarray):
        # Panels of one material share its maps, which are large.
        at = next((name for name, other in arrays.items() if other is value), at)
        # A name of the user's may be none for a file, or that of another array.
        if not at.isprintable() or arrays.get(at, value) is not value:
            at = f"array {len(arrays)}"
        arrays[at] = value
        return {"array": at}
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        name = type(value).__name__
        if _TYPES.get(name) is not type(value):
            raise TypeError(f"{at}: {name} has no place in a result file")
        names = [f.name for f in dataclasses.fields(value)]
        return {"type": name} | {n: _packed(getattr(value, n), here + n, arrays) for n in names}
    if isinstance(value, Mapping):
        return {"map": {str(k): _packed(v, f"{here}{k}", arrays) for k, v in value.items()}}
    if isinstance(value, tuple | list):
        return [_packed(v, f"{here}{i}", arrays) for i, v in enumerate(value)]
    if isinstance(value, np.generic):
        return value.item()
    if value is None or isinstance(value, str | bool | int | float):
        return value
    raise TypeError(f"{at}: {type(value).__name__} has no place in a result file")


def _unpacked(node: Any, arrays: Mapping[str, Any], maps: dict[str, Any]) -> Any:
    """Build the value again; lists become tuples, as all sequences of the core types are.

    ``maps``: the texture maps built so far, so that panels share them again.
    """
    if isinstance(node, list):
        return tuple(_unpacked(v, arrays, maps) for v in node)
    if not isinstance(node, dict):
        return node
    if "array" in node:
        return arrays[node["array"]]
    if "map" in node:
        return MappingProxyType({k: _unpacked(v, arrays, maps) for k, v in node["map"].items()})
    fields = {k: _unpacked(v, arrays, maps) for k, v in node.items() if k != "type"}
    kind = _TYPES[node["type"]]
    for name, hint in _hints(kind).items():
        if name in fields and not _fits(fields[name], hint):
            got, expected = shown(fields[name]), getattr(hint, "__name__", str(hint))
            raise InputError.single(f"{kind.__name__}.{name}", got=got, expected=expected)
    value = kind(**fields)
    return maps.setdefault(json.dumps(node), value) if isinstance(value, TextureMaps) else value


@functools.cache
def _hints(kind: type) -> dict[str, Any]:
    """Types of the fields of a core type."""
    return get_type_hints(kind)


def _fits(value: Any, hint: Any) -> bool:
    """Whether a value that was read is of the type that a field has."""
    origin, inner = get_origin(hint), get_args(hint)
    if origin in (Union, UnionType):
        return any(_fits(value, one) for one in inner)
    if origin is Literal:
        return value in inner
    if origin is tuple:
        length = len(value) if isinstance(value, tuple) else -1
        each = inner[:1] * length if inner[1:] == (...,) else inner
        return length == len(each) and all(map(_fits, value, each))
    if origin is MappingProxyType:
        return isinstance(value, MappingProxyType) and all(
            _fits(v, inner[1]) for v in value.values()
        )
    if hint is float:
        return isinstance(value, float | int) and not isinstance(value, bool)
    if hint is int:
        return isinstance(value, int) and not isinstance(value, bool)
    return isinstance(value, origin or hint)
