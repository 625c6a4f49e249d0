import numpy as np
import pytest
from scipy.sparse import csc_array, csr_array
from scipy.sparse.linalg import spsolve

from seatlook.solver.kernels import fronts
from seatlook.solver.methods.multifrontal import Cholesky, Pattern
from support import meshes


def problem(size, seed=0, h=0.05, far=0):
    """Blocks of a random definite matrix on a mesh, and the matrix; ``far`` pairs lie apart."""
    X, T = meshes.rectangle("uns", 1.0, 0.6, h)
    rng = np.random.default_rng(seed)
    pairs = np.concatenate([T[:, [0, 1]], T[:, [1, 2]], T[:, [2, 0]]])
    pairs = np.concatenate([pairs, rng.integers(0, len(X), (far, 2))])
    pairs = np.unique(np.sort(pairs, axis=1), axis=0)
    pairs = pairs[pairs[:, 0] != pairs[:, 1]]
    n = len(X)
    rows = np.concatenate([pairs[:, 1], np.arange(n)])
    columns = np.concatenate([pairs[:, 0], np.arange(n)])
    blocks = rng.standard_normal((len(rows), size, size))
    own = blocks[len(pairs) :]
    blocks[len(pairs) :] = own + own.transpose(0, 2, 1)
    full = np.zeros((n, size, n, size))
    for r, c, block in zip(rows, columns, blocks, strict=True):
        full[r, :, c] = block
        full[c, :, r] = block.T
    full = full.reshape(n * size, n * size)
    heavy = 1.0 + np.abs(full).sum(axis=1).max()
    blocks[len(pairs) :] += heavy * np.eye(size)
    return X, rows, columns, blocks, full + heavy * np.eye(n * size)


@pytest.mark.parametrize("size", [1, 2, 3, 4])
@pytest.mark.parametrize("far", [0, 12])
def test_solves_what_a_dense_solver_solves(size, far):
    X, rows, columns, blocks, full = problem(size, far=far)
    cholesky = Cholesky(Pattern(rows, columns, len(X), size=size))
    assert len(cholesky._pattern.children) > 8
    assert cholesky.factor(blocks)
    right = np.random.default_rng(1).standard_normal((len(X), size))
    expected = np.linalg.solve(full, right.ravel()).reshape(-1, size)
    np.testing.assert_allclose(cholesky.solve(right), expected, rtol=1e-10, atol=1e-13)


def test_several_right_hand_sides_of_a_scalar_matrix():
    X, rows, columns, blocks, full = problem(1)
    cholesky = Cholesky(Pattern(rows, columns, len(X)))
    assert cholesky.factor(blocks)
    right = np.random.default_rng(1).standard_normal((len(X), 3))
    np.testing.assert_allclose(cholesky.solve(right), np.linalg.solve(full, right), rtol=1e-10)


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_blocks_may_be_given_either_way_round(seed):
    X, rows, columns, blocks, _ = problem(3, h=0.2)
    turn = np.random.default_rng(seed).random(len(rows)) < 0.5
    other = np.where(turn, columns, rows), np.where(turn, rows, columns)
    turned = np.where(turn[:, None, None], blocks.transpose(0, 2, 1), blocks)
    one, two = (Cholesky(Pattern(*at, len(X), size=3)) for at in ((rows, columns), other))
    assert one.factor(blocks)
    assert two.factor(turned)
    right = np.ones((len(X), 3))
    np.testing.assert_array_equal(one.solve(right), two.solve(right))


def test_indefinite_matrices_are_refused_and_leave_no_trace():
    X, rows, columns, blocks, full = problem(3)
    cholesky = Cholesky(Pattern(rows, columns, len(X), size=3))
    bad = blocks.copy()
    bad[-1] -= 1e3 * np.eye(3)
    assert not cholesky.factor(bad)
    assert cholesky.factor(blocks)
    right = np.ones((len(X), 3))
    expected = np.linalg.solve(full, right.ravel()).reshape(-1, 3)
    np.testing.assert_allclose(cholesky.solve(right), expected, rtol=1e-10)


def test_same_bits_from_the_same_matrix():
    X, rows, columns, blocks, _ = problem(3)
    answers = []
    for _ in range(2):
        cholesky = Cholesky(Pattern(rows, columns, len(X), size=3))
        assert cholesky.factor(blocks)
        answers.append(cholesky.solve(np.ones((len(X), 3))).tobytes())
    assert answers[0] == answers[1]


