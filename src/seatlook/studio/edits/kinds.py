"""Every kind of edit by its name, and how several are made together."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from seatlook.errors import InputError, did_you_mean
from seatlook.studio.edits import seams
from seatlook.studio.edits.draft import Draft, Edit

KINDS: dict[str, Callable[[Draft, Edit], None]] = {
    "seam.add": seams.add,
    "seam.remove": seams.remove,
    "seam.turn": seams.turn,
    "seam.rename": seams.rename,
    "seam.set": seams.change,
    "guess.accept": seams.accept,
}


def make(draft: Draft, edits: Sequence[Any]) -> None:
    """Make edits one after the other, and read what comes out.

    Raises
    ------
    InputError
        An edit of no known kind, or one that leaves files that a run would refuse to read.
    Gone
        What one is about is not there.
    """
    for number, edit in enumerate(edits):
        kind = edit.get("kind") if isinstance(edit, dict) else None
        if not isinstance(kind, str) or kind not in KINDS:
            raise InputError.single(
                f"edits[{number}].kind", got=repr(kind), expected=f"one of {', '.join(KINDS)}",
                hint=did_you_mean(str(kind), KINDS),
            )  # fmt: skip
        try:
            KINDS[kind](draft, edit)
        except (KeyError, IndexError, TypeError) as error:
            raise InputError.single(
                f"edits[{number}]", got=f"{type(error).__name__}: {error}", expected=f"a {kind}"
            ) from error
    if draft.reading.problems:
        raise InputError(draft.reading.problems)
