"""Changes of a TOML text in place: what is not touched keeps its bytes, comments and order.

A comment right above a header belongs to the table below it, as people write them.
"""

from __future__ import annotations

import copy
import tomllib
from collections.abc import Mapping, Sequence
from typing import Any

from seatlook.io.toml import Key, Statement, quoted, statements, toml_key


def spelled_value(value: object) -> str:
    """Spell a value as TOML.

    Raises
    ------
    TypeError
        TOML has nothing for it.

    Examples
    --------
    >>> spelled_value([1.5, True, "a", {"b": 2}])
    '[1.5, true, "a", {b = 2}]'
    """
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return repr(int(value))
    if isinstance(value, float):
        return repr(float(value))
    if isinstance(value, str):
        return quoted(value)
    if isinstance(value, Mapping):
        inside = ", ".join(f"{toml_key(str(k))} = {spelled_value(v)}" for k, v in value.items())
        return f"{{{inside}}}"
    if isinstance(value, Sequence):
        return f"[{', '.join(map(spelled_value, value))}]"
    raise TypeError(f"no TOML for {type(value).__name__}")


def put(text: str, key: Key, value: object) -> str:
    r"""Set one key; a table that is not there is added at the end.

    Parameters
    ----------
    key : such as ``("stage", 0, "end_s")``; a row that is named must be there

    Raises
    ------
    KeyError, IndexError
        No such row, or the key goes through a value that is no table.

    Examples
    --------
    >>> put("# one\na = 1 # two\n", ("a",), 3)
    '# one\na = 3 # two\n'
    """
    wanted = copy.deepcopy(tomllib.loads(text))
    _at(wanted, key[:-1], make=True)[key[-1]] = value
    known = list(statements(text))
    for one in known:
        if one.header or one.key != key[: len(one.key)]:
            continue
        inside = wanted
        for part in one.key:
            inside = inside[part]  # type: ignore[index]
        start, end = _value(text, one)
        return _checked(text[:start] + spelled_value(inside) + text[end:], wanted)
    line = f"{toml_key(str(key[-1]))} = {spelled_value(value)}"
    return _checked(_with_line(text, known, key[:-1], line), wanted)


def drop(text: str, key: Key) -> str:
    r"""Take out a key, or a table or row with its tables and the comment right above it.

    Raises
    ------
    KeyError, IndexError
        There is none.

    Examples
    --------
    >>> drop("[[a]]\nb = 1\n# of the second\n[[a]]\nb = 2\n", ("a", 1))
    '[[a]]\nb = 1\n'
    """
    wanted = copy.deepcopy(tomllib.loads(text))
    _remove(wanted, key)
    own = [one for one in statements(text) if one.key[: len(key)] == key]
    for one in reversed(own):
        start = _comment_start(text, one.start) if one.header else one.start
        text = text[:start] + text[one.end :]
        # The empty line between two tables goes with the one that is taken out.
        if one.header and text[:start].endswith(("\n\n", "\n\r\n")):
            text = text[:start] + _without_empty_line(text[start:])
    return _checked(text, wanted)


def add_row(text: str, name: str, values: Mapping[str, object], comment: str = "") -> str:
    r"""Add a row to an array of tables, behind its last one or at the end.

    Examples
    --------
    >>> add_row("[[a]]\nb = 1\n\n[c]\n", "a", {"b": 2})
    '[[a]]\nb = 1\n\n[[a]]\nb = 2\n\n[c]\n'
    """
    wanted = copy.deepcopy(tomllib.loads(text))
    wanted.setdefault(name, []).append(dict(values))
    return _checked(_with_block(text, (name,), f"[[{toml_key(name)}]]", values, comment), wanted)


def add_table(
    text: str, key: Sequence[str], values: Mapping[str, object], comment: str = ""
) -> str:
    r"""Add a table, behind the last one that shares its first name or at the end.

    Raises
    ------
    KeyError
        It is there.

    Examples
    --------
    >>> add_table("[edge.a]\np = 1\n", ("edge", "my b"), {"p": 2})
    '[edge.a]\np = 1\n\n[edge."my b"]\np = 2\n'
    """
    wanted = copy.deepcopy(tomllib.loads(text))
    node = _at(wanted, tuple(key[:-1]), make=True)
    if key[-1] in node:
        raise KeyError(key[-1])
    node[key[-1]] = dict(values)
    header = f"[{'.'.join(map(toml_key, key))}]"
    return _checked(_with_block(text, tuple(key[:1]), header, values, comment), wanted)


