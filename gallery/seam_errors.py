"""Why eq. 4 does not rank every ease error and every short panel: strains, indices, sections.

Run it with: python gallery/seam_errors.py [SEEDS]

Solves the small cover of the tests, two panels sewn in the valley of a crowned block of foam: with
an ease of 0 to 4 %, taut over the valley and without either, and one panel 0 to 4 % too narrow.
Leaves docs/charts/seam_errors.csv, seam_errors_sections.csv and seam_errors.svg; rows that are in
the tables are not run again.
"""

from __future__ import annotations

import csv
import sys
from pathlib import Path

import numpy as np
import numpy.typing as npt

ROOT = Path(__file__).parents[1]
CHARTS = ROOT / "docs" / "charts"
TABLE, SECTIONS = CHARTS / "seam_errors.csv", CHARTS / "seam_errors_sections.csv"
sys.path.insert(0, str(ROOT / "tests"))

import matplotlib  # noqa: E402

matplotlib.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402

from seatlook import assess  # noqa: E402
from seatlook.assembly import assemble  # noqa: E402
from seatlook.mesh.kinematics import principal_values  # noqa: E402
from seatlook.model import Solution  # noqa: E402
from seatlook.solver import solve  # noqa: E402
from seatlook.wrinkle import excess_strain, section, signed_ratio, w2_net  # noqa: E402
from support import patch  # noqa: E402

FloatArray = npt.NDArray[np.float64]
EASES, SHORT = (0.0, 0.005, 0.01, 0.02, 0.04), (0.0, 0.01, 0.02, 0.03, 0.04)
CASES = {
    "ease, slack, no valley": ("ease", EASES, {"valley": 0.0, "tension": 0.0}),
    "ease, taut, over a valley": ("ease", EASES, {}),
    "short panel": ("short", SHORT, {}),
}
NEXT_TO_SEAM = 0.008  # m, where the section runs along it
COLUMNS = ("case", "amount", "seed", "along", "across", "major", "minor", "w2", "w_compression",
           "band_w_compression", "share", "w2_net", "excess_strain", "signed_share",
           "status")  # fmt: skip
WHERE = {
    "ease": "along the seam, 8 mm beside it [mm]",
    "short": "from the seam (left) across the panel [mm]",
}
# What should grow with the fault, and what does instead.
RANKED = {
    "ease": ("band_w_compression", "w_compression", "w2_net", "excess_strain"),
    "short": ("share", "signed_share"),
}


