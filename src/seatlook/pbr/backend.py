"""Find a GL library that draws without a screen, before VTK looks for one.

The vtk wheel carries no GL library: it opens one when the first window is made, and where there
is none it does not raise but ends the interpreter. So it is not imported before a probe succeeds.
"""

from __future__ import annotations

import ctypes
import functools
import os
import platform
import sys
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from seatlook.errors import NoOffscreenContext
from seatlook.pbr.window_trial import try_window

_EGL_PLATFORM_DEVICE = 0x313F
_OSMESA = "libOSMesa.so.8"
_EGL = "libEGL.so.1"
_OVERRIDE = "MESA_GL_VERSION_OVERRIDE"
_INSTALL = (
    "  as root:       apt-get install libegl1 libgl1-mesa-dri   (or libosmesa6, where it exists);\n"
    "                 without apt-get, Mesa's EGL with llvmpipe by the system's package manager\n"
    "  without root:  unpack libosmesa6, or libegl1 and libgl1-mesa-dri, and what they need below\n"
    "                 {folder}   (dpkg -x PACKAGE.deb {folder})"
)
_NONE = "no GL library that draws without a screen was found ({reasons}). Install one:\n"
_OLD = (
    "VTK draws with OpenGL 3.2 or later, and its window does not open ({reasons}).\n"
    "{override}Update the graphics driver or Mesa, or install another library:\n"
)
_OWN = {
    "Windows": "VTK draws with OpenGL 3.2 or later, and its window does not open ({reasons}).\n"
    "{override}Update the graphics driver. Over remote desktop or without a graphics card, put\n"
    "Mesa's opengl32.dll (llvmpipe) into the folder of {python}.",
    "Darwin": "VTK draws with OpenGL 3.2 or later, and its window does not open ({reasons}).\n"
    "{override}Run it as the user who is logged in at the Mac's screen, not as a service. If that\n"
    "does not help, update macOS and VTK: {python} -m pip install --upgrade vtk",
}


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
        On Windows and macOS VTK's own window. Elsewhere EGL if it opens a device, else OSMesa of
        the system, else either unpacked below ``sys.prefix/lib/seatlook-gl``. Each has opened a
        window in another process, see :mod:`seatlook.pbr.window_trial`.

    Raises
    ------
    NoOffscreenContext
        With what was tried, and what to do about it on this system.
    """
    own = _OWN.get(_system())
    reasons: list[str] = []
    old = False
    for name in ("own",) if own else tuple(LIBRARIES)[1:]:
        try:
            backend = LIBRARIES[name]()
        except OSError as error:
            reasons.append(str(error))
            continue
        trial = try_window(name, window=backend.window or None)
        if trial.window:
            if backend.window:
                os.environ["VTK_DEFAULT_OPENGL_WINDOW"] = backend.window
            return Backend(window=trial.window, library=backend.library)
        old = True
        reasons.append(f"{backend.library}: {trial.reason}" if backend.window else trial.reason)
    text = own or (_OLD if old else _NONE) + _INSTALL
    raise NoOffscreenContext(
        text.format(
            reasons="; ".join(reasons),
            override=_override(),
            folder=unpacked_folder(),
            python=sys.executable,
        )
    )


def _system() -> str:
    """Name of the system as ``platform.system`` has it."""
    named = {"win32": "Windows", "cygwin": "Windows", "darwin": "Darwin"}
    return named.get(sys.platform) or platform.system()


def _override() -> str:
    value = os.environ.get(_OVERRIDE)
    return f"{_OVERRIDE}={value} is set: unset it. " if value else ""


def unpacked_folder() -> Path:
    """Folder below the environment where a GL library may be unpacked without being root."""
    return Path(sys.prefix) / "lib" / "seatlook-gl"


def _own() -> Backend:
    """VTK's own window: there is nothing to load."""
    return Backend(window="", library="VTK's own")