def _with_block(
    text: str, family: Key, header: str, values: Mapping[str, object], comment: str
) -> str:
    newline = _newline(text)
    block = [f"# {line}" for line in comment.splitlines()] + [header]
    block += [f"{toml_key(k)} = {spelled_value(v)}" for k, v in values.items()]
    written = newline.join(block) + newline
    last = [one for one in statements(text) if one.key[: len(family)] == family]
    at = last[-1].end if last else len(text)
    before, after = text[:at], text[at:]
    if before and not before.endswith("\n"):
        before += newline
    gap = newline if before.strip() else ""
    return (
        before
        + gap
        + written
        + (newline if after.strip() and after[0] not in "\r\n" else "")
        + after
    )


def _with_line(text: str, known: list[Statement], table: Key, line: str) -> str:
    """Add an assignment behind the last one of a table, which is made if it is not there."""
    newline = _newline(text)
    own = [one for one in known if _table_of(one, known) == table or one.key == table]
    if not own and not table:
        return f"{line}{newline}{text}"
    if not own:
        header = f"[{'.'.join(toml_key(str(part)) for part in table)}]"
        gap = "" if not text.strip() else newline if text.endswith("\n") else 2 * newline
        return f"{text}{gap}{header}{newline}{line}{newline}"
    at = own[-1].end
    before = text[:at] if text[:at].endswith("\n") else text[:at] + newline
    return f"{before}{line}{newline}{text[at:]}"


def _table_of(statement: Statement, known: list[Statement]) -> Key | None:
    """Key of the header above an assignment; None of a header."""
    if statement.header:
        return None
    above = [one.key for one in known if one.header and one.start < statement.start]
    return above[-1] if above else ()


def _value(text: str, statement: Statement) -> tuple[int, int]:
    """Offsets of the value of an assignment, without what surrounds it."""
    chunk = text[statement.start : statement.end]
    equals = next(k for k in _equals(chunk) if _parses(chunk[:k]))
    start = equals + 1 + len(chunk[equals + 1 :]) - len(chunk[equals + 1 :].lstrip(" \t"))
    # A comment is the shortest tail without which the value stays what it is.
    ends = [k for k, mark in enumerate(chunk) if mark == "#" and k > start]
    for end in ends:
        if _same(chunk[:end], statement.parsed):
            return statement.start + start, statement.start + len(chunk[:end].rstrip())
    return statement.start + start, statement.start + len(chunk.rstrip())


def _equals(chunk: str) -> list[int]:
    return [k for k, mark in enumerate(chunk) if mark == "="]


def _parses(key: str) -> bool:
    try:
        tomllib.loads(f"{key}= 0")
    except tomllib.TOMLDecodeError:
        return False
    return True


def _same(chunk: str, parsed: dict[str, Any]) -> bool:
    try:
        return tomllib.loads(chunk) == parsed
    except tomllib.TOMLDecodeError:
        return False


def _comment_start(text: str, at: int) -> int:
    """Start of the comment lines right above a place."""
    while at > 0:
        line = text.rfind("\n", 0, at - 1) + 1
        if not text[line:at].lstrip().startswith("#"):
            break
        at = line
    return at


def _without_empty_line(text: str) -> str:
    for empty in ("\r\n", "\n"):
        if text.startswith(empty):
            return text[len(empty) :]
    return text


def _newline(text: str) -> str:
    return "\r\n" if "\r\n" in text else "\n"


def _at(data: Any, key: Key, *, make: bool = False) -> Any:
    for part in key:
        if make and isinstance(data, dict) and isinstance(part, str):
            data = data.setdefault(part, {})
        else:
            data = data[part]
    if not isinstance(data, dict):
        raise KeyError(key)
    return data


def _remove(data: Any, key: Key) -> None:
    """Take a key out of parsed data, and the array that it leaves without rows."""
    for part in key[:-1]:
        data = data[part]
    del data[key[-1]]


def _checked(text: str, wanted: dict[str, Any]) -> str:
    """The text, if it says what is wanted; an array without rows is as none."""
    if _plain(tomllib.loads(text)) != _plain(wanted):
        raise ValueError("the text is written in a way that cannot be changed in place")
    return text


def _plain(value: Any) -> Any:
    if isinstance(value, Mapping):
        return {key: _plain(one) for key, one in value.items() if one not in ([], {}, ())}
    if isinstance(value, list | tuple):
        return [_plain(one) for one in value]
    return value
