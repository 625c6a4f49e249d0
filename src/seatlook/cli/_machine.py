"""Commands about what comes with seatlook, and about the machine it runs on."""

from __future__ import annotations

import os
import platform
import sys
from pathlib import Path

from cyclopts import App

from seatlook._version import __version__
from seatlook.cli._output import Json, note, say, table

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


def doctor(*, json: Json = False) -> int:
    """Look whether this machine can solve and draw; say what to do where it cannot.

    Ends with 3 if nothing can be drawn.

    Example: seatlook doctor
    """
    from importlib.metadata import version

    advice: list[str] = []
    packages = ("numpy", "scipy", "numba", "vtk", "trimesh", "ezdxf", "shapely")
    drawn, code = _drawing(advice)
    table(
        ("what", "value"),
        [
            ("seatlook", __version__),
            ("python", platform.python_version()),
            *((name, version(name)) for name in packages),
            ("cores", os.cpu_count()),
            *_threads(advice),
            *_cache(advice),
            *_fields(advice),
            *drawn,
        ],
        json=json,
    )
    say(*advice)
    note(*([] if advice else ["nothing to do: this machine can solve and draw"]))
    return code


def _drawing(advice: list[str]) -> tuple[list[tuple[str, str | None]], int]:
    """Which GL library draws, and 0 or 3."""
    from seatlook.errors import NoOffscreenContext
    from seatlook.pbr.backend import offscreen_backend

    try:
        backend = offscreen_backend()
    except NoOffscreenContext as error:
        advice.append(str(error))
        return [("GL window", None), ("GL library", None)], error.exit_code
    return [("GL window", backend.window), ("GL library", backend.library)], 0


def _threads(advice: list[str]) -> list[tuple[str, int]]:
    """Threads of the kernels and of linear algebra."""
    import numba

    names = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
    counts = [os.environ[name] for name in names if os.environ.get(name, "").isdigit()]
    algebra = int(counts[0]) if counts else os.cpu_count() or 1
    if algebra > (os.cpu_count() or 1):
        advice.append(
            f"more threads ({algebra}) than cores: set OMP_NUM_THREADS={os.cpu_count()} or less"
        )
    return [("kernel threads", numba.get_num_threads()), ("algebra threads", algebra)]


def _cache(advice: list[str]) -> list[tuple[str, object]]:
    """Where compiled kernels are kept, and whether they can be."""
    import seatlook

    named = os.environ.get("NUMBA_CACHE_DIR")
    folder = Path(named) if named else Path(seatlook.__file__).parent
    writable = _writable(folder)
    if not writable:
        advice.append(
            f"{folder} cannot be written, so kernels are compiled again in every run (about a "
            "minute): set NUMBA_CACHE_DIR to a folder of your own"
        )
    files = list(folder.rglob("*.nbi")) if folder.exists() else []
    return [
        ("kernel cache", str(folder)),
        ("kernel cache writable", writable),
        ("kernels writable", len(files)),
    ]


def _fields(advice: list[str]) -> list[tuple[str, object]]:
    """Where distance fields of foams are kept, how many, and whether they can be."""
    from seatlook.solver.foam.field_cache import folder

    base = folder()
    writable = base is not None and _writable(base)
    if not writable:
        advice.append(
            f"{base or 'the home folder'} cannot be written, so the distance field of a foam is "
            "made again in every run (a second or two): set SEATLOOK_CACHE_DIR to a folder of "
            "your own"
        )
    files = list(base.glob("*.field")) if base is not None and base.exists() else []
    size = sum(path.stat().st_size for path in files)
    return [
        ("field cache", str(base)),
        ("field cache writable", writable),
        ("fields writable", f"{len(files)}, {size / 1e6:.0f} MB"),
    ]


def _writable(folder: Path) -> bool:
    """Whether files can be written there, or the folder be made."""
    above = next(p for p in (folder, *folder.parents) if p.exists())
    return above.is_dir() and os.access(above, os.W_OK)
