"""Do the stated companions of zone means hold? Random covers against seeds on a mesh twice as fine.

Run it with: python gallery/zone_errors.py [--covers N] [--seeds N] [--minutes M]

Each cover is a seat of the family with scale, bolster, tension and one sewing fault drawn at
random, in each of four materials. It is solved to a tolerance, with the scatter of seeds on its
first mesh. The truth is the mean over seeds of meshes of one size, half of the finest that the
tolerance asks for. Rows of docs/charts/zone_errors.csv are not run again, so a run that was stopped
goes on; --minutes ends it after the cover at hand. A row holds what every mesh found in a zone.
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
from seatlook.assembly import with_mesh
from seatlook.chain.companions import SEEDS
from seatlook.chain.local import coarser, finest_size, solve_scene
from seatlook.errors import InputWarning
from seatlook.model import Solution
from seatlook.model.zones import FREE_EDGE
from seatlook.results.needed_sizes import zone_sizes
from seatlook.seats import family
from support.kept_rows import KeptRows
from support.random_covers import FAULTS, Draw, named_fault, written

COLUMNS = ("cover", "material", "shape", "scale", "fault", "tolerance_percent", "zone", "area_cm2",
           "size_mm", "size_before_mm", "estimate", "mean", "mean_before", "seeds", "error",
           "truth", "truth_size_mm", "status", "cpu_s")  # fmt: skip
TABLE = KeptRows("zone_errors", COLUMNS)
MATERIALS = ("black-leather", "leather-laminate", "pvc", "suede-laminate")
LEAST = 0.02  # mean W2, below which a zone has no wrinkles to speak of
TOLERANCE = 0.2  # of the solves; a laminate's meshes are finer, as seats have no larger elements
SEED = 19
SMALL = 0.55, 0.5  # times scale and bolster of a headrest, which make the other shapes as large
family.SCALES = (0.3, 1.6)  # smaller than the family goes: else a finer mesh takes too long


def drawn(number: int, material: str) -> Draw:
    """Return cover ``number`` in a material."""
    rng = np.random.default_rng((SEED, number))
    scale, bolster, tension, size, place = rng.uniform(
        (0.6, 0.01, 0.003, 0.02, 0.0), (0.7, 0.04, 0.012, 0.05, 1.0)
    )
    shapes = ("headrest", "saddle", "box", "cushion", "backrest", "horseshoe")
    assert set(shapes) == set(family.SHAPES)
    shape = shapes[number % len(shapes)]
    if shape != shapes[0]:
        scale, bolster = SMALL[0] * scale, SMALL[1] * bolster
    kind = FAULTS[int(rng.integers(len(FAULTS)))]
    return Draw(shape, scale, bolster, material, material, tension, kind, size, place, 10.0)


def measure(number: int, material: str, seeds: int) -> list[dict[str, object]]:
    """Solve a cover to the tolerance, on its coarser meshes, and finer; a row per zone."""
    clock = time.process_time()
    draw = drawn(number, material)
    with tempfile.TemporaryDirectory() as folder:
        fault = named_fault(Path(folder) / "plain", draw)
        path = written(Path(folder) / "cover", draw, fault)
        scene = seatlook.open(path, tolerance=TOLERANCE).scene
    stated = solve_scene(scene)
    own = seatlook.assess(stated)
    before = coarser(scene)
    first = before
    while first.tolerance is not None:
        first = coarser(first)
    ladder = [solve_scene(before)] if before.tolerance is not None else []
    others = [solve_scene(with_mesh(first, seed=scene.seed + k)) for k in range(SEEDS)]
    ladder += others[:1]
    size = 0.5 * finest_size(scene)
    plain = with_mesh(scene, element_size=size)
    fine = [means(solve_scene(with_mesh(plain, seed=100 + k))) for k in range(seeds)]
    spent = time.process_time() - clock
    coarse = [means(other) for other in others]
    sizes, estimates = zone_sizes(stated.cover, own.values("w2"))
    sizes_before, _ = zone_sizes(ladder[0].cover, seatlook.assess(ladder[0]).values("w2"))
    means_before = means(ladder[0])
    head = (number, material, draw.shape, f"{draw.scale:.3f}",
            " ".join(f"{draw.kind} {k} {v:.1%}" for k, v in fault.items()) or "none",
            f"{100 * TOLERANCE:g}")  # fmt: skip
    rows = []
    for row in own.zones:
        zone = row.zone
        if zone == FREE_EDGE or not all(zone in one for one in (means_before, *coarse, *fine)):
            continue
        rows.append(dict(zip(COLUMNS, (
            *head, zone, f"{1e4 * row.area:.1f}", f"{1e3 * sizes[zone]:.3f}",
            f"{1e3 * sizes_before[zone]:.3f}", f"{estimates[zone]:.4f}", f"{row['w2_mean']:.5f}",
            f"{means_before[zone]:.5f}", " ".join(f"{one[zone]:.5f}" for one in coarse),
            f"{row.w2_mesh_error:.5f}", " ".join(f"{one[zone]:.5f}" for one in fine),
            f"{1e3 * size:.2f}", own.resolution.status, f"{spent:.0f}",
        ), strict=True)))  # fmt: skip
    return rows


def means(solution: Solution) -> dict[str, float]:
    """Mean W2 of every zone."""
    return {row.zone: row["w2_mean"] for row in seatlook.assess(solution).zones}


def main() -> None:
    """Run what is missing."""
    warnings.simplefilter("ignore", InputWarning)
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--covers", type=int, default=10)
    parser.add_argument("--seeds", type=int, default=2, help="of the finer mesh")
    parser.add_argument("--minutes", type=float, default=1e9)
    options = parser.parse_args()
    begin = time.monotonic()
    for number in range(options.covers):
        for material in MATERIALS:
            done = {(row["cover"], row["material"]) for row in TABLE.read()}
            if (str(number), material) in done:
                continue
            if time.monotonic() - begin > 60.0 * options.minutes:
                return
            rows = measure(number, material, options.seeds)
            TABLE.add(rows)
            print(number, material, f"{rows[0]['cpu_s']} CPU s", flush=True)


if __name__ == "__main__":
    main()
