"""The one writer of scenes: for a flattened surface, a pattern of one's own, and the demo."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType

import numpy as np

from seatlook import io
from seatlook.assembly.unfolding import broad_side_up
from seatlook.errors import InputError
from seatlook.io.surface.axes import Axes, Unit, Up
from seatlook.io.templates import write_template
from seatlook.mesh.mending.mend import AS_IT_IS, Mending
from seatlook.model import Fabric, FloatArray, Foam, FoamMaterial, Frame, Hook, Pose
from seatlook.results.resolution import largest_size
from seatlook.solver import foam_wavelength

SCENE, CURVES = "scene.toml", "curves.toml"
SEW, HOOK, COVER = "sew", "hook", "cover"  # stages
MATERIAL, FOAM_MATERIAL = "leather-laminate", "foam-seat"  # where none is given
TEXTURES = ("as built", "bright-leather", "suede")
_TEMPLATE = Path(__file__).with_name("scene.toml.j2")
_BULB = np.array([1.2, 0.53, 1.15])  # place of a bulb, in radii of the foam from its middle
_RADIUS = 0.38  # m, of a foam on which a bulb is exposed with ...
_EV100 = 5.0
_SMALL_MM = 200  # widest side of a foam that may well be one in cm
_HALVES = 2.0  # mm, from which an element size is rounded to halves


@dataclass(frozen=True, slots=True, kw_only=True)
class FoamFile:
    """A foam, and how its file is read.

    Parameters
    ----------
    axes : unit and vertical axis of the file
    material : name or file
    mending : what is done to its surface
    body : the foam with its wires
    notes : sentences on its size, and on what was guessed
    """

    path: Path
    axes: Axes
    material: str
    mending: Mending
    body: Foam
    notes: tuple[str, ...]


def read_foam_file(
    path: Path,
    material: str,
    *,
    unit: Unit | None,
    up: Up | None,
    wires: Path | None,
    mending: Mending = AS_IT_IS,
) -> FoamFile:
    """Read the foam of a scene that is to be written.

    Parameters
    ----------
    unit, up : of the file; by its format and size if not given
    wires : curves file with the wires in the foam, if there are any
    """
    filling = io.read_foam_material(material)
    surface = io.read_foam_surface(path, unit=unit, up=up, mending=mending)
    curves = {} if wires is None else io.read_curves(wires)
    return FoamFile(
        path=path,
        axes=surface.axes,
        material=material,
        mending=mending,
        body=Foam(
            vertices=surface.vertices,
            faces=surface.faces,
            material=filling,
            curves=MappingProxyType(curves),
        ),
        notes=_size_notes(path, surface, guessed=unit is None),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class SceneDraft:
    """What a scene is written from.

    Parameters
    ----------
    name : of the scene
    pattern, seams : files
    reading : how the pattern is read: size, units and so on; None for those not said
    guessed : whether the seams are guessed
    material : of all panels but those in ``panels``; names or files
    curves : name -> (k, 3) [m], besides the wires
    design : file of the surface that the shape is compared with, in mm and z up, if there is one
    hooks, frames, poses : see :class:`seatlook.model.Scene`
    element_size_mm, seed : of the mesh
    tolerance_percent : of zone means, from which the mesh follows instead of a size
    textures : rows of the gallery
    bulbs : rigs of one bulb each, the first to the left of the seat, the second to the right
    remarks : comments at the top
    """

    name: str
    pattern: Path
    seams: Path
    reading: Mapping[str, str | float | Mapping[str, str] | None] = field(
        default_factory=lambda: MappingProxyType({})
    )
    guessed: bool = False
    material: str
    panels: Mapping[str, str] = field(default_factory=lambda: MappingProxyType({}))
    foam: FoamFile
    curves: Mapping[str, FloatArray] = field(default_factory=lambda: MappingProxyType({}))
    design: Path | None = None
    hooks: tuple[Hook, ...] = ()
    frames: tuple[Frame, ...] = ()
    poses: Mapping[str, Pose]
    element_size_mm: float
    tolerance_percent: float | None = None
    seed: int = 0
    textures: tuple[str, ...] = TEXTURES
    bulbs: tuple[str, ...] = ("bulb",)
    remarks: tuple[str, ...] = ()


def write_scene(draft: SceneDraft, folder: Path) -> Path:
    """Write a commented scene, and the curves it names, into a folder; return the scene's file."""
    curves = {**draft.foam.body.curves, **draft.curves}
    if curves:
        io.write_curves(curves, folder / CURVES)
    low, high = draft.foam.body.vertices.min(axis=0), draft.foam.body.vertices.max(axis=0)
    radius = float(np.linalg.norm(high - low)) / 2
    write_template(
        _TEMPLATE,
        folder / SCENE,
        draft=draft,
        pattern=_seen_from(draft.pattern, folder),
        seams=_seen_from(draft.seams, folder),
        material=_name_or_path(draft.material, folder),
        panels={name: _name_or_path(what, folder) for name, what in draft.panels.items()},
        foam=_seen_from(draft.foam.path, folder),
        foam_material=_name_or_path(draft.foam.material, folder),
        curves=CURVES if curves else None,
        design=None if draft.design is None else _seen_from(draft.design, folder),
        bulbs={
            name: _bulb(draft.foam.body, radius, sign)
            for name, sign in zip(draft.bulbs, (1.0, -1.0), strict=False)
        },
        ev100=round(_EV100 - 2.0 * float(np.log2(radius / _RADIUS)), 1),
    )
    return folder / SCENE


