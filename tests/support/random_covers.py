"""Covers of the family drawn at random: shape, size, material, tension and one sewing fault."""

from __future__ import annotations

import tempfile
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import seatlook
from seatlook.errors import SeatlookError
from seatlook.results.resolution import resolution
from seatlook.seats import SHAPES, write_demo

MATERIALS = ("leather-laminate", "suede-laminate", "black-leather", "bright-leather", "pvc",
             "suede", "woven")  # fmt: skip
FAULTS = ("none", "ease", "short")


@dataclass(frozen=True)
class Draw:
    """What is drawn of a cover; ``place`` in [0, 1) says which seam or panel has the fault."""

    shape: str
    scale: float
    bolster: float
    material: str
    insert: str
    tension: float
    kind: str
    size: float
    place: float
    element_mm: float


def drawn(seed: int, number: int, coarsest: float) -> Draw:
    """Return cover ``number`` of a seed."""
    rng = np.random.default_rng((seed, number))
    shape, material, insert, kind = (
        str(rng.choice(names)) for names in (tuple(SHAPES), MATERIALS, MATERIALS, FAULTS)
    )
    scale, bolster, tension, size, place = rng.uniform(
        (0.7, 0.01, 0.0, 0.01, 0.0), (1.3, 0.06, 0.02, 0.05, 1.0)
    )
    element = rng.uniform(0.6, 1.0) * coarsest
    return Draw(shape, scale, bolster, material, insert, tension, kind, size, place, element)


def written(folder: Path, draw: Draw, fault: dict[str, float]) -> Path:
    """Write the files of a cover."""
    spoiled = {draw.kind: fault} if fault else {}
    return write_demo(
        folder,
        shape=draw.shape,
        scale=draw.scale,
        bolster=draw.bolster,
        material=draw.material,
        insert=draw.insert,
        tension=draw.tension,
        element_size_mm=draw.element_mm,
        **spoiled,
    )


def named_fault(folder: Path, draw: Draw) -> dict[str, float]:
    """The seam or panel of the drawn fault, chosen among those of the pattern without it."""
    if draw.kind == "none":
        return {}
    pattern = seatlook.open(written(folder, draw, {})).scene.pattern
    names = sorted(
        part.name for part in (pattern.panels if draw.kind == "short" else pattern.seams)
    )
    return {names[int(draw.place * len(names))]: draw.size}


def measure(draw: Draw) -> dict[str, object]:
    """Write, solve and judge one cover."""
    with tempfile.TemporaryDirectory() as folder:
        fault = named_fault(Path(folder) / "plain", draw)
        row: dict[str, object] = {
            "fault": " ".join(f"{draw.kind} {k} {v:.1%}" for k, v in fault.items()) or "none"
        }
        try:
            seat = seatlook.open(written(Path(folder) / "cover", draw, fault))
            clock = time.process_time()
            solution = seat.solve()
        except SeatlookError as error:
            return row | {"status": "refused", "reason": str(error).splitlines()[0]}
        spent, judged = time.process_time() - clock, resolution(solution)
    return row | {
        "vertices": len(solution.positions),
        "solve_cpu_s": f"{spent:.1f}",
        "status": judged.status,
        "sharp_folds": len(judged.folds),
        "largest_fold_deg": f"{judged.largest_fold:.0f}",
        "reason": judged.reason,
    }
