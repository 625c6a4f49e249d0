"""The answer to a small change of a solved cover, from its last balance."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from seatlook.errors import InputError
from seatlook.model import Cover, Solution
from seatlook.solver import solve

WARM = "warm"


def solve_warm(start: Solution, cover: Cover) -> Solution:
    """Let a changed cover come to rest from the shape, the seams' forces and the foam of another.

    Nothing is sewn or pulled in anew, so it takes a small part of the time. Its wrinkles are those
    of the start as they have changed: a result to rank changes by. What is kept, compared or judged
    by limits is solved from its scene, and this never stands for it: it says "warm" in its
    ``settings`` and carries no digest of a scene.

    Parameters
    ----------
    start : converged, at rest
    cover : the same mesh with other rest shapes, targets, foam or materials

    Raises
    ------
    InputError
        Another mesh, or a start that is not at rest.
    SolverError, InvertedElementError
        As ``solve``.
    """
    if start.status != "converged" or start.stage != "at rest":
        raise InputError.single(
            "start", got=f"{start.status}, {start.stage}", expected="a converged result at rest"
        )
    if not np.array_equal(start.cover.faces, cover.faces):
        raise InputError.single(
            "cover", got="another mesh than that of the start", expected="the same triangles"
        )
    solution = solve(replace(cover, scene_digest=""), start=start)
    return replace(solution, settings=f"{WARM}, {solution.settings}")


def is_warm(solution: Solution) -> bool:
    """Whether a result was solved from the balance of another cover.

    Examples
    --------
    >>> is_warm(solve_warm(solution, solution.cover))                # doctest: +SKIP
    True
    """
    return solution.settings.startswith(f"{WARM}, ")
