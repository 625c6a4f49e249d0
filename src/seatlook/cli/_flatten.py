"""The command that makes a flat pattern of a design surface."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

from cyclopts import Parameter

from seatlook.cli._mend import MendingOptions
from seatlook.cli._options import Out
from seatlook.cli._output import Json, note, progress, table
from seatlook.cli._shares import Shares, shares
from seatlook.io.surface.axes import Unit, Up

NO_SCENE = "no scene yet, as there is no foam: seatlook init --from {} FOAM"


def flatten(
    surface: Annotated[
        Path,
        Parameter(
            help="Design surface: OBJ, STL, PLY or glTF; a group per panel, or with --seam-lines."
        ),
    ],
    /,
    *,
    out: Out,
    seam_lines: Path | None = None,
    foam: Path | None = None,
    mending: MendingOptions | None = None,
    wires: Path | None = None,
    unit: Unit | None = None,
    up: Up | None = None,
    ease: Shares = (),
    short: Shares = (),
    tension_percent: float = 0.0,
    allowance_mm: float = 10.0,
    material: str | None = None,
    foam_material: str = "foam-seat",
    force: Annotated[bool, Parameter(negative=())] = False,
    json: Json = False,
) -> None:
    """Cut a design surface along its panels' borders, flatten them, and write a scene.

    Writes pattern.dxf (AAMA), seams.toml, placement.toml, panels.obj (the surface in a group per
    panel), pictures of the strain and seam-lengths.csv. With --foam also curves.toml and
    scene.toml, ready to check and evaluate: free borders are pulled to where they lie on the
    surface, seams beside wires are hooked to them. Prints the strain that each panel takes when it
    is laid back onto the surface.

    Example: seatlook flatten cushion.obj --foam foam.obj --out my-seat

    Example: seatlook flatten form.obj --seam-lines lines.toml --out pattern

    Parameters
    ----------
    seam_lines
        Curves file, [curve.NAME] points_mm, of lines within 2 mm of the surface, along which it is
        cut into panels. Each ends on the border or on another, or as a dart inside a panel; its
        seam takes its name.
    foam
        What the cover is pulled over: a closed surface, OBJ, STL, PLY or glTF.
    wires
        Curves file with the wires in the foam.
    unit
        Unit of the surface's and the foam's file; by their format and size if not given.
    up
        Vertical axis of both files; y in glTF, else z, if not given.
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
        that fabric, by its curves. That of an isotropic sheet, if not given; the scene then takes
        leather-laminate.
    foam_material
        Foam material, by name or file.
    force
        Write over a scene that is in the folder already.
    """
    from seatlook import io
    from seatlook.chain.start.surface import flatten_scene
    from seatlook.flattening.files import FlattenChoices, flatten_surface

    fabric = None if material is None else io.read_material(material).fabric
    how = FlattenChoices(
        seam_lines=seam_lines,
        unit=unit,
        up=up,
        ease=shares("--ease", ease),
        short=shares("--short", short),
        tension=tension_percent / 100,
        allowance=allowance_mm / 1e3,
        fabric=fabric,
    )
    notes: tuple[str, ...]
    with progress() as show:
        how["progress"] = show
        if foam is None:
            made = flatten_surface(surface, out, **how)
            notes = (NO_SCENE.format(out),)
        else:
            made, scene = flatten_scene(
                surface, foam, out, flattening=how,
                material=material or "leather-laminate", foam_material=foam_material, wires=wires,
                foam_unit=unit, foam_up=up,
                foam_mending=(mending or MendingOptions()).choices(), name=surface.stem,
                force=force,
            )  # fmt: skip
            notes = scene.notes
    note(*notes)
    note(f"pictures of the strain: {made.pictures[0].parent}")
    figures = ("mean", "rms", "smallest", "largest")
    heads = ["panel", "area_cm2", *(f"strain_{name}_percent" for name in figures)]
    panels = made.flat.panels
    rows = [[p.panel, 1e4 * p.area, *(100 * getattr(p, n) for n in figures)] for p in panels]
    if fabric is not None:
        heads.append("energy_mj")
        rows = [[*r, 1e3 * (p.energy or 0.0)] for r, p in zip(rows, panels, strict=True)]
    table(heads, rows, json=json)
