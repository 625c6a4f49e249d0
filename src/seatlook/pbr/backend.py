"""Find a GL library that draws without a screen, before VTK looks for one.

The vtk wheel carries no GL library: it opens one when the first window is made, and where there
is none it does not raise but ends the interpreter. So it is not imported before a probe succeeds.
"""

from __future__ import annotations

import ctypes
import functools
import os
import sys
from dataclasses import dataclass
from pathlib import Path

from seatlook.errors import NoOffscreenContext

_EGL_PLATFORM_DEVICE = 0x313F
_OSMESA = "libOSMesa.so.8"
_HOW_TO_INSTALL = (
    "no GL library that draws without a screen was found ({reasons}). Install one:\n"
    "  as root:       apt-get install libegl1 libgl1-mesa-dri   (or libosmesa6)\n"
    "  without root:  unpack the packages libosmesa6, libllvm15 and libglapi-mesa below\n"
    "                 {folder}   (dpkg -x PACKAGE.deb {folder})"
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Backend:
    """Which VTK window class draws, and the library it was found in."""

    window: str
    library: str


@functools.cache
def offscreen_backend() -> Backend:
    """Find the library once per process and tell VTK to use it.

    Returns
    -------
    Backend
        EGL if it opens a device, else OSMesa of the system, else OSMesa unpacked below
        ``sys.prefix/lib/seatlook-gl``.

    Raises
    ------
    NoOffscreenContext
        With what was tried and the two ways to install a library.
    """
    reasons: list[str] = []
    for probe in (_egl, _system_osmesa, _unpacked_osmesa):
        try:
            backend = probe()
        except OSError as error:
            reasons.append(str(error))
        else:
            os.environ["VTK_DEFAULT_OPENGL_WINDOW"] = backend.window
            return backend
    raise NoOffscreenContext(
        _HOW_TO_INSTALL.format(reasons="; ".join(reasons), folder=unpacked_folder())
    )


def unpacked_folder() -> Path:
    """Folder below the environment where a GL library may be unpacked without being root."""
    return Path(sys.prefix) / "lib" / "seatlook-gl"


def _egl() -> Backend:
    """Open the first EGL device; a dispatch library without a driver behind it has none."""
    egl = ctypes.CDLL("libEGL.so.1")
    egl.eglGetProcAddress.restype = ctypes.c_void_p
    query = egl.eglGetProcAddress(b"eglQueryDevicesEXT")
    get_display = egl.eglGetProcAddress(b"eglGetPlatformDisplayEXT")
    if not query or not get_display:
        raise OSError("libEGL.so.1: no device extension")
    devices, count = (ctypes.c_void_p * 1)(), ctypes.c_int()
    query_type = ctypes.CFUNCTYPE(
        ctypes.c_uint, ctypes.c_int, ctypes.c_void_p, ctypes.POINTER(ctypes.c_int)
    )
    if not query_type(query)(1, devices, ctypes.byref(count)) or count.value < 1:
        raise OSError("libEGL.so.1: no driver (libgl1-mesa-dri is missing)")
    display_type = ctypes.CFUNCTYPE(
        ctypes.c_void_p, ctypes.c_uint, ctypes.c_void_p, ctypes.c_void_p
    )
    display = display_type(get_display)(_EGL_PLATFORM_DEVICE, devices[0], None)
    egl.eglInitialize.argtypes = [ctypes.c_void_p] * 3
    egl.eglTerminate.argtypes = [ctypes.c_void_p]
    if not display or not egl.eglInitialize(display, None, None):
        raise OSError("libEGL.so.1: its device does not open")
    egl.eglTerminate(display)
    return Backend(window="vtkEGLRenderWindow", library="libEGL.so.1")


def _system_osmesa() -> Backend:
    ctypes.CDLL(_OSMESA, mode=ctypes.RTLD_GLOBAL)
    return Backend(window="vtkOSOpenGLRenderWindow", library=_OSMESA)


def _unpacked_osmesa() -> Backend:
    """Load OSMesa and what it needs by path; VTK then finds it by its soname."""
    candidates = sorted(unpacked_folder().glob(f"usr/lib/*/{_OSMESA}"))
    if not candidates:
        raise OSError(f"{unpacked_folder()}: no usr/lib/*/{_OSMESA}")
    library = candidates[0]
    waiting = [p for p in sorted(library.parent.glob("*.so*")) if p.name != library.name]
    # Libraries need each other in an order that only loading them shows.
    while True:
        left = [path for path in waiting if not _loads(path)]
        if len(left) == len(waiting):
            break
        waiting = left
    ctypes.CDLL(str(library), mode=ctypes.RTLD_GLOBAL)
    return Backend(window="vtkOSOpenGLRenderWindow", library=str(library))


def _loads(path: Path) -> bool:
    try:
        ctypes.CDLL(str(path), mode=ctypes.RTLD_GLOBAL)
    except OSError:
        return False
    return True
