"""Commands about what comes with seatlook, and about the machine it runs on."""

from __future__ import annotations

import os
import platform
import sys
from importlib.metadata import version

from cyclopts import App

from seatlook import __version__
from seatlook.cli._output import Json, table

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

    sys.stdout.write(material_path(name).read_text(encoding="utf-8"))


def doctor(*, json: Json = False) -> None:
    """Look whether this machine can solve and draw; say what to install where it cannot.

    Example: seatlook doctor
    """
    from seatlook.pbr.backend import offscreen_backend

    backend = offscreen_backend()
    packages = ("numpy", "scipy", "numba", "vtk", "trimesh", "ezdxf", "shapely")
    table(
        ("what", "value"),
        [
            ("seatlook", __version__),
            ("python", platform.python_version()),
            *((name, version(name)) for name in packages),
            ("cores", os.cpu_count()),
            ("GL window", backend.window),
            ("GL library", backend.library),
        ],
        json=json,
    )
