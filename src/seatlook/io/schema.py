"""What a TOML file may hold, declared once; reading notes every deviation with its line.

A *kind* reads one value: it returns it converted (mm to m and so on), or reports a problem to the
document and returns None (a table: a dict of its keys, with None for those). Names that other
parts of a file refer to are checked by the reader of that file. Defaults are in the file's units.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np

from seatlook.io.toml import Document, Key

MM = 1e-3
FAR_MM = 1e5  # no place of a seat lies farther away
LISTED = 16  # a message names no more choices than this


class Kind(Protocol):
    """One sort of value."""

    @property
    def required(self) -> bool:
        """Whether the key may not be missing."""

    def read(self, document: Document, key: Key, value: Any) -> Any:
        """Return the value in SI units, or report a problem and return None."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Number:
    """A finite number in [low, high], or above ``above``; multiplied by ``scale``."""

    low: float = -math.inf
    high: float = math.inf
    above: float = -math.inf
    scale: float = 1.0
    default: float | None = None
    required: bool = False

    def read(self, document: Document, key: Key, value: Any) -> float | None:
        """Return the value, converted; report what is wrong with it."""
        if isinstance(value, bool) or not isinstance(value, int | float):
            document.report(key, shown(value), "a number")
        elif not _is_finite(value):
            document.report(key, shown(value), "a finite number")
        elif not (self.low <= value <= self.high and value > self.above):
            document.report(key, shown(value), self._range())
        else:
            return value * self.scale
        return None

    def _range(self) -> str:
        if math.isfinite(self.above):
            top = f" and at most {self.high:g}" if math.isfinite(self.high) else ""
            return f"a number above {self.above:g}{top}"
        if not math.isfinite(self.high):
            return f"a number of at least {self.low:g}"
        return f"{self.low:g} to {self.high:g}"


@dataclass(frozen=True, slots=True, kw_only=True)
class Integer:
    """A whole number in [low, high]."""

    low: int = 0
    high: int = 2**31
    default: int | None = None
    required: bool = False

    def read(self, document: Document, key: Key, value: Any) -> int | None:
        """Return the value, converted; report what is wrong with it."""
        if isinstance(value, bool) or not isinstance(value, int):
            document.report(key, shown(value), "a whole number")
        elif not self.low <= value <= self.high:
            document.report(key, shown(value), f"{self.low} to {self.high}")
        else:
            return value
        return None


@dataclass(frozen=True, slots=True, kw_only=True)
class Flag:
    """True or false."""

    default: bool | None = None
    required: bool = False

    def read(self, document: Document, key: Key, value: Any) -> bool | None:
        """Return the value, converted; report what is wrong with it."""
        if isinstance(value, bool):
            return value
        document.report(key, shown(value), "true or false")
        return None


@dataclass(frozen=True, slots=True, kw_only=True)
class Text:
    """A text that is not empty, one of ``choices`` if there are any."""

    choices: tuple[str, ...] = ()
    default: str | None = None
    required: bool = False

    def read(self, document: Document, key: Key, value: Any) -> str | None:
        """Return the value, converted; report what is wrong with it."""
        if not isinstance(value, str) or not value:
            document.report(key, shown(value), "a text")
        elif not self.choices or known(document, key, value, self.choices, "a choice"):
            return value
        return None


@dataclass(frozen=True, slots=True, kw_only=True)
class Array:
    """A float64 array of ``shape`` (None = any length above 0), multiplied by ``scale``."""

    shape: tuple[int | None, ...] = (3,)
    low: float = -math.inf
    high: float = math.inf
    scale: float = 1.0
    default: Any = None
    required: bool = False

    def read(self, document: Document, key: Key, value: Any) -> Any:
        """Return the value, converted; report what is wrong with it."""
        shape = " x ".join("n" if n is None else str(n) for n in self.shape)
        if not _is_array(value, self.shape):
            document.report(key, shown(value), f"an array of {shape} numbers")
            return None
        try:
            array = np.array(value, dtype=np.float64)
        except OverflowError:
            array = np.full(1, np.nan)
        if not np.isfinite(array).all():
            document.report(key, shown(value), "finite numbers")
        elif array.min() < self.low or array.max() > self.high:
            document.report(key, shown(value), f"numbers from {self.low:g} to {self.high:g}")
        else:
            return array * self.scale
        return None


def _is_finite(value: float) -> bool:
    """Whether a number is one that a float64 holds; a whole number of TOML may have any length."""
    try:
        return math.isfinite(value)
    except OverflowError:
        return False


def _is_array(value: Any, shape: tuple[int | None, ...]) -> bool:
    if not shape:
        return isinstance(value, int | float) and not isinstance(value, bool)
    if not isinstance(value, list) or not value or shape[0] not in (None, len(value)):
        return False
    return all(_is_array(v, shape[1:]) for v in value)


