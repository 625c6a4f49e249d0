"""Sweeps on real processes and a real cluster: same bytes, nothing lost, nothing doubled."""

from __future__ import annotations

import contextlib
import csv
import json
import os
import random
import signal
import subprocess
import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import seatlook
from seatlook.cli import run
from seatlook.errors import InputError
from seatlook.io.sweep import read_sweep
from seatlook.sweeps.cell import Cell, plan, run_cell
from seatlook.sweeps.run import run_cluster, run_local, shard_of, unfinished
from seatlook.sweeps.sweep import list_cells
from support.sweep_runs import (
    children,
    contents,
    kill_and_run_again,
    local_cluster,
    results,
    seeds,
    start_sweep,
    wait_for,
)

pytestmark = pytest.mark.first


@pytest.fixture(scope="module")
def four(tmp_path_factory: pytest.TempPathFactory) -> tuple[tuple[Cell, ...], dict[str, bytes]]:
    """Four cells done by one worker."""
    folder = tmp_path_factory.mktemp("four")
    cells = seeds(folder, 4)
    assert [what for _, what in run_local(cells, folder / "cells")] == [""] * 4
    return cells, contents(folder / "cells")


def test_one_and_two_workers_leave_the_same_bytes(four, tmp_path):
    cells, expected = four
    assert len(expected) == 8
    assert all(what == "" for _, what in run_local(cells, tmp_path, workers=2))
    assert contents(tmp_path) == expected


def test_shards_make_up_the_whole_and_finished_cells_are_left_alone(four, tmp_path):
    cells, expected = four
    parts = [shard_of(cells, f"{i}/3") for i in (1, 2, 3)]
    assert sorted(c.name for part in parts for c in part) == sorted(c.name for c in cells)
    list(run_local(parts[0][:1], tmp_path))
    assert {c.name for c in unfinished(cells, tmp_path)} == {c.name for c in cells[1:]}
    name = f"{parts[0][0].name}.json"
    assert contents(tmp_path)[name] == expected[name]


@pytest.mark.parametrize("text", ["0/2", "3/2", "2", "a/b", ""])
def test_a_shard_is_i_of_n(text):
    with pytest.raises(InputError, match="expected i/n, such as 1/4"):
        shard_of((), text)


def test_a_sweep_in_python_gives_what_the_files_hold(four, tmp_path):
    cells, expected = four
    seeds(tmp_path, 4)
    (tmp_path / "out").mkdir()
    for name in [n for n in expected if n.startswith(tuple(c.name for c in cells[:3]))]:
        (tmp_path / "out" / "cells").mkdir(exist_ok=True)
        (tmp_path / "out" / "cells" / name).write_bytes(expected[name])
    listed = list_cells(tmp_path / "sweep.toml", tmp_path / "out", shard="1/4")
    assert [row[1] for row in listed.rows] == ["done"] * 3 + ["of another shard"]
    assert [row[2] for row in listed.rows] == [f"mesh.seed={k}" for k in range(4)]
    steps = []
    outcome = seatlook.sweep(
        tmp_path / "sweep.toml", tmp_path / "out", progress=lambda name, **at: steps.append(at)
    )
    assert (outcome.done_before, outcome.done, outcome.failed) == (3, 1, ())
    assert [at["step"] for at in steps] == [0, 1]
    assert [row["cell"] for row in outcome.rows] == [cell.name for cell in cells]
    assert contents(tmp_path / "out" / "cells") == expected
    heads, *lines = csv.reader((tmp_path / "out" / "sweep.csv").read_text().splitlines())
    means = [float(line[heads.index("w2_mean")]) for line in lines]
    assert means == [row["w2_mean"] for row in outcome.rows]
    assert (outcome.probability, outcome.notices) == ((), ())
    assert outcome.wanting.startswith("4 of 4 cells are not resolved; the reasons are in sweep.csv")


def test_workers_and_a_scheduler_exclude_each_other(tmp_path):
    seeds(tmp_path, 1)
    with pytest.raises(InputError, match="workers: got 2, expected none with a scheduler"):
        seatlook.sweep(tmp_path / "sweep.toml", tmp_path, workers=2, scheduler="tcp://x:1")


def test_the_name_stands_for_the_content(four, tmp_path):
    cells, _ = four
    moved = seeds(tmp_path, 4)
    assert [c.name for c in moved] == [c.name for c in cells]
    (tmp_path / "curves.toml").write_text((tmp_path / "curves.toml").read_text() + "\n")
    assert not {c.name for c in plan(read_sweep(tmp_path / "sweep.toml"))} & {c.name for c in cells}


