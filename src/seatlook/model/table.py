"""Values with what a reader must know about them: a table with its heads, a field with its unit."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from html import escape

from seatlook.errors import InputError
from seatlook.model._check import FloatArray, floats


@dataclass(frozen=True, slots=True, kw_only=True)
class Field:
    """One value per face of a cover, as files for other programs carry it.

    Parameters
    ----------
    name : in every file
    unit : "1" for a number
    meaning : one sentence
    values : (m,) float64 [unit]
    """

    name: str
    unit: str
    meaning: str
    values: FloatArray

    def __post_init__(self) -> None:
        floats(self, "values", None)


@dataclass(frozen=True, slots=True, kw_only=True)
class Table:
    """Heads (with the unit, if any) and rows; numbers are formatted and aligned by the page."""

    heads: tuple[str, ...]
    rows: tuple[tuple[str | float | int | None, ...], ...]

    def __post_init__(self) -> None:
        for count, row in enumerate(self.rows):
            if len(row) != len(self.heads):
                raise InputError.single(
                    f"table row {count}",
                    got=f"{len(row)} cells",
                    expected=f"{len(self.heads)}: {', '.join(self.heads)}",
                )

    @property
    def texts(self) -> tuple[tuple[str, ...], ...]:
        """The rows as they are read: a column has the same decimals in every row."""
        return tuple(zip(*map(column, zip(*self.rows, strict=True)), strict=True))

    @property
    def numeric(self) -> tuple[bool, ...]:
        """Whether a column holds numbers, which are aligned to the right."""
        return tuple(
            any(isinstance(v, int | float) for v in values)
            for values in zip(self.heads, *self.rows, strict=True)
        )

    def _repr_html_(self) -> str:
        heads = "".join(f"<th>{escape(head)}</th>" for head in self.heads)
        rows = "".join(
            "<tr>" + "".join(f"<td>{escape(text)}</td>" for text in row) + "</tr>"
            for row in self.texts
        )
        return f"<table><thead><tr>{heads}</tr></thead><tbody>{rows}</tbody></table>"


def spaced(values: Iterable[float] | None) -> str | None:
    """Write numbers of one cell, four digits each; None stays None.

    Examples
    --------
    >>> spaced([12072.4, 0.00011])
    '1.207e+04 0.00011'
    """
    return None if values is None else " ".join(f"{value:.4g}" for value in values)


def number(value: float | str | None) -> str:
    """Write a value for a reader: three digits, a minus sign, a dash for nothing.

    Examples
    --------
    >>> number(0.123456), number(-12.0), number(54321), number(0.0000321), number(None)
    ('0.123', '−12', '54321', '3.21e−5', '–')
    """
    if isinstance(value, str):
        return value
    if value is None or math.isnan(value):
        return "–"
    if math.isinf(value):
        text = "∞" if value > 0 else "-∞"
    elif isinstance(value, int) or (value == int(value) and abs(value) < 1e6):
        text = str(int(value))
    elif 1e-3 <= abs(value) < 1e6:
        digits = max(0, 2 - math.floor(math.log10(abs(value))))
        text = f"{value:.{digits}f}"
    else:
        mantissa, exponent = f"{value:.2e}".split("e")
        text = f"{mantissa}e{int(exponent)}"
    return text.replace("-", "−")


def column(values: Sequence[float | str | None]) -> tuple[str, ...]:
    """Write a column of a table: as many decimals in all rows as give its largest three digits.

    Examples
    --------
    >>> column([812.4, 40.25, None]), column([0.0949, 5.6e-5]), column(["none", 0.5])
    (('812', '40', '–'), ('0.0949', '0.0001'), ('none', '0.500'))
    """
    numbers = [v for v in values if v is not None]
    if all(isinstance(v, float) and math.isfinite(v) for v in numbers):
        largest = max((abs(float(v)) for v in numbers), default=0.0)
        if 1e-3 <= largest < 1e6:
            digits = max(0, 2 - math.floor(math.log10(largest)))
            # Adding 0 turns a rounded -0 into 0.
            written = (
                v if v is None else f"{round(float(v), digits) + 0.0:.{digits}f}" for v in values
            )
            return tuple("–" if text is None else text.replace("-", "−") for text in written)
    return tuple(number(v) for v in values)
