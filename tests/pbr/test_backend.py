"""Without a GL library: a readable error before VTK is touched, never a crash."""

from __future__ import annotations

import ctypes
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from seatlook.errors import NoOffscreenContext
from seatlook.pbr import backend

ASK = """
import sys
from seatlook.errors import SeatlookError
from seatlook.pbr import render
from support.reference.lit_sheets import above, flat, sheet
from seatlook.model import Rig, sun
try:
    rig = Rig(name="sun", lights=(sun(elevation_deg=60, azimuth_deg=0),))
    render(sheet(flat, steps=2), rig=rig, camera=above(size=(8, 8)), quality="draft")
except SeatlookError as error:
    print(type(error).__name__, error)
    assert not [m for m in sys.modules if m.startswith("vtkmodules")], "VTK was imported"
    sys.exit(error.exit_code)
"""
PATCH = """
import ctypes
real = ctypes.CDLL
def refuse(name, *args, **kwargs):
    if any(word in str(name) for word in ("EGL", "OSMesa")):
        raise OSError(f"{name}: cannot open shared object file")
    return real(name, *args, **kwargs)
ctypes.CDLL = refuse
"""
LOAD = """
import ctypes, sys
from seatlook.pbr import backend
sys.prefix = {prefix!r}
result = backend._unpacked_osmesa()
print(result.window, ctypes.CDLL(result.library).osmesa())
"""
TESTS = Path(__file__).parents[1]


def run(code, prefix=()):
    environment = {**os.environ, "PYTHONPATH": str(TESTS)}
    return subprocess.run(
        [*prefix, sys.executable, "-c", code],
        capture_output=True,
        text=True,
        timeout=120,
        env=environment,
        check=False,
    )


def assert_readable(done):
    assert done.returncode == 3, done.stdout + done.stderr
    assert "NoOffscreenContext" in done.stdout
    assert "apt-get install libegl1 libgl1-mesa-dri" in done.stdout
    assert "seatlook-gl" in done.stdout


def test_refused_libraries_raise_before_vtk_is_imported():
    assert_readable(run(PATCH + ASK))


def hidden(folder):
    """Command prefix that runs with every GL library of this machine replaced by nothing."""
    script = folder / "hide.sh"
    script.write_text(
        "set -e\n"
        "for f in $(find /usr/lib /lib /usr/local/lib -name 'libEGL*.so*' -o -name 'libGL*.so*' "
        "-o -name 'libOSMesa*.so*' -o -name 'libX11*.so*'); do\n"
        '  [ -e "$f" ] && mount --bind /dev/null "$(readlink -f "$f")"\n'
        "done\n"
        f"folder='{backend.unpacked_folder()}'\n"
        '[ -d "$folder" ] && mount -t tmpfs none "$folder"\n'
        'exec "$@"\n'
    )
    flags = "-m" if os.geteuid() == 0 else "-rm"
    return ["unshare", flags, "sh", str(script)]


def can_hide(folder):
    if shutil.which("unshare") is None:
        return False
    done = subprocess.run([*hidden(folder), "true"], capture_output=True, check=False)
    return done.returncode == 0


def test_hidden_libraries_do_not_crash_the_interpreter(tmp_path):
    if not can_hide(tmp_path):
        pytest.skip("this machine allows no private mounts; the refused-loader test still ran")
    assert_readable(run(ASK, prefix=hidden(tmp_path)))


def test_error_lists_what_was_tried(monkeypatch):
    def refuse(name, *_args, **_kwargs):
        raise OSError(f"{name}: hidden")

    monkeypatch.setattr(ctypes, "CDLL", refuse)
    # Past the cache: probing again ends the display in which other tests have drawn.
    with pytest.raises(NoOffscreenContext, match=r"libEGL\.so\.1: hidden; libOSMesa\.so\.8"):
        backend.offscreen_backend.__wrapped__()


def test_this_machine_has_a_library():
    result = backend.offscreen_backend()
    assert result.window in ("vtkEGLRenderWindow", "vtkOSOpenGLRenderWindow")
    assert os.environ["VTK_DEFAULT_OPENGL_WINDOW"] == result.window


def test_unpacked_library_is_loaded_with_what_it_needs(tmp_path):
    """Two real libraries, the second needing the first: loaded in whatever order works.

    In another process: here the windows of later tests would find this OSMesa.
    """
    compiler = shutil.which("gcc")
    if compiler is None:
        pytest.skip("no C compiler to make the libraries with")
    folder = tmp_path / "lib" / "seatlook-gl" / "usr" / "lib" / "x86_64-linux-gnu"
    folder.mkdir(parents=True)
    for name, source, need in (
        ("libneeded.so.1", "int needed(void) { return 7; }", []),
        (
            "libOSMesa.so.8",
            "int needed(void); int osmesa(void) { return needed(); }",
            [str(folder / "libneeded.so.1")],
        ),
    ):
        subprocess.run(
            [
                compiler,
                "-shared",
                "-fPIC",
                "-x",
                "c",
                "-",
                f"-Wl,-soname,{name}",
                "-x",
                "none",
                *need,
                "-o",
                str(folder / name),
            ],
            input=source,
            text=True,
            check=True,
        )
    done = run(LOAD.format(prefix=str(tmp_path)))
    assert done.stdout == "vtkOSOpenGLRenderWindow 7\n", done.stderr
