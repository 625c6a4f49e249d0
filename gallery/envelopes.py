"""Where each method works: maps over time step, thickness and stiffness ratio of a hanging strip.

Run it with: python gallery/envelopes.py

Leaves docs/charts/envelopes.csv and .svg; delete the table to run it again. Green: the step holds,
or converged and within 0.5 % of the length of Newton's shape; yellow: said not to be converged;
orange: raised; red would be a wrong answer that nobody reports.
"""

from __future__ import annotations

import csv
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).parents[1]
CHARTS = ROOT / "docs" / "charts"
TABLE = CHARTS / "envelopes.csv"
sys.path.insert(0, str(ROOT / "tests"))

import matplotlib  # noqa: E402

matplotlib.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402
from matplotlib.colors import ListedColormap  # noqa: E402

from seatlook.solver import Explicit  # noqa: E402
from seatlook.solver.sheet import SheetError, SheetSolution  # noqa: E402
from support.reference.hanging import explicit_limit, hanging  # noqa: E402

THICKNESS = (1e-1, 1e-2, 1e-3, 1e-4)
RATIO = (1.0, 1e1, 1e3, 1e5)
STEP = (0.5, 0.8, 0.95, 1.05, 1.3, 2.0)
STATES = ("converged", "stable", "not converged", "raised", "wrong")
COLOURS = ListedColormap(["#4c9f70", "#4c9f70", "#e9c46a", "#e76f51", "#c1121f"])
Row = tuple[str, float, float, str, float]


def verdict(solved: SheetSolution, reference: np.ndarray | None) -> str:
    """Classify a solution; without a reference a step that holds is enough."""
    if reference is None:
        return "stable"
    if not solved.converged:
        return "not converged"
    gap = np.linalg.norm(solved.positions - reference, axis=1).max()
    return "converged" if gap < 5e-3 else "wrong"


def implicit(method: str) -> list[Row]:
    """Thickness against the stiffness of the warp over that of the weft."""
    rows: list[Row] = []
    for thickness in THICKNESS:
        for ratio in RATIO:
            options = {"thickness": thickness, "stiffness_ratio": ratio, "edges": 6}
            _, best = hanging(method="newton", **options)
            solved = best
            if method != "newton":
                _, solved = hanging(method=method, max_iterations=1500, **options)
            state = verdict(solved, best.positions)
            rows.append((method, thickness, ratio, state, solved.residual))
    return rows


def explicit() -> list[Row]:
    """Thickness against the time step over the stable one; 400 steps."""
    rows: list[Row] = []
    for thickness in THICKNESS:
        limit = explicit_limit(thickness=thickness, edges=6)
        for share in STEP:
            method = Explicit(time_step=share * limit)
            try:
                _, solved = hanging(thickness=thickness, edges=6, method=method, max_iterations=8)
                rows.append(("explicit", thickness, share, verdict(solved, None), solved.residual))
            except SheetError:
                rows.append(("explicit", thickness, share, "raised", np.nan))
    return rows


def rows() -> list[Row]:
    """Return the table's rows; run them if there is none."""
    if not TABLE.exists():
        found = [*implicit("newton"), *implicit("lbfgs"), *explicit()]
        with TABLE.open("w", newline="", encoding="utf-8") as file:
            table = csv.writer(file)
            table.writerow(("method", "thickness_over_length", "ratio", "state", "residual"))
            table.writerows((*row[:4], f"{row[4]:.2e}") for row in found)
    with TABLE.open(encoding="utf-8") as file:
        kept = list(csv.reader(file))[1:]
    return [(m, float(t), float(r), state, float(residual)) for m, t, r, state, residual in kept]


def main() -> None:
    """Draw the maps."""
    found = rows()
    figure, axes = plt.subplots(1, 3, figsize=(11, 3.8), layout="constrained")
    titles = {
        "newton": "Newton",
        "lbfgs": "L-BFGS, 1500 iterations",
        "explicit": "explicit, 400 steps",
    }
    for axis, (method, title) in zip(axes, titles.items(), strict=True):
        mine = [row for row in found if row[0] == method]
        across = sorted({row[2] for row in mine})
        image = np.array([[STATES.index(next(r[3] for r in mine if r[1:3] == (t, c)))
                           for c in across] for t in THICKNESS])  # fmt: skip
        axis.imshow(image, cmap=COLOURS, vmin=-0.5, vmax=4.5, aspect="auto")
        for i, j in np.ndindex(image.shape):
            axis.text(j, i, STATES[image[i, j]].replace(" ", "\n"), ha="center", va="center",
                      fontsize=7)  # fmt: skip
        axis.set_xticks(range(len(across)), [f"{c:g}" for c in across])
        axis.set_yticks(range(len(THICKNESS)), [f"{t:g}" for t in THICKNESS])
        label = "time step / stable step" if method == "explicit" else "warp / weft stiffness"
        axis.set(title=title, xlabel=label, ylabel="thickness / length")
    figure.savefig(CHARTS / "envelopes.svg")


if __name__ == "__main__":
    main()
