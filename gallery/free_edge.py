"""What the strain of triangles along a free edge is taken from: four ways, two tests.

Run it with: python gallery/free_edge.py

Left: a radial load along the edge of a bent sheet, against the closed form of its layer. Right: the
slit annulus. Rows in docs/charts/free_edge.csv are kept, not run again; delete one to repeat it.
"""

from __future__ import annotations

import csv
import sys
import time
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from unittest import mock

import numpy as np

ROOT = Path(__file__).parents[1]
CHARTS = ROOT / "docs" / "charts"
TABLE = CHARTS / "free_edge.csv"
sys.path.insert(0, str(ROOT / "tests"))

import matplotlib  # noqa: E402

matplotlib.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402

from seatlook.solver.element import membrane  # noqa: E402
from support.reference.annulus import THIN, deflections, uniform  # noqa: E402
from support.reference.rim_layer import rim_stiffness  # noqa: E402

# Share of the way to the next row of edges, and whether that row answers.
WAYS = {
    "constant strain": (0.0, True),
    "rim triangles only": (1 / 3, False),
    "at Gauss points": (0.5 * (1 - 3**-0.5), True),
    "at centroids (now)": (1 / 3, True),
}
RATIOS = (2.0, 1.4, 1.0, 0.7, 0.5, 0.35)
SIZES = (1.4, 1.0, 0.7, 0.5)
Row = tuple[str, str, float, int, float, float, float]


@contextmanager
def way(name: str) -> Iterator[None]:
    """Build sheets in one of ``WAYS``."""
    share, both = WAYS[name]
    paired = membrane._along_rims

    def one_sided(edges, area):  # type: ignore[no-untyped-def]
        pairs, shares = paired(edges, area)
        rim = edges.free[edges.of_face].sum(axis=1) == 1
        return pairs, np.where(rim[pairs], shares, 0.0)

    with ExitStack() as stack:
        stack.enter_context(mock.patch.object(membrane, "_CENTROID", share))
        if not both:
            stack.enter_context(mock.patch.object(membrane, "_along_rims", one_sided))
        yield


def rows() -> list[Row]:
    """Return all rows; run what the table lacks."""
    if not TABLE.exists():
        TABLE.write_text("way,test,size,vertices,first,second,cpu_s\n", encoding="utf-8")
    done = read()
    plan = [(name, "layer", r) for name in WAYS for r in RATIOS]
    plan += [(name, "annulus", h) for h in SIZES for name in WAYS]
    for name, test, size in plan:
        if (name, test, size) in {row[:3] for row in done}:
            continue
        clock = time.process_time()
        with way(name):
            if test == "layer":
                count, errors = 0, (rim_stiffness("uns", size), 0.0)
            else:
                mesh = uniform(size)
                count, errors = len(mesh[0]), tuple(deflections(*mesh)[0] / THIN - 1)
        row = (name, test, size, count, *(f"{e:.5f}" for e in errors))
        print(*row, flush=True)
        with TABLE.open("a", newline="", encoding="utf-8") as file:
            writer = csv.writer(file, lineterminator="\n")
            writer.writerow((*row, f"{time.process_time() - clock:.1f}"))
    return read()


def read() -> list[Row]:
    """Read the table."""
    with TABLE.open(encoding="utf-8") as file:
        return [
            (name, test, float(size), int(count), float(first), float(second), float(cpu))
            for name, test, size, count, first, second, cpu in list(csv.reader(file))[1:]
        ]


def main() -> None:
    """Draw both tests."""
    found = rows()
    figure, axes = plt.subplots(1, 2, figsize=(10, 4.6), layout="constrained")
    for name in WAYS:
        style = {"lw": 2.2, "marker": "o"} if "now" in name else {"lw": 1, "marker": "."}
        layer = sorted((r[2], 100 * r[4]) for r in found if r[:2] == (name, "layer"))
        axes[0].plot(*zip(*layer, strict=True), label=name, **style)
        ring = sorted((r[3], 100 * r[4]) for r in found if r[:2] == (name, "annulus"))
        if ring:
            axes[1].plot(*zip(*ring, strict=True), label=name, **style)
    axes[0].set(xscale="log", ylim=(-20, 60), title="Load along the free edge of a bent sheet")
    axes[0].set(xlabel="element size / width of the layer", ylabel="error of the stiffness [%]")
    axes[1].set(xscale="log", title="Slit annulus")
    axes[1].set(xlabel="vertices", ylabel="error of the inner deflection [%]")
    axes[0].set_xticks(RATIOS, [f"{r:g}" for r in RATIOS])
    counts = sorted({r[3] for r in found if r[1] == "annulus"})
    axes[1].set_xticks(counts, [str(c) for c in counts])
    for axis in axes:
        axis.minorticks_off()
        axis.axhline(0.0, color="grey", lw=0.8)
        axis.grid(alpha=0.3)
    axes[0].legend(fontsize=8)
    figure.savefig(CHARTS / "free_edge.svg")


if __name__ == "__main__":
    main()
