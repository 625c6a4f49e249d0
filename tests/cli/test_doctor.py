"""The command doctor, and what runs where no picture can be drawn."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

from support.commands import HIDDEN, seatlook


def test_doctor_names_the_library_it_found(tmp_path):
    done = seatlook("doctor", "--json", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert found["GL window"].startswith("vtk")
    assert found["cores"] == os.cpu_count()
    assert found["kernel threads"] >= 1
    assert found["kernel cache writable"] is True
    assert found["field cache writable"] is True
    assert found["field cache"] == str(Path(os.environ["SEATLOOK_CACHE_DIR"]) / "fields")
    assert found["fields in cache"].endswith(" MB")
    assert done.stderr == "nothing to do: this machine can solve and draw\n"
    quiet = seatlook("doctor", "--json", "--quiet", cwd=tmp_path)
    assert quiet.stderr == ""


def test_doctor_says_what_to_set(tmp_path):
    done = seatlook(
        "doctor", cwd=tmp_path, OMP_NUM_THREADS="999", NUMBA_CACHE_DIR="/proc/none/such"
    )
    assert done.returncode == 0
    assert f"more threads (999) than cores: set OMP_NUM_THREADS={os.cpu_count()} or less" in (
        done.stderr
    )
    (tmp_path / "file").write_text("in the way")
    shut = seatlook("doctor", cwd=tmp_path, SEATLOOK_CACHE_DIR=str(tmp_path / "file"))
    assert f"{tmp_path / 'file' / 'fields'} cannot be written" in shut.stderr


@pytest.mark.parametrize("command", ["doctor", "evaluate"])
def test_without_a_gl_library_it_ends_with_3_before_any_work(command, demo_scene, tmp_path):
    words = ["doctor"]
    if command == "evaluate":
        words = ["evaluate", str(demo_scene), "--out", str(tmp_path / "out")]
    done = subprocess.run(
        [sys.executable, "-c", HIDDEN, *words], capture_output=True, text=True, check=False
    )
    assert done.returncode == 3
    assert bool(re.search(r"(?m)^GL library +-$", done.stdout)) == (command == "doctor")
    assert "as root:" in done.stderr
    assert "without root:" in done.stderr
    assert "Traceback" not in done.stderr
    assert not (tmp_path / "out").exists()
