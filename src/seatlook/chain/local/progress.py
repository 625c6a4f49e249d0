"""Progress of several meshes, shown as that of one work."""

from __future__ import annotations

from collections.abc import Iterator

from seatlook.model.progress import Progress

BEFORE = 0.35  # of the work is done on the meshes before, as an estimate


def part(progress: Progress, begin: float, end: float) -> Progress:
    """Progress that counts as a part of all the work."""

    def show(name: str, /, **figures: float | str) -> None:
        step, steps = figures.get("step"), figures.get("steps")
        if isinstance(step, float | int) and isinstance(steps, float | int):
            figures |= {"step": 100.0 * (begin + (end - begin) * step / steps), "steps": 100.0}
        progress(name, **figures)

    return show


def parts(progress: Progress, meshes: int) -> Iterator[Progress]:
    """Progress of each mesh after the coarser ones: half of what is left, as more may follow."""
    begin = BEFORE
    for left in reversed(range(meshes)):
        end = 0.5 * (begin + 1.0) if left else 1.0
        yield part(progress, begin, end)
        begin = end
