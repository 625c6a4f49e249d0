"""A flattened pattern in files: DXF, seams, poses, lengths of the seams, pictures of the strain."""

from __future__ import annotations

import shlex
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType
from typing import TypedDict, Unpack

from seatlook import io
from seatlook.errors import InputError
from seatlook.flattening.cutting import cut_along, opened
from seatlook.flattening.flatten import Flattened, flatten
from seatlook.flattening.lie import Lie, lie_of, write_lie
from seatlook.flattening.strain_map import write_strain_maps
from seatlook.flattening.surface import DesignSurface
from seatlook.io.surface.axes import Unit, Up
from seatlook.model import Fabric
from seatlook.model.progress import Progress, silent

PATTERN, SEAMS, PLACEMENT = "pattern.dxf", "seams.toml", "placement.toml"
PANELS = "panels.obj"
_MEND_COMMAND = "seatlook mend"
_MEND = f"{_MEND_COMMAND} SURFACE"  # in hints of what knows no file


class FlattenChoices(TypedDict, total=False):
    """How a design surface is flattened.

    ``seam_lines``: curves file with lines along which the surface is cut into panels; ``unit`` and
    ``up`` of the surface, by its format and size if not given; ``ease``: seam -> share by which one
    line is longer; ``short``: panel -> share by which it is narrower across its grain; ``tension``:
    share by which all panels are smaller; ``allowance`` [m]; ``fabric`` that takes the least strain
    energy; ``progress`` is called panel by panel.
    """

    seam_lines: Path | None
    unit: Unit | None
    up: Up | None
    ease: Mapping[str, float]
    short: Mapping[str, float]
    tension: float
    allowance: float
    fabric: Fabric | None
    progress: Progress


@dataclass(frozen=True, slots=True, kw_only=True)
class FlattenedFiles:
    """A flattened pattern, how it lies on the surface, and pictures of the strain left in it."""

    flat: Flattened
    lie: Lie
    pictures: tuple[Path, ...]


def flatten_surface(
    surface: Path | str, out: Path | str, **choices: Unpack[FlattenChoices]
) -> FlattenedFiles:
    """Flatten the panels of a design surface, and write a pattern of them.

    Leaves ``pattern.dxf``, ``seams.toml``, ``placement.toml``, ``seam-lengths.csv``, pictures of
    the strain, and ``panels.obj``: the surface with a group per panel and per seam line.

    Raises
    ------
    InputError
        A surface or lines that cannot be read, cut or flattened; names that do not exist.
    """
    folder, lines = Path(out), choices.get("seam_lines")
    progress = choices.get("progress", silent)
    progress("read", file=Path(surface).name)
    unit, up = choices.get("unit"), choices.get("up")
    fabric = choices.get("fabric")
    try:
        form = read_design(Path(surface), unit=unit, up=up, seam_lines=lines)
        flat = flatten(
            form,
            fabrics={} if fabric is None else dict.fromkeys(form.panel_names, fabric),
            allowance=choices.get("allowance", 0.010),
            ease=choices.get("ease", MappingProxyType({})),
            short=choices.get("short", MappingProxyType({})),
            tension=choices.get("tension", 0.0),
            progress=progress,
        )
    except InputError as error:
        mend = _mend_words(Path(surface), unit, up)
        raise InputError(
            replace(p, hint=p.hint.replace(_MEND, mend)) for p in error.problems
        ) from error
    write_panels(form, folder / PANELS)
    write_flat_pattern(flat, folder)
    progress("draw", what="strain")
    lie = lie_of(form, flat)
    write_lie(lie, folder / PLACEMENT)
    _write_seam_lengths(flat, folder / "seam-lengths.csv")
    return FlattenedFiles(flat=flat, lie=lie, pictures=write_strain_maps(form, flat, folder))


def read_design(
    path: Path, *, unit: Unit | None = None, up: Up | None = None, seam_lines: Path | None = None
) -> DesignSurface:
    """Read a design surface, and cut it along the lines of a file, if there is one."""
    form = DesignSurface(**io.read_surface(path, unit=unit, up=up, ungrouped="PANEL")._asdict())
    if seam_lines is None:
        return opened(form)
    lines, panels, bare = io.read_seam_lines(seam_lines)
    try:
        bare_at = {name: panels.pop(name) for name in bare}
        return cut_along(form, lines, bare=bare_at, names=panels)
    except InputError as error:
        raise InputError(
            problem if problem.file else replace(problem, file=seam_lines)
            for problem in error.problems
        ) from None


def _mend_words(surface: Path, unit: Unit | None, up: Up | None) -> str:
    """Return the command that mends this surface, to be copied."""
    axes = [f"--unit {unit}" if unit else "", f"--up {up}" if up else ""]
    out = surface.with_name(f"{surface.stem}-mended.obj")
    words = [_MEND_COMMAND, shlex.quote(str(surface)), *axes, "--out", shlex.quote(str(out))]
    return " ".join(filter(None, words))


def write_panels(form: DesignSurface, path: Path) -> None:
    """Write a design surface as OBJ, a group per panel, and one per line it was cut along."""
    rows = (form.vertices, form.faces, form.panel, form.panel_names, form.seam_lines)
    io.write_surface(io.GroupedMesh(*rows), path)


def write_flat_pattern(flat: Flattened, out: Path) -> None:
    """Write ``pattern.dxf`` and ``seams.toml``."""
    io.write_dxf(flat.pattern, out / PATTERN, style="seatlook")
    io.write_seams(flat.pattern, out / SEAMS)


def _write_seam_lengths(flat: Flattened, path: Path) -> None:
    """Write both lines of every seam, and that on the design, in mm."""
    rows = [(s.seam, s.a, s.b, s.difference, s.design) for s in flat.seams]
    heads = ("seam", "a_mm", "b_mm", "difference_mm", "design_mm")
    io.write_table(path, heads, [(name, *(1e3 * v for v in values)) for name, *values in rows])
