"""How the command line ends when it is interrupted, its output is closed or its memory is full."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from seatlook.cli import run
from seatlook.errors import SolverError
from support.commands import heeded

pytestmark = pytest.mark.first

COMMAND = [sys.executable, "-m", "seatlook"]
# Waits as long as a kernel would: signals are heeded when it returns.
HELD = """
import signal, sys, time
from seatlook import __main__, cli
{setup}
sys.argv = ["seatlook", "check", "a.toml"]
__main__.main()
"""
INTERRUPTED = "interrupted; no file was left half written\n"


def ended(setup, number, **options):
    """Run a command held where ``setup`` says, send a signal once it prints, return how it ends."""
    process = subprocess.Popen(
        [sys.executable, "-c", HELD.format(setup=setup)],
        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, preexec_fn=heeded, **options,
    )  # fmt: skip
    with process:
        assert process.stdout.readline() == "held\n"
        time.sleep(0.3)
        process.send_signal(number)
        _, errors = process.communicate(timeout=60)
    return process.returncode, errors


SLEEP = """
def held(*args, **kwargs):
    print("held", flush=True)
    time.sleep(50)
from seatlook import io
io.load_scene = held
"""
# What Numba and other compiled code make of an interrupt.
COMPILED = """
def held(*args, **kwargs):
    print("held", flush=True)
    try:
        time.sleep(50)
    except KeyboardInterrupt:
        raise SystemError("returned a result with an exception set")
from seatlook import io
io.load_scene = held
"""
# A callback of a library prints and goes on: it is asked again.
SWALLOWED = """
from seatlook import _interrupt, io
_interrupt._AGAIN = 0.5
def held(*args, **kwargs):
    print("held", flush=True)
    try:
        time.sleep(50)
    except KeyboardInterrupt:
        pass
    time.sleep(50)
io.load_scene = held
"""
# From a callback of C, Python prints what it cannot raise.
CALLBACK = """
import ctypes
from seatlook import _interrupt, io
_interrupt._AGAIN = 0.5
def wait():
    print("held", flush=True)
    time.sleep(50)
def held(*args, **kwargs):
    ctypes.CFUNCTYPE(None)(wait)()
    time.sleep(50)
io.load_scene = held
"""
IMPORT = """
class Finder:
    def find_spec(self, name, *rest):
        if name == "seatlook.cli._app":
            print("held", flush=True)
            time.sleep(50)
sys.meta_path.insert(0, Finder())
for name in [n for n in sys.modules if n.startswith("seatlook.cli")]:
    del sys.modules[name]
"""


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
@pytest.mark.parametrize(
    "where",
    [SLEEP, COMPILED, SWALLOWED, CALLBACK],
    ids=["python", "compiled", "lost", "callback"],
)
def test_a_signal_ends_with_130_and_one_line(where, number):
    assert ended(where, number) == (130, INTERRUPTED)


@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_signal_in_an_import_ends_with_130_and_one_line(number):
    assert ended(IMPORT, number) == (130, "interrupted\n")


def test_a_reader_that_goes_does_not_change_the_end():
    for words in (["materials", "list"], ["--help"], ["materials", "show", "suede"]):
        process = subprocess.Popen(
            [*COMMAND, *words], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True
        )
        with process:
            process.stdout.close()
            assert process.wait(60) == 0
            assert process.stderr.read() == ""


def test_closed_output_is_none():
    def close():
        os.close(1)
        os.close(2)

    assert subprocess.run([*COMMAND, "materials", "list"], preexec_fn=close).returncode == 0


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no such device")
def test_a_full_disk_is_named():
    with Path("/dev/full").open("w") as full:
        done = subprocess.run(
            [*COMMAND, "materials", "list"], stdout=full, stderr=subprocess.PIPE, text=True
        )
    assert (done.returncode, done.stderr) == (2, "stdout: No space left on device\n")


def test_what_a_terminal_cannot_show_is_written_as_escapes():
    done = subprocess.run(
        [*COMMAND, "check", "näht🪡.toml"], env=os.environ | {"PYTHONIOENCODING": "ascii"},
        capture_output=True, text=True,
    )  # fmt: skip
    assert done.returncode == 2
    assert "n\\xe4ht\\U0001faa1.toml: file: got no such file" in done.stderr


def test_out_of_memory_is_no_fault_of_seatlook(capsys, monkeypatch):
    from seatlook import io

    def no_memory(*args, **kwargs):
        raise MemoryError("Unable to allocate 9.00 TiB")

    monkeypatch.setattr(io, "load_scene", no_memory, raising=False)
    assert run(["check", "a.toml"]) == 3
    said = capsys.readouterr().err
    assert said.startswith("out of memory: a coarser mesh takes less")
    assert "9.00 TiB" in said
    assert "fault" not in said


def test_out_of_memory_in_the_solver_names_a_mesh_that_takes_less():
    from seatlook.chain.case import mesh_in_memory
    from support.io_samples import cover

    message = "3 triangles of 100 mm; .* --element-size-mm 200 with"
    with pytest.raises(SolverError, match=message), mesh_in_memory(cover()):
        raise MemoryError
