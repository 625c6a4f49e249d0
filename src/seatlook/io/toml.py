"""TOML with line numbers: every problem of a file is found and named ``file:line: key``."""

from __future__ import annotations

import re
import sys
import tomllib
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any, NamedTuple

from seatlook.errors import InputError, Problem, did_you_mean
from seatlook.files import LARGEST_TEXT, decoded, read_file

Key = tuple[str | int, ...]

# What tells where a statement ends, and the strings and comments that may hold the same marks.
_TOKENS = re.compile(
    r'''"""(?:\\.|[^\\])*?"{3,5}|\'{3}.*?\'{3,5}|"(?:\\.|[^"\\\n])*"|'[^'\n]*'|\#[^\n]*|[][{}.,=\n]''',
    re.DOTALL,
)
_OPENING, _CLOSING = ("[", "{"), ("]", "}")
DEEPEST = 32  # tables and arrays in each other
_HINTS = 50  # a file with more problems than this was not mistyped


@dataclass
class Document:
    """A parsed TOML file and the problems found in it so far."""

    file: Path
    text: str
    content: bytes
    data: dict[str, Any]
    problems: list[Problem] = field(default_factory=list)

    @cached_property
    def lines(self) -> dict[Key, int]:
        """Key -> line; only messages need it, and it takes longer than parsing."""
        return index_lines(self.text)

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

    def hint(self, word: str, choices: Iterable[str]) -> str:
        """Say which choice was meant; looking for it takes long, so only in the first problems."""
        return did_you_mean(word, choices) if len(self.problems) < _HINTS else ""

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
        When the file is absent, too large, not UTF-8 or not TOML, or nests too deep; the message
        carries the line.
    """
    content = read_file(path, at_most=LARGEST_TEXT)
    text = decoded(content, path)
    _check_depth(text, path)
    return Document(file=path, text=text, content=content, data=_parsed(text, path))


def _parsed(text: str, path: Path) -> dict[str, Any]:
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        place = re.search(r"\(at line (\d+), column (\d+)\)", str(error))
        # An error at the end of the file is reported without a line.
        line = int(place[1]) if place else text.count("\n") + 1
        what = re.sub(r"\s*\(at .*\)$", "", str(error))
        raise InputError.single(
            "syntax", got=what.lower(), expected="valid TOML", file=path, line=line
        ) from error
    # Python does not read numbers of more digits than this.
    except ValueError as error:
        most = sys.get_int_max_str_digits()
        digits = re.search(rf"[0-9_]{{{most},}}", text)
        where = None if digits is None else text.count("\n", 0, digits.start()) + 1
        raise InputError.single(
            "syntax", got=f"a number of over {most} digits", expected="valid TOML",
            file=path, line=where,
        ) from error  # fmt: skip


def _check_depth(text: str, path: Path) -> None:
    """Refuse arrays and tables in each other beyond what a file of ours holds."""
    depth = dots = 0
    for token in _TOKENS.finditer(text):
        mark = token[0]
        if mark in _OPENING:
            depth += 1
        elif mark in _CLOSING:
            depth -= 1
        # A key may be quoted between its dots.
        dots = dots + 1 if mark == "." else dots if mark[0] in "\"'" else 0
        if max(depth, dots) > DEEPEST:
            raise InputError.single(
                "nesting", got=f"more than {DEEPEST} tables or arrays in each other",
                expected=f"at most {DEEPEST}", file=path,
                line=text.count("\n", 0, token.start()) + 1,
            )  # fmt: skip


class Statement(NamedTuple):
    """A header or an assignment of a TOML text.

    Parameters
    ----------
    key : full; rows of an array of tables are counted from 0
    line : from 1
    start, end : offsets in the text; the end is behind the line's own
    parsed : the statement alone
    """

    key: Key
    line: int
    start: int
    end: int
    parsed: dict[str, Any]
    header: bool


def statements(text: str) -> Iterator[Statement]:
    r"""Cut a valid text into headers and assignments, which end with a line outside of brackets.

    Comments and empty lines before a statement belong to none: it starts at its own line.

    Examples
    --------
    >>> [one.key for one in statements("a = 1\n[[rig]]\nname = 'sun'\n")]
    [('a',), ('rig', 0), ('rig', 0, 'name')]
    """
    start, line, first, depth = 0, 1, 1, 0
    rows: dict[Key, int] = {}
    table: Key = ()
    for token in _TOKENS.finditer(f"{text}\n"):
        mark = token[0]
        depth += (mark in _OPENING) - (mark in _CLOSING)
        line += mark.count("\n")
        if mark != "\n" or depth > 0:
            continue
        chunk = text[start : token.end()]
        bare = chunk.strip()
        if bare and not bare.startswith("#"):
            parsed, header = tomllib.loads(chunk), bare.startswith("[")
            if header:
                key = table = _open_table(parsed, rows)
            else:
                key = (*table, *_dotted(chunk))
            yield Statement(key, first, start, min(token.end(), len(text)), parsed, header)
        start, first = token.end(), line


def _dotted(assignment: str) -> Key:
    """Return the parts of the key before the equals sign."""
    equals = next(t.start() for t in _TOKENS.finditer(assignment) if t[0] == "=")
    node: Any = tomllib.loads(f"{assignment[:equals]}= 0")
    key: Key = ()
    while isinstance(node, dict):
        name, node = next(iter(node.items()))
        key = (*key, name)
    return key


def index_lines(text: str) -> dict[Key, int]:
    r"""Return the line (from 1) on which each key of a valid TOML text is set.

    Examples
    --------
    >>> index_lines("a = 1\n[[rig]]\nname = 'sun'\n[rig.sky]\n")[("rig", 0, "name")]
    3
    """
    lines: dict[Key, int] = {}
    table: Key = ()
    for one in statements(text):
        if one.header:
            table = one.key
            lines.setdefault(table, one.line)
        else:
            for key in _keys(one.parsed):
                lines[(*table, *key)] = one.line
    return lines


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