def test_factor_of_a_mesh_stays_sparse():
    """George (1973) counts 31/4 n log2 n entries on a grid of n vertices, a band has n^1.5."""
    size = []
    for h in (0.04, 0.02):
        X, T = meshes.rectangle("right", 1.0, 1.0, h)
        graph = csr_array((np.ones(9 * len(T)), (np.repeat(T, 3), np.tile(T, (1, 3)).ravel())))
        rows, columns = csc_array(graph).tocoo().coords
        lower = rows >= columns
        rows, columns = rows[lower].astype(np.int64), columns[lower].astype(np.int64)
        cholesky = Cholesky(Pattern(rows, columns, len(X)))
        size.append((len(X), cholesky._storage.size))
    (few, small), (many, large) = size
    assert large / small < 1.35 * many / few
    assert large < 31 / 4 * many * np.log2(many)


def test_order_and_fronts_of_any_graph():
    """Two parts that do not touch, a vertex by itself, a clique: one order, and no fill is lost."""
    X, rows, columns, *_ = problem(1, h=0.1)
    n, clique = len(X), 40
    pairs = np.stack([rows, columns], axis=1)
    dense = 2 * n + np.stack(np.tril_indices(clique), axis=1)
    single = np.full((1, 2), 2 * n + clique)
    pairs = np.concatenate([pairs, pairs + n, dense, single])
    pattern = Pattern(*pairs.T.copy(), 2 * n + clique + 1)
    np.testing.assert_array_equal(np.sort(pattern.order), np.arange(2 * n + clique + 1))
    rank = np.argsort(pattern.order)
    matrix = np.eye(2 * n + clique + 1) * 200.0
    ends = rank[pairs]
    matrix[ends[:, 0], ends[:, 1]] += 1.0
    matrix[ends[:, 1], ends[:, 0]] += 1.0
    fill = np.abs(np.linalg.cholesky(matrix)) > 1e-14
    for f, last in enumerate(pattern.starts[1:]):
        own = fill[last:, pattern.starts[f] : last]
        rim = pattern.rims[pattern.rim_at[f] : pattern.rim_at[f + 1]]
        assert (np.diff(rim) > 0).all()
        assert set(last + np.flatnonzero(own.any(axis=1))) <= set(rim.tolist())


def test_wide_fronts_and_deep_updates_take_blocks_and_strips():
    """A torus of far neighbours has separators beyond the blocks and strips of a front."""
    n, away = 900, (1, 2, 30, 31, 60)
    rows = np.concatenate([np.arange(n), *[np.arange(n)] * len(away)])
    columns = np.concatenate([np.arange(n), *[(np.arange(n) + k) % n for k in away]])
    blocks = np.full((len(rows), 1, 1), -1.0)
    blocks[:n] = 2.0 * len(away) + 0.1
    pattern = Pattern(rows, columns, n)
    assert np.diff(pattern.starts).max() > fronts.BLOCK
    assert np.diff(pattern.rim_at).max() > 60
    full = np.zeros((n, n))
    full[rows, columns] = blocks[:, 0, 0]
    full = np.maximum(full, 0.0) + np.minimum(full, 0.0) + np.minimum(full.T, 0.0)
    cholesky = Cholesky(pattern)
    assert cholesky.factor(blocks)
    right = np.random.default_rng(2).standard_normal((n, 4))
    expected = np.linalg.solve(full, right)
    np.testing.assert_allclose(cholesky.solve(right), expected, rtol=1e-10, atol=1e-13)
    np.testing.assert_allclose(cholesky.solve(right[:, :3]), expected[:, :3], rtol=1e-10)


def test_strips_of_an_update_equal_one_product():
    below = np.random.default_rng(0).standard_normal((7, 2 * fronts.STRIP + 5))
    rest = np.zeros((below.shape[1], below.shape[1]))
    work = np.empty((7 + fronts.STRIP) * (below.shape[1] + fronts.STRIP))
    fronts.update_rim(below, rest, work)
    np.testing.assert_allclose(np.triu(rest), np.triu(-below.T @ below), atol=1e-12)


def test_agrees_with_scipy_on_a_laplacian():
    X, T = meshes.rectangle("sliver", 1.0, 1.0, 0.1)
    n = len(X)
    pairs = np.unique(np.sort(np.concatenate([T[:, :2], T[:, 1:], T[:, [2, 0]]]), axis=1), axis=0)
    matrix = csc_array((np.full(len(pairs), -1.0), pairs.T), shape=(n, n))
    matrix = matrix + matrix.T + csc_array(np.diag(np.full(n, 0.1) - (matrix + matrix.T).sum(0)))
    rows, columns = np.concatenate([pairs[:, ::-1], np.repeat(np.arange(n)[:, None], 2, 1)]).T
    dense = matrix.toarray()
    cholesky = Cholesky(Pattern(rows, columns, len(X)))
    assert cholesky.factor(dense[rows, columns][:, None, None])
    right = np.arange(float(n))[:, None]
    np.testing.assert_allclose(cholesky.solve(right)[:, 0], spsolve(matrix, right[:, 0]), rtol=1e-9)
