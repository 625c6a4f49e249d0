"""A first scene for a pattern and a foam: seams, poses and hooks guessed, and why."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType
from typing import TypedDict, Unpack

from seatlook import io
from seatlook.assembly.hooking import hooks_beside
from seatlook.assembly.seam_guess import Proposal, propose_seams
from seatlook.assembly.unfolding import Layout, lay_out
from seatlook.chain.start.scene_file import (
    COVER,
    FOAM_MATERIAL,
    HOOK,
    MATERIAL,
    FoamFile,
    SceneDraft,
    element_size,
    read_foam_file,
    refuse_scene,
    write_scene,
)
from seatlook.chain.start.to_do import (
    doubtful_seams,
    scale_notes,
    seam_notes,
    seam_reasons,
    what_is_missing,
)
from seatlook.errors import InputError
from seatlook.io.pattern.dxf import Reading
from seatlook.io.pattern.units import Units
from seatlook.io.surface.axes import Unit, Up
from seatlook.mesh.mending.mend import AS_IT_IS, Mending
from seatlook.model import FloatArray, Foam, Frame, Hook, Pattern

SEAMS = "seams.toml"
_NEAREST_WIRE = 0.08  # m from a seam to the wire it may be hooked to


class StartChoices(TypedDict, total=False):
    """How a first scene is made; all may be left out.

    ``unit`` ("mm", "cm", "m", "inch") and ``up`` ("z", "y") of the foam's file;
    ``mending`` of its surface; ``material`` and
    ``foam_material``: supplied names or files; ``seams``: file taken instead of a guess; ``wires``:
    curves file of the wires in the foam; ``size``, ``units`` and ``encoding`` of the pattern, and
    ``grain_deg`` of its pieces without a grain line, ``allowance_mm`` of those without a sew line;
    ``layers``: layer of the file -> what it means, as CUT or SEW;
    ``top``: the panel on top, turned by
    ``turn_deg``; ``force``: write over a scene that is there.
    """

    unit: Unit | None
    up: Up | None
    mending: Mending
    material: str
    foam_material: str
    seams: Path | None
    wires: Path | None
    size: str | None
    units: Units | None
    encoding: str | None
    grain_deg: float | None
    allowance_mm: float | None
    layers: Mapping[str, str] | None
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
    hooks : seams that lie beside wires
    notes : what was read of the pattern and what was not, and what was guessed of the foam
    missing : sentences on what is left to be filled in by hand
    """

    scene: Path
    proposal: Proposal
    hooks: tuple[Hook, ...]
    notes: tuple[str, ...]
    missing: tuple[str, ...]

    @property
    def reasons(self) -> dict[str, str]:
        """Seam -> why it was guessed, and what else would fit."""
        return seam_reasons(self.proposal)