def refuse_scene(folder: Path, *files: str, force: bool) -> None:
    """Refuse a folder that holds a scene, or one of these files, which may have been edited."""
    there = [name for name in (SCENE, CURVES, *files) if (folder / name).exists()]
    if there and not force:
        raise InputError.single(
            "--out", got=f"a folder with {', '.join(there)}", expected="a new one, or --force"
        )


def hook_words(hook: Hook) -> str:
    """Say what a hook pulls where."""
    return f"{' + '.join(hook.lines)} to {hook.wire}"


def element_size(fabric: Fabric, foam: FoamMaterial) -> float:
    """Edge length [mm] that a first scene takes: what resolves a wrinkle on this foam."""
    wave = largest_size(foam_wavelength(fabric, foam))
    return int(2.0 * wave) / 2.0 if wave >= _HALVES else wave


def _size_notes(path: Path, surface: io.FoamSurface, *, guessed: bool) -> tuple[str, ...]:
    """Say how large the foam is; one that stands on its edge is most often in other axes."""
    unit, up = surface.axes
    width, depth, height = (round(1e3 * v) for v in np.ptp(surface.vertices, axis=0))
    notes = [f"foam: {m.number} {m.what} at {surface.axes.place(m.place)}" for m in surface.mended]
    notes += [f"foam: {width} mm wide, {depth} mm deep, {height} mm high"]
    if guessed and unit != "mm":
        notes.insert(0, f"{path}: read in {unit}, by its format or size")
    elif guessed and max(width, depth, height) < _SMALL_MM:
        notes.append("that is small for a part of a seat: if its file is in cm, say --unit cm")
    if height > min(width, depth):
        other = "z" if up == "y" else "y"
        notes.append(
            "it is higher than wide or deep: "
            f"if its file's vertical axis is {other}, say --up {other}"
        )
    return tuple(notes)


def _bulb(foam: Foam, radius: float, sign: float) -> list[float]:
    """Place [mm] of a bulb before the broad side of a foam, to the left or right, to 1 cm."""
    turn = broad_side_up(foam)
    body = foam.vertices @ turn.T
    middle = (body.min(axis=0) + body.max(axis=0)) / 2
    place = (middle + radius * _BULB * [sign, 1.0, 1.0]) @ turn
    return [float(10 * round(100 * value)) for value in place]


def _seen_from(path: Path, folder: Path) -> str:
    """Spell a path as seen from a folder."""
    return Path(os.path.relpath(path.resolve(), folder.resolve())).as_posix()


def _name_or_path(material: str, folder: Path) -> str:
    return _seen_from(Path(material), folder) if material.endswith(".toml") else material