def axes_of_seam(solution: Solution, panel: int) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Middle of the seam, its direction and that into the panel, all in rest coordinates."""
    cover = solution.cover
    (seam,) = cover.stitchings
    line = (seam.a if panel == 0 else seam.b).at(cover.rest)
    along = (line[-1] - line[0]) / np.linalg.norm(line[-1] - line[0])
    inward = np.array([-along[1], along[0]])
    middle = line[len(line) // 2]
    centre = cover.rest[cover.faces[cover.panel == panel]].mean(axis=(0, 1))
    return middle, along, inward if inward @ (centre - middle) > 0 else -inward


def measure(solution: Solution, fault: str) -> dict[str, float]:
    """Means over the faulty panel: in the seam band, or where the test of a short panel looks."""
    cover, panel = solution.cover, 0 if fault == "ease" else 1
    assessment = assess(solution)
    indices = assessment.indices
    major, minor = principal_values(solution.strain_mid)
    zone = np.array(cover.zone_names)[cover.zone]
    band = zone == "seam LEFT-RIGHT"
    chosen = (cover.panel == panel) & band
    if fault == "short":
        stretched = np.maximum(np.abs(major), np.abs(minor)) > 1e-3
        chosen = (cover.panel == panel) & (zone != "free edge") & (indices.w2 > 0.1) & stretched
    _, along, across = axes_of_seam(solution, panel)
    signed = signed_ratio(solution.strain_mid)

    def mean(values: FloatArray, weight: FloatArray = cover.rest_area) -> float:
        return float(np.average(values[chosen], weights=weight[chosen]))

    weight = cover.rest_area * indices.w2
    return {
        "along": mean(np.einsum("i,mij,j->m", along, solution.strain_mid, along)),
        "across": mean(np.einsum("i,mij,j->m", across, solution.strain_mid, across)),
        "major": mean(major),
        "minor": mean(minor),
        "w2": mean(indices.w2),
        "w_compression": mean(indices.w_compression),
        "band_w_compression": float(
            np.average(indices.w_compression[band], weights=cover.rest_area[band])
        ),
        "share": mean(indices.r_stretch, weight),
        "w2_net": mean(w2_net(assessment.surface)),
        "excess_strain": mean(excess_strain(assessment.surface)),
        "signed_share": mean(signed, weight),
    }


def profile(solution: Solution, fault: str) -> FloatArray:
    """Place and height below a straight edge (k, 2) [m].

    Along the seam, where an ease makes waves; across it, where a short panel is pulled.
    """
    panel = 0 if fault == "ease" else 1
    middle, along, inward = axes_of_seam(solution, panel)
    place, direction, half = (
        (NEXT_TO_SEAM, along, 0.07) if fault == "ease" else (0.036, inward, 0.035)
    )
    found = section(
        solution.cover,
        solution.positions,
        panel=panel,
        middle=middle + place * inward,
        direction=direction,
        half_length=half,
    )
    return np.column_stack([found.along, found.height])


def read(path: Path) -> list[dict[str, str]]:
    """Return the rows that are there."""
    if not path.exists():
        return []
    with path.open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


def keep(path: Path, columns: tuple[str, ...], rows: list[dict[str, float | str]]) -> None:
    """Append rows to a table."""
    fresh = not path.exists()
    with path.open("a", newline="", encoding="utf-8") as file:
        table = csv.DictWriter(file, columns)
        if fresh:
            table.writeheader()
        table.writerows(rows)


def run(case: str, amount: float, seed: int) -> None:
    """Solve one cover and keep its row, of the first seed its section as well."""
    fault, _, change = CASES[case]
    scene = patch.scene(**{**change, fault: amount})
    solution = solve(assemble(scene, seed=seed))
    head: dict[str, float | str] = {"case": case, "amount": amount, "seed": seed}
    figures = {name: f"{value:.6g}" for name, value in measure(solution, fault).items()}
    keep(TABLE, COLUMNS, [{**head, **figures, "status": solution.status}])
    if seed == 0:
        rows = [{"case": case, "amount": amount, "along_mm": round(1e3 * s, 2),
                 "height_mm": round(1e3 * z, 4)} for s, z in profile(solution, fault)]  # fmt: skip
        keep(SECTIONS, ("case", "amount", "along_mm", "height_mm"), rows)


def spearman(a: FloatArray, b: FloatArray) -> float:
    """Rank correlation."""
    return float(np.corrcoef(*(np.argsort(np.argsort(v)) for v in (a, b)))[0, 1])


def means(case: str, column: str) -> FloatArray:
    """Amount and mean over the seeds, (k, 2)."""
    rows = [row for row in read(TABLE) if row["case"] == case]
    amounts = sorted({float(row["amount"]) for row in rows})
    return np.array(
        [[a, np.mean([float(r[column]) for r in rows if float(r["amount"]) == a])] for a in amounts]
    )


def draw() -> None:
    """Sections above, strains and what is ranked by them below."""
    figure, axes = plt.subplots(3, len(CASES), figsize=(12, 9), layout="constrained")
    curves = read(SECTIONS)
    for (case, (fault, amounts, _)), column in zip(CASES.items(), axes.T, strict=True):
        for k, amount in enumerate(amounts):
            points = np.array([[float(r["along_mm"]), float(r["height_mm"])] for r in curves
                               if r["case"] == case and float(r["amount"]) == amount])  # fmt: skip
            if len(points):
                column[0].plot(*points.T, color=plt.cm.viridis(k / 4.5), label=f"{amount:.1%}")
        column[0].set(title=case, xlabel=WHERE[fault],
                      ylabel="below a straight edge [mm]")  # fmt: skip
        column[0].legend(title=fault, fontsize=7)
        for name, colour in (("along", "C0"), ("across", "C1"), ("major", "C2"), ("minor", "C3")):
            x, y = means(case, name).T
            column[1].plot(100 * x, 100 * y, "o-", color=colour, label=name, ms=3)
        column[1].axhline(0, color="k", lw=0.5)
        column[1].set(xlabel=f"{fault} [%]", ylabel="strain, mean [%]")
        column[1].legend(fontsize=7)
        for name in RANKED[fault]:
            x, y = means(case, name).T
            rank = spearman(x, y)
            column[2].plot(
                100 * x, y / max(y.max(), 1e-12), "o-", ms=3, label=f"{name}: {rank:.2f}"
            )
            print(f"{case}: Spearman of {name} {rank:.2f}; {np.round(y, 5).tolist()}")
        column[2].set(xlabel=f"{fault} [%]", ylabel="over its largest")
        column[2].legend(title="Spearman", fontsize=7)
    figure.savefig(CHARTS / "seam_errors.svg", metadata={"Date": None})
    plt.close(figure)


def main(seeds: int) -> None:
    """Run what is missing, then draw."""
    for seed in range(seeds):
        for case, (_, amounts, _) in CASES.items():
            done = {(r["case"], float(r["amount"]), int(r["seed"])) for r in read(TABLE)}
            for amount in amounts:
                if (case, amount, seed) not in done:
                    run(case, amount, seed)
    draw()


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 5)
