"""A first scene for a pattern and a foam: seams, poses and hooks guessed, and why."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import TypedDict, Unpack

import numpy as np

from seatlook import io
from seatlook.assembly.seam_guess import Proposal, propose_seams
from seatlook.assembly.unfolding import Layout, lay_out
from seatlook.errors import InputError
from seatlook.io.pattern.units import Units
from seatlook.io.surface.axes import Unit, Up
from seatlook.io.templates import write_template
from seatlook.mesh.polyline import length
from seatlook.model import FloatArray, Foam, Pattern
from seatlook.solver import foam_wavelength

SCENE, SEAMS, CURVES = "scene.toml", "seams.toml", "curves.toml"
_TEMPLATE = Path(__file__).with_name("init_scene.toml.j2")
_NEAREST_WIRE = 0.08  # m from a seam to the wire it may be hooked to
_LONGEST_LINE = 1.05  # a scene refuses lines that are longer than their wire by more


class StartChoices(TypedDict, total=False):
    """How a first scene is made; all may be left out.

    ``unit`` ("mm", "cm", "m", "inch") and ``up`` ("z", "y") of the foam's file; ``material`` and
    ``foam_material``: supplied names or files; ``seams``: file taken instead of a guess; ``wires``:
    curves file of the wires in the foam; ``size``, ``units`` and ``encoding`` of the pattern, and
    ``grain_deg`` of its pieces without a grain line; ``top``: the panel on top, turned by
    ``turn_deg``; ``force``: write over a scene that is there.
    """

    unit: Unit | None
    up: Up | None
    material: str
    foam_material: str
    seams: Path | None
    wires: Path | None
    size: str | None
    units: Units | None
    encoding: str | None
    grain_deg: float | None
    top: str | None
    turn_deg: float
    force: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class FirstScene:
    """A scene that was begun.

    Parameters
    ----------
    scene : its file
    proposal : the seams, and why each was guessed
    hooks : wire -> seam
    notes : sentences on what was guessed of the foam
    """

    scene: Path
    proposal: Proposal
    hooks: MappingProxyType[str, str]
    notes: tuple[str, ...]

    @property
    def reasons(self) -> dict[str, str]:
        """Seam -> why it was guessed, and what else would fit."""
        return _reasons(self.proposal)


def init(
    pattern: Path | str, foam: Path | str, out: Path | str, **choices: Unpack[StartChoices]
) -> FirstScene:
    """Write a commented scene for a pattern and a foam, ready to check and evaluate.

    Guesses which edges are sewn together, where the panels start, where the free edges are pulled
    to, and which wires the seams are hooked to.

    Raises
    ------
    InputError
        Files that cannot be read or are in the wrong order, a folder with a scene in it.
    """
    cut, body_file, folder = Path(pattern), Path(foam), Path(out)
    _check_files(cut, body_file, folder, force=choices.get("force", False))
    material = choices.get("material", "leather-laminate")
    filling_name = choices.get("foam_material", "foam-seat")
    cloth, filling = io.read_material(material), io.read_foam_material(filling_name)
    seams, wires = choices.get("seams"), choices.get("wires")
    proposal = _sewn(cut, seams, choices)
    surface = io.read_foam_surface(body_file, unit=choices.get("unit"), up=choices.get("up"))
    body = Foam(vertices=surface.vertices, faces=surface.faces, material=filling)
    turn = choices.get("turn_deg", 0.0)
    layout = lay_out(
        proposal.pattern, body, first=choices.get("top"), turn_deg=turn, free=proposal.free
    )
    curves = {**({} if wires is None else io.read_curves(wires)), **layout.curves}
    hooks = _hooks(proposal.pattern, layout, curves)
    if curves:
        io.write_curves(curves, folder / CURVES)
    if seams is None:
        io.write_seams(proposal.pattern, folder / SEAMS, notes=_reasons(proposal))
    write_template(
        _TEMPLATE,
        folder / SCENE,
        name=cut.stem,
        pattern=_seen_from(cut, folder),
        seams=SEAMS if seams is None else _seen_from(seams, folder),
        size=choices.get("size"), units=choices.get("units"),
        unit=surface.axes.unit, up=surface.axes.up,
        encoding=choices.get("encoding"), grain_deg=choices.get("grain_deg"),
        foam=_seen_from(body_file, folder),
        material=_name_or_path(material, folder),
        foam_material=_name_or_path(filling_name, folder),
        curves=CURVES if curves else None,
        element_size_mm=max(2.0, int(2e3 * foam_wavelength(cloth.fabric, filling) / 8) / 2),
        hooks=hooks, frames=tuple(layout.curves), layout=layout, guessed=seams is None,
    )  # fmt: skip
    return FirstScene(
        scene=folder / SCENE,
        proposal=proposal,
        hooks=MappingProxyType(hooks),
        notes=_foam_notes(body_file, surface, guessed=choices.get("unit") is None),
    )


def _check_files(pattern: Path, foam: Path, out: Path, *, force: bool) -> None:
    """Refuse files in the wrong order, and a folder with a scene in it."""
    if pattern.suffix.lower() != ".dxf" and foam.suffix.lower() == ".dxf":
        raise InputError.single(
            "files", got=f"{pattern.name} {foam.name}", expected="first the pattern, then the foam"
        )
    there = [name for name in (SCENE, SEAMS, CURVES) if (out / name).exists()]
    if there and not force:
        raise InputError.single(
            "--out", got=f"a folder with {', '.join(there)}", expected="a new one, or --force"
        )


def _sewn(pattern: Path, seams: Path | None, choices: StartChoices) -> Proposal:
    """Guess the seams, or read those of the user."""
    size, units = choices.get("size"), choices.get("units")
    encoding, grain_deg = choices.get("encoding"), choices.get("grain_deg")
    if seams is None:
        return propose_seams(
            io.read_panels(pattern, size=size, units=units, encoding=encoding, grain_deg=grain_deg)
        )
    read = io.read_pattern(
        pattern, seams, size=size, units=units, encoding=encoding, grain_deg=grain_deg
    )
    sewn = {name for seam in read.seams for name in (seam.a, *seam.b)}
    return Proposal(
        pattern=read,
        reasons=MappingProxyType({seam.name: "as in the seams file" for seam in read.seams}),
        rivals=MappingProxyType({}),
        free=tuple(name for name in read.edges if name not in sewn),
    )


def _foam_notes(path: Path, surface: io.FoamSurface, *, guessed: bool) -> tuple[str, ...]:
    """Say how large the foam is; one that stands on its edge is most often in other axes."""
    unit, up = surface.axes
    width, depth, height = (round(1e3 * v) for v in np.ptp(surface.vertices, axis=0))
    notes = [f"foam: {width} mm wide, {depth} mm deep, {height} mm high"]
    if guessed and unit != "mm":
        notes.insert(0, f"{path}: read in {unit}, by its format or size")
    if height > min(width, depth):
        other = "z" if up == "y" else "y"
        notes.append(
            "it is higher than wide or deep: "
            f"if its file's vertical axis is {other}, say --up {other}"
        )
    return tuple(notes)


def _hooks(pattern: Pattern, layout: Layout, curves: Mapping[str, FloatArray]) -> dict[str, str]:
    """Wire -> the seam that lies nearest over it and is not longer than it."""
    lines = {}
    for seam in pattern.seams:
        pose = layout.poses[pattern.edges[seam.a].panel]
        line = pattern.edge_points(seam.a) @ pose.rotation[:, :2].T + pose.translation
        lines[seam.name] = line.mean(axis=0), pattern.edge_length(seam.a)
    hooks: dict[str, str] = {}
    for wire, points in curves.items():
        along = length(points)
        middle = points.mean(axis=0)
        near = {
            name: float(np.linalg.norm(at - middle))
            for name, (at, long) in lines.items()
            if along / 2 < long < _LONGEST_LINE * along and name not in hooks.values()
        }
        if wire not in layout.curves and near and min(near.values()) < _NEAREST_WIRE:
            hooks[wire] = min(near, key=lambda name: near[name])
    return hooks


def _reasons(proposal: Proposal) -> dict[str, str]:
    return {
        name: reason
        + (f"; would fit as well: {', '.join(also)}" if (also := proposal.rivals.get(name)) else "")
        for name, reason in proposal.reasons.items()
    }


def _seen_from(path: Path, folder: Path) -> str:
    """Spell a path as seen from a folder."""
    return Path(os.path.relpath(path.resolve(), folder.resolve())).as_posix()


def _name_or_path(material: str, folder: Path) -> str:
    return _seen_from(Path(material), folder) if material.endswith(".toml") else material
