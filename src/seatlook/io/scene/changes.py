"""Values set over those of a file: ``mesh.seed=3``, ``rig.sun.light.0.elevation_deg=20``."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable
from typing import Any

from seatlook.errors import InputError, did_you_mean
from seatlook.io.schema import shown
from seatlook.io.toml import DEEPEST, Document

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
            # A word that is no UTF-8 comes from the command line as half pairs.
            word.encode()
            parsed = tomllib.loads(f"{name} = {value}")
            keys, changed = _path(parsed)
            repr((keys, changed))
        # Beside what is no TOML: numbers that Python does not read, brackets without end.
        except (ValueError, RecursionError):
            continue
        if equals and "\n" not in word and len(keys) <= DEEPEST:
            return keys, changed
    raise _refusal(word, EXPECTED)


def _path(parsed: dict[str, Any]) -> tuple[list[str], Any]:
    """Unwrap ``{a: {b: value}}``; an inline table as the value stays one."""
    keys, node = [], parsed
    while True:
        (name, node), *_ = node.items()
        keys.append(name)
        if not isinstance(node, dict) or len(node) != 1:
            return keys, node


def _refusal(word: str, expected: str, hint: str = "") -> InputError:
    return InputError.single("--set", got=shown(word), expected=expected, hint=hint)


def _put(data: dict[str, Any], keys: list[str], value: Any, word: str) -> None:
    node: Any = data
    before = ""
    for key, following in zip(keys, [*keys[1:], None], strict=True):
        if not isinstance(node, dict | list):
            raise _refusal(word, f"{before} to be a table")
        before = key
        if isinstance(node, list):
            index = _row(node, key, word)
            if following is None:
                node[index] = value
            node = node[index]
        elif following is None:
            node[key] = value
        else:
            node = node.setdefault(key, {})


def _row(rows: list[Any], key: str, word: str) -> int:
    """Find a row by its number or its name."""
    if re.fullmatch("[0-9]{1,9}", key) and int(key) < len(rows):
        return int(key)
    names = [str(row.get("name", "")) if isinstance(row, dict) else "" for row in rows]
    if key in names:
        return names.index(key)
    listed = [name for name in names if name]
    expected = f"a row from 0 to {len(rows) - 1}"
    expected += f", or one of {', '.join(listed)}" if listed else ""
    raise _refusal(word, expected, did_you_mean(key, listed))
