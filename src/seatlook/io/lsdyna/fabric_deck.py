"""The text of a *MAT_FABRIC card with its curves, and its reader."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from types import MappingProxyType

import numpy as np

from seatlook.errors import InputError
from seatlook.files import read_file, reader, write_text
from seatlook.io.lsdyna.deck.cards import Block, refuse
from seatlook.io.lsdyna.deck.includes import deck_blocks
from seatlook.io.lsdyna.fabric_card import FabricCard, fabric_of
from seatlook.io.parameter_text import fields_of, file_key
from seatlook.model import FloatArray, Material

_FORM = -14
_CURVES = ("LCA", "LCB", "LCAB", "LCUA", "LCUB", "LCUAB")
_TITLE = 80
_FIRST_CURVE = 100  # of the numbers of the curves of material 1
_HEAD = """$ Cloth for *MAT_FABRIC, FORM = -14. Units: mm, s, t, N, MPa.
$ Curves: second Piola-Kirchhoff stress over Green strain; what the coats carry is taken off.
$ LCAB: abscissa 2 E12, the engineering shear. Whether a solver takes 2 E12 or E12 is not public:
$ shear one element first.
$ Thickness of the section: {thickness:.6g} mm.
"""


def write_fabric_card(path: Path, card: FabricCard, notes: tuple[str, ...] = ()) -> None:
    """Write a card with its curves as a keyword file.

    Parameters
    ----------
    notes : lines of comment, such as what the card loses
    """
    ids = {name: _FIRST_CURVE * card.number + i for i, name in enumerate(_CURVES)}
    rows: list[tuple[float | int, ...]] = [
        (card.number, card.density, card.ea, card.eb, 0, card.prba, card.prab, 0),
        # CSE 1: no compression. The liner stays out.
        (card.gab, 0, 0, 1.0, 0, 0, 0, 0),
        (0, 0, 0, 0, 0, _FORM, 0, 0),
        (0, 0, 0, 0, 0, 0, 0, 0),
        (0, 0, 0, 0, 0, 0, 0, 0),
        (*(ids[name] for name in _CURVES), 0.0),
        (0, 0, card.hysteresis, 0, 0, card.coat_young, 0, card.coat_thickness),
    ]
    text = _HEAD.format(thickness=card.thickness)
    text += "".join(f"$ {line}\n" for line in notes)
    text += f"*KEYWORD\n*MAT_FABRIC_TITLE\n{card.title[:_TITLE]}\n"
    text += "".join("".join(map(_field, row)) + "\n" for row in rows)
    for name in _CURVES:
        points = card.curves[name]
        text += f"*DEFINE_CURVE_TITLE\n{name} of {card.title}"[: _TITLE + 20] + "\n"
        # LCINT: as many points inside as here, or LS-DYNA makes 100 of them.
        head = (ids[name], 0, 1.0, 1.0, 0.0, 0.0, 0, len(points))
        text += "".join(map(_field, head)) + "\n"
        text += "".join(f"{x:20.12e}{y:20.12e}\n" for x, y in points.tolist())
    text += f"*SECTION_SHELL\n{_field(card.number)}{_field(9)}\n"
    text += "".join(_field(card.thickness) for _ in range(4)) + "\n*END\n"
    write_text(path, text)


@reader("a *MAT_FABRIC card")
def read_fabric_card(path: Path, *, thickness: float | None = None) -> FabricCard:
    """Read the first *MAT_FABRIC of FORM 14 or -14, its curves and its thickness.

    Parameters
    ----------
    thickness : [mm] of the section, where the deck has no *SECTION_SHELL

    Raises
    ------
    InputError
        No such card, another FORM, a curve that is not there or does not rise from (0, 0), no
        thickness.
    """
    file = Path(path)
    blocks = list(deck_blocks(file, read_file(file)))
    card = next((b for b in blocks if b.name in ("MAT_FABRIC", "MAT_FABRIC_TITLE", "MAT_034",
                                                 "MAT_034_TITLE")), None)  # fmt: skip
    if card is None:
        raise InputError.single("file", got="no *MAT_FABRIC", expected="a card of FORM -14",
                                file=file)  # fmt: skip
    first = int(card.name.endswith("TITLE"))
    title = card.cards[0].decode("latin-1").strip() if first else file.stem
    form = int(_row(card, first + 2)[5])
    if abs(form) != abs(_FORM):
        raise refuse(card, f"FORM {form}", "FORM -14 or 14, which has curves", first + 2)
    # With FVOPT below 0 a card of venting stands between.
    shift = first + (1 if _row(card, first + 2)[6] < 0.0 else 0)
    ids, one, two = _row(card, shift + 5), _row(card, first), _row(card, first + 1)
    coat = _row(card, shift + 6) if form < 0 else np.zeros(8)
    curves = {
        name: _curve(file, blocks, int(ids[i])) for i, name in enumerate(_CURVES) if ids[i] > 0
    }
    for name in ("LCA", "LCB", "LCAB"):
        if name not in curves:
            raise refuse(card, f"no {name}", "a curve", shift + 5)
    t = _thickness(blocks) if thickness is None else thickness
    if not t > 0.0:
        raise InputError.single("thickness", got="none in the deck", file=file,
                                expected="*SECTION_SHELL, or a thickness given")  # fmt: skip
    return FabricCard(
        title=title, number=int(one[0]), thickness=t, density=float(one[1]), ea=float(one[2]),
        eb=float(one[3]), prba=float(one[5]), prab=float(one[6]), gab=float(two[0]), curves=curves,
        hysteresis=float(coat[2]), coat_young=float(coat[5]), coat_thickness=float(coat[7]),
    )  # fmt: skip


def material_of(card: FabricCard, base: Material, file: Path) -> Material:
    """Make a material of a card; what no card holds is that of the base, and judgement."""
    fabric = fabric_of(card, base.fabric)
    coated = card.coat_young > 0.0
    read = {"thickness", "density", "warp", "weft", "shear", "poisson"}
    read |= {"warp_unloading", "weft_unloading"}
    if coated:
        read |= {"bending_warp", "bending_weft", "bending_twist", "bending_poisson"}
    source = {}
    for name, _ in fields_of(fabric):
        key = file_key(name)[0]
        text = f"*MAT_FABRIC {card.title} of {file.name}"
        if name.startswith("bending") and name in read:
            text += ", its isotropic coats"
        source[key] = text if name in read else f"judgement: not on the card, as {base.name}"
    looks = {k: v for k, v in base.source.items() if k not in source}
    return replace(
        base, name=card.title, fabric=fabric, source=MappingProxyType(source | looks),
        appearance=replace(base.appearance, maps=None),
    )  # fmt: skip


def _row(block: Block, card: int) -> FloatArray:
    if card >= len(block.cards):
        raise refuse(block, f"{len(block.cards)} cards", f"{card + 1} or more")
    return np.asarray(block.table([10] * 8, slice(card, card + 1)).floats(*range(8))[0])


def _curve(file: Path, blocks: list[Block], number: int) -> FloatArray:
    """Points (k, 2) of a *DEFINE_CURVE, with its scales and offsets."""
    for block in blocks:
        if not block.name.startswith("DEFINE_CURVE"):
            continue
        first = int(block.name.endswith("TITLE"))
        head = _row(block, first)
        if int(head[0]) + block.place.define != number:
            continue
        points = block.table([20, 20], slice(first + 1, None)).floats(0, 1)
        scale = np.where(head[2:4] == 0.0, 1.0, head[2:4])
        points = scale * (points + head[4:6])
        if len(points) < 2 or points[0].any() or (np.diff(points, axis=0) <= 0.0).any():
            raise refuse(block, f"curve {number}", "points that rise from (0, 0)", first + 1)
        return np.asarray(points)
    raise InputError.single("*DEFINE_CURVE", got=f"no curve {number}", expected="every curve of "
                            "the card", file=file)  # fmt: skip


def _thickness(blocks: list[Block]) -> float:
    for block in blocks:
        if block.name.startswith("SECTION_SHELL"):
            first = int(block.name.endswith("TITLE"))
            return float(_row(block, first + 1)[0])
    return 0.0


def _field(value: float) -> str:
    """A number in ten columns, with as many digits as they hold."""
    if value == 0:
        return "         0"
    if isinstance(value, int) or (float(value).is_integer() and abs(value) < 1e9):
        return f"{value:10d}" if isinstance(value, int) else f"{value:10.1f}"
    for digits in range(9, 1, -1):
        text = f"{value:.{digits}g}"
        if len(text) <= 10:
            return f"{text:>10}"
    raise InputError.single("card", got=value, expected="a number that ten columns hold")
