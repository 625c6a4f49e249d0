"""The command that starts a scene from a user's own pattern and foam."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from seatlook.cli._mend import MendingOptions
from seatlook.cli._options import Names
from seatlook.cli._output import Json, note, progress, table
from seatlook.errors import InputError
from seatlook.io.pattern.units import Units
from seatlook.io.surface.axes import Unit, Up

if TYPE_CHECKING:
    from seatlook.chain.start.pattern import FirstScene
    from seatlook.chain.start.surface import FlattenedScene


def init(
    pattern: Annotated[
        Path | None, Parameter(help="Cover pattern: AAMA / ASTM D6673 DXF; not with --from.")
    ] = None,
    /,
    foam: Annotated[
        Path | None, Parameter(help="Foam: closed surface, OBJ, STL, PLY or glTF.")
    ] = None,
    *,
    from_: Annotated[Path | None, Parameter(name="--from")] = None,
    out: Annotated[Path | None, Parameter(help="Folder for the new scene.")] = None,
    unit: Unit | None = None,
    up: Up | None = None,
    mending: MendingOptions | None = None,
    material: str = "leather-laminate",
    foam_material: str = "foam-seat",
    seams: Path | None = None,
    wires: Path | None = None,
    size: str | None = None,
    units: Units | None = None,
    encoding: str | None = None,
    grain_deg: float | None = None,
    allowance_mm: float | None = None,
    layer: Names = (),
    top: str | None = None,
    turn_deg: float = 0.0,
    force: Annotated[bool, Parameter(negative=())] = False,
    json: Json = False,
) -> None:
    """Write a commented scene for a pattern and a foam of your own, ready to check and evaluate.

    Guesses which edges are sewn together (lengths, notches, symmetry, a closed surface), where
    the panels start, and where the free edges are pulled to; says why beside each guess. Read
    seams.toml over: the guesses are the weakest part of the scene.

    Example: seatlook init cover.dxf foam.obj --out my-seat

    Example: seatlook init --from pattern-folder foam.obj

    Parameters
    ----------
    from_
        Folder that "seatlook flatten" wrote: nothing is guessed. The foam may lie in it as foam.obj
        and the wires as wires.toml; the scene is written there if --out is not given.
    unit
        Unit of the foam's file; by its format and size if not given.
    up
        Vertical axis of the foam's file; y in glTF, else z, if not given.
    material
        Cover material, from "seatlook materials list" or a file of your own.
    foam_material
        Foam material, by name or file.
    seams
        Seams file of your own, taken instead of a guess.
    wires
        Curves file with the wires in the foam; seams beside them are hooked to them.
    size
        Which of the pattern's graded sizes.
    units
        Units of a DXF that does not say them.
    encoding
        Encoding of the names in the DXF, as gb18030; guessed if not given.
    grain_deg
        Warp of panels without a grain line, from the pattern's x axis; 90 if not given.
    allowance_mm
        Width of the allowance where only the cut line is drawn: the sew line lies so far inside.
    layer
        LAYER=MEANING for a layer of the DXF: SCHNITT=CUT. Also SEW, NOTCH, GRAIN and others.
    top
        Panel that lies on top; the largest if not given.
    turn_deg
        Turn of that panel seen from above; at 0 its vertical axis points backward.
    force
        Write over a scene that is in the folder already.
    """
    from seatlook.chain.start import init as start
    from seatlook.chain.start import scene_from

    if from_ is not None:
        made = scene_from(
            from_, foam or pattern, out,
            foam_unit=unit, foam_up=up, foam_mending=(mending or MendingOptions()).choices(),
            material=material, foam_material=foam_material, wires=wires, force=force,
        )  # fmt: skip
        _show_ties(made, json=json)
        return
    if pattern is None or foam is None or out is None:
        raise InputError.single(
            "init",
            got="too little",
            expected="PATTERN FOAM --out FOLDER, or --from FOLDER",
            hint="see: seatlook init --help",
        )
    with progress() as show:
        show("lay out")
        first = start(
            pattern, foam, out,
            unit=unit, up=up, mending=(mending or MendingOptions()).choices(),
            material=material, foam_material=foam_material, seams=seams,
            wires=wires, size=size, units=units, encoding=encoding, grain_deg=grain_deg,
            allowance_mm=allowance_mm, layers=_layers(layer), top=top,
            turn_deg=turn_deg, force=force,
        )  # fmt: skip
    _show_guesses(first, out, json=json)


def _show_guesses(first: FirstScene, out: Path, *, json: bool) -> None:
    """Draw the pattern, print what was guessed and what is missing, and how to go on."""
    from seatlook.chain.start.scene_file import hook_words
    from seatlook.report.pattern_drawing import draw_pattern

    drawing, _ = draw_pattern(first.proposal, out)
    note(*first.notes)
    reasons, proposal = first.reasons, first.proposal
    table(
        ("seam", "a", "b", "why"),
        [(s.name, s.a, " + ".join(s.b), reasons[s.name]) for s in proposal.pattern.seams],
        json=json,
    )
    note(
        f"free edges: {', '.join(proposal.free) or 'none'}",
        f"hooks: {', '.join(map(hook_words, first.hooks)) or 'none'}",
        *(f"missing: {what}" for what in first.missing),
        f"drawing with the names of all edges: {drawing} and .png",
        f"scene: {first.scene}; read {out / 'seams.toml'} over, then:",
        f"  seatlook check {first.scene}",
        f"  seatlook evaluate {first.scene} --out {out / 'gallery'}",
    )


def _show_ties(made: FlattenedScene, *, json: bool) -> None:
    """Print what the cover of a flattened surface is pulled to, and how to go on."""
    rows = [(h.name, " + ".join(h.lines), h.wire) for h in made.draft.hooks]
    rows += [(f.name, " + ".join(f.edges), f.curve) for f in made.draft.frames]
    table(("tie", "lines", "to"), rows, json=json)
    note(*made.notes)


def _layers(words: tuple[str, ...]) -> dict[str, str]:
    """Read LAYER=MEANING."""
    pairs = [word.rpartition("=") for word in words]
    for word, (name, _, meaning) in zip(words, pairs, strict=True):
        if not name or not meaning:
            raise InputError.single("--layer", got=word, expected="LAYER=MEANING, as SCHNITT=CUT")
    return {name: meaning for name, _, meaning in pairs}
