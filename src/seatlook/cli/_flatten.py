"""The command that makes a flat pattern of a design surface."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Literal

from cyclopts import Parameter

from seatlook.cli._options import Out
from seatlook.cli._output import Json, note, table
from seatlook.cli._shares import Shares, shares


def flatten(
    surface: Annotated[
        Path,
        Parameter(help="Design surface: OBJ, one group per panel unless --seam-lines is given."),
    ],
    /,
    *,
    out: Out,
    seam_lines: Path | None = None,
    unit: Literal["mm", "m"] = "mm",
    ease: Shares = (),
    short: Shares = (),
    tension_percent: float = 0.0,
    allowance_mm: float = 10.0,
    material: str | None = None,
    json: Json = False,
) -> None:
    """Cut a design surface along its panels' borders and flatten them into a pattern.

    Writes pattern.dxf (AAMA), seams.toml and placement.toml, whose tables go into a scene, and
    pictures and seam-lengths.csv; with --seam-lines also panels.obj, the surface in a group per
    panel. Prints the strain that each panel takes when it is laid back onto the surface.

    Example: seatlook flatten cushion.obj --out pattern --ease INSERT-BOLSTER_L=2%

    Example: seatlook flatten form.obj --seam-lines lines.toml --out pattern

    Parameters
    ----------
    seam_lines
        Curves file, [curve.NAME] points_mm, of lines within 2 mm of the surface, along which it is
        cut into panels. Each ends on the border or on another, or as a dart inside a panel; its
        seam takes its name.
    unit
        Unit of the surface file.
    ease
        SEAM=2%: make one sewing line of this seam longer than its partner.
    short
        PANEL=3%: make this panel narrower across its grain.
    tension_percent
        All panels are cut smaller by this share, so that the cover is taut.
    allowance_mm
        Seam allowance and hem round every panel.
    material
        What all panels are made of, a supplied name or a file: they take the least strain energy of
        that fabric, by its curves. That of an isotropic sheet, if not given.
    """
    from seatlook import io
    from seatlook.flattening.files import flatten_surface

    fabric = None if material is None else io.read_material(material).fabric
    made = flatten_surface(
        surface,
        out,
        seam_lines=seam_lines,
        unit=unit,
        ease=shares("--ease", ease),
        short=shares("--short", short),
        tension=tension_percent / 100,
        allowance=allowance_mm / 1e3,
        fabric=fabric,
    )
    note(f"pictures of the strain: {made.pictures[0].parent}")
    heads = ["panel", "area_cm2", "strain_mean", "strain_rms", "strain_smallest", "strain_largest"]
    panels = made.flat.panels
    rows = [[p.panel, 1e4 * p.area, p.mean, p.rms, p.smallest, p.largest] for p in panels]
    if fabric is not None:
        heads.append("energy_mj")
        rows = [[*r, 1e3 * (p.energy or 0.0)] for r, p in zip(rows, panels, strict=True)]
    table(heads, rows, json=json)
