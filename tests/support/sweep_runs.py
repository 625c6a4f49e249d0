"""Small sweeps as files on disk, and what can be seen of their processes."""

from __future__ import annotations

import importlib
import os
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from seatlook.io.sweep import read_sweep
from seatlook.sweeps.cell import Cell, plan
from support.commands import heeded
from support.scene_files import write_two_panels

SEEDS = 'schema = 1\nscene = "scene.toml"\n[axis]\n"mesh.seed" = [{}]\n'


def seeds(folder: Path, count: int, *, more: str = "") -> tuple[Cell, ...]:
    """Write a sweep over seeds of the two panels and return its cells."""
    write_two_panels(folder)
    (folder / "sweep.toml").write_text(SEEDS.format(", ".join(map(str, range(count)))) + more)
    return plan(read_sweep(folder / "sweep.toml"))


def contents(folder: Path) -> dict[str, bytes]:
    """Every file below a folder by its path in it."""
    files = (p for p in sorted(folder.rglob("*")) if p.is_file())
    return {p.relative_to(folder).as_posix(): p.read_bytes() for p in files}


def results(folder: Path) -> list[Path]:
    """The JSON files of finished cells.

    A glob takes hidden files as well: halves that are being written, or that a killed worker left
    and the next run removes.
    """
    files = folder.glob("[!.]*.json")
    return [path for path in files if not path.name.endswith(".failed.json")]


@contextmanager
def local_cluster() -> Iterator[Any]:
    """Two Dask worker processes here; closing them takes long where the machine is loaded."""
    distributed = importlib.import_module("distributed")
    cluster = distributed.LocalCluster(
        n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None
    )
    try:
        yield cluster
    finally:
        cluster.close(timeout=120)


def children(pid: int) -> list[int]:
    """Processes that a process started, whichever of its threads did."""
    tasks = Path(f"/proc/{pid}/task").glob("*/children")
    return [int(child) for task in tasks for child in task.read_text().split()]


def resident(pid: int) -> float:
    """Memory that a process holds [MB]."""
    pages = int(Path(f"/proc/{pid}/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def wait_for(holds: Callable[[], object], *, seconds: float = 240.0) -> None:
    end = time.monotonic() + seconds
    while not holds():
        assert time.monotonic() < end
        time.sleep(0.05)


def start_sweep(folder: Path, *words: str) -> subprocess.Popen[str]:
    """Start the sweep of a folder, as a group of its own, its results below "out"."""
    return subprocess.Popen(
        [
            sys.executable,
            "-m",
            "seatlook",
            "sweep",
            "sweep.toml",
            "--out",
            "out",
            "--preview",
            *words,
        ],
        cwd=folder,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        preexec_fn=heeded,
    )


def kill_and_run_again(folder: Path, *, before: Callable[[Path], object]) -> tuple[set[str], str]:
    """Kill a sweep of two workers once ``before(cells)`` holds, wait, and run it to its end.

    Returns the cells that were done when it was killed, which must not be touched again, and the
    table that the second run prints.
    """
    cells = folder / "out" / "cells"
    process = start_sweep(folder, "--quiet", "--workers", "2")
    wait_for(lambda: cells.is_dir() and before(cells))
    workers = children(process.pid)
    process.kill()
    process.communicate()
    # Workers end by themselves when the process that started them is gone.
    wait_for(lambda: not any(Path(f"/proc/{pid}").exists() for pid in workers))
    done = {p: p.stat().st_mtime_ns for p in results(cells)}
    again = start_sweep(folder, "--quiet")
    said, wrong = again.communicate()
    assert again.returncode == 0, wrong
    assert {p: p.stat().st_mtime_ns for p in done} == done
    return {p.stem for p in done}, said
