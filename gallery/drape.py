"""Drape a square of 0.5 m over a sphere of 0.1 m radius until it is in static equilibrium.

Run it with: python gallery/drape.py [VERTICES ...]

B 5e-5 N m, 2 kN/m, 0.3 kg/m2, friction 0.3; prints CPU seconds, memory, depth in the sphere and
strains. Each mesh begins from the shape of the one before. The sphere is foam so stiff that it
gives way by less than a tenth of a millimetre.
"""

from __future__ import annotations

import resource
import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

from seatlook.model import Cover, Curve, Solution, Stage
from seatlook.solver import SolverSettings, solve
from support.covers import cover, foam, sheet, sphere

SETTINGS = SolverSettings(method="newton", dt=0.04, iterations=10)
SIDE, RADIUS, THICKNESS, YOUNG = 0.5, 0.1, 5e-4, 30e3


def cloth(vertices: int) -> Cover:
    """Square above the sphere."""
    h = SIDE / np.sqrt(vertices * np.sqrt(0.75))
    half = -0.5 * SIDE
    panel = sheet(SIDE, SIDE, h, z=RADIUS + 0.5 * THICKNESS + 1e-4, at=(half, half))
    column = np.array([0.0, 0.5, 0.8])
    hard = {"young": YOUNG, "strain": column, "stress": 60.0 * YOUNG * column, "friction": 0.3}
    return cover(
        [panel],
        foam=foam(*sphere(RADIUS, 5), **hard),
        stages=[Stage(name="drop", start=0.0, end=0.2)],
        h=h,
        thickness=THICKNESS,
        density=0.3,
        warp=Curve.linear(2000.0),
        weft=Curve.linear(2000.0),
        shear=Curve.linear(500.0),
        bending_warp=5e-5,
        bending_weft=5e-5,
        bending_twist=2.5e-5,
    )


def main(sizes: list[int]) -> None:
    """Drape, from the coarsest mesh to the finest, and print."""
    clock = time.process_time()
    s: Solution | None = None
    for vertices in sizes:
        square = cloth(vertices)
        s = solve(square, settings=SETTINGS, start=s)
        spent = time.process_time() - clock
        print(f"{len(square.rest)} vertices: {s.status} {s.reason}; {spent:.1f} CPU s so far, "
              f"{s.figures['iterations']:.0f} iterations", flush=True)  # fmt: skip
    strain = np.abs(np.concatenate([s.strain_mid[:, 0, 0], s.strain_mid[:, 1, 1]]))
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"{memory:.0f} MiB, depth {1e3 * s.figures['contact_depth_max']:.3f} mm, 99 % of the "
          f"strains along warp and weft below {100 * np.quantile(strain, 0.99):.2f} %")  # fmt: skip


if __name__ == "__main__":
    main([int(size) for size in sys.argv[1:]] or [2_500, 10_000])
