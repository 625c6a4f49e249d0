"""``*ELEMENT_SHELL_COMPOSITE``: shells with their plies, of which the thickness is the sum."""

from __future__ import annotations

import numpy as np

from seatlook.io.lsdyna.deck.cards import Block, refuse
from seatlook.model import FloatArray, IntArray


def composite_shells(block: Block, *, long: bool) -> tuple[IntArray, FloatArray]:
    """Return numbers (k, 10) and thickness (k,): the sum of the plies behind each shell's card.

    Parameters
    ----------
    long : one ply on a card, as in ``_COMPOSITE_LONG``; else two

    Raises
    ------
    InputError
        A shell without plies, or plies without a shell.
    """
    cards = range(len(block.cards))
    rows = [card for card in cards if _is_shell(block, block.cards[card])]
    behind = np.setdiff1d(cards, rows)
    owner = np.searchsorted(rows, behind) - 1
    if not rows or (owner < 0).any():
        raise refuse(block, "plies without a shell", "a shell's card, then its plies", 0)
    i = block.width or 8
    # Cards are taken one by one: their kinds alternate as they like.
    ids = np.concatenate([
        block.table([i] * 10, slice(card, card + 1)).ints(*range(10)) for card in rows
    ])  # fmt: skip
    thickness = np.zeros(len(rows))
    for card, shell in zip(behind.tolist(), owner.tolist(), strict=True):
        thickness[shell] += ply_thickness(block, card, (1,) if long else (1, 5))
    bare = np.flatnonzero(~(thickness > 0))
    if len(bare):
        got = f"shell {ids[bare[0], 0]} without plies"
        raise refuse(block, got, "plies with a thickness", rows[bare[0]])
    return ids, thickness


def ply_thickness(block: Block, card: int, columns: tuple[int, ...]) -> float:
    """Sum the thickness of the plies of one card."""
    table = block.table([10] * 8, slice(card, card + 1))
    return float(table.floats(*columns).sum())


def _is_shell(block: Block, card: bytes) -> bool:
    """Tell a shell's card, which holds whole numbers, from one of plies with a thickness."""
    if b"." in card or b"E" in card.upper():
        return False
    width = block.width or 8
    fields = (
        card.split(b",") if b"," in card else [card[k * width : (k + 1) * width] for k in range(5)]
    )
    return len(fields) >= 5 and all(field.strip().isdigit() for field in fields[:5])
