import numpy as np
import pytest
from scipy.sparse import csc_array, diags_array

from seatlook.solver import SolverSettings
from seatlook.solver.methods.factor import Factor
from seatlook.solver.methods.lbfgs import Potential
from seatlook.solver.methods.stability import downhill
from seatlook.solver.process.process import Process
from support.covers import cover, flat_foam, sheet


class Quadratic:
    def __init__(self, matrix):
        self.matrix = matrix

    def value(self, x, gradient):
        pull = self.matrix @ x
        gradient += pull
        return 0.5 * float((x * pull).sum())


def chain(n, lift):
    """Laplacian of a chain, its lowest eigenvalue moved to ``lift``."""
    matrix = 2.0 * np.eye(n) - np.eye(n, k=1) - np.eye(n, k=-1)
    return matrix + (lift - np.linalg.eigvalsh(matrix)[0]) * np.eye(n)


@pytest.mark.parametrize("lift", [1e-2, 1e-3])
def test_positive_matrices_have_no_way_down(lift):
    matrix = chain(60, lift)
    guess = Factor(csc_array(diags_array(np.full(60, 2.0))))
    assert downhill(Potential([Quadratic(matrix)]), np.zeros((60, 3)), guess, most=200) is None


@pytest.mark.parametrize("lift", [-1e-1, -1e-2, -3e-3])
def test_one_negative_eigenvalue_is_found(lift):
    matrix = chain(60, lift)
    guess = Factor(csc_array(diags_array(np.full(60, 2.0))))
    result = downhill(Potential([Quadratic(matrix)]), np.zeros((60, 3)), guess, most=200)
    assert result is not None
    assert (result * (matrix @ result)).sum() < 0.0


@pytest.mark.parametrize("method", ["lbfgs", "newton"])
def test_a_flat_cover_past_its_buckling_load_is_pushed_out_of_its_plane(method):
    process = Process(cover([sheet(0.2, 0.06, 0.02)], h=0.02), SolverSettings(method=method))
    assert not process.downhill()
    process.x[:, 0] *= 0.98
    flat = process._static.value(process.state, np.zeros_like(process.state))
    assert process.downhill(1e-4)
    assert 5e-5 < np.abs(process.x[:, 2]).max() <= 1e-4
    assert process._static.value(process.state, np.zeros_like(process.state)) < flat


@pytest.mark.parametrize(("compression", "unstable"), [(0.012, False), (0.014, True)])
def test_a_cover_on_foam_is_unstable_from_its_buckling_load_on(compression, unstable):
    """A rectangle of 0.2 x 0.1 m pressed 0.02 mm into the foam, between rigid ends."""
    rectangle = sheet(0.2, 0.1, 0.01, z=0.0005, at=(-0.1, -0.05))
    process = Process(cover([rectangle], foam=flat_foam(0.4), h=0.01))
    process.begin(rest=True)
    process.x[:, 0] *= 1.0 - compression
    process.x[:, 2] -= 2e-5
    process.record()
    assert process.downhill() == unstable
