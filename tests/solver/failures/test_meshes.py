"""Meshes that fail elements: the counter-examples must fail here, the product must not."""

import numpy as np
import pytest

from seatlook.errors import InvertedElementError
from seatlook.solver import Sheet, solve_sheet
from support import fabrics, meshes
from support.reference.buckling import threshold

pytestmark = pytest.mark.failure


def test_linear_membrane_under_tension_hides_buckling():
    """Tension across a wave costs nothing; in linear triangles it acts as bending stiffness."""
    # T h^2 = 30 B.
    options = {"tension": 6000.0, "bed": 2e6}
    assert threshold("hinge", "uns", 8, **options) > 0.1
    assert abs(threshold("edgeslope", "uns", 8, **options)) < 0.04


@pytest.mark.parametrize("kind", ["alt", "cross"])
def test_four_valent_meshes(kind):
    """Hinges and six-node patches do not converge on them."""
    assert abs(threshold("hinge", kind, 12)) > 0.05
    assert abs(threshold("patch6", kind, 12)) > 0.05
    assert abs(threshold("edgeslope", kind, 12)) < 0.03


def test_reference_converges_under_tension():
    """Morley's plate: second order, with slopes as unknowns beside the vertices."""
    errors = [abs(threshold("morley", "uns", n, tension=2000.0)) for n in (6, 12)]
    assert errors[1] < 0.01
    assert errors[0] / errors[1] > 3.0


def test_slivers():
    assert abs(threshold("edgeslope", "sliver", 12)) < 0.02


def test_inverted_triangles_are_refused():
    X, T = meshes.rectangle("uns", 1.0, 0.5, 0.1)
    middle = np.argmin(np.linalg.norm(X - [0.5, 0.25], axis=1))
    X[middle] += [0.25, 0.0]
    with pytest.raises(InvertedElementError, match="turned over or have no area"):
        solve_sheet(Sheet(X, T, fabrics.isotropic()))
