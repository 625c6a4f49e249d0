"""A chart's table that grows: rows that are there are not measured again."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Mapping
from pathlib import Path

CHARTS = Path(__file__).parents[2] / "docs" / "charts"


class KeptRows:
    """Rows of a CSV file below docs/charts, which is begun where it is missing.

    Parameters
    ----------
    name : of the file, without its ending
    columns : in their order
    """

    def __init__(self, name: str, columns: tuple[str, ...]) -> None:
        self.path = CHARTS / f"{name}.csv"
        self.columns = columns

    def read(self) -> list[dict[str, str]]:
        """Return the rows that are there."""
        if not self.path.exists():
            return []
        with self.path.open(encoding="utf-8", newline="") as file:
            return list(csv.DictReader(file))

    def add(self, rows: Iterable[Mapping[str, object]]) -> None:
        """Append rows to the file."""
        fresh = not self.path.exists()
        with self.path.open("a", newline="", encoding="utf-8") as file:
            table = csv.DictWriter(file, self.columns, lineterminator="\n")
            if fresh:
                table.writeheader()
            table.writerows(rows)
