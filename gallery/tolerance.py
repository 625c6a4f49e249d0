"""Error of zone means over CPU seconds: meshes of one size, and meshes from a tolerance.

Run it with: python gallery/tolerance.py [MATERIAL KIND ASKED SEED]

The demo cushion at 0.6 of its size with one seam 4 % too long, in four materials. Rows are kept in
docs/charts/tolerance.csv as they are finished and not run again; delete rows to repeat them. With
arguments only that case is run: KIND is "uniform", ASKED then an element size in mm, or
"tolerance", ASKED then in per cent. Run a coarse case once before, so that kernels are compiled.
"""

from __future__ import annotations

import sys
import tempfile
from collections import defaultdict
from pathlib import Path

import matplotlib
import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

import seatlook
from seatlook.model import Solution
from seatlook.seats.files import write_demo
from support.kept_rows import KeptRows

matplotlib.use("Agg")
from matplotlib import pyplot as plt
from matplotlib.ticker import FixedLocator, NullFormatter, ScalarFormatter

COLUMNS = ("material", "kind", "asked", "seed", "vertices", "cpu_seconds", "status", "zone",
           "area_cm2", "w2_mean", "w2_p95", "w2_mesh_error")  # fmt: skip
TABLE = KeptRows("tolerance", COLUMNS)
EASED = "INSERT-BOLSTER_L"
SMALL = 0.02  # mean W2 below which the error counts absolutely
Case = tuple[str, str, float, int]
CASES: tuple[Case, ...] = (
    *(("leather-laminate", "uniform", size, 0) for size in (14.0, 10.0, 7.0, 5.0)),
    *(("leather-laminate", "tolerance", share, 0) for share in (20.0, 10.0, 5.0)),
    *(("black-leather", "uniform", size, 0) for size in (10.0, 7.0, 5.0, 3.5, 2.5)),
    *(("black-leather", "tolerance", share, 0) for share in (20.0, 10.0, 5.0)),
    *((name, "uniform", size, 0) for name in ("suede", "woven") for size in (7.0, 5.0, 3.5)),
    *((name, "tolerance", share, 0) for name in ("suede", "woven") for share in (20.0, 10.0)),
)


def solved(material: str, kind: str, asked: float, seed: int) -> Solution:
    """Solve the seat in a material on one mesh."""
    with tempfile.TemporaryDirectory() as folder:
        scene = write_demo(
            folder, scale=0.6, ease={EASED: 0.04}, tension=0.005, material=material, insert=material
        )
        size = {"element_size": 1e-3 * asked} if kind == "uniform" else {"tolerance": asked / 100}
        return seatlook.open(scene, seed=seed, **size).solve()


def rows_of(case: Case, solution: Solution) -> list[dict[str, str]]:
    """Rows of one solve, one for each zone but free edges."""
    head = (*case, len(solution.cover.rest), f"{solution.figures['cpu_seconds']:.2f}")
    found = seatlook.assess(solution)
    values = [
        (*head, found.resolution.status, row.zone, f"{1e4 * row.area:.1f}", f"{row['w2_mean']:.5f}",
         f"{row['w2_p95']:.4f}", "" if row.w2_mesh_error is None else f"{row.w2_mesh_error:.5f}")
        for row in found.zones
        if row.zone != "free edge"
    ]  # fmt: skip
    return [dict(zip(COLUMNS, map(str, line), strict=True)) for line in values]


def case_of(row: dict[str, str]) -> Case:
    """Which case a row is of."""
    return row["material"], row["kind"], float(row["asked"]), int(row["seed"])


def error(zones: list[dict[str, str]], truth: dict[str, float]) -> float:
    """Error over all zones, as the status has it: over their means or 0.02, weighted by area."""
    area = np.array([float(row["area_cm2"]) for row in zones])
    away = [
        (float(row["w2_mean"]) - truth[row["zone"]]) / max(truth[row["zone"]], SMALL)
        for row in zones
    ]
    return float(np.sqrt(area @ np.square(away) / area.sum()))


def chart() -> None:
    """Draw the error over CPU seconds, against the finest mesh of one size; print the rows."""
    cases: dict[Case, list[dict[str, str]]] = defaultdict(list)
    for row in TABLE.read():
        cases[case_of(row)].append(row)
    # Without a mesh of one size there is nothing to compare with.
    materials = list(dict.fromkeys(case[0] for case in cases if case[1] == "uniform"))
    figure, panels = plt.subplots(1, len(materials), figsize=(3.4 * len(materials), 3.6))
    for panel, material in zip(np.atleast_1d(panels), materials, strict=True):
        own = {case: zones for case, zones in cases.items() if case[0] == material}
        finest = min((case for case in own if case[1] == "uniform"), key=lambda case: case[2])
        truth = {row["zone"]: float(row["w2_mean"]) for row in own[finest]}
        for kind, unit in (("uniform", "mm"), ("tolerance", "%")):
            points = sorted(
                (float(zones[0]["cpu_seconds"]), 100 * error(zones, truth), case[2], case[3])
                for case, zones in own.items()
                if case[1] == kind and case != finest
            )
            if not points:
                continue
            panel.plot([p[0] for p in points], [p[1] for p in points], "o-", label=kind)
            for seconds, away, asked, seed in points:
                panel.annotate(f"{asked:g} {unit}", (seconds, away), fontsize=7)
                print(f"{material} {kind} {asked:g} {unit} seed {seed}: "
                      f"{seconds:.1f} s, {away:.1f} %")  # fmt: skip
        panel.set(xscale="log", yscale="log", xlabel="CPU seconds", title=material)
        for axis in (panel.xaxis, panel.yaxis):
            axis.set_major_locator(FixedLocator((1, 2, 3, 5, 10, 20, 30, 50, 100)))
            axis.set_major_formatter(ScalarFormatter())
            axis.set_minor_formatter(NullFormatter())
        panel.text(0.03, 0.03, f"against {finest[2]:g} mm", fontsize=7, transform=panel.transAxes)
        panel.legend(fontsize=7)
    np.atleast_1d(panels)[0].set_ylabel("error of zone means of W2 [%]")
    figure.tight_layout()
    figure.savefig(TABLE.path.with_suffix(".svg"), metadata={"Date": None})


def main(wanted: tuple[Case, ...]) -> None:
    """Run what is missing, keep every case as it is finished, and draw all."""
    for case in wanted:
        if case not in {case_of(row) for row in TABLE.read()}:
            TABLE.add(rows_of(case, solved(*case)))
            print(*case, "done", flush=True)
    chart()


if __name__ == "__main__":
    words = sys.argv[1:]
    main(((words[0], words[1], float(words[2]), int(words[3])),) if words else CASES)
