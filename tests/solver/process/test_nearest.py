import numpy as np
import pytest
from scipy.linalg import eigh
from scipy.sparse import csc_array, diags_array, eye_array, kron

from seatlook.errors import SolverError
from seatlook.solver.element.elastic import ElasticSheet
from seatlook.solver.methods.factor import Renewed
from seatlook.solver.process.nearest import NearestHessian, _hinges
from support import fabrics, meshes


def elastic(kind="uns", h=0.1, bend=1e-2):
    X, T = meshes.rectangle(kind, 1.0, 0.6, h)
    return X, ElasticSheet(X, T, np.zeros(len(T)), [fabrics.isotropic(1e4, bend)])


def nearest(X, sheet_, x, ties=None):
    ties = csc_array((len(X), len(X))) if ties is None else ties
    result = NearestHessian(sheet_, np.pad(X, ((0, 0), (0, 1))), ties)
    result.factor(x, csc_array(diags_array(np.ones(len(X)))), np.zeros((len(X), 3, 3)))
    return result


def inverse(result, n):
    out, columns = np.empty((n, 3)), []
    for unit in np.eye(3 * n):
        result.solve(unit.reshape(n, 3), out)
        columns.append(out.ravel().copy())
    return np.array(columns).T


@pytest.mark.parametrize("kind", ["uns", "right", "sliver"])
def test_chords_of_an_unstrained_sheet_are_its_membrane(kind):
    X, sheet_ = elastic(kind)
    turn = np.linalg.qr(np.random.default_rng(0).standard_normal((3, 3)))[0]
    x = np.ascontiguousarray(np.pad(X, ((0, 0), (0, 1))) @ turn)
    # What triangles at a rim exchange with their neighbours is left out: it reaches further.
    sheet_.membrane._share[:] = 0.0
    scalar = _hinges(sheet_) + diags_array(np.ones(len(X)))
    matrix = sheet_.membrane.hessian(x) + kron(scalar, eye_array(3))
    right = np.random.default_rng(1).standard_normal((len(X), 3))
    out = np.empty_like(right)
    nearest(X, sheet_, x).solve(right, out)
    np.testing.assert_allclose((matrix @ out.ravel()).reshape(-1, 3), right, atol=1e-5)


def test_close_to_the_projected_hessian_where_waves_are_resolved():
    X, sheet_ = elastic(h=0.09, bend=1.0)
    x = np.column_stack([1.02 * X[:, 0], X[:, 1], 0.01 * np.sin(2 * np.pi * X[:, 0])])
    matrix = sum(term.hessian(x, definite=True) for term in sheet_.energies)
    matrix = matrix + eye_array(x.size)
    values = eigh(matrix.toarray(), np.linalg.inv(inverse(nearest(X, sheet_, x), len(X))),
                  eigvals_only=True)  # fmt: skip
    print(values.min(), values.max())
    assert values.min() > 0.3
    assert values.max() < 3.0


def test_definite_however_crumpled_the_sheet():
    X, sheet_ = elastic()
    rng = np.random.default_rng(0)
    x = 0.7 * np.pad(X, ((0, 0), (0, 1))) + 0.05 * rng.standard_normal((len(X), 3))
    result = nearest(X, sheet_, x)
    right, out = rng.standard_normal((len(X), 3)), np.empty((len(X), 3))
    result.solve(right, out)
    assert (right * out).sum() > 0.0


def test_renewed_after_six_uses():
    made = []

    class One:
        def solve(self, right, out):
            np.copyto(out, right)

    def make():
        made.append(One())
        return made[-1]

    renewed = Renewed(make)
    for uses in range(1, 14):
        renewed.solve(np.ones((2, 3)), np.empty((2, 3)))
        assert len(made) == -(-uses // 6)
    renewed.expire()
    renewed.solve(np.ones((2, 3)), np.empty((2, 3)))
    assert len(made) == 4


def test_terms_outside_the_pattern_are_refused():
    X, sheet_ = elastic()
    last = len(X) - 1
    ends = ([0, last, 0, last], [last, 0, 0, last])
    far = csc_array(([-1.0, -1.0, 1.0, 1.0], ends), shape=(len(X), len(X)))
    x = np.pad(X, ((0, 0), (0, 1)))
    with pytest.raises(SolverError, match="outside the pattern"):
        NearestHessian(sheet_, x, csc_array((len(X), len(X)))).factor(
            x, far, np.zeros((len(X), 3, 3))
        )
    NearestHessian(sheet_, x, abs(far)).factor(x, far, np.zeros((len(X), 3, 3)))
