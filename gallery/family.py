"""The family of seats at sizes drawn at random: what converges, where the cover is, a picture each.

Run it with: python gallery/family.py [--sizes N] [--seed N] [--element-size-mm H] [--only SHAPE]

Nothing is edited by hand: each seat is written, checked and solved as "seatlook demo --shape" does.
Rows that are in docs/charts/family.csv are not run again; delete a row to repeat it. The pictures
of one seed are put together at the end, shapes in rows.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
import time
import warnings
from dataclasses import replace
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

import seatlook
from seatlook.errors import InputError, InputWarning, SeatlookError
from seatlook.seats import SHAPES, write_demo
from support.kept_rows import KeptRows

DOCS = Path(__file__).parents[1] / "docs"
SHEET = DOCS / "pictures" / "family.jpg"
COLUMNS = ("shape", "seed", "number", "scale", "bolster_mm", "element_size_mm", "vertices",
           "write_cpu_s", "solve_cpu_s", "check", "status", "buried_10mm_percent",
           "buried_20mm_percent", "bare_percent", "seam_gap_mm", "gap_p95_mm",
           "crossing_pairs", "reason")  # fmt: skip
TABLE = KeptRows("family", COLUMNS)
TILE = (400, 300)


def drawn(seed: int, count: int) -> list[tuple[str, int, float, float]]:
    """Shape, number, scale and bolster height [m] of all seats."""
    rng = np.random.default_rng(seed)
    return [
        (shape, number, float(scale), float(bolster))
        for shape in SHAPES
        for number, (scale, bolster) in enumerate(rng.uniform((0.6, 0.0), (1.6, 0.1), (count, 2)))
    ]


def measure(
    folder: Path, shape: str, scale: float, bolster: float, size: float
) -> tuple[dict[str, object], Image.Image]:
    """Write, check and solve one seat, and draw it."""
    clock = time.process_time()
    scene = write_demo(folder, shape=shape, scale=scale, bolster=bolster, element_size_mm=size)
    written = time.process_time()
    seat = seatlook.open(scene)
    try:
        seat.check()
        check = "nothing wrong"
    except InputError as error:
        check = str(error)
    clock, written = written - clock, time.process_time()
    solution = seat.solve()
    row = {
        "vertices": len(seat.cover.rest),
        "write_cpu_s": f"{clock:.1f}",
        "solve_cpu_s": f"{time.process_time() - written:.1f}",
        "check": check,
        "status": solution.status,
        "reason": solution.reason,
        **figures(solution.figures),
    }
    scene_view = replace(seat.scene.cameras[0], size=TILE)
    picture = seat.render(camera=scene_view, texture="bright-leather").to_srgb()
    return row, Image.fromarray(picture)


def figures(values: dict[str, float]) -> dict[str, str]:
    """Where the cover is, in percent of its area and in mm."""
    return {
        "buried_10mm_percent": f"{100 * values['buried_10mm']:.2f}",
        "buried_20mm_percent": f"{100 * values['buried_20mm']:.2f}",
        "bare_percent": f"{100 * values['bare_foam']:.2f}",
        "seam_gap_mm": f"{1e3 * values['seam_gap_max']:.3f}",
        "gap_p95_mm": f"{1e3 * values['gap_p95']:.1f}",
        "crossing_pairs": f"{values['intersecting_pairs']:.0f}",
    }


def sheet(pictures: Path, seats: list[tuple[str, int, float, float]]) -> None:
    """Put the pictures of one seed together, a shape in each row."""
    count = 1 + max(number for _, number, _, _ in seats)
    shapes = list(dict.fromkeys(shape for shape, *_ in seats))
    whole = Image.new("RGB", (TILE[0] * count, TILE[1] * len(shapes)), "white")
    for shape, number, scale, bolster in seats:
        file = pictures / f"{shape}-{number}.png"
        if file.exists():
            tile = Image.open(file)
            ImageDraw.Draw(tile).text((8, 6), f"{shape} x {scale:.2f}, {1e3 * bolster:.0f} mm")
            whole.paste(tile, (TILE[0] * number, TILE[1] * shapes.index(shape)))
    whole.save(SHEET, quality=85, optimize=True)


def main() -> None:
    """Run the seats that are missing."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sizes", type=int, default=5)
    parser.add_argument("--seed", type=int, default=17)
    parser.add_argument("--element-size-mm", type=float, default=7.0)
    parser.add_argument("--only", choices=tuple(SHAPES))
    parser.add_argument("--pictures", type=Path, default=Path("out/family"))
    chosen = parser.parse_args()
    chosen.pictures.mkdir(parents=True, exist_ok=True)
    warnings.simplefilter("ignore", InputWarning)  # steep bolsters strain; see the strain maps
    done = {
        (row["shape"], int(row["seed"]), int(row["number"]), float(row["element_size_mm"]))
        for row in TABLE.read()
    }
    seats = drawn(chosen.seed, chosen.sizes)
    for shape, number, scale, bolster in seats:
        key = (shape, chosen.seed, number, chosen.element_size_mm)
        if key in done or chosen.only not in (None, shape):
            continue
        head = dict(zip(("shape", "seed", "number", "element_size_mm"), key, strict=True))
        head |= {"scale": f"{scale:.3f}", "bolster_mm": f"{1e3 * bolster:.1f}"}
        with tempfile.TemporaryDirectory() as folder:
            try:
                row, picture = measure(Path(folder), shape, scale, bolster, chosen.element_size_mm)
                picture.save(chosen.pictures / f"{shape}-{number}.png")
            except SeatlookError as error:
                row = {"status": "refused", "reason": str(error)}
        TABLE.add([{**head, **row}])
        print(*head.values(), *row.values(), flush=True)
    sheet(chosen.pictures, seats)


if __name__ == "__main__":
    main()
