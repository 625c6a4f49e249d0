"""Fixtures: the demo's design surface, foam and pattern on a coarse mesh."""

import numpy as np
import pytest

from seatlook.flattening import flatten
from seatlook.seats import Cushion, demo_design, demo_foam_mesh


@pytest.fixture(scope="session")
def surface():
    return demo_design(element_size=0.010)


@pytest.fixture(scope="session")
def foam():
    return demo_foam_mesh(element_size=0.010)


@pytest.fixture(scope="session")
def flattened(surface):
    return flatten(surface)


@pytest.fixture(scope="session")
def cushion():
    return Cushion()


@pytest.fixture(scope="session")
def solid_angle():
    def measure(points, vertices, faces):
        """Solid angle of a closed surface over 4 pi: 1 inside, 0 outside (van Oosterom 1983)."""
        found = np.empty(len(points))
        for i, point in enumerate(points):
            a, b, c = (vertices[faces] - point).transpose(1, 0, 2)
            la, lb, lc = (np.linalg.norm(v, axis=1) for v in (a, b, c))
            top = np.einsum("md,md->m", a, np.cross(b, c))
            below = (
                la * lb * lc
                + np.einsum("md,md->m", a, b) * lc
                + np.einsum("md,md->m", b, c) * la
                + np.einsum("md,md->m", c, a) * lb
            )
            found[i] = 2 * np.arctan2(top, below).sum()
        return found / (4 * np.pi)

    return measure