def _egl(library: str = _EGL) -> Backend:
    """Open the first EGL device; a dispatch library without a driver behind it has none."""
    egl = ctypes.CDLL(library, mode=ctypes.RTLD_GLOBAL)
    egl.eglGetProcAddress.restype = ctypes.c_void_p
    query = egl.eglGetProcAddress(b"eglQueryDevicesEXT")
    get_display = egl.eglGetProcAddress(b"eglGetPlatformDisplayEXT")
    if not query or not get_display:
        raise OSError(f"{library}: no device extension")
    devices, count = (ctypes.c_void_p * 1)(), ctypes.c_int()
    query_type = ctypes.CFUNCTYPE(
        ctypes.c_uint, ctypes.c_int, ctypes.c_void_p, ctypes.POINTER(ctypes.c_int)
    )
    if not query_type(query)(1, devices, ctypes.byref(count)) or count.value < 1:
        raise OSError(f"{library}: no driver (libgl1-mesa-dri is missing)")
    display_type = ctypes.CFUNCTYPE(
        ctypes.c_void_p, ctypes.c_uint, ctypes.c_void_p, ctypes.c_void_p
    )
    display = display_type(get_display)(_EGL_PLATFORM_DEVICE, devices[0], None)
    egl.eglInitialize.argtypes = [ctypes.c_void_p] * 3
    egl.eglTerminate.argtypes = [ctypes.c_void_p]
    if not display or not egl.eglInitialize(display, None, None):
        raise OSError(f"{library}: its device does not open")
    egl.eglTerminate(display)
    return Backend(window="vtkEGLRenderWindow", library=library)


def _system_osmesa() -> Backend:
    ctypes.CDLL(_OSMESA, mode=ctypes.RTLD_GLOBAL)
    return Backend(window="vtkOSOpenGLRenderWindow", library=_OSMESA)


def _unpacked_osmesa() -> Backend:
    """Load OSMesa and what it needs by path; VTK then finds it by its soname."""
    library = _unpacked(_OSMESA)
    _preload(library)
    ctypes.CDLL(str(library), mode=ctypes.RTLD_GLOBAL)
    return Backend(window="vtkOSOpenGLRenderWindow", library=str(library))


def _unpacked_egl() -> Backend:
    """Load EGL, its vendor's library and what they need by path."""
    library = _unpacked(_EGL)
    # Mesa looks for these two by name, not among what is loaded.
    vendors = unpacked_folder() / "usr" / "share" / "glvnd" / "egl_vendor.d"
    places = {
        "__EGL_VENDOR_LIBRARY_DIRS": str(vendors),
        "LIBGL_DRIVERS_PATH": str(library.parent / "dri"),
    }
    os.environ.update({name: place for name, place in places.items() if name not in os.environ})
    _preload(library)
    return _egl(str(library))


def _unpacked(name: str) -> Path:
    """Path of a library below the environment."""
    candidates = sorted(unpacked_folder().glob(f"usr/lib/*/{name}"))
    if not candidates:
        raise OSError(f"{unpacked_folder()}: no usr/lib/*/{name}")
    return candidates[0]


def _preload(library: Path) -> None:
    """Load all libraries beside one by path."""
    waiting = [p for p in sorted(library.parent.glob("*.so*")) if p.name != library.name]
    # Libraries need each other in an order that only loading them shows.
    while True:
        left = [path for path in waiting if not _loads(path)]
        if len(left) == len(waiting):
            return
        waiting = left


def _loads(path: Path) -> bool:
    try:
        ctypes.CDLL(str(path), mode=ctypes.RTLD_GLOBAL)
    except OSError:
        return False
    return True


# Name -> how it is loaded; after the first, in the order in which they are tried.
LIBRARIES: dict[str, Callable[[], Backend]] = {
    "own": _own,
    "EGL": _egl,
    "OSMesa": _system_osmesa,
    "unpacked OSMesa": _unpacked_osmesa,
    "unpacked EGL": _unpacked_egl,
}
