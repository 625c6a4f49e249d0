"""How visible a seam that is 3 % too long is on every shape of the family, against a good twin.

Run it with: python gallery/visible_faults.py [FOLDER] [--only SHAPE]

Solves each shape in black leather, good and spoiled, and scores the panel beside the seam in three
textures under three rigs. Results in FOLDER are taken again. Leaves docs/charts/visible_faults.csv;
rows that are there are not run again. Says at the end how many cells tell the spoiled one.
"""

from __future__ import annotations

import argparse
import sys
import warnings
from collections import defaultdict
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

import seatlook
from seatlook.chain.case import Case
from seatlook.errors import InputError, InputWarning
from seatlook.seats import write_demo
from seatlook.visibility.observer import VISIBLE
from seatlook.visibility.view import View
from support.kept_rows import KeptRows

# shape -> the seam that is too long, and the panel whose line is
FAULTS = {
    "cushion": ("INSERT-BOLSTER_L", "INSERT"),
    "horseshoe": ("INSERT_FRONT-BOLSTER_L", "INSERT_FRONT"),
    "backrest": ("INSERT_LOWER-WING_L", "INSERT_LOWER"),
    "headrest": ("FRONT-GUSSET", "FRONT"),
    "box": ("piping", "TOP"),
    "saddle": ("edge", "SEAT"),
}
EASE = 0.03
COLUMNS = ("shape", "state", "texture", "rig", "vwi", "apparent_contrast_percent", "zone_vwi",
           "zone_contrast_percent", "share_in_top_pixels", "wave_inside_percent")  # fmt: skip
TABLE = KeptRows("visible_faults", COLUMNS)


def solved(folder: Path, shape: str, *, spoiled: bool) -> Case:
    """Write and solve one seat, or take the result that is there."""
    scene = folder / "scene.toml"
    if not scene.exists():
        ease = {FAULTS[shape][0]: EASE} if spoiled else {}
        write_demo(folder, shape=shape, material="black-leather", ease=ease)
    seat = seatlook.open(scene)
    seat.solve(folder / "result.npz", resume=True)
    return seat


def inside(view: View, zone: str) -> float:
    """Share of the squared height of a panel's waves that lies where it is scored, in per cent."""
    cover = view.solution.cover
    faces = cover.panel == cover.panel_names.index(zone.removesuffix(" interior"))
    square = (view.heights[cover.faces] ** 2).mean(axis=1) * cover.rest_area * faces
    shown = np.zeros(len(cover.faces), dtype=bool)
    shown[view.region.face[view.region.mask]] = True
    return float(100 * square[shown].sum() / square.sum())


def rows(shape: str, state: str, seat: Case) -> list[dict[str, str]]:
    """Score nine cells of one seat."""
    zone = f"{FAULTS[shape][1]} interior"
    view = View(seat.solution, seat.camera(None))
    share = inside(view, zone)
    out = []
    for rig in seat.scene.rigs:
        for texture, looks in seat.scene.textures.items():
            sight = view.sight(looks, rig)
            whole = sight.score.vwi, sight.score.apparent_contrast
            part = sight.zones.get(zone, np.nan), sight.contrasts.get(zone, np.nan)
            figures = (*whole, *part, sight.peak.share, share)
            head = (shape, state, texture, rig.name)
            cells = (*head, *(f"{x:.4g}" for x in figures))
            out.append(dict(zip(COLUMNS, cells, strict=True)))
    return out


def report() -> None:
    """Say of every shape what its cells tell."""
    cells: dict[str, dict[tuple[str, str], dict[str, float]]] = defaultdict(dict)
    for row in TABLE.read():
        pair = cells[row["shape"]].setdefault((row["texture"], row["rig"]), {})
        pair[row["state"]] = float(row["zone_vwi"])
    print(f"| shape | cells of 9 at least doubled | of 9 good ones below {VISIBLE:g} | good |"
          " spoiled | least ratio |")  # fmt: skip
    for shape, pairs in cells.items():
        good, bad = (np.array([pair.get(s, np.nan) for pair in pairs.values()])
                     for s in ("good", "spoiled"))  # fmt: skip
        ranges = " | ".join(f"{v.min():.2f} to {v.max():.2f}" for v in (good, bad))
        told, below = (bad >= 2 * good).sum(), (good < VISIBLE).sum()
        print(f"| {shape} | {told} | {below} | {ranges} | {(bad / good).min():.2f} |")


def main() -> None:
    """Run what is missing."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("folder", nargs="?", type=Path, default=Path("out/visible_faults"))
    parser.add_argument("--only", choices=tuple(FAULTS))
    chosen = parser.parse_args()
    warnings.simplefilter("ignore", InputWarning)  # steep bolsters strain; see the strain maps
    done = {(row["shape"], row["state"]) for row in TABLE.read()}
    for shape in FAULTS:
        for state in ("good", "spoiled"):
            if (shape, state) in done or chosen.only not in (None, shape):
                continue
            seat = solved(chosen.folder / f"{shape}-{state}", shape, spoiled=state == "spoiled")
            try:
                TABLE.add(rows(shape, state, seat))
            except InputError as error:
                print(shape, state, error, flush=True)
    report()


if __name__ == "__main__":
    main()
