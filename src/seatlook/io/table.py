"""Tables of figures as CSV."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Sequence
from pathlib import Path

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
