"""Do the stated companions of zone means hold? Random covers against seeds on a mesh twice as fine.

Run it with: python gallery/zone_errors.py [--covers N] [--seed N] [--seeds N] [--minutes M]
             [--per-wave H]

Each cover is a seat of the family with a scale, a bolster and an ease drawn at random, in one of
four materials. "precision" states mesh error and scatter of each zone. The truth is the mean over
seeds of a mesh with half the element size. Rows that are in docs/charts/zone_errors.csv are not run
again, so a run that was stopped goes on; --minutes ends it after the cover at hand. At the end it
prints in how many zones (mean W2 above 0.02) the sum holds, and how large it is to the true error.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
import warnings
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

import seatlook
from seatlook.chain.precision import solve_to
from seatlook.errors import InputWarning
from seatlook.model.zones import FREE_EDGE
from seatlook.results.resolution import CURVATURE_ERROR
from seatlook.seats import SHAPES, write_demo
from support.kept_rows import KeptRows

COLUMNS = ("cover", "material", "shape", "zone", "element_size_mm", "w2_mean", "mesh_error",
           "scatter", "truth", "truth_scatter", "status", "cpu_s")  # fmt: skip
TABLE = KeptRows("zone_errors", COLUMNS)
MATERIALS = ("leather-laminate", "suede-laminate", "black-leather", "pvc")
LEAST = 0.02  # mean W2, below which a zone has no wrinkles to speak of


def drawn(seed: int, count: int) -> list[tuple[int, str, str, float, float]]:
    """Number, material, shape, scale, bolster height [m] of every cover."""
    rng = np.random.default_rng(seed)
    shapes = list(SHAPES)
    covers = [
        (k, shapes[int(rng.integers(len(shapes)))], float(rng.uniform(0.6, 0.8)),
         float(rng.uniform(0.0, 0.06)))
        for k in range(count)
    ]  # fmt: skip
    return [(k, material, *cover) for material in MATERIALS for k, *cover in covers]


def measure(
    cover: tuple[int, str, str, float, float], per_wave: float, seeds: int
) -> list[dict[str, object]]:
    """State the errors of one cover, then solve it on the finer mesh; a row per zone."""
    number, material, shape, scale, bolster = cover
    clock = time.process_time()
    with tempfile.TemporaryDirectory() as folder:
        path = write_demo(folder, shape=shape, scale=scale, bolster=bolster, material=material)
        scene = seatlook.open(path).scene
        stated = solve_to(scene, min(0.99, 2.0 * CURVATURE_ERROR / per_wave**2))
        size = 0.5 * stated.plan.element_size
        fine = [
            {row.zone: row["w2_mean"] for row in seat.assessment.zones}
            for seat in (seatlook.open(path, element_size=size, seed=100 + k) for k in range(seeds))
        ]
    spent = time.process_time() - clock
    rows = []
    for zone in stated.zones:
        truth = [one[zone.zone] for one in fine if zone.zone in one]
        if zone.zone == FREE_EDGE or len(truth) < 2:
            continue
        rows.append(dict(zip(COLUMNS, (
            number, material, shape, zone.zone, f"{1e3 * stated.plan.element_size:.2f}",
            f"{zone.w2_mean:.5f}", f"{zone.error:.5f}", f"{zone.scatter:.5f}",
            f"{np.mean(truth):.5f}", f"{np.std(truth, ddof=1) / np.sqrt(len(truth)):.5f}",
            stated.solution.status, f"{spent:.0f}",
        ), strict=True)))  # fmt: skip
    return rows


def summary(rows: list[dict[str, str]]) -> str:
    """How often the companions hold, and how large they are."""
    held, ratio = [], []
    for row in rows:
        mean, truth = float(row["w2_mean"]), float(row["truth"])
        if truth > LEAST:
            stated = float(row["mesh_error"]) + float(row["scatter"])
            held.append(abs(mean - truth) <= stated)
            ratio.append(stated / max(abs(mean - truth), 1e-12))
    if not held:
        return "no zone with wrinkles yet"
    return (
        f"{sum(held)} of {len(held)} zones hold ({100 * np.mean(held):.0f} %); "
        f"stated over true error: median {np.median(ratio):.1f}"
    )


def main() -> None:
    """Run what is missing, and sum up."""
    warnings.simplefilter("ignore", InputWarning)
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--covers", type=int, default=10)
    parser.add_argument("--seed", type=int, default=19)
    parser.add_argument("--seeds", type=int, default=4, help="of the finer mesh")
    parser.add_argument("--minutes", type=float, default=1e9)
    parser.add_argument("--per-wave", type=float, default=8.0, help="elements of the stated mesh")
    options = parser.parse_args()
    begin = time.monotonic()
    for cover in drawn(options.seed, options.covers):
        if any(
            (row["cover"], row["material"]) == (str(cover[0]), cover[1]) for row in TABLE.read()
        ):
            continue
        if time.monotonic() - begin > 60.0 * options.minutes:
            break
        rows = measure(cover, options.per_wave, options.seeds)
        TABLE.add(rows)
        print(cover, summary(TABLE.read()), flush=True)
    print(summary(TABLE.read()))


if __name__ == "__main__":
    main()
