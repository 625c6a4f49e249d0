"""The command line in a process of its own, and one that finds no GL library."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

HIDDEN = """
import ctypes, sys
real = ctypes.CDLL
class Hidden(real):
    def __init__(self, name, *args, **options):
        if name and ("EGL" in str(name) or "OSMesa" in str(name)):
            raise OSError(f"{name}: cannot open shared object file")
        super().__init__(name, *args, **options)
ctypes.CDLL = Hidden
from seatlook.cli import run
sys.exit(run(sys.argv[1:]))
"""


def heeded() -> None:
    """Undo what a shell's background job passes on to its children: an ignored interrupt."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def seatlook(*words: str, cwd: Path, **environment: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-m", "seatlook", *words],
        cwd=cwd,
        capture_output=True,
        text=True,
        env={**os.environ, **environment},
        check=False,
    )
