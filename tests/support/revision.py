"""The shapes that the solver's revision stands for; record them anew with every new revision.

Run it from the folder of the tests: python -m support.revision
"""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from seatlook.assembly import assemble
from seatlook.model import Cover, FloatArray
from seatlook.solver import solve
from seatlook.solver.solve import REVISION
from support.scenes import two_panels

FILE = Path(__file__).parents[1] / "data" / "revision.npz"


def covers() -> dict[str, Cover]:
    """Two sewn and hooked panels, with free seams and with a hem, on a mesh of either seed."""
    scene = two_panels(element_size=0.015)
    return {
        "free seams": assemble(scene),
        "hem": assemble(replace(scene, hem=True)),
        "another seed": assemble(scene, seed=7),
    }


def shapes() -> dict[str, FloatArray]:
    """Positions (n, 3) [m] at rest."""
    return {name: solve(cover).positions for name, cover in covers().items()}


def main() -> None:
    """Record the shapes of this revision."""
    np.savez_compressed(FILE, revision=REVISION, **shapes())


if __name__ == "__main__":
    main()
