"""The making of a cover stage by stage: each kept on disk, and gone on from."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator
from itertools import zip_longest
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
import numpy.typing as npt

from seatlook import io
from seatlook.errors import InputError, did_you_mean
from seatlook.model import Anchor, Cover, FloatArray, Solution, Stage, Stitching, stage_units
from seatlook.solver import SETTINGS, solve
from seatlook.solver.solve import Progress

# What adds up over the calls of the solver.
_ADDED = ("steps", "iterations", "cpu_seconds")


def solve_in_stages(
    cover: Cover,
    folder: Path,
    *,
    again_from: str | None = None,
    resume: bool = False,
    progress: Progress | None = None,
) -> Solution:
    """Solve a cover and keep its state at the end of every stage, a group of stages being one.

    Snapshots are written whole or not at all, so a run that is killed leaves those of the stages
    it has finished; going on from one gives the same bits as not stopping.

    Parameters
    ----------
    folder : for ``1-sew.npz``, ``2-hook.npz``, ... and the shapes on the way, ``shapes/1-sew.npz``
    again_from : stage or group to do again, with all after it, from the snapshot before it
        What was sewn or tied earlier must not have changed; what comes later, and the foam, may.
    resume : go on from the last snapshot of this very cover, if there is one
    progress : as in ``solve``

    Returns
    -------
    Solution
        At rest. History, steps, iterations and CPU time are those of all stages, including the
        ones that were taken from snapshots.

    Raises
    ------
    InputError
        ``again_from`` is no stage or group, its snapshot is missing or is not of this cover's mesh,
        fabrics and earlier stages; and what ``solve`` raises.
    """
    start = None
    if again_from is not None:
        start = _before(again_from, cover, folder)
    elif resume:
        start = _last_of(cover, folder)
    order = stage_order(cover)
    times: list[float] = []
    shapes: list[npt.NDArray[np.float32]] = []

    def see(stage: str, time: float, positions: FloatArray) -> None:
        del stage
        times.append(time)
        shapes.append(positions.astype(np.float32))

    def keep(state: Solution) -> None:
        # Before the snapshot: where that is, the stage's shapes are as well.
        io.write_shapes(folder / shapes_name(cover, state.stage), times, np.stack(shapes))
        times.clear()
        shapes.clear()
        io.write_result(joined(start, state), folder / snapshot_name(order, state.stage))

    return joined(start, solve(cover, progress=progress, start=start, snapshot=keep, shape=see))


def stage_order(cover: Cover) -> list[str]:
    """Names of the groups, and of stages without one, in the order in which they begin."""
    return stage_units(cover.stages)


def snapshot_name(order: list[str], stage: str) -> str:
    """Name of a stage's file.

    Examples
    --------
    >>> snapshot_name(["sew", "pull down"], "pull down")
    '2-pull-down.npz'
    """
    slug = "".join(c if c.isalnum() else "-" for c in stage.lower())
    return f"{order.index(stage) + 1}-{slug}.npz"


def shapes_name(cover: Cover, stage: str) -> str:
    """Name of the file of the shapes that the cover goes through in a stage."""
    return f"shapes/{snapshot_name(stage_order(cover), stage)}"


def joined(start: Solution | None, after: Solution) -> Solution:
    """Put the history of the stages before in front of a solution that went on from ``start``."""
    if start is None:
        return after
    history = {
        name: np.concatenate([start.history[name], column])
        for name, column in after.history.items()
    }
    spent = start.figures["cpu_seconds"]
    history["cpu_seconds"] = np.concatenate(
        [start.history["cpu_seconds"], spent + after.history["cpu_seconds"]]
    )
    figures = dict(after.figures)
    for name in _ADDED:
        figures[name] += start.figures[name]
    settings = after.settings
    if start.cover.scene_digest != after.cover.scene_digest:
        settings += ", begun with another scene"  # so that it never stands for solving this one
    return dataclasses.replace(
        after,
        history=MappingProxyType(history),
        figures=MappingProxyType(figures),
        settings=settings,
    )


def _begun(cover: Cover) -> list[Stage]:
    return sorted(cover.stages, key=lambda stage: stage.start)


def _snapshots(cover: Cover, folder: Path) -> Iterator[Solution]:
    """Stored states, the last stage first; absent ones are left out."""
    order = stage_order(cover)
    for stage in reversed(order):
        path = folder / snapshot_name(order, stage)
        if path.exists():
            yield io.read_result(path)


def _last_of(cover: Cover, folder: Path) -> Solution | None:
    """Return the last state that is of this very cover and solver."""
    for state in _snapshots(cover, folder):
        if state.settings == SETTINGS and _same(state.cover, cover):
            return state
    return None


def _before(stage: str, cover: Cover, folder: Path) -> Solution | None:
    """Return the state at the end of the stage before ``stage``; None before the first."""
    order = stage_order(cover)
    if stage not in order:
        raise InputError.single(
            "stage", got=repr(stage), expected=f"one of {order}", hint=did_you_mean(stage, order)
        )
    starts = {unit: min(s.start for s in cover.stages if s.unit == unit) for unit in order}
    before = [unit for unit in order if starts[unit] < starts[stage]]
    if not before:
        return None
    # Of what begins together only the last has steps of its own and so a snapshot.
    paths = {name: folder / snapshot_name(order, name) for name in before}
    stored = [name for name in before if paths[name].exists()]
    if not stored:
        raise InputError.single(
            "snapshot", got="no such file", expected=f"the end of stage {before[-1]!r}",
            file=paths[before[-1]], hint="it is written by solving in stages",
        )  # fmt: skip
    state: Solution = io.read_result(paths[stored[-1]])
    changed = list(_changes(state.cover, cover, before[: before.index(stored[-1]) + 1]))
    if changed:
        raise InputError.single(
            "snapshot", got=f"another {', '.join(changed)}",
            expected=f"one of the same cover up to the end of {stored[-1]!r}",
            file=paths[stored[-1]], hint="do an earlier stage again",
        )  # fmt: skip
    return state


def _changes(old: Cover, new: Cover, units: list[str]) -> Iterator[str]:
    """Name what counted in these groups and stages and is no longer the same."""
    for name in ("rest", "faces", "positions", "materials"):
        if not _same(getattr(old, name), getattr(new, name)):
            yield name
    stages = [stage.name for stage in _begun(old) if stage.unit in units]
    following = len(stages) + 1
    for a, b in zip_longest(_begun(old)[:following], _begun(new)[:following]):
        if not a or not b or not _same_stage(a, b, done=b.name in stages):
            yield f"stage {(b or a).name}"
    if not _same(_ties(old, stages), _ties(new, stages)):
        yield "seam, hook or frame of these stages"
    shapes = {t.name: len(t.length) for t in _every(old)}
    for tie in _every(new):
        if tie.stage not in stages and shapes.get(tie.name, len(tie.length)) != len(tie.length):
            yield f"number of points of {tie.name}"


def _same_stage(a: Stage, b: Stage, *, done: bool) -> bool:
    """Whether nothing of a stage has changed; of one still to come, when it begins."""
    if done:
        return a == b
    return (a.name, a.start, a.unit) == (b.name, b.start, b.unit)


def _ties(cover: Cover, stages: list[str]) -> tuple[Stitching | Anchor, ...]:
    return tuple(tie for tie in _every(cover) if tie.stage in stages)


def _every(cover: Cover) -> tuple[Stitching | Anchor, ...]:
    return (*cover.stitchings, *cover.anchors)


def _same(a: Any, b: Any) -> bool:
    """Whether two values are equal, arrays in them to the last bit."""
    if type(a) is not type(b):
        return False
    if isinstance(a, np.ndarray):
        return bool(np.array_equal(a, b))
    if dataclasses.is_dataclass(a):
        fields = [f.name for f in dataclasses.fields(a)]
        return all(_same(getattr(a, n), getattr(b, n)) for n in fields)
    if isinstance(a, tuple | list):
        return len(a) == len(b) and all(_same(x, y) for x, y in zip(a, b, strict=True))
    if isinstance(a, MappingProxyType | dict):
        return a.keys() == b.keys() and all(_same(a[k], b[k]) for k in a)
    return bool(a == b)
