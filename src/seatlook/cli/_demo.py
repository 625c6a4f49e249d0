"""The demo seat, and flat patterns from a design surface."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Literal

from cyclopts import Parameter

from seatlook.cli._output import Json, note, progress, table, template
from seatlook.cli._run import Out, Resume, Scored, Seed, evaluate_scene, load
from seatlook.errors import InputError

if TYPE_CHECKING:
    from seatlook.flattening import DesignSurface, Flattened

Shares = Annotated[tuple[str, ...], Parameter(negative=())]


def demo(
    *,
    out: Out = Path("out/demo"),
    ease: Shares = (),
    short: Shares = (),
    tension_percent: float = 1.0,
    material: str = "leather-laminate",
    insert: str | None = None,
    element_size_mm: float = 7.0,
    seed: Seed = 0,
    resume: Resume = False,
    score: Scored = True,
    files_only: Annotated[bool, Parameter(negative=())] = False,
    json: Json = False,
) -> int:
    """Write the files of a seat cushion with a pattern that fits it, and evaluate them.

    Leaves the design surface, foam, wires, pattern, seams and a commented scene.toml to start
    from, and everything that "seatlook evaluate" leaves.

    Example: seatlook demo --out out/demo

    Example: seatlook demo --out out/eased --ease INSERT-BOLSTER_L=4%

    Parameters
    ----------
    ease
        SEAM=2%: make one sewing line of this seam longer than its partner, a sewing fault.
    short
        PANEL=3%: make this panel narrower across its grain.
    tension_percent
        All panels are cut smaller by this share, so that the cover is taut.
    material
        Cover material, from "seatlook materials list".
    insert
        Material of the middle panel, if it is another one.
    element_size_mm
        Mean edge length of the mesh.
    files_only
        Write the files, and evaluate nothing.
    """
    wanted = _shares("--ease", ease), _shares("--short", short)
    write_demo(
        out,
        ease=wanted[0],
        short=wanted[1],
        tension=tension_percent / 100,
        material=material,
        insert=insert or material,
        element_size_mm=element_size_mm,
        seed=seed or 0,
    )
    note(f"scene: {out / 'scene.toml'}")
    if files_only:
        return 0
    return evaluate_scene(load(out / "scene.toml"), out, resume=resume, score=score, json=json)


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
        cut into panels. Each ends on the border or on another; its seam takes its name.
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
    from seatlook import files, flattening, io
    from seatlook.chain.strain_map import write_strain_maps

    form = _form(surface, unit, seam_lines)
    fabric = None if material is None else io.read_material(material).fabric
    flat = flattening.flatten(
        form,
        fabrics={} if fabric is None else dict.fromkeys(form.panel_names, fabric),
        allowance=allowance_mm / 1e3,
        ease=_shares("--ease", ease),
        short=_shares("--short", short),
        tension=tension_percent / 100,
    )
    if seam_lines is not None:
        _write_panels(form, out / "panels.obj")
    _write_pattern(flat, out)
    files.write_text(out / "placement.toml", _placement(flat) + "\n")
    _write_seam_lengths(flat, out / "seam-lengths.csv")
    note(f"pictures of the strain: {write_strain_maps(form, flat, out)[0].parent}")
    heads = ["panel", "area_cm2", "strain_mean", "strain_rms", "strain_smallest", "strain_largest"]
    rows = [[p.panel, 1e4 * p.area, p.mean, p.rms, p.smallest, p.largest] for p in flat.panels]
    if fabric is not None:
        heads.append("energy_mj")
        rows = [[*r, 1e3 * (p.energy or 0.0)] for r, p in zip(rows, flat.panels, strict=True)]
    table(heads, rows, json=json)


def _form(path: Path, unit: Literal["mm", "m"], seam_lines: Path | None) -> DesignSurface:
    """Read a design surface and cut it along the lines of a file, if there is one."""
    from seatlook import flattening, io

    ungrouped = None if seam_lines is None else "PANEL"
    form = flattening.DesignSurface(
        **io.read_surface(path, unit=unit, ungrouped=ungrouped)._asdict()
    )
    if seam_lines is None:
        return form
    lines = io.read_curves(seam_lines)
    try:
        return flattening.cut_along(form, lines)
    except InputError as error:
        raise InputError(
            problem if problem.file else replace(problem, file=seam_lines)
            for problem in error.problems
        ) from None


def write_demo(
    out: Path,
    *,
    ease: dict[str, float],
    short: dict[str, float],
    tension: float = 0.01,
    material: str,
    insert: str,
    element_size_mm: float,
    seed: int,
    surface_size: float = 0.006,
) -> None:
    """Write the demo's design surface, foam, wires, pattern, seams and scene.

    ``surface_size`` [m] is the edge length of design surface and foam, which stay the same
    however the cover is meshed.
    """
    from seatlook import files, flattening, io, seats

    thickness = io.read_material(material).fabric.thickness
    io.read_material(insert)
    with progress() as show:
        show("flatten")
        surface = seats.demo_design(element_size=surface_size)
        flat = flattening.flatten(surface, tension=tension, ease=ease, short=short)
        foam = seats.demo_foam_mesh(element_size=surface_size, cover_thickness=thickness)
    _write_panels(surface, out / "design.obj")
    io.write_obj(foam.vertices, foam.faces, out / "foam.obj")
    io.write_curves(foam.curves, out / "wires.toml")
    _write_pattern(flat, out)
    scene = template("demo_scene.toml.j2").render(
        material=material,
        insert=insert,
        element_size_mm=element_size_mm,
        seed=seed,
        tension=tension,
        placement=_placement(flat),
        spoiled=[*(f"ease {k} {v:.1%}" for k, v in ease.items()),
                 *(f"short {k} {v:.1%}" for k, v in short.items())],
    )  # fmt: skip
    files.write_text(out / "scene.toml", scene + "\n")


def _write_panels(form: DesignSurface, path: Path) -> None:
    from seatlook import io

    io.write_surface(io.GroupedMesh(form.vertices, form.faces, form.panel, form.panel_names), path)


def _write_pattern(flat: Flattened, out: Path) -> None:
    from seatlook import io

    io.write_dxf(flat.pattern, out / "pattern.dxf", style="seatlook")
    io.write_seams(flat.pattern, out / "seams.toml")


def _write_seam_lengths(flat: Flattened, path: Path) -> None:
    """Write both lines of every seam, and that on the design, in mm."""
    from seatlook import io

    rows = [(s.seam, s.a, s.b, s.difference, s.design) for s in flat.seams]
    heads = ("seam", "a_mm", "b_mm", "difference_mm", "design_mm")
    io.write_table(path, heads, [(name, *(1e3 * v for v in values)) for name, *values in rows])


def _placement(flat: Flattened) -> str:
    """[placement.PANEL] tables as they stand in a scene."""
    return "\n\n".join(
        f"[placement.{name}]\n"
        f"rotation = {pose.rotation.tolist()}\n"
        f"translation_mm = {(1e3 * pose.translation).tolist()}"
        for name, pose in flat.placement.items()
    )


def _shares(option: str, words: tuple[str, ...]) -> dict[str, float]:
    """Read NAME=2% (or NAME=0.02) into fractions."""
    shares = {}
    for word in words:
        name, _, text = word.rpartition("=")
        try:
            value = float(text.removesuffix("%")) / (100 if text.endswith("%") else 1)
        except ValueError:
            name = ""
        if not name:
            raise InputError.single(option, got=repr(word), expected="NAME=2%")
        shares[name] = value
    return shares