def init(
    pattern: Path | str, foam: Path | str, out: Path | str, **choices: Unpack[StartChoices]
) -> FirstScene:
    """Write a commented scene for a pattern and a foam, ready to check and evaluate.

    Guesses which edges are sewn together, where the panels start, where the free edges are pulled
    to, and which wires the seams are hooked to. What cannot be guessed is written as far as it is
    known, and listed.

    Raises
    ------
    InputError
        Files that cannot be read or are in the wrong order, a folder with a scene in it.
    """
    cut, folder, own_seams = Path(pattern), Path(out), choices.get("seams")
    _check_files(cut, Path(foam), folder, force=choices.get("force", False))
    io.read_material(choices.get("material", MATERIAL))
    proposal = _sewn(cut, own_seams, choices)
    filling = read_foam_file(
        Path(foam),
        choices.get("foam_material", FOAM_MATERIAL),
        unit=choices.get("unit"),
        up=choices.get("up"),
        wires=choices.get("wires"),
        mending=choices.get("mending", AS_IT_IS),
    )
    arrangement = arrange(
        proposal.pattern,
        filling.body,
        top=choices.get("top"),
        turn_deg=choices.get("turn_deg", 0.0),
    )
    if own_seams is None:
        io.write_seams(
            proposal.pattern, folder / SEAMS,
            notes=seam_notes(proposal), remarks=doubtful_seams(proposal),
        )  # fmt: skip
    files = cut, folder / SEAMS if own_seams is None else own_seams
    draft = _draft(files, arrangement, filling, choices)
    return FirstScene(
        scene=write_scene(draft, folder),
        proposal=proposal,
        hooks=draft.hooks,
        notes=(
            *_pattern_notes(cut, choices),
            *filling.notes,
            *scale_notes(proposal.pattern, filling.body),
        ),
        missing=what_is_missing(proposal, arrangement.layout),
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class Arrangement:
    """Where panels start and what is tied to what, as far as it follows from seams and foam.

    Parameters
    ----------
    hooks : seams that lie beside wires
    frames : free borders and the curves they are pulled to
    curves : name -> (k, 3) [m], of the frames
    """

    layout: Layout
    hooks: tuple[Hook, ...]
    frames: tuple[Frame, ...]
    curves: Mapping[str, FloatArray]


def arrange(
    pattern: Pattern, foam: Foam, *, top: str | None = None, turn_deg: float = 0.0
) -> Arrangement:
    """Lay a sewn pattern out over a foam, hook what lies beside wires, and frame the borders.

    Parameters
    ----------
    top : the panel on top, turned by ``turn_deg``
    """
    layout = lay_out(pattern, foam, first=top, turn_deg=turn_deg, partial=True)
    lines = {seam.name: _placed(pattern, seam.a, layout) for seam in pattern.seams}
    return Arrangement(
        layout=layout,
        hooks=hooks_beside(lines, foam.curves, reach=_NEAREST_WIRE, stage=HOOK),
        frames=tuple(border.frame(COVER) for border in layout.borders),
        curves={border.name: border.curve for border in layout.borders},
    )


def _draft(
    files: tuple[Path, Path],
    arrangement: Arrangement,
    foam: FoamFile,
    choices: StartChoices,
) -> SceneDraft:
    """What the scene of a pattern and its seams file is written from."""
    material = choices.get("material", MATERIAL)
    return SceneDraft(
        name=files[0].stem,
        pattern=files[0],
        seams=files[1],
        reading={
            "size": choices.get("size"),
            "units": choices.get("units"),
            "encoding": choices.get("encoding"),
            "grain_deg": choices.get("grain_deg"),
            "allowance_mm": choices.get("allowance_mm"),
            "layers": choices.get("layers"),
        },
        guessed=choices.get("seams") is None,
        material=material,
        foam=foam,
        curves=arrangement.curves,
        hooks=arrangement.hooks,
        frames=arrangement.frames,
        poses=arrangement.layout.poses,
        element_size_mm=element_size(io.read_material(material).fabric, foam.body.material),
    )


def _check_files(pattern: Path, foam: Path, out: Path, *, force: bool) -> None:
    """Refuse files in the wrong order, and a folder with a scene in it."""
    if pattern.suffix.lower() != ".dxf" and foam.suffix.lower() == ".dxf":
        raise InputError.single(
            "files", got=f"{pattern.name} {foam.name}", expected="first the pattern, then the foam"
        )
    refuse_scene(out, SEAMS, force=force)


def _pattern_notes(cut: Path, choices: StartChoices) -> tuple[str, ...]:
    """Say what was read of the pattern, and what was not."""
    if cut.suffix.lower() != ".dxf":
        return ()
    report = io.report_dxf(
        cut,
        size=choices.get("size"),
        units=choices.get("units"),
        encoding=choices.get("encoding"),
        layers=choices.get("layers") or {},
    )
    return tuple(f"{cut.name}: {line}" for line in report.lines())


def _sewn(pattern: Path, seams: Path | None, choices: StartChoices) -> Proposal:
    """Guess the seams, or read those of the user."""
    width = choices.get("allowance_mm")
    reading = Reading(
        size=choices.get("size"),
        units=choices.get("units"),
        encoding=choices.get("encoding"),
        grain_deg=choices.get("grain_deg"),
        allowance=None if width is None else width / 1e3,
        layers=choices.get("layers") or {},
    )
    if seams is None:
        return propose_seams(io.read_panels(pattern, **reading))
    read = io.read_pattern(pattern, seams, **reading)
    sewn = {name for seam in read.seams for name in (seam.a, *seam.b)}
    return Proposal(
        pattern=read,
        reasons=MappingProxyType({seam.name: "as in the seams file" for seam in read.seams}),
        rivals=MappingProxyType({}),
        free=tuple(name for name in read.edges if name not in sewn),
    )


def _placed(pattern: Pattern, edge: str, layout: Layout) -> FloatArray:
    """Points (k, 3) [m] of an edge where its panel starts."""
    pose = layout.poses[pattern.edges[edge].panel]
    return pose.at(pattern.edge_points(edge))
