"""Without a GL library: a readable error before VTK is touched, never a crash."""

from __future__ import annotations

import ctypes
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from seatlook.errors import NoOffscreenContext
from seatlook.pbr import backend

pytestmark = pytest.mark.first

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


# Other packages load their libraries by the real system first.
TELL = """
import platform, sys
import seatlook.pbr.shading.studio
{system}
"""
WINDOWS = ["sys.platform = 'win32'", "platform.system = lambda: 'Windows'"]
MACOS = ["sys.platform = 'darwin'", "platform.system = lambda: 'Darwin'"]
KEPT = """
import subprocess
from seatlook.pbr.window_trial import try_window
real, started = subprocess.run, []
subprocess.run = lambda *words, **options: started.append(words) or real(*words, **options)
from seatlook.pbr.backend import offscreen_backend
print(offscreen_backend().window, len(started))
"""
# What nobody can use who has another system than Debian.
FOREIGN = ("apt-get", "dpkg", "libEGL", "OSMesa")


def run(code, prefix=(), **variables):
    path = os.pathsep.join(filter(None, [str(TESTS), os.environ.get("PYTHONPATH")]))
    environment = {**os.environ, "PYTHONPATH": path, **variables}
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


@pytest.mark.parametrize("version", ["1.1", "2.1", "3.1"])
def test_a_gl_too_old_for_vtk_is_said_and_ends_nothing(version):
    done = run(ASK, MESA_GL_VERSION_OVERRIDE=version)
    assert_readable(done)
    assert "VTK draws with OpenGL 3.2 or later" in done.stdout
    assert f"MESA_GL_VERSION_OVERRIDE={version} is set: unset it" in done.stdout
    assert done.stderr == ""


def test_doctor_finds_a_gl_too_old():
    done = run(
        "from seatlook.cli import run; import sys; sys.exit(run(['doctor']))",
        MESA_GL_VERSION_OVERRIDE="1.1",
    )
    assert done.returncode == 3
    assert "VTK draws with OpenGL 3.2 or later" in done.stderr


@pytest.mark.parametrize(
    ("system", "advice"),
    [(w, "Mesa's opengl32.dll") for w in WINDOWS] + [(m, "at the Mac's screen") for m in MACOS],
)
def test_other_systems_get_advice_of_their_own(system, advice):
    """VTK's own window is tried there, which an old GL closes on this system too."""
    tell = TELL.format(system=system)
    done = run(tell + ASK, MESA_GL_VERSION_OVERRIDE="1.1")
    assert done.returncode == 3, done.stdout + done.stderr
    assert advice in done.stdout
    # By the library that VTK finds, an old GL is refused or ends the process of the trial.
    assert re.search("ended its process with signal|gives no OpenGL that VTK can", done.stdout)
    assert not [word for word in FOREIGN if word in done.stdout]
    ask = "from seatlook.pbr.backend import offscreen_backend; print(offscreen_backend())"
    done = run(tell + ask)
    assert done.returncode == 0, done.stderr
    assert "VTK's own" in done.stdout


@pytest.mark.parametrize("system", [WINDOWS[0], MACOS[0]])
def test_other_systems_without_any_library_are_not_ended(tmp_path, system):
    if not can_hide(tmp_path):
        pytest.skip("this machine allows no private mounts")
    cache = str(tmp_path / "cache")
    done = run(TELL.format(system=system) + ASK, hidden(tmp_path), SEATLOOK_CACHE_DIR=cache)
    assert done.returncode == 3, done.stdout + done.stderr
    assert "VTK draws with OpenGL 3.2 or later" in done.stdout
    assert not [word for word in FOREIGN if word in done.stdout]


def test_a_window_that_opened_is_kept_until_something_changes(tmp_path):
    cache = {"SEATLOOK_CACHE_DIR": str(tmp_path / "cache")}
    first, again = run(KEPT, **cache), run(KEPT, **cache)
    assert first.stdout.split() == [backend.offscreen_backend().window, "1"], first.stderr
    assert again.stdout.split() == [backend.offscreen_backend().window, "0"], again.stderr
    assert run(KEPT, **cache, MESA_DEBUG="silent").stdout.split()[1] == "1"
    # One that did not open is tried again, and spoils nothing.
    assert run(KEPT, **cache, MESA_GL_VERSION_OVERRIDE="1.1").returncode != 0
    assert run(KEPT, **cache).stdout.split()[1] == "0"
    (tmp_path / "cache" / "windows.json").write_text("{broken")
    assert run(KEPT, **cache).stdout.split()[1] == "1"


def test_a_cache_that_cannot_be_written_costs_only_the_trial(tmp_path):
    (tmp_path / "cache").write_text("a file")
    done = run(KEPT, SEATLOOK_CACHE_DIR=str(tmp_path / "cache"))
    assert done.stdout.split()[1] == "1", done.stderr


STUB = """#!/bin/sh
echo "{name} $*" >> "{log}"
case "{name} $*" in
"apt-cache"*) echo "  Candidate: {candidate}" ;;
"id -u") echo 0 ;;
"python"*) [ -e "{log}.installed" ] || exit 3 ;;
"apt-get install"*) touch "{log}.installed" ;;
esac
"""


@pytest.mark.parametrize(
    ("candidate", "packages"),
    [("22.3.6-1", "libosmesa6"), ("(none)", "libegl1 libgl1-mesa-dri")],
)
def test_make_installs_what_the_system_has(tmp_path, candidate, packages):
    """Debian's Mesa has no OSMesa from 25.1 on."""
    log, folder = tmp_path / "log", tmp_path / "bin"
    folder.mkdir()
    for name in ("apt-get", "apt-cache", "dpkg", "id", "python"):
        stub = folder / name
        stub.write_text(STUB.format(name=name, log=log, candidate=candidate))
        stub.chmod(0o755)
    subprocess.run(
        ["bash", str(TESTS.parent / ".ci" / "gl.sh"), str(tmp_path)],
        env={**os.environ, "PATH": f"{folder}:{os.environ['PATH']}"},
        check=True,
        capture_output=True,
    )
    (installed,) = (ln for ln in log.read_text().splitlines() if "apt-get install" in ln)
    assert installed.endswith(f"--no-install-recommends {packages}")


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
