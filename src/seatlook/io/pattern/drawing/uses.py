"""Which blocks of a pattern file are pieces, and how each is placed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from seatlook.errors import InputError, did_you_mean
from seatlook.io.pattern.drawing.drawing import Drawing
from seatlook.io.pattern.drawing.entities import (
    has_line,
    line_layers,
    matrix_of,
    read_attributes,
    read_texts,
)
from seatlook.io.pattern.drawing.layers import BOUNDARY, meaning
from seatlook.model import FloatArray

_DEEPEST = 16  # blocks in blocks


@dataclass(frozen=True, slots=True)
class Use:
    """One piece: a block as it is used once.

    Parameters
    ----------
    matrix : (4, 4) or None
        How it is turned, scaled and mirrored. Where it lies on the sheet means nothing.
    layer : of what is drawn on layer 0 of the block
    """

    block: Any
    name: str
    texts: dict[str, str]
    matrix: FloatArray | None
    layer: str = "0"

    @property
    def is_mirrored(self) -> bool:
        """Whether its INSERT turns it over."""
        return self.matrix is not None and float(np.linalg.det(self.matrix[:2, :2])) < 0


def find_uses(
    drawing: Drawing, titles: dict[str, str], size: str | None, notes: list[str]
) -> list[Use]:
    """Return the pieces of the wanted size, in the order of the file; note blocks that are none.

    Raises
    ------
    InputError
        When the size is unknown, or several are there and none is wanted.
    """
    uses = _without_copies(_placed(drawing, notes))
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


def _placed(drawing: Drawing, notes: list[str]) -> Iterator[tuple[Use, FloatArray | None]]:
    """Return the uses with all of their matrix; where none is put on the sheet all blocks."""
    document = drawing.document
    are_put = False
    for insert in document.modelspace().query("INSERT"):
        name, layer = insert.dxf.get("name", ""), meaning(insert.dxf.layer)
        block = document.blocks.get(name)
        if block is not None and _has_outline(document, block, layer, ()):
            are_put = True
            said = read_attributes(insert)
            for matrix in matrix_of(insert):
                yield from _expanded(drawing, block, matrix, layer, (), said)
        else:
            _note_no_piece(drawing, block, name, notes)
    for block in _never_put(document):
        if not has_line(block, BOUNDARY):
            _note_no_piece(drawing, block, block.name, notes)
        elif are_put:
            own = drawing.name_of(block.name)
            notes.append(f"block {own} has an outline, but is put nowhere on the sheet: not read")
        else:
            yield _use(drawing, block, None, "0", {}), None


def _never_put(document: Any) -> list[Any]:
    """Return the blocks that stand neither on the sheet nor in another block."""
    layouts = (*document.blocks, document.modelspace())
    put = {i.dxf.get("name", "").casefold() for layout in layouts for i in layout.query("INSERT")}
    return [b for b in document.blocks if not b.is_any_layout and b.name.casefold() not in put]


def _note_no_piece(drawing: Drawing, block: Any, name: str, notes: list[str]) -> None:
    """Say that a block is no piece, where lines are in it or it is not there."""
    layers = set() if block is None else line_layers(block)
    own = drawing.name_of(name)
    if block is None and not name:
        notes.append("an INSERT names no block: not read")
    elif block is None:
        notes.append(f"block {own} is put on the sheet, but the file does not hold it: not read")
    elif layers and not name.startswith("*"):  # the name of dimensions and hatches
        shown = ", ".join(sorted(layers))
        notes.append(f"block {own} has no outline on layer 1: not read (its layers: {shown})")


def _expanded(
    drawing: Drawing,
    block: Any,
    matrix: FloatArray,
    layer: str,
    around: tuple[str, ...],
    said: dict[str, str],
) -> Iterator[tuple[Use, FloatArray | None]]:
    """Return the uses in a block, which is a piece, or a sheet of pieces.

    ``said`` are the attributes of its INSERT.
    """
    inserts = block.query("INSERT")
    named = "piece name" in (read_texts(block) | said)
    if _draws_outline(block, layer) or named or not inserts:
        if _has_outline(drawing.document, block, layer, ()):
            yield _use(drawing, block, matrix, layer, said), matrix
        return
    for insert in inserts:
        inner = drawing.document.blocks.get(insert.dxf.get("name", ""))
        if inner is not None and inner.name not in around and len(around) < _DEEPEST:
            below = _layer_below(insert, layer)
            chain, inner_said = (*around, block.name), read_attributes(insert)
            for own in matrix_of(insert):
                yield from _expanded(drawing, inner, own @ matrix, below, chain, inner_said)


def _layer_below(insert: Any, layer: str) -> str:
    """Return the layer that layer 0 of a block stands for; that of its INSERT."""
    own = meaning(insert.dxf.layer)
    return layer if own == "0" else own


def _draws_outline(block: Any, layer: str) -> bool:
    """Whether a block has lines of an outline itself, on layer 1 or on the layer it is put on."""
    return has_line(block, BOUNDARY) or (layer == BOUNDARY and has_line(block, "0"))


def _has_outline(document: Any, block: Any, layer: str, around: tuple[str, ...]) -> bool:
    if _draws_outline(block, layer):
        return True
    inner = [
        (document.blocks.get(i.dxf.get("name", "")), _layer_below(i, layer))
        for i in block.query("INSERT")
    ]
    return len(around) < _DEEPEST and any(
        b is not None
        and b.name not in around
        and _has_outline(document, b, below, (*around, block.name))
        for b, below in inner
    )


def _use(
    drawing: Drawing, block: Any, matrix: FloatArray | None, layer: str, said: dict[str, str]
) -> Use:
    if matrix is not None:
        matrix = matrix.copy()
        matrix[3, :3] = 0.0
        if np.abs(matrix - np.eye(4)).max() < 1e-12:
            matrix = None
    # Where the outline has its own layer, the rest on layer 0 is no outline too.
    layer = "0" if has_line(block, BOUNDARY) else layer
    return Use(block, drawing.name_of(block.name), read_texts(block) | said, matrix, layer)


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
