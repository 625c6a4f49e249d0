"""Values set over those of a file: ``mesh.seed=3``, ``rig.sun.light.0.elevation_deg=20``."""

from __future__ import annotations

import tomllib
from collections.abc import Iterable
from typing import Any

from seatlook.errors import InputError, did_you_mean
from seatlook.io.toml import Document

EXPECTED = "KEY=VALUE, such as mesh.seed=3 or rig.sun.ev100=14"


def change(document: Document, words: Iterable[str]) -> None:
    """Set keys of a parsed document before it is read; its content tells the changes.

    Parameters
    ----------
    words : ``KEY=VALUE`` with KEY in TOML's dotted spelling; a row of an array of tables is named
        by its number, from 0, or by its ``name``. What is no TOML value is a text.

    Raises
    ------
    InputError
        A word of another shape, or a row that does not exist. Unknown keys and values of a wrong
        type are found when the document is read, with the file's own.
    """
    for word in words:
        keys, value = _parsed(word)
        _put(document.data, keys, value, word)
        # The digest of a scene is that of its content, so another value is another scene.
        document.content += f"\n# set {word}".encode()


def _parsed(word: str) -> tuple[list[str], Any]:
    name, equals, text = word.partition("=")
    for value in (text, f'"{text}"'):
        try:
            parsed = tomllib.loads(f"{name} = {value}")
        except tomllib.TOMLDecodeError:
            continue
        if equals and "\n" not in word:
            return _path(parsed)
    raise InputError.single("--set", got=repr(word), expected=EXPECTED)


def _path(parsed: dict[str, Any]) -> tuple[list[str], Any]:
    """Unwrap ``{a: {b: value}}``; an inline table as the value stays one."""
    keys, node = [], parsed
    while True:
        (name, node), *_ = node.items()
        keys.append(name)
        if not isinstance(node, dict) or len(node) != 1:
            return keys, node


def _put(data: dict[str, Any], keys: list[str], value: Any, word: str) -> None:
    node: Any = data
    for key, following in zip(keys, [*keys[1:], None], strict=True):
        if isinstance(node, list):
            index = _row(node, key, word)
            if following is None:
                node[index] = value
            node = node[index]
        elif following is None:
            node[key] = value
        elif isinstance(node.get(key), dict | list):
            node = node[key]
        elif key in node:
            raise InputError.single("--set", got=repr(word), expected=f"{key} to be a table")
        else:
            node[key] = {}
            node = node[key]


def _row(rows: list[Any], key: str, word: str) -> int:
    """Find a row by its number or its name."""
    if key.isdigit() and int(key) < len(rows):
        return int(key)
    names = [str(row.get("name", "")) if isinstance(row, dict) else "" for row in rows]
    if key in names:
        return names.index(key)
    listed = [name for name in names if name]
    raise InputError.single(
        "--set",
        got=repr(word),
        expected=f"a row from 0 to {len(rows) - 1}"
        + (f", or one of {', '.join(listed)}" if listed else ""),
        hint=did_you_mean(key, listed),
    )
