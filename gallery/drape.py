"""Drape a square of 0.5 m over a sphere of 0.1 m radius until it is in static equilibrium.

Run it with: python gallery/drape.py [VERTICES]

B 5e-5 N m, 2 kN/m, 0.3 kg/m2, friction 0.3; prints CPU seconds, memory, depth in the sphere and
strains. The sphere is foam so stiff that it gives way by less than a tenth of a millimetre.
"""

from __future__ import annotations

import resource
import sys
import time
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

from covers import cover, foam, sheet, sphere
from seatlook.model import Curve, Stage
from seatlook.solver import solve

SIDE, RADIUS, THICKNESS, YOUNG = 0.5, 0.1, 5e-4, 30e3


def main(vertices: int) -> None:
    """Drape and print."""
    h = SIDE / np.sqrt(vertices * np.sqrt(0.75))
    half = -0.5 * SIDE
    panel = sheet(SIDE, SIDE, h, z=RADIUS + 0.5 * THICKNESS + 1e-4, at=(half, half))
    column = np.array([0.0, 0.5, 0.8])
    hard = {"young": YOUNG, "strain": column, "stress": 60.0 * YOUNG * column, "friction": 0.3}
    cloth = cover(
        [panel],
        foam=foam(*sphere(RADIUS, 5), **hard),
        stages=[Stage(name="drop", start=0.0, end=2.0)],
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
    clock = time.process_time()
    s = solve(cloth, dt=0.04, iterations=60)
    spent = time.process_time() - clock
    strain = np.abs(np.concatenate([s.strain_mid[:, 0, 0], s.strain_mid[:, 1, 1]]))
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"{len(cloth.rest)} vertices: {s.status} {s.reason}")
    print(f"{spent:.1f} CPU s, {s.figures['iterations']:.0f} iterations, {memory:.0f} MiB")
    print(f"depth {1e3 * s.figures['contact_depth_max']:.3f} mm, 99 % of the strains along warp "
          f"and weft below {100 * np.quantile(strain, 0.99):.2f} %")  # fmt: skip


if __name__ == "__main__":
    main(int(sys.argv[1]) if sys.argv[1:] else 10_000)
