"""The folder of a run: one run at a time, the user's files, no trace of a refusal."""

from __future__ import annotations

import os
import signal
import subprocess
import sys

import pytest

from seatlook.chain.run_folder import run_folder
from seatlook.errors import InputError

WRITES = ("index.html", "images/**/*.png")
HOLD = """
import sys, time
from pathlib import Path
from seatlook.chain.run_folder import run_folder
with run_folder(Path(sys.argv[1]), writes=("a.csv",)) as out:
    (out / "a.csv").write_text("half")
    print("held", flush=True)
    time.sleep(60)
"""


def refused(folder, message):
    with pytest.raises(InputError, match=message), run_folder(folder, writes=WRITES, page=True):
        pass


def test_what_a_run_wrote_is_overwritten_by_the_next(tmp_path):
    for text in ("one", "two"):
        with run_folder(tmp_path, writes=WRITES, page=True) as out:
            assert not (out / "index.html").exists()
            (out / "images/sun").mkdir(parents=True, exist_ok=True)
            (out / "images/sun/a.png").write_text(text)
            (out / "index.html").write_text(text)
    assert (tmp_path / "images/sun/a.png").read_text() == "two"


@pytest.mark.parametrize("name", ["index.html", "images/sun/a.png"])
def test_files_of_the_user_are_refused_and_edited_ones_too(tmp_path, name):
    path = tmp_path / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("mine")
    refused(tmp_path, "edited or not written by seatlook, expected another")
    assert path.read_text() == "mine"
    with run_folder(tmp_path, writes=WRITES, force=True):
        path.write_text("ours")
    with run_folder(tmp_path, writes=WRITES):
        pass
    path.write_text("edited")
    with (
        pytest.raises(InputError, match="--force to overwrite"),
        run_folder(tmp_path, writes=WRITES),
    ):
        pass


def test_other_files_of_the_user_are_let_alone(tmp_path):
    (tmp_path / "notes.txt").write_text("mine")
    with run_folder(tmp_path, writes=WRITES):
        pass
    assert (tmp_path / "notes.txt").read_text() == "mine"


def test_a_folder_in_use_is_refused_and_a_killed_run_leaves_it_usable(tmp_path):
    run = subprocess.Popen(
        [sys.executable, "-c", HOLD, str(tmp_path)], stdout=subprocess.PIPE, text=True
    )
    try:
        assert run.stdout.readline() == "held\n"
        refused(tmp_path, "another run of seatlook writes to")
    finally:
        os.kill(run.pid, signal.SIGKILL)
        run.wait()
        run.stdout.close()
    # The lock goes with its process; what was half written is not taken for the user's.
    with run_folder(tmp_path, writes=("a.csv",)) as out:
        (out / "a.csv").write_text("whole")
    assert (tmp_path / "a.csv").read_text() == "whole"


def test_a_refused_run_leaves_no_trace(tmp_path):
    out = tmp_path / "new" / "folder"
    with pytest.raises(ZeroDivisionError), run_folder(out):
        raise ZeroDivisionError
    assert list(tmp_path.iterdir()) == []


def test_a_folder_that_cannot_be_made_is_named(tmp_path):
    (tmp_path / "file").write_text("")
    refused(tmp_path / "file" / "out", r"out: got .*file/out.*expected a folder that can be made")
