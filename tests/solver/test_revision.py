"""A solver that comes to rest in another shape has another revision, or kept results would lie."""

from __future__ import annotations

import numpy as np

from seatlook.solver.solve import REVISION, SETTINGS
from support.revision import FILE, shapes

# Processors differ in the last bits, which the way to rest magnifies by an amount that is recorded
# with the shapes; a change of the method moves at least one of them by much more.
TIMES = 3.0
LEAST = 1e-6
ADVICE = (
    "the solver comes to rest in another shape: raise REVISION in solver/solve.py, so that results "
    "kept until now are not taken again, and record the shapes: python -m support.revision"
)


def test_shapes_are_those_of_this_revision():
    with np.load(FILE) as recorded:
        assert int(recorded["revision"]) == REVISION, ADVICE
        for name, positions in shapes().items():
            assert positions.shape == recorded[name].shape, ADVICE
            away = np.abs(positions - recorded[name]).max()
            same = max(LEAST, TIMES * recorded[f"{name} spread"])
            assert away < same, f"{name}: {away:.2g} m away, bound {same:.2g} m; {ADVICE}"


def test_the_revision_is_part_of_what_a_result_was_solved_with():
    assert SETTINGS.startswith(f"revision {REVISION}, ")
