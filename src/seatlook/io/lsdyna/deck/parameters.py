"""*PARAMETER: names that stand for numbers in the fields of other keywords."""

from __future__ import annotations

from collections.abc import Iterable

from seatlook.io.lsdyna.deck.cards import Block, refuse

_PAIRS = 4  # a name and its value, each 10 columns wide, up to four times in a card
_KINDS = (b"R", b"I", b"C")


def parameters(blocks: Iterable[Block]) -> dict[bytes, bytes]:
    """Return name in capitals -> value as text, of a whole deck.

    Of a name that is defined twice the first value counts, as in LS-DYNA without
    *PARAMETER_DUPLICATION. What *PARAMETER_EXPRESSION defines is not among them.

    Raises
    ------
    InputError
        A kind of parameter that is not R, I or C, or a name without a value.
    """
    values: dict[bytes, bytes] = {}
    for block in blocks:
        if block.name not in ("PARAMETER", "PARAMETER_LOCAL"):
            continue
        for card, fields in enumerate(block.table([10] * (2 * _PAIRS)).fields):
            for name, value in zip(fields[::2].tolist(), fields[1::2].tolist(), strict=True):
                word, text = name.strip().upper(), value.strip()
                if not word:
                    continue
                if word[:1] not in _KINDS or not word[1:].strip() or not text:
                    shown = f"{name.decode('latin-1')!r} {value.decode('latin-1')!r}"
                    raise refuse(block, shown, "R, I or C, a name, and its value", card)
                values.setdefault(word[1:].strip(), text)
    return values
