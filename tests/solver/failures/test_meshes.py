"""Meshes that fail elements: the counter-examples must fail here, the product must not."""

import numpy as np
import pytest
from scipy.sparse import diags_array
from scipy.sparse.linalg import eigsh

import fabrics
import meshes
from counter_examples import sheet_of
from morley import MorleySheet
from seatlook.errors import InvertedElementError
from seatlook.solver import solve_sheet

pytestmark = pytest.mark.failure


def threshold(element, kind, per_wave, *, tension=0.0, bend=5e-5, bed=2e6, waves=3, seed=0):
    """Buckling load of a sheet on springs over 2 sqrt(B K), minus 1; tension across the wave."""
    length = 2 * np.pi * (bend / bed) ** 0.25
    X, T = meshes.rectangle(kind, waves * length, 2 * length, length / per_wave, seed=seed)
    fabric = fabrics.isotropic(bend=bend)
    sheet = MorleySheet(X, T, fabric) if element == "morley" else sheet_of(element, X, T, fabric)

    def pulled(along, across):
        size = max(abs(along), abs(across))
        if element == "morley":
            return sheet.stress_stiffness(np.diag([along, across]) / size)
        x = np.pad(X * [1 + along, 1 + across], ((0, 0), (0, 1)))
        matrix = sheet.membrane.hessian(x).tocsr()[2::3][:, 2::3]
        return matrix / (1000.0 * size)

    springs = diags_array(sheet.mass / fabric.density * bed)
    stiff = sheet.bending.stiffness() + springs + tension * pulled(0.0, 1e-4)
    held = np.zeros(len(sheet.mass), dtype=bool)
    held[: len(X)] = (X[:, 0] < 1e-9) | (X[:, 0] > X[:, 0].max() - 1e-9)
    inner = np.flatnonzero(~held)
    top = eigsh(
        pulled(-1e-4, 0.0).tocsc()[inner][:, inner] * -1.0,
        k=1,
        M=stiff.tocsc()[inner][:, inner],
        which="LA",
        tol=1e-5,
        return_eigenvectors=False,
        v0=np.random.default_rng(0).standard_normal(len(inner)),
    )
    return 1.0 / top[0] / (2.0 * np.sqrt(bed * bend)) - 1.0


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
        solve_sheet(X, T, fabrics.isotropic())
