"""TOML with line numbers: every problem of a file is found and named ``file:line: key``."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

from seatlook.errors import InputError, Problem

Key = tuple[str | int, ...]

_STRINGS_AND_COMMENTS = re.compile(r'"(?:\\.|[^"\\])*"|\'[^\']*\'|#.*')


@dataclass
class Document:
    """A parsed TOML file and the problems found in it so far."""

    file: Path
    content: bytes
    data: dict[str, Any]
    problems: list[Problem] = field(default_factory=list)

    @cached_property
    def lines(self) -> dict[Key, int]:
        """Key -> line; only messages need it, and it takes longer than parsing."""
        return index_lines(self.content.decode())

    def line(self, key: Key) -> int | None:
        """Return the line of ``key``, or of the innermost table around it that has one."""
        for length in range(len(key), 0, -1):
            if key[:length] in self.lines:
                return self.lines[key[:length]]
        return None

    def report(self, key: Key, got: object, expected: str, hint: str = "") -> None:
        """Note one problem."""
        self.problems.append(
            Problem(
                key=spelled(key),
                got=str(got),
                expected=expected,
                file=self.file,
                line=self.line(key),
                hint=hint,
            )
        )

    @contextmanager
    def blame(self, key: Key) -> Iterator[None]:
        """Note the problems raised inside; those without a file are those of ``key``."""
        try:
            yield
        except InputError as error:
            self.note(key, error)

    def note(self, key: Key, error: InputError) -> None:
        """Note the problems of ``error``; those without a file are those of ``key``."""
        for p in error.problems:
            if p.file is None:
                self.report((*key, p.key), p.got, p.expected, p.hint)
            else:
                self.problems.append(p)

    def finish(self) -> None:
        """Raise everything noted so far.

        Raises
        ------
        InputError
            When there is any problem.
        """
        if self.problems:
            raise InputError(sorted(self.problems, key=lambda p: (str(p.file), p.line or 0)))


def spelled(key: Key) -> str:
    """Spell a key as users write it.

    Examples
    --------
    >>> spelled(("rig", 1, "light", 0, "kind"))
    'rig[1].light[0].kind'
    """
    text = ""
    for part in key:
        text += f"[{part}]" if isinstance(part, int) else f".{part}" if text else part
    return text


def quoted(text: str) -> str:
    r"""Spell a text as a TOML string.

    Examples
    --------
    >>> print(quoted('left "A"'))
    "left \"A\""
    """
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    escaped = "".join(c if c >= " " and c != "\x7f" else f"\\u{ord(c):04x}" for c in escaped)
    return f'"{escaped}"'


def toml_key(name: str) -> str:
    """Spell a name as one part of a TOML key: bare where it may be.

    Examples
    --------
    >>> toml_key("INSERT"), toml_key("my insert")
    ('INSERT', '"my insert"')
    """
    bare = name.isascii() and name.replace("-", "").replace("_", "").isalnum()
    return name if bare else quoted(name)


def read_document(path: Path) -> Document:
    """Read and parse a TOML file.

    Raises
    ------
    InputError
        When the file is absent, not UTF-8 or not TOML; the message carries the line.
    """
    content = read_file(path)
    try:
        data = tomllib.loads(content.decode())
    except UnicodeDecodeError as error:
        line = content[: error.start].count(b"\n") + 1
        raise InputError.single(
            "encoding",
            got=f"byte {content[error.start]:#x}",
            expected="UTF-8",
            file=path,
            line=line,
        ) from error
    except tomllib.TOMLDecodeError as error:
        place = re.search(r"\(at line (\d+), column (\d+)\)", str(error))
        # An error at the end of the file is reported without a line.
        line = int(place[1]) if place else content.count(b"\n") + 1
        what = re.sub(r"\s*\(at .*\)$", "", str(error))
        raise InputError.single(
            "syntax", got=what.lower(), expected="valid TOML", file=path, line=line
        ) from error
    return Document(file=path, content=content, data=data)


def read_file(path: Path, *, named_by: Key = ("file",)) -> bytes:
    """Return the content of a file that must exist."""
    try:
        return path.read_bytes()
    except FileNotFoundError as error:
        raise InputError.single(
            spelled(named_by), got="no such file", expected="a file", file=path
        ) from error
    except OSError as error:
        raise InputError.single(
            spelled(named_by), got=error.strerror, expected="a readable file", file=path
        ) from error


def index_lines(text: str) -> dict[Key, int]:
    r"""Return the line (from 1) on which each key of a valid TOML text is set.

    Examples
    --------
    >>> index_lines("a = 1\n[[rig]]\nname = 'sun'\n[rig.sky]\n")[("rig", 0, "name")]
    3
    """
    lines: dict[Key, int] = {}
    rows: dict[Key, int] = {}
    table: Key = ()
    for first, parsed, is_header in _statements(text):
        if is_header:
            table = _open_table(parsed, rows)
            lines.setdefault(table, first)
        else:
            for key in _keys(parsed):
                lines[(*table, *key)] = first
    return lines


def _statements(text: str) -> Iterator[tuple[int, dict[str, Any], bool]]:
    """Cut a valid text into headers and assignments: the shortest runs of lines that parse."""
    chunk, first, depth = "", 0, 0
    for number, line in enumerate(text.splitlines(keepends=True), start=1):
        bare = _STRINGS_AND_COMMENTS.sub("", line).strip()
        if not chunk and not bare:
            continue
        first = first if chunk else number
        chunk += line
        depth += sum(map(bare.count, "[{")) - sum(map(bare.count, "]}"))
        # Parsing every prefix of a long array would take quadratic time.
        if depth > 0 and not ('"""' in chunk or "'''" in chunk):
            continue
        try:
            parsed = tomllib.loads(chunk)
        except tomllib.TOMLDecodeError:
            continue
        yield first, parsed, chunk.lstrip().startswith("[")
        chunk, depth = "", 0


def _open_table(parsed: dict[str, Any], rows: dict[Key, int]) -> Key:
    """Return the full key of a header; ``rows`` counts the tables of each array of tables."""
    key: Key = ()
    node: Any = parsed
    while node:
        name, node = next(iter(node.items()))
        key = (*key, name)
        if isinstance(node, list):
            rows[key] = rows.get(key, 0) + 1
            node = node[0]
        if key in rows:
            key = (*key, rows[key] - 1)
    return key


def _keys(node: Any, at: Key = ()) -> Iterator[Key]:
    if at:
        yield at
    children: Any = ()
    if isinstance(node, dict):
        children = node.items()
    elif isinstance(node, list):
        children = enumerate(node)
    for name, child in children:
        if isinstance(node, dict) or isinstance(child, dict):
            yield from _keys(child, (*at, name))
