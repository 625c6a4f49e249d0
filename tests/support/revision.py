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


def spread(cover: Cover, rest: FloatArray, repeats: int = 8) -> float:
    """Return how far [m] last bits of the start, as between processors, move the shape at rest."""
    rng = np.random.default_rng(0)
    bit = np.finfo(float).eps
    return max(
        float(
            np.abs(solve(replace(cover, positions=cover.positions * factor)).positions - rest).max()
        )
        for factor in 1.0 + bit * rng.integers(-1, 2, (repeats, *cover.positions.shape))
    )


def main() -> None:
    """Record the shapes of this revision, and how far the last bits move them."""
    recorded: dict[str, FloatArray | float] = {}
    for name, cover in covers().items():
        recorded[name] = solve(cover).positions
        recorded[f"{name} spread"] = spread(cover, recorded[name])
        print(f"{name}: {recorded[f'{name} spread']:.1e} m by the last bits")
    np.savez_compressed(FILE, revision=REVISION, **recorded)


if __name__ == "__main__":
    main()
