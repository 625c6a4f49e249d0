"""Whether VTK's window opens, tried once in a process of its own, and kept.

Where a GL library is too old or has no screen, VTK does not raise: it ends the process.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
import subprocess
import sys
from contextlib import suppress
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path

from seatlook.files import cache_folder, write_text

_CODE = """
import sys
from seatlook.pbr import backend
backend.LIBRARIES[sys.argv[1]]()
from seatlook.pbr._vtk import open_window
print(open_window())
"""
_FILE = "windows.json"  # in the cache folder: digest -> class of the window that opened
_WINDOW = "VTK_DEFAULT_OPENGL_WINDOW"
_PATIENCE = 120.0  # s
_MAPS = Path("/proc/self/maps")
_GL_FILES = ("EGL", "OSMesa", "gallium", "_dri", "GLX", "libGL", "nvidia")
_GL_VARIABLES = ("MESA_", "GALLIUM_", "LIBGL_", "LP_", "EGL_", "__EGL", "__GLX", "VTK_", "DISPLAY")


@dataclass(frozen=True, slots=True, kw_only=True)
class Trial:
    """The class of the window that opened, or the reason why none did."""

    window: str = ""
    reason: str = ""


def try_window(library: str, *, window: str | None) -> Trial:
    """Open VTK's window with a library out of ``backend.LIBRARIES``, in a process of its own.

    Parameters
    ----------
    window : class that VTK is told to open; None leaves it to VTK

    Notes
    -----
    A window that opened is kept in the cache folder, until another VTK, library, driver or setting
    is there. One that did not is tried again by the next process.
    """
    key = _key(library, window)
    kept = _kept()
    if key in kept:
        return Trial(window=kept[key])
    trial = _tried(library, window)
    folder = cache_folder()
    if trial.window and folder is not None:
        # Without a place to keep it, it is tried again.
        with suppress(OSError):
            write_text(folder / _FILE, json.dumps({**kept, key: trial.window}, indent=1) + "\n")
    return trial


def _tried(library: str, window: str | None) -> Trial:
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path))}
    if window is not None:
        environment[_WINDOW] = window
    try:
        done = subprocess.run(
            [sys.executable, "-c", _CODE, library],
            capture_output=True,
            text=True,
            errors="replace",
            timeout=_PATIENCE,
            env=environment,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return Trial(reason=f"VTK's window did not open in {_PATIENCE:.0f} s")
    except OSError as error:
        return Trial(reason=f"{sys.executable} does not start: {error.strerror}")
    if done.returncode == 0:
        return Trial(window=done.stdout.split()[-1])
    said = [line for line in done.stderr.splitlines() if line.startswith("seatlook.errors.")]
    if said:
        return Trial(reason=said[-1].split(": ", 1)[-1])
    how = f"signal {-done.returncode}" if done.returncode < 0 else f"code {done.returncode}"
    return Trial(reason=f"VTK's window ended its process with {how}")


def _kept() -> dict[str, str]:
    folder = cache_folder()
    if folder is None:
        return {}
    try:
        content = json.loads((folder / _FILE).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return {str(k): str(v) for k, v in content.items()} if isinstance(content, dict) else {}


def _key(library: str, window: str | None) -> str:
    """Digest of all that decides whether the window opens."""
    settings = {k: v for k, v in os.environ.items() if k.startswith(_GL_VARIABLES)}
    if window is not None:
        settings.pop(_WINDOW, None)
    parts = [
        sys.platform,
        sys.executable,
        version("vtk"),
        library,
        window,
        sorted(settings.items()),
        _loaded(),
    ]
    return hashlib.sha256(repr(parts).encode()).hexdigest()[:32]


def _loaded() -> list[tuple[str, int, int]]:
    """GL libraries in this process, with size and time; elsewhere than on Linux none."""
    try:
        text = _MAPS.read_text(errors="replace")
    except OSError:
        return []
    paths = set(re.findall(r"(/\S+)$", text, re.MULTILINE))
    files = []
    for path in sorted(paths):
        if any(word in Path(path).name for word in _GL_FILES):
            with suppress(OSError):
                status = Path(path).stat()
                files.append((path, status.st_size, status.st_mtime_ns))
    return files
