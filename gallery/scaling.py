"""Time, memory and result of the demo cover from 2.5k to 40k vertices; rows are kept beside.

Run it with: python gallery/scaling.py [ELEMENT_SIZE_MM ...]

Each size runs in a process of its own; run it once before with a coarse mesh, so that the kernels
are compiled. Rows that are in docs/charts/scaling.csv are not run again; delete a row to repeat it.
"""

from __future__ import annotations

import csv
import resource
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

from seatlook import assemble, assess, load_scene, solve
from seatlook.cli._demo import write_demo

TABLE = Path(__file__).parents[1] / "docs" / "charts" / "scaling.csv"
SIZES = (20.0, 14.0, 10.0, 7.0, 5.0)  # mm: 1.4k, 2.7k, 5k, 10k and 19k vertices; 3.5 makes 40k
SEEDS = 3  # of the sizes up to 5k vertices
COLUMNS = ("element_size_mm", "seed", "vertices", "cpu_seconds", "iterations", "w2_mean", "mib",
           "status")  # fmt: skip


def measure(scene_file: Path, size: float, seed: int) -> dict[str, float | str]:
    """Mesh and solve; the clock runs over both."""
    scene = load_scene(scene_file)
    clock = time.process_time()
    cover = assemble(scene, element_size=1e-3 * size, seed=seed)
    solution = solve(cover)
    spent = time.process_time() - clock
    rows = assess(solution).zones
    area = np.array([row.area for row in rows])
    w2 = float(np.array([row["w2_mean"] for row in rows]) @ area / area.sum())
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    values = (size, seed, len(cover.rest), f"{spent:.2f}", int(solution.figures["iterations"]),
              f"{w2:.5f}", round(memory), solution.status)  # fmt: skip
    return dict(zip(COLUMNS, values, strict=True))


def rows() -> list[dict[str, str]]:
    """Return the finished rows."""
    if not TABLE.exists():
        return []
    with TABLE.open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


def main(sizes: tuple[float, ...]) -> None:
    """Run the sizes that are missing and print the exponent of time against vertices."""
    done = {(float(row["element_size_mm"]), int(row["seed"])) for row in rows()}
    wanted = [(size, seed) for size in sizes for seed in range(SEEDS if size > 12.0 else 1)]
    with tempfile.TemporaryDirectory() as folder:
        scene = Path(folder) / "scene.toml"
        missing = [case for case in wanted if case not in done]
        if missing:
            write_demo(Path(folder), ease={}, short={}, material="leather-laminate",
                       insert="leather-laminate", element_size_mm=7.0, seed=0)  # fmt: skip
        for size, seed in missing:
            command = [sys.executable, __file__, "--one", str(scene), str(size), str(seed)]
            print(subprocess.run(command, check=True, capture_output=True, text=True).stdout)
    table = [row for row in rows() if int(row["vertices"]) > 2500]
    n = np.log([float(row["vertices"]) for row in table])
    t = np.log([float(row["cpu_seconds"]) for row in table])
    if len(table) > 1:
        print(
            f"From 2.5k vertices, CPU seconds grow as vertices to the {np.polyfit(n, t, 1)[0]:.2f}"
        )


def keep(row: dict[str, float | str]) -> None:
    """Append a row to the table."""
    fresh = not TABLE.exists()
    TABLE.parent.mkdir(exist_ok=True)
    with TABLE.open("a", newline="", encoding="utf-8") as file:
        table = csv.DictWriter(file, COLUMNS)
        if fresh:
            table.writeheader()
        table.writerow(row)


if __name__ == "__main__":
    if sys.argv[1:2] == ["--one"]:
        found = measure(Path(sys.argv[2]), float(sys.argv[3]), int(sys.argv[4]))
        keep(found)
        print(*found.values())
    else:
        main(tuple(map(float, sys.argv[1:])) or SIZES)
