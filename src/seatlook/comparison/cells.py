"""HTML of single pictures and tables, for notebooks: no script is needed to see everything."""

from __future__ import annotations

import uuid
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path

from seatlook.errors import InputError
from seatlook.files import write_bytes
from seatlook.model.table import Table, number
from seatlook.pbr.picture import img


@dataclass(frozen=True, slots=True, kw_only=True)
class Cell:
    """One picture with its name; a notebook shows it."""

    name: str
    png: bytes
    ev100: float | None = None

    def save(self, path: Path | str) -> None:
        """Write a ``.png`` file.

        Raises
        ------
        InputError
            Another file ending.
        """
        path = Path(path)
        if path.suffix != ".png":
            raise InputError.single("picture file", got=path.name, expected="a .png name")
        write_bytes(path, self.png)

    def _repr_png_(self) -> bytes:
        return self.png

    def img(self, style: str = "width:100%") -> str:
        """HTML of the picture, with its name for those who cannot see it."""
        return img(self.png, self.name, style)


@dataclass(frozen=True, slots=True, kw_only=True)
class Contrast:
    """Picture ``b`` over ``a`` with a slider between; side by side where scripts do not run."""

    a: Cell
    b: Cell

    def _repr_html_(self) -> str:
        name = f"seatlook-{uuid.uuid4().hex[:8]}"
        move = f"document.getElementById('{name}').style.clipPath='inset(0 0 0 '+this.value+'%)'"
        return (
            '<figure style="margin:0;max-width:1280px;position:relative">'
            f"{self.a.img()}"
            f'<div id="{name}" style="position:absolute;top:0;left:0;width:100%;'
            f'clip-path:inset(0 0 0 50%)">{self.b.img()}</div>'
            f'<input type="range" min="0" max="100" value="50" style="width:100%" '
            f'aria-label="Border between A and B" oninput="{move}">'
            f"<figcaption>A: {escape(self.a.name)}. B: {escape(self.b.name)}.</figcaption>"
            "</figure>"
        )

    def __repr__(self) -> str:
        return f"Contrast(A: {self.a.name}; B: {self.b.name})"


def cell_table(
    *,
    rows: Sequence[str],
    columns: Sequence[str],
    cell: Callable[[str, str], Cell],
    corner: str,
    below: Table,
) -> str:
    """HTML of a grid of pictures with a folded table below."""
    heads = "".join(f"<th>{escape(name)}{_exposure(cell(rows[0], name))}</th>" for name in columns)
    body = "".join(
        f"<tr><th>{escape(row)}</th>"
        + "".join(f"<td>{cell(row, name).img('max-width:420px')}</td>" for name in columns)
        + "</tr>"
        for row in rows
    )
    zones = below._repr_html_()
    return (
        f"<table><thead><tr><th>{escape(corner)}</th>{heads}</tr></thead>"
        f"<tbody>{body}</tbody></table>"
        f"<details><summary>Zones, largest difference first</summary>{zones}</details>"
    )


def _exposure(cell: Cell) -> str:
    return "" if cell.ev100 is None else f"<br>EV {number(cell.ev100)}"
