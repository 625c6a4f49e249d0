"""How the demo's zones change with the foam's two stiffnesses, beside seeds.

Run it with: python gallery/foam_model.py [ELEMENT_SIZE_MM]

The column's curve (settlement) is varied by a fifth, the half-space modulus (short waves) by two:
no elastic body is solved here. Writes docs/charts/foam_model.csv, one row per run and zone, and the
changes against the base as foam_model.svg; finished runs are not run again.
"""

from __future__ import annotations

import csv
import sys
import tempfile
from dataclasses import replace
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

from seatlook import assemble, assess, load_scene, solve
from seatlook.cli._demo import write_demo
from seatlook.model import Scene
from seatlook.results.gap import gap, zone_gaps

TABLE = Path(__file__).parents[1] / "docs" / "charts" / "foam_model.csv"
# name -> factors on the column's stress and on the half-space modulus, seed
RUNS = {
    "base": (1.0, 1.0, 0),
    "column -20 %": (0.8, 1.0, 0),
    "column +20 %": (1.2, 1.0, 0),
    "half-space / 2": (1.0, 0.5, 0),
    "half-space x 2": (1.0, 2.0, 0),
    "seed 1": (1.0, 1.0, 1),
    "seed 2": (1.0, 1.0, 2),
}
FIGURES = ("w2_mean", "w_stretch_mean", "w_compression_mean", "gap_mean_mm")
LABELS = dict(zip(FIGURES, ("W2", "W_stretch", "W_compression", "gap"), strict=True))
COLUMNS = ("run", "element_size_mm", "zone", "area_cm2", *FIGURES, "status")


def measure(scene: Scene, name: str, size: float) -> list[dict[str, float | str]]:
    """Solve one variant; one row per zone."""
    column, short, seed = RUNS[name]
    stuff = scene.foam.material
    stuff = replace(stuff, stress=column * stuff.stress, young=short * stuff.young)
    foam = replace(scene.foam, material=stuff)
    solution = solve(assemble(replace(scene, foam=foam, seed=seed, element_size=1e-3 * size)))
    gaps = {row.zone: 1e3 * row.mean for row in zone_gaps(solution, gap(solution))}
    return [
        {
            "run": name,
            "element_size_mm": size,
            "zone": row.zone,
            "area_cm2": 1e4 * row.area,
            **{figure: row.values()[figure] for figure in FIGURES[:-1]},
            "gap_mean_mm": gaps[row.zone],
            "status": solution.status,
        }
        for row in assess(solution).zones
        if row.zone != "free edge"
    ]


def rows() -> list[dict[str, str]]:
    """Return the finished rows."""
    if not TABLE.exists():
        return []
    with TABLE.open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


def changes(table: list[dict[str, str]], kind: str) -> dict[str, dict[str, float]]:
    """Change of each figure's mean over a kind of zone against the base, run by run."""
    means = {}
    for name in RUNS:
        mine = [r for r in table if r["run"] == name and kind in r["zone"]]
        area = [float(r["area_cm2"]) for r in mine]
        means[name] = {f: np.average([float(r[f]) for r in mine], weights=area) for f in FIGURES}
        print(f"{kind} {name}: " + ", ".join(f"{f} {means[name][f]:.5f}" for f in FIGURES))
    return {n: {f: m[f] / means["base"][f] - 1 for f in FIGURES} for n, m in means.items()}


def chart(table: list[dict[str, str]], size: float) -> None:
    """Bars of the changes in per cent, with the 10 % that would ask for an elastic body."""
    figure, panels = plt.subplots(1, 2, figsize=(10, 4.4), sharey=True)
    names = [name for name in RUNS if name != "base"]
    for panel, kind in zip(panels, ("interior", "seam"), strict=True):
        found = changes(table, kind)
        for k, key in enumerate(FIGURES):
            at = np.arange(len(names)) + 0.2 * (k - 1.5)
            panel.barh(at, [100 * found[n][key] for n in names], 0.18, label=LABELS[key])
        for limit in (-10, 10):
            panel.axvline(limit, color="0.5", ls="--", lw=1)
        panel.axvline(0, color="0.2", lw=0.8)
        panel.set_xlim(-20, 20)
        panel.set_xlabel("change of the mean [%]")
        panel.set_title({"interior": "panel interiors", "seam": "seam bands"}[kind])
    panels[0].set_yticks(np.arange(len(names)), names)
    panels[0].invert_yaxis()
    panels[1].legend(fontsize=8, loc="lower right")
    figure.suptitle(f"Demo, leather laminate, {size:g} mm: the foam's two stiffnesses, and seeds")
    figure.tight_layout()
    figure.savefig(TABLE.with_suffix(".svg"), metadata={"Date": None})


def main(size: float) -> None:
    """Run what is missing, keep every run as it is finished, and print the changes."""
    done = {row["run"] for row in rows() if float(row["element_size_mm"]) == size}
    with tempfile.TemporaryDirectory() as folder:
        missing = [name for name in RUNS if name not in done]
        if missing:
            write_demo(Path(folder), ease={}, short={}, material="leather-laminate",
                       insert="leather-laminate", element_size_mm=size, seed=0)  # fmt: skip
            scene = load_scene(Path(folder) / "scene.toml")
        for name in missing:
            found = measure(scene, name, size)
            with TABLE.open("a", encoding="utf-8", newline="") as file:
                writer = csv.DictWriter(file, COLUMNS, lineterminator="\n")
                if not file.tell():
                    writer.writeheader()
                writer.writerows(found)
    chart([row for row in rows() if float(row["element_size_mm"]) == size], size)


if __name__ == "__main__":
    main(float(sys.argv[1]) if len(sys.argv) > 1 else 14.0)
