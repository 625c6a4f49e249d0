"""The command line: data on stdout, progress and errors on stderr, nothing heavy imported early.

Exit codes: 0 good, 1 a limit of [accept] is missed, 2 wrong input, 3 solver or renderer failed,
70 a fault of seatlook itself, 130 interrupted.
"""

from __future__ import annotations

import json as json_module
import sys
import traceback
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import Annotated, Any

from cyclopts import App, CycloptsError, Parameter

from seatlook import __version__
from seatlook.errors import SeatlookError

_HELP = """Where a car-seat cover wrinkles, why, and whether anyone will see it.

Start with: seatlook demo --out out/demo
"""

app = App(
    name="seatlook",
    help=_HELP,
    version=__version__,
    help_format="plaintext",
    suppress_keyboard_interrupt=False,
)
materials = App(name="materials", help="List the supplied materials, or show one.")
app.command(materials)

Json = Annotated[bool, Parameter(name="--json", negative=(), help="Print JSON, not a table.")]


def main() -> None:
    """Run the command line and leave with its exit code."""
    sys.exit(run())


def run(tokens: Sequence[str] | None = None) -> int:
    """Run one command and return its exit code; ``tokens`` default to the process's arguments."""
    try:
        code = app(tokens, exit_on_error=False, print_error=False, result_action="return_value")
    except CycloptsError as error:
        _say(f"seatlook: {error}", "see: seatlook --help")
        return 2
    except SeatlookError as error:
        _say(str(error))
        return error.exit_code
    except KeyboardInterrupt:
        _say("interrupted; no file was left half written")
        return 130
    except OSError as error:
        _say(f"{error.filename or 'file system'}: {error.strerror or error}")
        return 2
    except Exception:
        _say(traceback.format_exc(), "this is a fault of seatlook, not of the input")
        return 70
    return code if isinstance(code, int) else 0


@app.command
def check(scene: Path, /, *, json: Json = False) -> None:
    """Read a scene with all its files, mesh it, and say what would be solved; solve nothing.

    Example: seatlook check seat.toml

    Parameters
    ----------
    scene
        Scene file (TOML).
    """
    from seatlook import assembly, io
    from seatlook.solver.contact import foam_wavelength

    read = io.load_scene(scene)
    cover = assembly.assemble(read)
    shortest = min(foam_wavelength(m.fabric, read.foam.material) for m in cover.materials)
    _table(
        ("what", "value"),
        [
            ("scene", read.name),
            ("panels", len(cover.panel_names)),
            ("seams", len(cover.stitchings)),
            ("hooks and frames", len(cover.anchors)),
            ("vertices", len(cover.rest)),
            ("triangles", len(cover.faces)),
            ("element_size_mm", round(1e3 * cover.element_size, 3)),
            ("wavelength_mm", round(1e3 * shortest, 3)),
            ("wavelength_over_element_size", round(shortest / cover.element_size, 2)),
        ],
        json=json,
    )


@materials.command(name="list")
def list_materials(*, json: Json = False) -> None:
    """List the supplied cover materials and foams.

    Example: seatlook materials list
    """
    from seatlook import io

    rows = [
        (
            name,
            "cover",
            1e3 * (m := io.read_material(name)).fabric.thickness,
            m.appearance.roughness,
        )
        for name in io.list_materials()
    ]
    rows += [(name, "foam", None, None) for name in io.list_foam_materials()]
    _table(("name", "kind", "thickness_mm", "roughness"), rows, json=json)


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


@app.command
def doctor(*, json: Json = False) -> None:
    """Look whether this machine can solve and draw; say what to install where it cannot.

    Example: seatlook doctor
    """
    import os
    import platform
    from importlib.metadata import version

    from seatlook.pbr.backend import offscreen_backend

    backend = offscreen_backend()
    packages = ("numpy", "scipy", "numba", "vtk", "trimesh", "ezdxf", "shapely")
    _table(
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


def _table(heads: Sequence[str], rows: Iterable[Sequence[Any]], *, json: bool) -> None:
    """Print rows on stdout: aligned text, or a JSON list of objects.

    A table of ("what", "value") is one JSON object.
    """
    rows = list(rows)
    if json:
        pairs = tuple(heads) == ("what", "value")
        data = dict(rows) if pairs else [dict(zip(heads, row, strict=True)) for row in rows]
        sys.stdout.write(json_module.dumps(data, indent=1) + "\n")
        return
    cells = [list(heads), *([_text(cell) for cell in row] for row in rows)]
    widths = [max(len(row[k]) for row in cells) for k in range(len(heads))]
    for row in cells:
        line = "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True))
        sys.stdout.write(line.rstrip() + "\n")


def _text(cell: Any) -> str:
    if cell is None:
        return "-"
    return f"{cell:.4g}" if isinstance(cell, float) else str(cell)


def _say(*lines: str) -> None:
    for line in lines:
        sys.stderr.write(line.rstrip() + "\n")
