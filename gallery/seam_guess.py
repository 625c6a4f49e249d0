"""How many seams are guessed right: own family of seats, and garments of another program.

Run it with: python gallery/seam_guess.py [FOLDER]

Flattens each shape of the family at five random sizes, takes all, half, all but one, and all of its
notches away, and compares the guess with the seams that the pattern was flattened with. FOLDER may
hold specification files of GarmentCode (``*.json``), which know their stitches. Leaves
docs/charts/seam_guess.csv and seam_guess.svg.
"""

from __future__ import annotations

import csv
import sys
import time
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import replace
from pathlib import Path

import matplotlib
import numpy as np

matplotlib.use("Agg")
from garments import read_garment
from matplotlib import pyplot as plt

from seatlook.assembly.seam_guess import propose_seams
from seatlook.assembly.seam_guess.kin import find_kin
from seatlook.assembly.seam_guess.outlines import Outlines
from seatlook.errors import SeatlookError
from seatlook.flattening import flatten
from seatlook.model import Panel, Pattern
from seatlook.seats import SHAPES, design_surface, shaped

CHARTS = Path(__file__).parents[1] / "docs" / "charts"
SIZES, SEED = 5, 17
ELEMENT_SIZE = 0.012
NOTCHES = {"all": 1.0, "half": 0.5, "one": -1.0, "none": 0.0}
COLUMNS = ("pattern", "notches", "panels", "seams", "right", "alike", "wrong", "doubtful", "cpu_s")

Stretch = tuple[str, int, int]


def family() -> Iterator[tuple[str, Pattern]]:
    """Flat patterns of all shapes at random sizes; those that are not flattened are named."""
    for row, name in enumerate(SHAPES):
        for k in range(SIZES):
            rng = np.random.default_rng((SEED, row, k))
            scale, bolster = rng.uniform(0.6, 1.6), rng.uniform(0.0, 0.1)
            try:
                surface = design_surface(shaped(name, scale, bolster), element_size=ELEMENT_SIZE)
                yield f"{name} {k}", flatten(surface).pattern
            except SeatlookError as error:
                print(f"{name} x {scale:.2f}, bolsters {1e3 * bolster:.0f} mm: {error}")


def with_notches(pattern: Pattern, share: float, seed: int) -> tuple[Panel, ...]:
    """Keep a share of the notches, drawn at random; of a negative share a single one."""
    rng = np.random.default_rng(seed)
    count = sum(len(panel.notches) for panel in pattern.panels)
    kept = rng.random(count) < share
    if share < 0 and count:
        kept[rng.integers(count)] = True
    rest = iter(kept)
    return tuple(
        replace(p, notches=tuple(n for n in p.notches if next(rest))) for p in pattern.panels
    )


def stretches(pattern: Pattern) -> set[frozenset[Stretch]]:
    """Seams as sets of stretches of outlines, whatever edges and seams are called."""
    ends = {e.name: (e.panel, e.start, e.end) for e in pattern.edges.values()}
    return {frozenset(ends[name] for name in (s.a, *s.b)) for s in pattern.seams}


def kinds(panels: Sequence[Panel], seams: set[frozenset[Stretch]]) -> list[frozenset[object]]:
    """Seams as sets of what symmetry leaves of their stretches."""
    outlines = Outlines(panels)
    kind = find_kin(outlines).kind
    number = {p.name: k for k, p in enumerate(outlines.panels)}

    def of(stretch: Stretch) -> object:
        panel, start, end = stretch
        inside = [a for a in outlines.whole(number[panel]) if outlines.place(a) == start]
        if not inside:
            return stretch
        atoms, stop = [], inside[0]
        while not atoms or (outlines.place(stop) != end and len(atoms) < len(outlines)):
            atoms.append(kind[stop])
            stop = outlines.ahead[stop]
        return frozenset(atoms)

    return [frozenset(of(s) for s in seam) for seam in seams]


def measure(name: str, notches: str, pattern: Pattern, panels: tuple[Panel, ...]) -> list[object]:
    """One row of the table."""
    start = time.process_time()
    proposal = propose_seams(panels)
    seconds = time.process_time() - start
    true, found = stretches(pattern), stretches(proposal.pattern)
    right = found & true
    # What only symmetry tells from a true seam counts as right, as often as there are true ones.
    open_ = kinds(panels, true - right)
    alike = 0
    for kind in kinds(panels, found - right):
        if kind in open_:
            open_.remove(kind)
            alike += 1
    wrong = len(found) - len(right) - alike
    counts = (len(panels), len(true), len(right), alike, wrong, len(proposal.doubtful))
    return [name, notches, *counts, round(seconds, 2)]


def chart(rows: Sequence[Sequence[object]]) -> None:
    """Shares of seams right and wrong, by shape and notches."""
    groups: dict[tuple[str, str], list[int]] = {}
    for name, notches, _, seams, right, alike, wrong, *_ in rows:
        key = (str(name).split()[0], str(notches))
        sums = groups.setdefault(key, [0, 0, 0])
        for k, value in enumerate((seams, int(str(right)) + int(str(alike)), wrong)):
            sums[k] += int(str(value))
    labels = [f"{shape}, {notches}" for shape, notches in groups]
    figure, axis = plt.subplots(figsize=(max(8.0, 0.48 * len(labels)), 3.6))
    x = np.arange(len(labels))
    axis.bar(x, [100 * r / n for n, r, _ in groups.values()], color="#005cab", label="right")
    axis.bar(x, [100 * w / n for n, _, w in groups.values()], color="#c85200", label="wrong")
    axis.set_xticks(x, labels, fontsize=7, rotation=90)
    axis.set_ylabel("of the true seams [%]")
    axis.set_ylim(0, 105)
    axis.legend(loc="upper right")
    figure.tight_layout()
    figure.savefig(CHARTS / "seam_guess.svg")


def is_garment(row: Sequence[object]) -> bool:
    """Whether a row is one of a garment."""
    return str(row[0]).startswith("garment ")


def main(folder: Path | None) -> None:
    """Measure, print, write the table and the chart."""
    warnings.simplefilter("ignore")
    rows: list[list[object]] = []
    for number, (name, pattern) in enumerate(family()):
        for label, share in NOTCHES.items():
            panels = with_notches(pattern, share, SEED + number)
            rows.append(measure(name, label, pattern, panels))
            print(*rows[-1])
    for path in sorted(folder.glob("*.json")) if folder else ():
        pattern = read_garment(path)
        rows.append(measure(f"garment {path.stem}", "none", pattern, pattern.panels))
        print(*rows[-1])
    for label in NOTCHES:
        for what in ("family", "garment"):
            garments = what == "garment"
            own = [
                r for r in rows if r[1] == label and str(r[0]).startswith("garment ") == garments
            ]
            seams, right, wrong = (sum(int(str(r[k])) for r in own) for k in (3, 4, 6))
            right += sum(int(str(r[5])) for r in own)
            if seams:
                given = max(right + wrong, 1)
                print(f"{what}, {label} notches: {len(own)} patterns, {seams} seams, "
                      f"{right / seams:.1%} right, {wrong / seams:.1%} wrong "
                      f"({wrong / given:.1%} of those given)")  # fmt: skip
    own = [r for r in rows if not is_garment(r)]
    with (CHARTS / "seam_guess.csv").open("w", newline="") as file:
        csv.writer(file).writerows([COLUMNS, *own])
    chart(own)


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else None)
