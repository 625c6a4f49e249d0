"""Every kind of edit by its name, and how several are made together."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from seatlook.errors import InputError, did_you_mean
from seatlook.studio.edits import arrange, scene, seams
from seatlook.studio.edits.draft import Draft, Edit

TABLES = (
    "accept",
    "camera",
    "gallery",
    "mesh",
    "wrinkle",
    "improve",
    "check",
    "pattern",
    "foam",
    "thread",
)
ROWS = ("stage", "hook", "frame", "rig")

KINDS: dict[str, Callable[[Draft, Edit], None]] = {
    "seam.add": seams.add,
    "seam.remove": seams.remove,
    "seam.turn": seams.turn,
    "seam.rename": seams.rename,
    "seam.set": seams.change,
    "guess.accept": seams.accept,
    "guess.refuse": scene.refuse_guess,
    "panel.set": scene.set_panel,
    "pose.set": scene.set_pose,
    "wire.set": scene.set_wire,
    "material.copy": scene.copy_material,
    "material.set": scene.set_material,
    "scene.arrange": arrange.arrange,
    "scene.copy": scene.copy_scene,
    **{f"{table}.set": scene.set_in_table(table) for table in TABLES},
    **{f"{table}.set": scene.set_in_row(table) for table in ROWS},
    **{f"{table}.add": scene.add_to(table) for table in ROWS},
    **{f"{table}.remove": scene.remove_from(table) for table in ROWS},
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
        except InputError:
            raise
        except (KeyError, IndexError, TypeError, ValueError) as error:
            if draft.reading.problems:
                raise InputError(draft.reading.problems) from error
            raise InputError.single(
                f"edits[{number}]", got=f"{type(error).__name__}: {error}", expected=f"a {kind}"
            ) from error
    if draft.reading.problems:
        raise InputError(draft.reading.problems)
