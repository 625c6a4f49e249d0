"""Let a limp round cloth hang over a round table: which method brings it to rest, in what time.

Run it with: python gallery/cusick.py [VERTICES ...] [--method auto|lbfgs|newton] [--bending B]

Prints status, CPU seconds, iterations and how often "auto" went over to the other method.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

from seatlook.solver import SolverSettings, solve
from support.cusick import cusick

parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("vertices", type=int, nargs="*", default=[439, 1700])
parser.add_argument("--method", default="auto")
parser.add_argument("--bending", type=float, default=1e-5, help="N m")
options = parser.parse_args()
for vertices in options.vertices:
    cloth = cusick(vertices, options.bending)
    clock = time.process_time()
    s = solve(cloth, settings=SolverSettings(method=options.method))
    spent, figures = time.process_time() - clock, s.figures
    changes = int(figures["changes_of_method"])
    print(f"{len(cloth.rest)} vertices, {options.method}: {s.status} {s.reason}; "
          f"{spent:.1f} CPU s, {figures['iterations']:.0f} iterations, {changes} changes of "
          f"method; it hangs {-1e3 * s.positions[:, 2].min():.1f} mm down", flush=True)  # fmt: skip
