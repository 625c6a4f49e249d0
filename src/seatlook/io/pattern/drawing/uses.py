"""Which blocks of a pattern file are pieces, and how each is placed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from seatlook.errors import InputError, did_you_mean
from seatlook.io.pattern.drawing.drawing import Drawing
from seatlook.io.pattern.drawing.entities import has_line, matrix_of, read_texts
from seatlook.io.pattern.drawing.layers import BOUNDARY
from seatlook.model import FloatArray

_DEEPEST = 16  # blocks in blocks


@dataclass(frozen=True, slots=True)
class Use:
    """One piece: a block as it is used once.

    Parameters
    ----------
    matrix : (4, 4) or None
        How it is turned, scaled and mirrored. Where it lies on the sheet means nothing.
    """

    block: Any
    name: str
    texts: dict[str, str]
    matrix: FloatArray | None

    @property
    def is_mirrored(self) -> bool:
        """Whether its INSERT turns it over."""
        return self.matrix is not None and float(np.linalg.det(self.matrix[:2, :2])) < 0


def find_uses(drawing: Drawing, titles: dict[str, str], size: str | None) -> list[Use]:
    """Return the pieces of the wanted size, in the order of the file.

    Raises
    ------
    InputError
        When the size is unknown, or several are there and none is wanted.
    """
    uses = _without_copies(_placed(drawing))
    sizes = list(dict.fromkeys(u.texts["size"] for u in uses if "size" in u.texts))
    known = {s.casefold() for s in sizes}
    if size is None and len(known) > 1:
        size = titles.get("sample size")
    wanted = None if size is None else size.casefold()
    if uses and (wanted is not None or len(known) > 1) and wanted not in known:
        raise InputError.single(
            "size", got=repr(size), expected=f"one of {', '.join(sizes)}", file=drawing.path,
            hint=did_you_mean(size or "", sizes),
        )  # fmt: skip
    return [
        use for use in uses if wanted is None or use.texts.get("size", wanted).casefold() == wanted
    ]


def unique_names(uses: Sequence[Use], notes: list[str]) -> list[str]:
    """Return a name for each use; what is used again is numbered."""
    names: list[str] = []
    for use in uses:
        name = use.texts.get("piece name") or use.name
        names.append(
            unique(f"{name}_mirrored" if name in names and use.is_mirrored else name, names)
        )
        if names[-1] != name:
            same = any(use.block is u.block for u in uses[: len(names) - 1])
            why = "it is used again" if same else "the file has several pieces of this name"
            notes.append(f"piece {name}: {why}: read as {names[-1]}")
    return names


def unique(name: str, taken: Sequence[str]) -> str:
    """Number a name that is taken.

    Examples
    --------
    >>> unique("A", ["A", "A_2"])
    'A_3'
    """
    number, free = 2, name
    while free in taken:
        free, number = f"{name}_{number}", number + 1
    return free


def layers_of(document: Any) -> list[str]:
    """Return the layers on which anything is drawn, for a message."""
    layouts = (*document.blocks,)
    return sorted({e.dxf.layer for layout in layouts for e in layout if e.dxftype() != "INSERT"})


def _placed(drawing: Drawing) -> Iterator[tuple[Use, FloatArray | None]]:
    """Return the uses with all of their matrix; without any INSERT those of all blocks."""
    document = drawing.document
    inserts = document.modelspace().query("INSERT")
    if not inserts:
        for block in document.blocks:
            if not block.is_any_layout and has_line(block, BOUNDARY):
                yield _use(drawing, block, None), None
    for insert in inserts:
        block = document.blocks.get(insert.dxf.get("name", ""))
        if block is not None and _has_outline(document, block, ()):
            for matrix in matrix_of(insert):
                yield from _expanded(drawing, block, matrix, ())


def _expanded(
    drawing: Drawing, block: Any, matrix: FloatArray, around: tuple[str, ...]
) -> Iterator[tuple[Use, FloatArray | None]]:
    """Return the uses in a block, which is a piece, or a sheet of pieces."""
    inserts = block.query("INSERT")
    if has_line(block, BOUNDARY) or "piece name" in read_texts(block) or not inserts:
        if _has_outline(drawing.document, block, ()):
            yield _use(drawing, block, matrix), matrix
        return
    for insert in inserts:
        inner = drawing.document.blocks.get(insert.dxf.get("name", ""))
        if inner is not None and inner.name not in around and len(around) < _DEEPEST:
            for own in matrix_of(insert):
                yield from _expanded(drawing, inner, own @ matrix, (*around, block.name))


def _has_outline(document: Any, block: Any, around: tuple[str, ...]) -> bool:
    if has_line(block, BOUNDARY):
        return True
    inner = [document.blocks.get(i.dxf.get("name", "")) for i in block.query("INSERT")]
    return len(around) < _DEEPEST and any(
        b is not None and b.name not in around and _has_outline(document, b, (*around, block.name))
        for b in inner
    )


def _use(drawing: Drawing, block: Any, matrix: FloatArray | None) -> Use:
    if matrix is not None:
        matrix = matrix.copy()
        matrix[3, :3] = 0.0
        if np.abs(matrix - np.eye(4)).max() < 1e-12:
            matrix = None
    return Use(block, drawing.name_of(block.name), read_texts(block), matrix)


def _without_copies(placed: Iterator[tuple[Use, FloatArray | None]]) -> list[Use]:
    """Drop what is used twice in one place."""
    uses: list[Use] = []
    places: set[tuple[str, bytes]] = set()
    for use, matrix in placed:
        place = (use.block.name, b"" if matrix is None else matrix.round(6).tobytes())
        if place not in places:
            places.add(place)
            uses.append(use)
    return uses
