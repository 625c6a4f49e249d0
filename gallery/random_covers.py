"""Covers drawn at random: how many come to rest, how many are resolved, and why the others are not.

Run it with: python gallery/random_covers.py [--count N] [--seed N] [--first K] [--coarsest MM]

Shape, size, material, tension, element size and one sewing fault of each cover follow from the seed
and its number, whatever else is run. Rows of docs/charts/random_covers.csv are kept, not run again;
delete one to repeat it. The counts of all rows are printed at the end.
"""

from __future__ import annotations

import argparse
import sys
import warnings
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

from seatlook.errors import InputWarning
from seatlook.results.resolution import SHARPEST
from support.kept_rows import KeptRows
from support.random_covers import drawn, measure

COLUMNS = ("seed", "number", "shape", "scale", "bolster_mm", "material", "insert",
           "tension_percent", "fault", "element_size_mm", "vertices", "solve_cpu_s", "status",
           "sharp_folds", "largest_fold_deg", "reason")  # fmt: skip
TABLE = KeptRows("random_covers", COLUMNS)


def counted() -> str:
    """Return how many of all rows ended how."""
    done = TABLE.read()
    statuses = [row["status"] for row in done]
    parts = [f"{statuses.count(status)} {status}" for status in dict.fromkeys(statuses)]
    sharp = sum(row["status"] == "resolved" and row["sharp_folds"] != "0" for row in done)
    return (
        f"{len(done)} covers: {', '.join(parts)}; "
        f"{sharp} resolved with a fold over {SHARPEST:g} degrees"
    )


def main() -> None:
    """Run the covers that are missing."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=66)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--seed", type=int, default=2026)
    parser.add_argument("--coarsest", type=float, default=14.0, help="largest element size [mm]")
    chosen = parser.parse_args()
    warnings.simplefilter("ignore", InputWarning)  # steep bolsters strain, and faults are meant
    done = {(int(row["seed"]), int(row["number"])) for row in TABLE.read()}
    for number in range(chosen.first, chosen.first + chosen.count):
        if (chosen.seed, number) in done:
            continue
        draw = drawn(chosen.seed, number, chosen.coarsest)
        head = {
            "seed": chosen.seed, "number": number, "shape": draw.shape,
            "scale": f"{draw.scale:.2f}", "bolster_mm": f"{1e3 * draw.bolster:.0f}",
            "material": draw.material, "insert": draw.insert,
            "tension_percent": f"{1e2 * draw.tension:.1f}",
            "element_size_mm": f"{draw.element_mm:.1f}",
        }  # fmt: skip
        row = head | measure(draw)
        TABLE.add([row])
        print(*row.values(), flush=True)
    print(counted())


if __name__ == "__main__":
    main()
