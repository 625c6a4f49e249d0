"""Commands about what comes with seatlook, and about the machine it runs on."""

from __future__ import annotations

from cyclopts import App

from seatlook.cli._output import Json, note, say, table, write
from seatlook.errors import NoOffscreenContext

materials = App(name="materials", help="List the supplied materials, or show one.")


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

    Example: seatlook materials show suede > my-suede.toml

    Parameters
    ----------
    name
        A name from "seatlook materials list".
    """
    from seatlook.io.material import material_path

    write(material_path(name).read_text(encoding="utf-8"))


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
