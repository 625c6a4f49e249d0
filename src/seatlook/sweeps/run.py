"""Run the cells of a sweep: in worker processes here, or on a Dask cluster."""

from __future__ import annotations

import multiprocessing
import os
import threading
from collections import Counter
from collections.abc import Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor, as_completed
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from multiprocessing import connection
from pathlib import Path
from typing import Any

from seatlook.errors import InputError
from seatlook.sweeps.cell import Cell, finished, run_cell

# A worker ends after that many cells: what libraries do not give back goes with it.
_CELLS_PER_WORKER = 32
_ATTEMPTS = 2  # at a cell whose worker dies, before it counts as failed
_ONE_THREAD = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMBA_NUM_THREADS")


def shard_of(cells: Sequence[Cell], text: str) -> tuple[Cell, ...]:
    """Return part ``i/n`` (i from 1) of the cells: every n-th.

    Raises
    ------
    InputError
        Another text, or i out of 1 to n.

    Examples
    --------
    >>> [c.name for c in shard_of([Cell(name=k, spec="{}") for k in "abcde"], "2/2")]
    ['b', 'd']
    """
    i, _, n = text.partition("/")
    if not (i.isdigit() and n.isdigit() and 1 <= int(i) <= int(n)):
        raise InputError.single("shard", got=repr(text), expected="i/n, such as 1/4")
    return tuple(cells[int(i) - 1 :: int(n)])


def unfinished(cells: Sequence[Cell], folder: Path) -> tuple[Cell, ...]:
    """Return the cells without a result in the folder."""
    return tuple(cell for cell in cells if not finished(cell, folder))


def run_local(
    cells: Sequence[Cell], folder: Path, *, workers: int = 1
) -> Iterator[tuple[Cell, str]]:
    """Run cells in processes of this machine, one thread each; yield each with what went wrong.

    Workers are spawned, not forked: a process that has drawn cannot be forked. They end with this
    process, however it ends. A cell whose worker dies is tried once more in a worker of its own.
    """
    if workers < 1:
        raise InputError.single("workers", got=workers, expected="1 or more")
    folder.mkdir(parents=True, exist_ok=True)
    left, suspects, tries = list(cells), list[Cell](), Counter[str]()
    while batch := suspects[:1] or left:
        alone, done, others = bool(suspects), set[str](), set(multiprocessing.active_children())
        with _one_thread(), _pool(1 if alone else workers) as pool:
            waiting = _submitted(pool, batch, folder)
            try:
                for future in as_completed(waiting):
                    what = future.result()
                    done.add(waiting[future].name)
                    yield waiting[future], what
            except BrokenProcessPool:
                lost = [c for c in batch if c.name not in done]
                # Cells are handed out in order: the one that killed its worker is among these.
                suspects = suspects if alone else lost[:workers]
                tries.update(c.name for c in lost if alone)
            except BaseException:
                # Interrupted: what is not finished is done by the next run, which can be soon.
                pool.shutdown(wait=False, cancel_futures=True)
                for worker in set(multiprocessing.active_children()) - others:
                    worker.kill()
                raise
        for cell in batch:
            if cell.name not in done and tries[cell.name] >= _ATTEMPTS:
                done.add(cell.name)
                yield cell, "its worker was killed, twice"
        suspects = [c for c in suspects if c.name not in done]
        left = [c for c in left if c.name not in done and c not in suspects]


def run_cluster(
    cells: Sequence[Cell], folder: Path, *, scheduler: str
) -> Iterator[tuple[Cell, str]]:
    """Run cells on a Dask cluster whose workers see the folder and the scenes under these paths.

    Raises
    ------
    InputError
        Dask is not installed, or nothing answers at the address.
    """
    try:
        from distributed import Client
        from distributed import as_completed as as_dask_completed
    except ImportError as error:
        raise InputError.single(
            "scheduler", got="no distributed", expected='pip install "seatlook[cluster]"'
        ) from error
    folder.mkdir(parents=True, exist_ok=True)
    by_name = {cell.name: cell for cell in cells}
    try:
        client = Client(scheduler, timeout="20s")
    except (OSError, ValueError) as error:
        raise InputError.single(
            "scheduler", got=scheduler, expected="the address of a Dask scheduler",
            hint="start one with: dask scheduler",
        ) from error  # fmt: skip
    with client:
        futures = [
            client.submit(run_cell, c.name, c.spec, str(folder.resolve()), key=c.name, retries=2)
            for c in cells
        ]
        for future in as_dask_completed(futures):
            failed = future.status == "error"
            what = str(future.exception()) if failed else str(future.result())
            yield by_name[future.key], what


def _submitted(
    pool: ProcessPoolExecutor, cells: Sequence[Cell], folder: Path
) -> dict[Future[str], Cell]:
    return {pool.submit(run_cell, c.name, c.spec, str(folder)): c for c in cells}


def _pool(workers: int) -> ProcessPoolExecutor:
    return ProcessPoolExecutor(
        max_workers=workers,
        mp_context=multiprocessing.get_context("spawn"),
        initializer=_end_with_parent,
        max_tasks_per_child=_CELLS_PER_WORKER,
    )


def _end_with_parent() -> None:
    """Let a worker end when its parent is killed, which cannot tell it any more."""
    parent = multiprocessing.parent_process()
    if parent is None:
        return

    def watch(sentinel: Any) -> None:
        connection.wait([sentinel])
        os._exit(1)

    threading.Thread(target=watch, args=(parent.sentinel,), daemon=True).start()


@contextmanager
def _one_thread() -> Iterator[None]:
    """Give processes started inside one thread each, so that sums do not depend on their number."""
    before = {name: os.environ.get(name) for name in _ONE_THREAD}
    os.environ.update(dict.fromkeys(_ONE_THREAD, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value
