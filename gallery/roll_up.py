"""How far the constant bending matrix misses a roll-up, against element size over radius.

Run it with: python gallery/roll_up.py

A strip of five times its width bent to a full circle: what its moment misses of B kappa, and the
gap of its ends. Rows in docs/charts/roll_up.csv are kept, not run again; delete one to repeat it.
"""

from __future__ import annotations

import csv
import sys
from pathlib import Path

import numpy as np

ROOT = Path(__file__).parents[1]
CHARTS = ROOT / "docs" / "charts"
TABLE = CHARTS / "roll_up.csv"
sys.path.insert(0, str(ROOT / "tests"))

import matplotlib  # noqa: E402

matplotlib.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402

from support.reference.rolled import missed  # noqa: E402

KINDS = {"uns": "o", "right": "s", "sliver": "^"}
EDGES = (10, 14, 20, 28, 40, 56)
BAR = 1e-3
# Of the length: what the strip stretches, about 2 (2 pi t / L)^2 / 12 of its moment, is 3e-5.
THIN = 2e-3


def rows() -> list[tuple[str, int, float, float]]:
    """Return kind, edges, moment and gap of every case; run what the table lacks."""
    if not TABLE.exists():
        TABLE.write_text("mesh,edges,moment_missed,end_gap\n", encoding="utf-8")
    done = read()
    for kind in KINDS:
        for edges in EDGES:
            if (kind, edges) in {row[:2] for row in done}:
                continue
            moment, gap = missed(kind, edges, THIN)
            print(kind, edges, f"{moment:+.6f} {gap:.6f}", flush=True)
            with TABLE.open("a", newline="", encoding="utf-8") as file:
                writer = csv.writer(file, lineterminator="\n")
                writer.writerow((kind, edges, f"{moment:.6f}", f"{gap:.6f}"))
    return read()


def read() -> list[tuple[str, int, float, float]]:
    """Read the table."""
    with TABLE.open(encoding="utf-8") as file:
        return [(kind, int(n), float(m), float(g)) for kind, n, m, g in list(csv.reader(file))[1:]]


def main() -> None:
    """Draw both misses with their power laws."""
    found = rows()
    figure, axes = plt.subplots(1, 2, figsize=(9, 4), layout="constrained", sharey=True)
    for column, name in enumerate(("moment off B kappa [1]", "gap of the ends [L]")):
        axis = axes[column]
        for kind, marker in KINDS.items():
            mine = sorted(row[1:] for row in found if row[0] == kind)
            x = 2 * np.pi / np.array([row[0] for row in mine])
            y = np.abs([row[1 + column] for row in mine])
            slope, level = np.polyfit(np.log(x), np.log(y), 1)
            print(f"{kind}: {name} {np.exp(level):.3f} (h/R)^{slope:.2f}")
            axis.plot(x, y, marker, mfc="none", label=f"{kind}, (h/R)^{slope:.1f}")
            axis.plot(x, np.exp(level) * x**slope, lw=0.8, color=axis.lines[-1].get_color())
        axis.axhline(BAR, ls="--", color="grey", lw=0.8)
        ticks = 2 * np.pi / np.array(EDGES)
        axis.set(xscale="log", yscale="log", title=name,
                 xlabel="element size / radius (edges to the circle)")  # fmt: skip
        axis.set_xticks(ticks, [f"{t:.2f}\n({n})" for t, n in zip(ticks, EDGES, strict=True)])
        axis.minorticks_off()
        axis.grid(alpha=0.3)
        axis.legend(fontsize=8)
    figure.savefig(CHARTS / "roll_up.svg")


if __name__ == "__main__":
    main()
