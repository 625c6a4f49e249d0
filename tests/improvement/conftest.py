"""The coarse demo, solved once, and all that may be changed of it."""

from dataclasses import replace

import pytest

from seatlook import io
from seatlook.assembly import assemble
from seatlook.chain.assess import assess
from seatlook.improvement.candidate import candidates_of
from seatlook.improvement.changes import Changes
from seatlook.improvement.objective import Goal, Objective, weights
from seatlook.improvement.warm import solve_warm
from seatlook.solver import solve
from seatlook.solver.balance import Balance


@pytest.fixture(scope="session")
def scene(demo_scene):
    return io.load_scene(demo_scene)


@pytest.fixture(scope="session")
def solved(scene):
    return solve(assemble(scene))


@pytest.fixture(scope="session")
def changes(scene, solved):
    return Changes(solved, scene.pattern)


@pytest.fixture(scope="session")
def candidates(solved, changes):
    return candidates_of(solved.cover, changes.outlines)


@pytest.fixture(scope="session")
def slippery(solved):
    """The same seat on foam without friction, far better in balance than a solve leaves it."""
    cover = solved.cover
    foam = replace(cover.foam, material=replace(cover.foam.material, friction=0.0))
    balance = Balance(solve_warm(solved, replace(cover, foam=foam)))
    balance.polish()
    return balance.solution()


@pytest.fixture(scope="session")
def slippery_changes(scene, slippery):
    return Changes(slippery, scene.pattern)


@pytest.fixture(scope="session")
def balance(slippery):
    balance = Balance(slippery)
    balance.polish()
    return balance


@pytest.fixture(scope="session")
def objective(slippery):
    surface = assess(slippery).surface
    return Objective(
        slippery,
        net=surface.net,
        c_threshold=surface.c_threshold,
        weight=weights(slippery.cover, {}),
        goal=Goal(w2=0.02, strain=(-0.002, 0.01), gap=5e-4),
    )
