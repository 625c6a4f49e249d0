"""Commands about what comes with seatlook, and about the machine it runs on."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import App, Parameter

from seatlook.cli._output import Json, note, say, table, write
from seatlook.errors import NoOffscreenContext

if TYPE_CHECKING:
    from seatlook.model import Appearance

materials = App(name="materials", help="List and show materials; to and from LS-DYNA.")


@materials.command(name="list")
def list_materials(*, json: Json = False) -> None:
    """List the supplied cover materials and foams.

    Example: seatlook materials list
    """
    from seatlook import io

    covers = (io.read_material(name) for name in io.list_materials())
    table(
        ("name", "kind", "thickness_mm", "roughness"),
        [
            *((m.name, "cover", 1e3 * m.fabric.thickness, m.appearance.roughness) for m in covers),
            *((name, "foam", None, None) for name in io.list_foam_materials()),
        ],
        json=json,
    )


@materials.command(name="show")
def show_material(name: str, /) -> None:
    """Print the file of a material, with the source of each number, to copy and change.

    Below it stand, as comments, L*a*b* and gloss units that instruments would measure.

    Example: seatlook materials show suede > my-suede.toml

    Parameters
    ----------
    name
        A name from "seatlook materials list".
    """
    from seatlook.io.material import list_materials, material_path, read_material

    write(material_path(name).read_text(encoding="utf-8"))
    if name in list_materials():
        write(_measured(read_material(name).appearance))


def _measured(appearance: Appearance) -> str:
    """Lines that say, as comments, what instruments measure on a material."""
    from seatlook.pbr.reflectance.instrument import GEOMETRIES, gloss, lab

    lines = ["", "# What instruments measure on it (D65, 2 degrees; ISO 2813):"]
    for geometry in GEOMETRIES:
        values = " ".join(f"{value:.1f}" for value in lab(appearance, geometry))
        lines.append(f"# L* a* b* by {geometry}: {values}")
    units = ", ".join(f"{gloss(appearance, angle):.1f} at {angle}" for angle in (20, 60, 85))
    return "\n".join([*lines, f"# gloss units: {units} degrees", ""])


@materials.command(name="export")
def export_material(
    name: Annotated[str, Parameter(help='A name from "seatlook materials list", or a file.')],
    /,
    *,
    out: Annotated[Path, Parameter(help="Keyword file (.k) to write.")],
    coat: bool = True,
    number: int = 1,
    json: Json = False,
) -> None:
    """Write a cover material as *MAT_FABRIC, FORM = -14, with its curves; print what is lost.

    Example: seatlook materials export black-leather --out cover.k

    Parameters
    ----------
    coat
        Bend by two elastic coats, whose tension is taken off the curves; without, the card has no
        bending.
    number
        Number of the material; its curves have a hundred times this and the next five.
    """
    from seatlook import io
    from seatlook.identify.card_losses import losses
    from seatlook.io.lsdyna.fabric_card import card_of
    from seatlook.io.lsdyna.fabric_deck import write_fabric_card

    material = io.read_material(name)
    card = card_of(material.fabric, title=material.name, number=number, coat=coat)
    rows = losses(material.fabric, card)
    write_fabric_card(out, card, tuple(f"{what}: {law}, here {here}" for what, law, here in rows))
    table(("what", "material", "card"), rows, json=json)
    note(f"card of {material.name}: {out}")


@materials.command(name="import")
def import_material(
    card: Annotated[Path, Parameter(help="Keyword file with a *MAT_FABRIC of FORM 14 or -14.")],
    /,
    *,
    out: Annotated[Path, Parameter(help="Material file (TOML) to write.")],
    base: str = "woven",
    thickness_mm: float | None = None,
) -> None:
    """Make a material of the curves and coats of a *MAT_FABRIC card.

    Example: seatlook materials import cover.k --base black-leather --out my-cover.toml

    Parameters
    ----------
    base
        Material for what no card holds, such as appearance and compression.
    thickness_mm
        Of the section, where the file has no *SECTION_SHELL.
    """
    from seatlook import io
    from seatlook.io.lsdyna.fabric_deck import material_of, read_fabric_card
    from seatlook.io.parameter_text import write_material

    read = read_fabric_card(card, thickness=thickness_mm)
    material = material_of(read, io.read_material(base), card)
    write_material(out, material, head=f"From *MAT_FABRIC {read.title} of {card.name}.")
    note(f"material: {out}")


def doctor(*, json: Json = False) -> int:
    """Look whether this machine can solve and draw; say what to do where it cannot.

    Ends with 3 if nothing can be drawn.

    Example: seatlook doctor
    """
    from seatlook.machine import examine

    machine = examine()
    table(("what", "value"), machine.rows, json=json)
    say(*machine.advice)
    note(*([] if machine.advice else ["nothing to do: this machine can solve and draw"]))
    return 0 if machine.draws else NoOffscreenContext.exit_code
