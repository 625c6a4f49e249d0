"""Whether this machine can solve and draw, and what to do where it cannot."""

from __future__ import annotations

import os
import platform
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path

import numba

from seatlook._version import __version__
from seatlook.errors import NoOffscreenContext
from seatlook.pbr.backend import offscreen_backend
from seatlook.solver.foam.field_cache import folder as field_folder

_PACKAGES = ("numpy", "scipy", "numba", "vtk", "trimesh", "ezdxf", "shapely")
Row = tuple[str, str | int | bool | None]


@dataclass(frozen=True, slots=True, kw_only=True)
class Machine:
    """What was found.

    Parameters
    ----------
    rows : what was looked at, and its value
    advice : a sentence for everything that should be changed
    draws : whether pictures can be drawn
    """

    rows: tuple[Row, ...]
    advice: tuple[str, ...]
    draws: bool


def examine() -> Machine:
    """Look at packages, threads, caches and the GL library of this machine."""
    rows: list[Row] = [
        ("seatlook", __version__),
        ("python", platform.python_version()),
        *((name, version(name)) for name in _PACKAGES),
        ("cores", os.cpu_count()),
    ]
    parts = [_threads(), _kernel_cache(), _field_cache(), _drawing()]
    return Machine(
        rows=(*rows, *(row for part, _ in parts for row in part)),
        advice=tuple(advice for _, advice in parts if advice),
        draws=not parts[-1][1],
    )


Part = tuple[list[Row], str]  # rows, and advice or nothing


def _drawing() -> Part:
    """Which GL library draws."""
    try:
        backend = offscreen_backend()
    except NoOffscreenContext as error:
        return [("GL window", None), ("GL library", None)], str(error)
    return [("GL window", backend.window), ("GL library", backend.library)], ""


def _threads() -> Part:
    """Threads of the kernels and of linear algebra."""
    names = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
    counts = [os.environ[name] for name in names if os.environ.get(name, "").isdigit()]
    cores = os.cpu_count() or 1
    algebra = int(counts[0]) if counts else cores
    advice = (
        f"more threads ({algebra}) than cores: set OMP_NUM_THREADS={cores} or less"
        if algebra > cores
        else ""
    )
    return [("kernel threads", numba.get_num_threads()), ("algebra threads", algebra)], advice


def _kernel_cache() -> Part:
    """Where compiled kernels are kept, and whether they can be."""
    named = os.environ.get("NUMBA_CACHE_DIR")
    folder = Path(named) if named else Path(__file__).parent
    writable = _writable(folder)
    advice = (
        ""
        if writable
        else f"{folder} cannot be written, so kernels are compiled again in every run (about a "
        "minute): set NUMBA_CACHE_DIR to a folder of your own"
    )
    files = list(folder.rglob("*.nbi")) if folder.exists() else []
    return [
        ("kernel cache", str(folder)),
        ("kernel cache writable", writable),
        ("kernels in cache", len(files)),
    ], advice


def _field_cache() -> Part:
    """Where distance fields of foams are kept, how many, and whether they can be."""
    base = field_folder()
    writable = base is not None and _writable(base)
    advice = (
        ""
        if writable
        else f"{base or 'the home folder'} cannot be written, so the distance field of a foam is "
        "made again in every run (a second or two): set SEATLOOK_CACHE_DIR to a folder of "
        "your own"
    )
    files = list(base.glob("*.field")) if base is not None and base.exists() else []
    size = sum(path.stat().st_size for path in files)
    return [
        ("field cache", str(base)),
        ("field cache writable", writable),
        ("fields in cache", f"{len(files)}, {size / 1e6:.0f} MB"),
    ], advice


def _writable(folder: Path) -> bool:
    """Whether files can be written there, or the folder be made."""
    above = next(p for p in (folder, *folder.parents) if p.exists())
    return above.is_dir() and os.access(above, os.W_OK)
