"""How much faster two workers are than one, start-up excluded; times are printed, not asserted."""

from __future__ import annotations

import os
import time
from pathlib import Path

import pytest

from seatlook.sweeps.run import run_local
from support.sweep_runs import seeds

pytestmark = pytest.mark.bench


def test_two_workers_against_one(tmp_path: Path):
    count = int(os.environ.get("SEATLOOK_CELLS", "24"))
    cells = seeds(tmp_path, count)
    rate = {}
    for workers in (1, 2):
        done = []
        for _, what in run_local(cells, tmp_path / str(workers), workers=workers):
            assert what == ""
            done.append(time.perf_counter())
        # Each worker's first cell holds its imports and its compiled kernels' loading.
        rate[workers] = (len(done) - workers) / (done[-1] - done[workers - 1])
    print(f"{count} cells: {rate[1]:.2f} and {rate[2]:.2f} per s, {rate[2] / rate[1]:.2f} x")
    assert len(list((tmp_path / "2").glob("*.json"))) == count
