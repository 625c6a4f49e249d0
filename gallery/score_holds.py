"""Whether a score is the same however it is taken: sizes, qualities, seeds, distances, null, pairs.

Run it with: python gallery/score_holds.py [FOLDER] [--only PART]

Solves the demo as it fits, and with one seam 4 % too long, and scores three textures under three
rigs again and again. Solutions in FOLDER are taken again. Leaves docs/charts/score_holds.csv; rows
that are there are not run again. Says at the end what changed by how much, against the bars.
"""

from __future__ import annotations

import argparse
import itertools
import sys
import warnings
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

import seatlook
from seatlook.chain.case import Case
from seatlook.errors import InputWarning
from seatlook.model import Camera
from seatlook.seats import write_demo
from seatlook.visibility.cross_check import Measures, more_visible
from seatlook.visibility.view import Sampling, View
from support.kept_rows import KeptRows

ZONE = "INSERT interior"
EASE = {"INSERT-BOLSTER_L": 0.04}
SIZES, SEEDS, DISTANCES = (320, 640, 1920), (1, 2, 3, 4), (1.0, 2.0, 4.0)
MESH, COARSE = 7.0, 10.0  # mm
MEASURES = ("vwi", "log_ratio", "dissimilarity")
COLUMNS = ("part", "variant", "texture", "rig", *MEASURES, "apparent_contrast_percent",
           "zone_vwi", "zone_contrast_percent")  # fmt: skip
TABLE = KeptRows("score_holds", COLUMNS)
Row = dict[str, str]
Cell = tuple[str, str]


def solved(folder: Path, *, eased: bool, mesh: float = MESH, seed: int = 0) -> Case:
    """Write and solve a demo, or take the result that is there."""
    kind = "eased" if eased else "good"
    home = folder / (kind if mesh == MESH else f"{kind}-{mesh:g}")
    if not (home / "scene.toml").exists():
        write_demo(home, ease=EASE if eased else {}, element_size_mm=mesh)
    seat = Case(replace(seatlook.open(home / "scene.toml").scene, seed=seed))
    seat.solve(home / f"result-{seed}.npz", resume=True)
    return seat


def sized(camera: Camera, width: int) -> Camera:
    """The same camera in a picture of another width."""
    width_now, height = camera.size
    return replace(camera, size=(width, round(width * height / width_now)))


def stepped(camera: Camera, distance: float) -> Camera:
    """The same camera from another distance [m], its picture as wide on the seat."""
    way = camera.position - camera.target
    now = float(np.linalg.norm(way))
    half = np.tan(np.radians(camera.vertical_fov_deg) / 2) * now / distance
    return replace(
        camera,
        position=camera.target + way * distance / now,
        vertical_fov_deg=float(2 * np.degrees(np.arctan(half))),
    )


def views(part: str, folder: Path) -> Iterator[tuple[str, Case, View]]:
    """Variants of a part of the table."""
    seat = solved(folder, eased=part != "good")
    camera, solution = seat.camera(None), seat.solution
    if part in ("good", "eased"):
        yield "as it is", seat, View(solution, camera)
    elif part == "size":
        for width in SIZES:
            yield f"{width} wide", seat, View(solution, sized(camera, width))
    elif part == "quality":
        yield "high", seat, View(solution, camera, sampling=Sampling("high"))
    elif part == "seed":
        for seed in SEEDS:
            other = solved(folder, eased=True, seed=seed)
            yield f"seed {seed}", other, View(other.solution, camera)
    elif part == "distance":
        for distance in DISTANCES:
            yield f"{distance:g} m", seat, View(solution, stepped(camera, distance))
    else:
        for mesh in (MESH, COARSE):
            good = solved(folder, eased=False, mesh=mesh)
            size = 1e3 * good.cover.element_size
            yield f"{size:.2g} mm", good, View(good.solution, camera).without_wrinkles()


PARTS = ("good", "eased", "size", "quality", "seed", "distance", "null")


def rows(part: str, variant: str, seat: Case, view: View) -> Iterator[Row]:
    """Score nine cells."""
    for rig in seat.scene.rigs:
        for texture, looks in seat.scene.textures.items():
            sight = view.sight(looks, rig)
            cheap = (getattr(sight.measures, name) for name in MEASURES)
            zone = sight.zones.get(ZONE, np.nan), sight.contrasts.get(ZONE, np.nan)
            figures = (*cheap, sight.score.apparent_contrast, *zone)
            cells = (part, variant, texture, rig.name, *(f"{x:.5g}" for x in figures))
            yield dict(zip(COLUMNS, cells, strict=True))


def report() -> None:
    """Print one line for each row of the bars."""
    grids: dict[Cell, dict[Cell, Row]] = {}
    for row in TABLE.read():
        grids.setdefault((row["part"], row["variant"]), {})[row["texture"], row["rig"]] = row
    base = grids["eased", "as it is"]
    print("| part | variant | VWI of it | zone VWI | zone contrast |")
    for (part, variant), cells in grids.items():
        if part == "null":
            largest = max(float(row["vwi"]) for row in cells.values())
            print(f"| null | {variant} | largest {largest:.3g} | | |")
            continue
        names = ("vwi", "zone_vwi", "zone_contrast_percent")
        spans = (span(cells, base, name) for name in names)
        print(f"| {part} | {variant} | " + " | ".join(spans) + " |")
    turned(grids, base)


def span(cells: dict[Cell, Row], base: dict[Cell, Row], name: str) -> str:
    """Least and greatest ratio to the eased demo as it is, over the cells."""
    pairs = [(float(cells[cell][name]), float(base[cell][name])) for cell in base]
    ratios = [a / b for a, b in pairs if b > 0]
    return f"{min(ratios):.3f} to {max(ratios):.3f}" if ratios else "none seen"


def turned(grids: dict[Cell, dict[Cell, Row]], base: dict[Cell, Row]) -> None:
    """Say which pairs of textures are separable, and which are told otherwise anywhere."""
    textures = list(dict.fromkeys(texture for texture, _ in base))
    for rig in dict.fromkeys(rig for _, rig in base):
        for first, second in itertools.combinations(textures, 2):
            told = {
                key: more_visible(measures(cells[first, rig]), measures(cells[second, rig]))
                for key, cells in grids.items()
                if key[0] not in ("null", "good")
            }
            words = {word: list(told.values()).count(word) for word in dict.fromkeys(told.values())}
            turn = " TURNED" if {"first", "second"} <= set(words) else ""
            print(f"{rig}: {first} against {second}: {words}{turn}")


def measures(row: Row) -> Measures:
    """Measures of a cell of the table."""
    return Measures(**{name: float(row[name]) for name in MEASURES})


def main() -> None:
    """Run what is missing."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", nargs="?", type=Path, default=Path("out/score_holds"))
    parser.add_argument("--only", choices=PARTS)
    chosen = parser.parse_args()
    warnings.simplefilter("ignore", InputWarning)  # steep bolsters strain; see the strain maps
    for part in PARTS if chosen.only is None else (chosen.only,):
        for variant, seat, view in views(part, chosen.folder):
            if any((r["part"], r["variant"]) == (part, variant) for r in TABLE.read()):
                continue
            TABLE.add(list(rows(part, variant, seat, view)))
    if chosen.only is None:
        report()


if __name__ == "__main__":
    main()
