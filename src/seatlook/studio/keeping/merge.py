"""Two changes of the same files put together, where they do not touch the same things."""

from __future__ import annotations

import difflib
from collections.abc import Iterator, Mapping
from typing import Any

from seatlook.studio.folder import parsed

Path = tuple[str | int, ...]
Values = dict[Path, Any]
_NONE = object()


def changed(before: Mapping[str, bytes | None], after: Mapping[str, bytes | None]) -> Values:
    """What keys of TOML files are set anew, by path; rows are called by their names.

    Examples
    --------
    >>> changed({"a.toml": b"x = 1"}, {"a.toml": b"x = 2"})
    {('a.toml', 'x'): 2}
    """
    old, new = _flat(before), _flat(after)
    return {
        path: new.get(path)
        for path in {**old, **new}
        if old.get(path, _NONE) != new.get(path, _NONE)
    }


def touching(one: Values, two: Values) -> list[Path]:
    """Paths that both change, also where one changes what the other's is in."""
    heads = {path[:k] for path in two for k in range(len(path) + 1)}
    return [path for path in one if path in heads or any(path[:k] in two for k in range(len(path)))]


def merged(base: bytes | None, mine: bytes | None, theirs: bytes | None) -> bytes | None:
    r"""Put two changes of a text together, line by line.

    Raises
    ------
    ValueError
        They change the same lines.

    Examples
    --------
    >>> merged(b"a\nb\nc\n", b"A\nb\nc\n", b"a\nb\nC\n")
    b'A\nb\nC\n'
    """
    if mine == theirs or theirs == base:
        return mine
    if mine == base:
        return theirs
    if base is None or mine is None or theirs is None:
        raise ValueError("a file is gone on one side")
    lines = base.splitlines(keepends=True)
    own, other = _hunks(lines, mine), _hunks(lines, theirs)
    for start, end, _ in own:
        if any(start <= last and first <= end for first, last, _ in other):
            raise ValueError("both change the same lines")
    for start, end, new in sorted([*own, *other], reverse=True, key=lambda hunk: hunk[0]):
        lines[start:end] = new
    return b"".join(lines)


def _hunks(lines: list[bytes], text: bytes) -> list[tuple[int, int, list[bytes]]]:
    new = text.splitlines(keepends=True)
    matcher = difflib.SequenceMatcher(None, lines, new, autojunk=False)
    return [(a, b, new[c:d]) for tag, a, b, c, d in matcher.get_opcodes() if tag != "equal"]


def _flat(contents: Mapping[str, bytes | None]) -> Values:
    values: Values = {}
    for name, content in contents.items():
        values.update(_leaves(parsed(content or b""), (name,)))
    return values


def _leaves(node: Any, at: Path) -> Iterator[tuple[Path, Any]]:
    if isinstance(node, dict) and node:
        for key, value in node.items():
            yield from _leaves(value, (*at, key))
    elif isinstance(node, list) and node and all(isinstance(row, dict) for row in node):
        seen: dict[str | int, int] = {}
        for number, row in enumerate(node):
            name = row.get("name", number)
            name = name if isinstance(name, str) else number
            seen[name] = seen.get(name, 0) + 1
            yield from _leaves(row, (*at, name, seen[name]))
    else:
        yield at, node
