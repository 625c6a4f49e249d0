"""Synthetic laboratory: known fabrics are tested with noise, identified, and compared.

Run it with: python gallery/identify.py [--knots] [COUNT]

With --knots the files of tests name the knots of the curves, so that every stiffness can be
compared with its stated error; without, knots are chosen. Prints a row for each fabric, then how
often a parameter is within twice its standard error, and the worst curve.
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

from seatlook.identify.material import identify_file
from support.lab_scores import loop_errors, scores, tension_errors
from support.laboratory import Bench, fabrics, whole_set


def main() -> None:
    """Test, identify and compare."""
    words = sys.argv[1:]
    count = int(next((word for word in words if word.isdigit()), 12))
    every, tension, worst_loss = [], [], 0.0
    print("fabric, tension out and back of warp and weft, bending, shear [% of peak] | losses [%]")
    for number, (fabric, peak) in enumerate(fabrics(count)):
        with tempfile.TemporaryDirectory() as folder:
            bench = Bench(seed=100 + number, knots="--knots" in words)
            found = identify_file(whole_set(Path(folder), fabric, peak, bench))
        pulled, lost = tension_errors(fabric, found.material.fabric, peak)
        turned, widths = loop_errors(fabric, found.material.fabric)
        print(number, *(f"{v:.2f}" for v in (*pulled, *turned)), "|",
              *(f"{v:+.1f}" for v in (*lost, *widths)), flush=True)  # fmt: skip
        every += scores(fabric, found.findings)
        tension += pulled
        worst_loss = max(worst_loss, *np.abs([*lost, *widths]))
    within = np.abs(every) < 2
    print(f"{100 * within.mean():.1f} % of {len(every)} parameters within twice their error")
    print(f"tension: {sum(np.less(tension, 1))} of {len(tension)} curves within 1 %, worst "
          f"{max(tension):.2f} %; losses within {worst_loss:.1f} %")  # fmt: skip


if __name__ == "__main__":
    main()
