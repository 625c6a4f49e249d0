"""A sweep of 24 cells, solved and drawn: by one worker, two, a cluster, and after a kill."""

from __future__ import annotations

import itertools
import os
import random
import signal
from pathlib import Path

import pytest

from seatlook.sweeps.cell import Cell
from seatlook.sweeps.run import run_cluster, run_local
from support.sweep_runs import (
    children,
    contents,
    kill_and_run_again,
    local_cluster,
    resident,
    results,
    seeds,
)

pytestmark = [pytest.mark.validate, pytest.mark.render]

COUNT = 24
DRAWN = '[draw]\ntextures = ["suede"]\nrigs = ["sun"]\n'
Whole = tuple[tuple[Cell, ...], dict[str, bytes], list[float]]


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Whole:
    """Cells, what one worker leaves of them, and the memory [MB] of all processes after each."""
    folder = tmp_path_factory.mktemp("whole")
    cells, held = seeds(folder, COUNT, more=DRAWN), []
    for _, what in run_local(cells, folder / "cells"):
        assert what == ""
        held.append(sum(map(resident, [os.getpid(), *children(os.getpid())])))
    return cells, contents(folder / "cells"), held


def test_each_cell_leaves_its_three_files(whole):
    cells, expected, _ = whole
    assert len(expected) == 3 * COUNT
    assert {path.split("/")[0].split(".")[0] for path in expected} == {c.name for c in cells}


def test_memory_is_flat(whole):
    _, _, held = whole
    print("MB held after each cell:", " ".join(f"{mb:.0f}" for mb in held))
    # The first cells load libraries and kernels; a worker ends after 32 anyway.
    assert max(held[6:]) < 1.05 * held[5]


def test_two_workers_leave_the_same_bytes(whole, tmp_path):
    cells, expected, _ = whole
    assert all(what == "" for _, what in run_local(cells, tmp_path, workers=2))
    assert contents(tmp_path) == expected


def test_a_cluster_leaves_the_same_bytes_though_a_worker_is_killed(whole, tmp_path):
    cells, expected, _ = whole
    with local_cluster() as cluster:
        first = next(iter(cluster.workers.values()))
        running = run_cluster(cells, tmp_path, scheduler=cluster.scheduler_address)
        result = list(itertools.islice(running, COUNT // 2))
        os.kill(first.pid, signal.SIGKILL)
        result += running
    assert {done.name: what for done, what in result} == {c.name: "" for c in cells}
    assert contents(tmp_path) == expected


def test_killed_at_any_moment_and_run_again_nothing_is_lost_or_doubled(whole, tmp_path):
    cells, expected, _ = whole
    seeds(tmp_path, COUNT, more=DRAWN)
    enough = random.randint(1, COUNT - 4)

    def far(folder: Path) -> bool:
        return len(results(folder)) >= enough

    done, printed = kill_and_run_again(tmp_path, before=far)
    print(f"killed after {len(done)} of {COUNT} cells")
    assert enough <= len(done) < COUNT
    assert contents(tmp_path / "out" / "cells") == expected
    assert len(printed.splitlines()) == 1 + len(cells)
