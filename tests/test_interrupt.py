"""Interrupts at places that do not bear them."""

from __future__ import annotations

import subprocess
import sys

import pytest

from support.commands import heeded

# The signal comes while the module's own code, in C, imports others.
WHILE_LOADING = """
import os, signal, sys
from importlib.machinery import ExtensionFileLoader
from seatlook import _interrupt
import numpy

_interrupt.heed()
sent = []

def hook(event, arguments):
    frame = None if sent or event != "import" else sys._getframe()
    while frame is not None:
        if frame.f_code is ExtensionFileLoader.exec_module.__code__:
            sent.append(frame.f_locals["module"].__name__)
            os.kill(os.getpid(), signal.{signal})
            return
        frame = frame.f_back

sys.addaudithook(hook)
try:
    import scipy.spatial, time
    time.sleep(10.0)
except KeyboardInterrupt:
    print("loaded:", hasattr(sys.modules[sent[0]], "{part}"), sent[0])
"""
WHILE_CALLED_BACK = """
import os, signal, time
from seatlook import _interrupt
from numba.core.codegen import JITCodeLibrary
import numba

_interrupt.heed()
given = []
compiled = JITCodeLibrary._object_compiled_hook

def hook(module, code):
    os.kill(os.getpid(), signal.{signal})
    compiled(module, code)
    given.append(len(code))

JITCodeLibrary._object_compiled_hook = hook
try:
    numba.njit(lambda x: x + 1.0)(1.0)
    time.sleep(10.0)
except KeyboardInterrupt:
    print("to the end:", bool(given))
"""


def run(code: str) -> str:
    done = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
        preexec_fn=heeded,
    )
    assert done.stderr == ""
    assert done.returncode == 0
    return done.stdout


@pytest.mark.parametrize("signal", ["SIGINT", "SIGTERM"])
def test_a_compiled_module_is_loaded_to_its_end(signal):
    said = run(WHILE_LOADING.format(signal=signal, part="__file__"))
    assert said.startswith("loaded: True scipy.")


@pytest.mark.parametrize("signal", ["SIGINT", "SIGTERM"])
def test_the_compiler_gets_what_it_asks_for(signal):
    assert run(WHILE_CALLED_BACK.format(signal=signal)) == "to the end: True\n"


TWICE = """
import os, signal, time
from seatlook import _interrupt

def held():
    os.kill(os.getpid(), signal.{signal})
    time.sleep(0.01)
    os.kill(os.getpid(), signal.{signal})

held.__globals__["__name__"] = _interrupt._CALLED_BACK
_interrupt.heed()
try:
    held()
    __name__ = "__main__"
    time.sleep(10.0)
except KeyboardInterrupt:
    time.sleep(0.5)
    print("once")
"""


@pytest.mark.parametrize("signal", ["SIGINT", "SIGTERM"])
def test_two_that_had_to_wait_end_a_command_once(signal):
    assert run(TWICE.format(signal=signal)) == "once\n"