def test_a_failed_cell_is_listed_and_does_not_stop_the_others(tmp_path, capsys, monkeypatch):
    (good,) = seeds(tmp_path, 1)
    # As if the scene had been moved between planning and running.
    gone = replace(good, name="gone", spec=good.spec.replace("scene.toml", "moved.toml"))
    monkeypatch.setattr("seatlook.sweeps.sweep.plan", lambda sweep: (gone, good))
    out = tmp_path / "out"
    code = run(["sweep", str(tmp_path / "sweep.toml"), "--out", str(out), "--quiet"])
    printed = capsys.readouterr()
    assert code == 3
    assert printed.err.startswith("failed: gone (mesh.seed=0): InputError: ")
    assert "moved.toml" in json.loads((out / "cells/gone.failed.json").read_text())["error"]
    assert [p.stem for p in (out / "cells").glob("*.npy")] == [good.name]
    assert len((out / "sweep.csv").read_text().splitlines()) == 2


def test_a_cell_whose_worker_dies_is_named_alone(tmp_path, monkeypatch):
    cells = seeds(tmp_path, 3)
    # As the system does to a process that takes too much memory.
    deadly = Cell(name="deadly", spec=json.dumps({"kill": True}))
    hook = tmp_path / "sitecustomize.py"
    hook.write_text(
        "import json, os, signal\n"
        "real = json.loads\n"
        "def loads(text, **options):\n"
        "    value = real(text, **options)\n"
        "    if value == {'kill': True}:\n"
        "        os.kill(os.getpid(), signal.SIGKILL)\n"
        "    return value\n"
        "json.loads = loads\n"
    )
    monkeypatch.setenv("PYTHONPATH", str(tmp_path))
    result = {
        done.name: what for done, what in run_local([deadly, *cells], tmp_path / "c", workers=2)
    }
    assert result == {"deadly": "its worker was killed, twice"} | {c.name: "" for c in cells}


def test_killed_at_any_moment_and_run_again_nothing_is_lost_or_doubled(four, tmp_path):
    cells, expected = four
    seeds(tmp_path, 4)

    def working(folder: Path) -> bool:
        time.sleep(0.2 * random.random())
        # As if a worker had been killed while it wrote the last of them.
        (folder / f".{cells[-1].name}-half.json").write_text("{")
        return bool(list(folder.glob("[!.]*.npy")))

    _, printed = kill_and_run_again(tmp_path, before=working)
    assert contents(tmp_path / "out" / "cells") == expected
    assert len(printed.splitlines()) == 1 + len(cells)


@pytest.mark.parametrize("group", [True, False], ids=["keyboard", "one process"])
def test_an_interrupted_sweep_ends_at_once_and_says_how_to_go_on(four, tmp_path, group):
    _, expected = four
    seeds(tmp_path, 40)
    process = start_sweep(tmp_path, "--workers", "2")
    folder = tmp_path / "out" / "cells"
    wait_for(lambda: results(folder))
    workers = children(process.pid)
    # Python drops an interrupt that meets a finaliser; a person presses the keys again.
    for _ in range(6):
        (os.killpg if group else os.kill)(process.pid, signal.SIGINT)
        with contextlib.suppress(subprocess.TimeoutExpired):
            _, printed = process.communicate(timeout=20)
            break
    assert process.returncode == 130
    assert printed.endswith("the same command again goes on where it was: what is done is kept\n")
    wait_for(lambda: not any(Path(f"/proc/{pid}").exists() for pid in workers))
    assert 0 < len(results(folder)) < 30
    assert not list(folder.glob("*.failed.json"))
    done = contents(folder)
    assert all(done[name] == body for name, body in expected.items() if name in done)


def test_a_cluster_gives_the_same_bytes_though_a_worker_is_killed(four, tmp_path):
    cells, expected = four
    with local_cluster() as cluster:
        first = next(iter(cluster.workers.values()))
        run_ = run_cluster(cells, tmp_path, scheduler=cluster.scheduler_address)
        result = [next(run_)]
        os.kill(first.pid, signal.SIGKILL)
        result += run_
    assert {done.name: what for done, what in result} == {c.name: "" for c in cells}
    assert contents(tmp_path) == expected


def test_an_address_where_no_scheduler_is(tmp_path):
    with pytest.raises(InputError, match="expected the address of a Dask scheduler"):
        list(run_cluster([], tmp_path, scheduler="nonsense://here"))


def test_a_cell_says_nothing_of_time_or_place(four):
    _, expected = four
    text = b"".join(expected.values()).decode("latin-1")
    assert "cpu_seconds" not in text
    assert "/tmp" not in text


def test_halves_of_a_killed_run_are_removed(tmp_path):
    (one,) = seeds(tmp_path, 1)
    half = tmp_path / f".{one.name}-abc.npy"
    half.write_bytes(b"half")
    assert run_cell(one.name, one.spec, str(tmp_path)) == ""
    assert not half.exists()
    assert np.load(tmp_path / f"{one.name}.npy").dtype == np.float32