@dataclass(frozen=True, slots=True, kw_only=True)
class Texts:
    """A list of texts, out of ``choices`` if any; with ``or_one`` a text is a list of one."""

    choices: tuple[str, ...] = ()
    or_one: bool = False
    default: tuple[str, ...] | None = None
    required: bool = False

    def read(self, document: Document, key: Key, value: Any) -> tuple[str, ...] | None:
        """Return the value, converted; report what is wrong with it."""
        values = [value] if self.or_one and isinstance(value, str) else value
        if isinstance(values, list) and values and all(isinstance(v, str) and v for v in values):
            if not self.choices:
                return tuple(values)
            known_all = [known(document, key, v, self.choices, "a choice") for v in values]
            return tuple(values) if all(known_all) else None
        single = "a text or " if self.or_one else ""
        document.report(key, shown(value), f"{single}a list of texts")
        return None


@dataclass(frozen=True, slots=True)
class Table:
    """A table with these keys and no others; a missing optional one takes its default."""

    keys: Mapping[str, Kind]
    required: bool = False

    def read(self, document: Document, key: Key, value: Any) -> dict[str, Any]:
        """Return the value, converted; report what is wrong with it."""
        if not isinstance(value, dict):
            document.report(key, shown(value), "a table")
            return {name: _absent(kind) for name, kind in self.keys.items()}
        for name in value:
            if name not in self.keys:
                hint = document.hint(name, self.keys)
                document.report((*key, name), "unknown key", f"one of {', '.join(self.keys)}", hint)
        result: dict[str, Any] = {}
        for name, kind in self.keys.items():
            if name in value:
                result[name] = kind.read(document, (*key, name), value[name])
                continue
            if kind.required:
                document.report((*key, name), "nothing", described(kind))
            result[name] = _absent(kind)
        return result


@dataclass(frozen=True, slots=True)
class Named:
    """Tables or values under free names, as ``[edge.NAME]``."""

    table: Kind
    required: bool = False

    def read(self, document: Document, key: Key, value: Any) -> dict[str, Any]:
        """Return the value, converted; report what is wrong with it."""
        if not isinstance(value, dict):
            document.report(key, shown(value), "tables with names")
            return {}
        return {n: self.table.read(document, (*key, n), v) for n, v in value.items()}


@dataclass(frozen=True, slots=True)
class Rows:
    """An array of tables, as ``[[seam]]``; the value of ``unique`` may not repeat."""

    table: Kind
    unique: str = "name"
    required: bool = False

    def read(self, document: Document, key: Key, value: Any) -> list[dict[str, Any]]:
        """Return the value, converted; report what is wrong with it."""
        if not isinstance(value, list):
            document.report(key, shown(value), f"an array of tables, [[{key[-1]}]]")
            return []
        rows = [self.table.read(document, (*key, i), v) for i, v in enumerate(value)]
        first: dict[str, int] = {}
        for i, row in enumerate(rows):
            name = row.get(self.unique)
            if isinstance(name, str) and first.setdefault(name, i) != i:
                line = document.line((*key, first[name]))
                document.report(
                    (*key, i, self.unique), shown(name), f"a name not used before (line {line})"
                )
        return rows


def place_mm(size: int, *, required: bool = True, many: bool = False) -> Array:
    """Kind of a place of ``size`` coordinates, or of any number of them."""
    shape = (None, size) if many else (size,)
    return Array(shape=shape, low=-FAR_MM, high=FAR_MM, scale=MM, required=required)


# C_threshold: radii from a tenth of a millimetre to a hundred metres.
THRESHOLD = Number(low=1e-5, high=10, scale=1 / MM)


def known(
    document: Document, key: Key, name: str | None, choices: Iterable[str], what: str
) -> bool:
    """Report a name that is not among ``choices``; a missing one is reported already."""
    names = tuple(choices)
    if name is None or name in names:
        return name is not None
    listed = f"one of {', '.join(names)}" if len(names) <= LISTED else what
    expected = listed if names else f"{what}; there are none"
    document.report(key, shown(name), expected, document.hint(name, names))
    return False


def read_table(document: Document, keys: Mapping[str, Kind]) -> dict[str, Any]:
    """Read the whole document as a table of ``keys``."""
    return Table(keys).read(document, (), document.data)


def described(kind: Kind) -> str:
    """Say in a few words what a kind wants."""
    if isinstance(kind, Text) and kind.choices:
        return f"one of {', '.join(kind.choices)}"
    names = {
        Number: "a number",
        Integer: "a whole number",
        Flag: "true or false",
        Text: "a text",
        Array: "an array of numbers",
        Texts: "a text or a list of texts",
        Named: "tables with names",
        Rows: "an array of tables",
    }
    return names.get(type(kind), "a table")


def shown(value: Any) -> str:
    """Show a value in a message, cut to a readable length."""
    if isinstance(value, bool):
        return "true" if value else "false"
    # Python spells no number of more digits than it reads.
    if isinstance(value, int) and value.bit_length() > 1024:
        return f"a whole number of {value.bit_length()} bits"
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:57]}..."


def _absent(kind: Kind) -> Any:
    """Return what stands for a key that is not there."""
    if isinstance(kind, Table):
        return {name: _absent(k) for name, k in kind.keys.items()}
    if isinstance(kind, Named):
        return {}
    if isinstance(kind, Rows):
        return []
    default = getattr(kind, "default", None)
    scale = getattr(kind, "scale", 1.0)
    return default * scale if isinstance(default, float) else default
