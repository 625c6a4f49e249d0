"""The command that starts a scene from a user's own pattern and foam."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import Parameter

from seatlook.cli._output import Json, note, progress, table, template
from seatlook.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Mapping

    from seatlook.assembly.seam_guess import Proposal
    from seatlook.assembly.unfolding import Layout
    from seatlook.model import FloatArray, Foam, FoamMaterial, Pattern

_FILES = ("scene.toml", "seams.toml", "curves.toml")
_NEAREST_WIRE = 0.08  # m from a seam to the wire it may be hooked to
_LONGEST_LINE = 1.05  # a scene refuses lines that are longer than their wire by more


@dataclass(frozen=True)
class Sources:
    """Files a scene is started from."""

    pattern: Path
    foam: Path
    seams: Path | None
    wires: Path | None


def init(
    pattern: Annotated[Path, Parameter(help="Cover pattern: AAMA / ASTM D6673 DXF.")],
    foam: Annotated[Path, Parameter(help="Foam: closed surface, OBJ, STL or PLY.")],
    /,
    *,
    out: Annotated[Path, Parameter(help="Folder for the new scene.")],
    unit: Literal["mm", "m"] | None = None,
    up: Literal["z", "y"] = "z",
    material: str = "leather-laminate",
    foam_material: str = "foam-seat",
    seams: Path | None = None,
    wires: Path | None = None,
    size: str | None = None,
    units: Literal["metric", "english"] | None = None,
    top: str | None = None,
    turn_deg: float = 0.0,
    force: Annotated[bool, Parameter(negative=())] = False,
    json: Json = False,
) -> None:
    """Write a commented scene for a pattern and a foam of your own, ready to check and evaluate.

    Guesses which edges are sewn together (equal lengths, notches that meet, ends that meet), where
    the panels start, and where the free edges are pulled to; says why beside each guess. Read
    seams.toml over: the guesses are the weakest part of the scene.

    Example: seatlook init cover.dxf foam.obj --out my-seat

    Parameters
    ----------
    unit
        Unit of the foam's file; guessed from its size if not given.
    up
        Vertical axis of the foam's file.
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
    top
        Panel that lies on top; the largest if not given.
    turn_deg
        Turn of that panel seen from above; at 0 its vertical axis points backward.
    force
        Write over a scene that is in the folder already.
    """
    _check_files(pattern, foam, out, force=force)
    from seatlook import io
    from seatlook.assembly.unfolding import lay_out
    from seatlook.solver.foam.contact import foam_wavelength

    sources = Sources(pattern, foam, seams, wires)
    cloth, filling = io.read_material(material), io.read_foam_material(foam_material)
    proposal = _sewn(sources, size, units)
    body, unit = _foam(foam, filling, unit, up)
    _tell_size(body, up)
    with progress() as show:
        show("lay out")
        layout = lay_out(proposal.pattern, body, first=top, turn_deg=turn_deg, free=proposal.free)
    curves = {**({} if wires is None else io.read_curves(wires)), **layout.curves}
    hooks = _hooks(proposal.pattern, layout, curves, tuple(layout.curves))
    if curves:
        io.write_curves(curves, out / "curves.toml")
    if seams is None:
        io.write_seams(proposal.pattern, out / "seams.toml", notes=_notes(proposal))
    text = template("init_scene.toml.j2").render(
        name=pattern.stem,
        pattern=_seen_from(pattern, out),
        seams="seams.toml" if seams is None else _seen_from(seams, out),
        size=size, units=units, unit=unit, up=up,
        foam=_seen_from(foam, out),
        material=_name_or_path(material, out),
        foam_material=_name_or_path(foam_material, out),
        curves="curves.toml" if curves else None,
        element_size_mm=max(2.0, int(2e3 * foam_wavelength(cloth.fabric, filling) / 8) / 2),
        hooks=hooks, frames=tuple(layout.curves), layout=layout, guessed=seams is None,
    )  # fmt: skip
    from seatlook.files import write_text

    write_text(out / "scene.toml", text + "\n")
    _tell(proposal, hooks, out, json=json)


def _check_files(pattern: Path, foam: Path, out: Path, *, force: bool) -> None:
    """Refuse files in the wrong order, and a folder with a scene in it."""
    if pattern.suffix.lower() != ".dxf" and foam.suffix.lower() == ".dxf":
        raise InputError.single(
            "files", got=f"{pattern.name} {foam.name}", expected="first the pattern, then the foam"
        )
    there = [name for name in _FILES if (out / name).exists()]
    if there and not force:
        raise InputError.single(
            "--out", got=f"a folder with {', '.join(there)}", expected="a new one, or --force"
        )


def _sewn(
    sources: Sources, size: str | None, units: Literal["metric", "english"] | None
) -> Proposal:
    """Guess the seams, or read those of the user."""
    from types import MappingProxyType

    from seatlook import io
    from seatlook.assembly.seam_guess import Proposal, propose_seams

    if sources.seams is None:
        return propose_seams(io.read_panels(sources.pattern, size=size, units=units))
    read = io.read_pattern(sources.pattern, sources.seams, size=size, units=units)
    sewn = {name for seam in read.seams for name in (seam.a, *seam.b)}
    return Proposal(
        pattern=read,
        reasons=MappingProxyType({seam.name: "as in the seams file" for seam in read.seams}),
        rivals=MappingProxyType({}),
        free=tuple(name for name in read.edges if name not in sewn),
    )


def _foam(
    path: Path, material: FoamMaterial, unit: Literal["mm", "m"] | None, up: Literal["z", "y"]
) -> tuple[Foam, Literal["mm", "m"]]:
    """Read the foam; without a unit, in the one in which it is as large as a seat."""
    from seatlook import io

    if unit is not None:
        return io.read_foam(path, material=material, unit=unit, up=up), unit
    try:
        return io.read_foam(path, material=material, unit="mm", up=up), "mm"
    except InputError as error:
        try:
            body = io.read_foam(path, material=material, unit="m", up=up)
        except InputError:
            raise error from None
    note(f"{path}: read in metres, by its size")
    return body, "m"


def _tell_size(body: Foam, up: Literal["z", "y"]) -> None:
    """Say how large the foam is; one that stands on its edge is most often in other axes."""
    import numpy as np

    width, depth, height = (round(1e3 * v) for v in np.ptp(body.vertices, axis=0))
    note(f"foam: {width} mm wide, {depth} mm deep, {height} mm high")
    if height > min(width, depth):
        other = "z" if up == "y" else "y"
        note(
            "it is higher than wide or deep: "
            f"if its file's vertical axis is {other}, say --up {other}"
        )


def _hooks(
    pattern: Pattern, layout: Layout, curves: Mapping[str, FloatArray], frames: tuple[str, ...]
) -> dict[str, str]:
    """Wire -> the seam that lies nearest over it and is not longer than it."""
    import numpy as np

    from seatlook import mesh

    lines = {}
    for seam in pattern.seams:
        pose = layout.poses[pattern.edges[seam.a].panel]
        line = pattern.edge_points(seam.a) @ pose.rotation[:, :2].T + pose.translation
        lines[seam.name] = line.mean(axis=0), pattern.edge_length(seam.a)
    hooks: dict[str, str] = {}
    for wire, points in curves.items():
        length = mesh.length(points)
        middle = points.mean(axis=0)
        near = {
            name: float(np.linalg.norm(at - middle))
            for name, (at, long) in lines.items()
            if length / 2 < long < _LONGEST_LINE * length and name not in hooks.values()
        }
        if wire not in frames and near and min(near.values()) < _NEAREST_WIRE:
            hooks[wire] = min(near, key=lambda name: near[name])
    return hooks


def _notes(proposal: Proposal) -> dict[str, str]:
    """One comment per seam: why it was guessed, and what else would fit."""
    return {
        name: reason
        + (f"; would fit as well: {', '.join(also)}" if (also := proposal.rivals.get(name)) else "")
        for name, reason in proposal.reasons.items()
    }


def _tell(proposal: Proposal, hooks: Mapping[str, str], out: Path, *, json: bool) -> None:
    table(
        ("seam", "a", "b", "why"),
        [(s.name, s.a, " + ".join(s.b), _notes(proposal)[s.name]) for s in proposal.pattern.seams],
        json=json,
    )
    note(
        f"free edges: {', '.join(proposal.free) or 'none'}",
        f"hooks: {', '.join(f'{line} to {wire}' for wire, line in hooks.items()) or 'none'}",
        f"scene: {out / 'scene.toml'}; read {out / 'seams.toml'} over, then:",
        f"  seatlook check {out / 'scene.toml'}",
        f"  seatlook evaluate {out / 'scene.toml'} --out {out / 'gallery'}",
    )


def _seen_from(path: Path, folder: Path) -> str:
    """Spell a path as seen from a folder."""
    return Path(os.path.relpath(path.resolve(), folder.resolve())).as_posix()


def _name_or_path(material: str, folder: Path) -> str:
    return _seen_from(Path(material), folder) if material.endswith(".toml") else material
