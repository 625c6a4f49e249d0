"""Good patterns with one to three edges displaced: what the correction loop gives back.

Run it with: python gallery/improve_trials.py [FOLDER] [--shape SHAPE] [--trials COUNT] [--report]

Six shapes at 0.6 of their size, laminate, 12 mm elements. Each good pattern is solved with four
seeds: the scatter of W2, strain and gap, no less than 1 % of all that is wrong with it. A trial
moves one to three sewn edges in or out by up to 3 mm, unseen by the loop, which starts from that
pattern. A trial counts where some part leaves the scatter by 3 standard deviations; it is back if
none does so after the correction, solved cold. Rows are kept in docs/charts/improve_trials.csv and
not run again. The report is printed at the end.
"""

from __future__ import annotations

import argparse
import sys
import time
import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

from seatlook import io
from seatlook.assembly import assemble
from seatlook.chain.assess import Assessment, assess
from seatlook.errors import InputWarning, SeatlookError
from seatlook.improvement.candidate import Candidate, candidates_of
from seatlook.improvement.changes import Changes
from seatlook.improvement.loop import improve
from seatlook.improvement.objective import Goal, Parts, objective_of
from seatlook.model import Scene
from seatlook.seats.files import write_demo
from seatlook.solver import solve
from support.kept_rows import KeptRows

SHAPES = ("cushion", "horseshoe", "backrest", "headrest", "box", "saddle")
SCALE, SIZE, SEEDS, FAR, LEAST = 0.6, 12.0, 4, 3e-3, 0.01
NAMES = ("w2", "strain", "gap")
PARTS = tuple(f"{name}_{when}" for when in ("good", "sd", "spoiled", "corrected") for name in NAMES)
COLUMNS = ("shape", "trial", "displaced", *PARTS, "counts", "back", "moved", "corrections",
           "loop_solves", "loop_cpu_seconds", "solve_cpu_seconds", "ended")  # fmt: skip
TABLE = KeptRows("improve_trials", COLUMNS)
Row = dict[str, str]


def cold(scene: Scene, seed: int = 0) -> Assessment:
    """Solve a scene on a mesh of its own."""
    return assess(solve(assemble(scene, seed=seed)))


def parts(scene: Scene, assessment: Assessment) -> np.ndarray:
    """W2, strain and gap beyond their goals, kinks sharp."""
    found: Parts = objective_of(scene, assessment, Goal()).literal().of(assessment.solution)
    return np.array([found.w2, found.strain, found.gap])


class Shape:
    """A good seat, and how much its parts scatter."""

    def __init__(self, name: str, folder: Path) -> None:
        self.name = name
        file = folder / name / "scene.toml"
        if not file.exists():
            write_demo(folder / name, shape=name, scale=SCALE, element_size_mm=SIZE)
        self.scene = io.load_scene(file)
        seeds = [cold(self.scene, seed) for seed in range(SEEDS)]
        values = np.array([parts(self.scene, one) for one in seeds])
        self.mean, self.scatter = values.mean(axis=0), values.std(axis=0, ddof=1)
        self.scatter = np.maximum(self.scatter, LEAST * self.mean.sum())
        self.changes = Changes(seeds[0].solution, self.scene.pattern)
        every = candidates_of(seeds[0].solution.cover, self.changes.outlines)
        sewn = {edge for seam in self.scene.pattern.seams for edge in (seam.a, *seam.b)}
        edges: dict[str, list[Candidate]] = {}
        for one in every:
            if one.kind == "offset" and one.name in sewn:
                edges.setdefault(one.name, []).append(one)
        self.edges = edges

    def off(self, values: np.ndarray) -> bool:
        """Whether some part is worse than the good seats by 3 standard deviations."""
        return bool((values > self.mean + 3.0 * self.scatter).any())

    def spoiled(self, trial: int) -> tuple[dict[str, float], dict[Candidate, float]]:
        """Edges displaced, their amounts [m], and the same for every stretch."""
        rng = np.random.default_rng([trial, SHAPES.index(self.name)])
        names = rng.choice(sorted(self.edges), int(rng.integers(1, 4)), replace=False)
        displaced = {str(n): float(rng.uniform(-FAR, FAR)) for n in names}
        return displaced, {c: v for n, v in displaced.items() for c in self.edges[n]}


