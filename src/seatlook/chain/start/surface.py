"""A design surface made into a scene that runs: flattened, framed at its borders, hooked."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import TypedDict, Unpack

from seatlook import io
from seatlook.assembly.hooking import hooks_beside
from seatlook.chain.start.scene_file import (
    COVER,
    FOAM_MATERIAL,
    HOOK,
    MATERIAL,
    TEXTURES,
    FoamFile,
    SceneDraft,
    element_size,
    hook_words,
    read_foam_file,
    refuse_scene,
    write_scene,
)
from seatlook.errors import InputError
from seatlook.flattening.files import (
    PANELS,
    PATTERN,
    PLACEMENT,
    SEAMS,
    FlattenChoices,
    FlattenedFiles,
    flatten_surface,
)
from seatlook.flattening.lie import Lie, read_lie
from seatlook.io.surface.axes import Unit, Up
from seatlook.io.surface.formats import READERS
from seatlook.mesh.mending.mend import AS_IT_IS, Mending

WIRES = "wires.toml"
NEAREST_WIRE = 0.030  # m from a seam of the design to the wire it is hooked to


class SceneChoices(TypedDict, total=False):
    """What a scene over a flattened surface is made with; all may be left out.

    ``material`` of all panels but those in ``panels`` (panel -> material) and ``foam_material``:
    supplied names or files. ``wires``: curves file of the wires in the foam. ``foam_unit`` and
    ``foam_up`` of the foam's file; by its format and size if not given. ``foam_mending`` of its
    surface. ``element_size_mm``, or ``tolerance_percent`` instead, and
    ``seed`` of the mesh; ``name``, ``textures``, ``bulbs`` (rigs) and ``remarks`` (comments at the
    top) of the scene. ``force``: write over a scene that is there.
    """

    material: str
    panels: Mapping[str, str]
    foam_material: str
    wires: Path | None
    foam_unit: Unit | None
    foam_up: Up | None
    foam_mending: Mending
    element_size_mm: float | None
    tolerance_percent: float | None
    seed: int
    name: str
    textures: tuple[str, ...]
    bulbs: tuple[str, ...]
    remarks: tuple[str, ...]
    force: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class FlattenedScene:
    """A surface that was flattened into a scene.

    Parameters
    ----------
    scene : its file
    draft : what it was written from
    """

    scene: Path
    draft: SceneDraft

    @property
    def notes(self) -> tuple[str, ...]:
        """What the scene holds, and how to go on."""
        hooks, frames = self.draft.hooks, self.draft.frames
        hooked = {hook.wire for hook in hooks}
        loose = [name for name in self.draft.foam.body.curves if name not in hooked]
        return (
            *self.draft.foam.notes,
            f"borders: {', '.join(f.name for f in frames) or 'none, the cover is closed'}",
            f"hooks: {', '.join(map(hook_words, hooks)) or 'none'}",
            *(f"wire {name}: no seam runs beside it" for name in loose),
            f"scene: {self.scene}; next:",
            f"  seatlook check {self.scene}",
            f"  seatlook evaluate {self.scene} --out {self.scene.with_name('gallery')}",
        )


def flatten_scene(
    surface: Path | str,
    foam: Path | str,
    out: Path | str,
    *,
    flattening: FlattenChoices | None = None,
    **choices: Unpack[SceneChoices],
) -> tuple[FlattenedFiles, FlattenedScene]:
    """Flatten a design surface and write a scene in which the pattern is pulled over a foam.

    Leaves what :func:`seatlook.flattening.files.flatten_surface` does, ``curves.toml`` and
    ``scene.toml``. Free borders are pulled to where they lie on the surface, one closed curve for
    each border; seams beside wires are hooked to them.

    Parameters
    ----------
    surface, foam : files; out : folder
    flattening : how the surface is flattened

    Raises
    ------
    InputError
        Files that cannot be read; a surface that cannot be cut or flattened; unknown names.
    """
    folder = Path(out)
    refuse_scene(folder, force=choices.get("force", False))
    filling = foam_file(Path(foam), **choices)
    made = flatten_surface(surface, folder, **(flattening or {}))
    return made, _scene_of(made.lie, filling, folder, folder, choices)


def foam_file(foam: Path, **choices: Unpack[SceneChoices]) -> FoamFile:
    """Read the foam, its material and wires, as the choices of a scene say."""
    return read_foam_file(
        foam,
        choices.get("foam_material", FOAM_MATERIAL),
        unit=choices.get("foam_unit"),
        up=choices.get("foam_up"),
        mending=choices.get("foam_mending", AS_IT_IS),
        wires=choices.get("wires"),
    )


def scene_from(
    folder: Path | str,
    foam: Path | str | None = None,
    out: Path | str | None = None,
    **choices: Unpack[SceneChoices],
) -> FlattenedScene:
    """Write the scene of a surface that was flattened into a folder before.

    Parameters
    ----------
    folder : with what :func:`seatlook.flattening.files.flatten_surface` left
    foam : file; None takes ``foam.obj``, ``.stl``, ``.ply`` or ``.glb`` of the folder; a file
        ``wires.toml`` there counts if no wires are given
    out : folder of the scene; None takes the same

    Raises
    ------
    InputError
        Files that are missing or cannot be read, a folder with a scene in it.
    """
    home = Path(folder)
    there = home if out is None else Path(out)
    refuse_scene(there, force=choices.get("force", False))
    for name in (PATTERN, SEAMS, PLACEMENT):
        if not (home / name).exists():
            raise InputError.single(
                "--from", got=f"a folder without {name}", expected="one that flatten wrote",
                file=home,
            )  # fmt: skip
    lie = read_lie(home / PLACEMENT)
    if choices.get("wires") is None and (home / WIRES).exists():
        choices["wires"] = home / WIRES
    filling = foam_file(_foam_in(home) if foam is None else Path(foam), **choices)
    return _scene_of(lie, filling, home, there, choices)


def _foam_in(folder: Path) -> Path:
    """The foam that lies in a folder."""
    files = [folder / f"foam{ending}" for ending in READERS]
    found = [file for file in files if file.exists()]
    if len(found) != 1:
        got = f"{len(found)} of {', '.join(file.name for file in files)}"
        raise InputError.single("foam", got=got, expected="one, or its file", file=folder)
    return found[0]


def _scene_of(
    lie: Lie, foam: FoamFile, home: Path, folder: Path, choices: SceneChoices
) -> FlattenedScene:
    """Write into a folder the scene of a pattern at home in another."""
    material = choices.get("material", MATERIAL)
    size = element_size(io.read_material(material).fabric, foam.body.material)
    draft = SceneDraft(
        name=choices.get("name", folder.resolve().name),
        pattern=home / PATTERN,
        seams=home / SEAMS,
        material=material,
        panels=choices.get("panels", MappingProxyType({})),
        foam=foam,
        curves={border.name: border.curve for border in lie.borders},
        design=home / PANELS if (home / PANELS).exists() else None,
        hooks=hooks_beside(lie.seams, foam.body.curves, reach=NEAREST_WIRE, stage=HOOK),
        frames=tuple(border.frame(COVER) for border in lie.borders),
        poses=lie.poses,
        element_size_mm=choices.get("element_size_mm") or size,
        tolerance_percent=choices.get("tolerance_percent"),
        seed=choices.get("seed", 0),
        textures=choices.get("textures", TEXTURES),
        bulbs=choices.get("bulbs", ("bulb",)),
        remarks=choices.get("remarks", ()),
    )
    return FlattenedScene(scene=write_scene(draft, folder), draft=draft)