def run(shape: Shape, trial: int) -> Row:
    """Spoil, count, correct and solve cold."""
    displaced, amounts = shape.spoiled(trial)
    scene = replace(shape.scene, pattern=shape.changes.pattern(amounts))
    words = "; ".join(f"{n} {1e3 * v:+.2f}" for n, v in displaced.items())
    row = dict.fromkeys(COLUMNS, "") | {"shape": shape.name, "trial": str(trial)}
    row |= {"displaced": words} | _cells("good", shape.mean) | _cells("sd", shape.scatter)
    try:
        start = cold(scene)
        before = parts(scene, start)
        row |= _cells("spoiled", before) | {
            "counts": str(int(shape.off(before))),
            "solve_cpu_seconds": f"{start.solution.figures['cpu_seconds']:.2f}",
        }
        if shape.off(before):
            row |= _corrected(shape, scene, start)
    except SeatlookError as error:
        row["ended"] = str(error).splitlines()[0]
    return row


def _corrected(shape: Shape, scene: Scene, start: Assessment) -> Row:
    clock = time.process_time()
    *_, last = improve(scene, start)
    seconds = time.process_time() - clock
    changes = Changes(start.solution, scene.pattern)
    after = changes.scene(scene, last.made)
    values = parts(after, cold(after))
    moved = sum(abs(v) > 3e-4 for v in last.made.values())
    return _cells("corrected", values) | {
        "back": str(int(not shape.off(values))),
        "moved": str(moved),
        "corrections": "; ".join(f"{' + '.join(move.names)} {move.kind}" for move in last.chosen),
        "loop_solves": str(last.solves),
        "loop_cpu_seconds": f"{seconds:.1f}",
        "ended": last.ended,
    }


def _cells(when: str, values: np.ndarray) -> Row:
    return {f"{n}_{when}": f"{v:.6f}" for n, v in zip(NAMES, values, strict=True)}


def report() -> None:
    """Print, for each shape, how many trials count, and what became of them."""
    rows = TABLE.read()
    print("| shape | trials | count | back | objective gone | loop solves | CPU s |")
    for shape in (*SHAPES, "all"):
        own = [r for r in rows if shape in ("all", r["shape"])]
        counted = [r for r in own if r["counts"] == "1"]
        done = [r for r in counted if r["back"]]
        back = sum(r["back"] == "1" for r in done)
        print(f"| {shape} | {len(own)} | {len(counted)} | {back} of {len(counted)} "
              f"| {_median(done, _gone):.0f} % | {_median(done, 'loop_solves'):.0f} "
              f"| {_median(done, 'loop_cpu_seconds'):.0f} |")  # fmt: skip


def _gone(row: Row) -> float:
    """Share of what the displacement made worse that is gone again [%]."""
    sums = {w: sum(float(row[f"{n}_{w}"]) for n in NAMES) for w in ("good", "spoiled", "corrected")}
    worse = sums["spoiled"] - sums["good"]
    return 100.0 * (sums["spoiled"] - sums["corrected"]) / worse if worse > 0.0 else np.nan


def _median(rows: list[Row], what: object) -> float:
    values = [what(r) if callable(what) else float(r[str(what)]) for r in rows]
    return float(np.nanmedian(values)) if values else np.nan


def main() -> None:
    """Run what is missing, trial by trial over all shapes."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", nargs="?", type=Path, default=Path("out/improve_trials"))
    parser.add_argument("--shape", choices=SHAPES)
    parser.add_argument("--trials", type=int, default=10)
    parser.add_argument("--report", action="store_true")
    chosen = parser.parse_args()
    warnings.simplefilter("ignore", InputWarning)
    for name in () if chosen.report else (chosen.shape,) if chosen.shape else SHAPES:
        done = {int(r["trial"]) for r in TABLE.read() if r["shape"] == name}
        left = [trial for trial in range(chosen.trials) if trial not in done]
        shape = Shape(name, chosen.folder) if left else None
        for trial in left if shape else ():
            TABLE.add([run(shape, trial)])
    report()


if __name__ == "__main__":
    main()
