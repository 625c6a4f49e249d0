"""The folds of a hem carry bending moment across a seam, neither more nor less than they should."""

import dataclasses

import numpy as np
import pytest
from scipy.sparse import csc_array, csr_array
from scipy.sparse.linalg import spsolve

from seatlook import model
from seatlook.errors import InputError
from seatlook.solver.element.edgeslope import edges_of, slope_rows
from seatlook.solver.element.elastic import ElasticSheet
from seatlook.solver.element.hem import Folds
from support import fabrics, meshes

LENGTH, WIDTH, BEND = 0.2, 0.05, 6e-3


def strips(h, h_far, kind="uns"):
    """Two halves of a strip, each on its own mesh; their rims meet at x = LENGTH / 2."""
    X, T = meshes.rectangle(kind, LENGTH / 2, WIDTH, h)
    Y, U = meshes.rectangle(kind, LENGTH / 2, WIDTH, h_far, seed=1)
    rest = np.concatenate([X, Y + np.array([LENGTH / 2, 0.0])])
    return rest, np.concatenate([T, U + len(X)]), len(X)


def rims(rest, n):
    """Vertices of both rims at the seam, from y = 0 up."""
    at = np.abs(rest[:, 0] - LENGTH / 2) < 1e-9
    both = (
        np.flatnonzero(at & (np.arange(len(rest)) < n)),
        np.flatnonzero(at & (np.arange(len(rest)) >= n)),
    )
    return [r[np.argsort(rest[r, 1])] for r in both]


def hem(rest, faces, n, stiffness):
    """Folds alone: no second layer."""
    a, b = rims(rest, n)
    if len(a) > len(b):
        a, b = b, a
    ends = [np.column_stack([rest[r[:-1], 1], rest[r[1:], 1]]) for r in (a, b)]
    shared = np.minimum(ends[0][:, 1:], ends[1][:, 1]) - np.maximum(ends[0][:, :1], ends[1][:, 0])
    row, other = np.nonzero(shared > 1e-9)
    length = np.diff(ends[0])[:, 0]
    return model.Hem(
        bending=np.zeros((len(faces), 3, 3)),
        density=np.zeros(len(faces)),
        lift=np.zeros(len(rest)),
        near=np.column_stack([a[:-1], a[1:]]),
        far=np.column_stack([b[:-1], b[1:]])[other],
        row=row,
        weight=shared[row, other] / length[row],
        length=length,
        stiffness=np.full(len(length), stiffness),
    )


def sewn_sheet(h, h_far, stiffness, kind="uns", *, clamped=False):
    rest, faces, n = strips(h, h_far, kind)
    folds = hem(rest, faces, n, stiffness)
    fabric = fabrics.isotropic(bend=BEND, poisson=0.0)
    held = rest[:, 0] < 1e-9 if clamped else None
    panel = np.zeros(len(faces))
    return rest, n, ElasticSheet(rest, faces, panel, [fabric], hem=folds, clamped=held)


def merged(rest, n):
    """(all, free) matrix: far rim vertices follow the near rim, which may have other vertices."""
    a, b = rims(rest, n)
    free = np.setdiff1d(np.arange(len(rest)), b)
    place = np.full(len(rest), -1)
    place[free] = np.arange(len(free))
    rows, columns, values = [*free], [*place[free]], [1.0] * len(free)
    for v in b:
        k = np.clip(np.searchsorted(rest[a, 1], rest[v, 1]) - 1, 0, len(a) - 2)
        w = (rest[v, 1] - rest[a[k], 1]) / (rest[a[k + 1], 1] - rest[a[k], 1])
        rows += [v, v]
        columns += [place[a[k]], place[a[k + 1]]]
        values += [1.0 - w, w]
    return csr_array((values, (rows, columns)), shape=(len(rest), len(free)))


def tip(h, h_far, stiffness):
    """Deflection of the end of a cantilever under unit force."""
    return deflection(*sewn_sheet(h, h_far, stiffness, clamped=True))


def deflection(rest, n, sheet):
    """The same of a given sheet, clamped at x = 0."""
    join = merged(rest, n)
    matrix = csc_array(join.T @ sheet.across() @ join)
    end = np.flatnonzero(rest[:, 0] > LENGTH - 1e-9)
    end = end[np.argsort(rest[end, 1])]
    length = np.diff(rest[end, 1])
    share = np.zeros(len(rest))
    share[end] = np.concatenate([[0.0], length]) + np.concatenate([length, [0.0]])
    share /= share.sum()
    free = np.flatnonzero(~(join.T @ (rest[:, 0] < 1e-9) > 0))
    z = np.zeros(join.shape[1])
    z[free] = spsolve(matrix[free][:, free], (join.T @ share)[free])
    return float(share @ (join @ z))


@pytest.mark.parametrize(("h", "h_far"), [(0.01, 0.01), (0.01, 0.006), (0.006, 0.01)])
def test_soft_and_stiff_folds_turn_by_the_moment_over_their_stiffness(h, h_far):
    """A fold adds M / k of angle: tip F (L - a)^2 / k, times width; a stiff one adds nothing."""
    stiff = tip(h, h_far, 1e3 * BEND / h)
    whole = LENGTH**3 / (3.0 * BEND * WIDTH)
    print(f"stiff {stiff / whole:.4f}")
    assert stiff == pytest.approx(whole, rel=0.03)
    for k in (0.3, 1.0):
        soft = tip(h, h_far, k)
        added = (LENGTH / 2) ** 2 / (k * WIDTH)
        print(f"k {k}: {(soft - stiff) / added:.4f}")
        assert soft - stiff == pytest.approx(added, rel=0.02)


@pytest.mark.parametrize("kind", ["uns", "right", "sliver"])
def test_constant_moment_passes_the_seam(kind):
    """Quadratic on both sides, turned at the seam by M / k: no vertex there is out of balance."""
    k = 0.8
    rest, n, sheet = sewn_sheet(0.01, 0.007, k, kind)
    curvature = 0.5
    x = rest[:, 0] - LENGTH / 2
    z = 0.5 * curvature * x**2 + np.where(np.arange(len(rest)) < n, 0.0, BEND * curvature / k) * x
    join = merged(rest, n)
    force = join.T @ (sheet.across() @ z)
    y = rest[:, 1] @ join / np.asarray(join.sum(axis=0))
    near = np.abs(x @ join / np.asarray(join.sum(axis=0))) < 0.03
    inside = near & (y > 0.012) & (y < WIDTH - 0.012)
    assert inside.sum() > 10
    edge = np.abs(force).max()
    assert np.abs(force[inside]).max() < 1e-9 * edge


def test_energy_and_gradient():
    rest, _, sheet = sewn_sheet(0.02, 0.015, 0.7)
    rng = np.random.default_rng(0)
    x, d = rng.standard_normal((2, len(rest), 3))
    out = np.zeros_like(x)
    value = sheet.folds.value(x, out)
    rise = sheet.folds.value(x + 1e-3 * d, np.zeros_like(x)) - sheet.folds.value(
        x - 1e-3 * d, np.zeros_like(x)
    )
    assert rise / 2e-3 == pytest.approx((out * d).sum(), rel=1e-8)
    assert value == pytest.approx(0.5 * (x * (sheet.folds.matrix() @ x)).sum())
    np.testing.assert_allclose(
        sheet.folds.hessian(x) @ d.ravel(), (sheet.folds.matrix() @ d).ravel(), atol=1e-9
    )


@pytest.mark.parametrize("angle", [0.2, 1.0])
def test_moment_of_a_folded_sheet(angle):
    """Both halves flat, at an angle to each other: M = k sin(angle)."""
    rest, n, sheet = sewn_sheet(0.02, 0.015, 0.7)
    x = rest[:, 0] - LENGTH / 2
    far = np.arange(len(rest)) >= n
    turned = np.column_stack(
        [np.where(far, np.cos(angle) * x, x), rest[:, 1], np.where(far, np.sin(angle) * x, 0.0)]
    )
    np.testing.assert_allclose(sheet.folds.moments(turned), 0.7 * np.sin(angle), rtol=1e-9)


def test_matrix_of_the_minimiser_has_the_folds_and_bending_below_them():
    """But not that of the rest, which would cost three times the entries."""
    rest, faces, n = strips(0.02, 0.015)
    fabric = fabrics.isotropic(bend=BEND, poisson=0.0)
    bare = hem(rest, faces, n, 0.7)
    over = np.abs(rest[faces, 0].mean(axis=1) - LENGTH / 2) < 0.02
    covered = dataclasses.replace(bare, density=np.where(over, 0.5, 0.0))
    for folds, some in ((bare, np.zeros(len(faces), dtype=bool)), (covered, over)):
        sheet = ElasticSheet(rest, faces, np.zeros(len(faces)), [fabric], hem=folds)
        extra = sheet.stiffness() - sheet.membrane.stiffness() - sheet.folds.matrix()
        touched = np.flatnonzero(np.abs(extra).sum(axis=1) > 1e-9)
        assert bool(len(touched)) == some.any()
        full = sheet.stiffness(True) - sheet.membrane.stiffness() - sheet.across()
        assert np.abs(full).max() < 1e-9
        # A patch of bending reaches one ring of triangles beyond its own.
        assert (np.abs(rest[touched, 0] - LENGTH / 2) < 0.02 + 3 * 0.02).all()


@pytest.mark.parametrize("angle", [0.4, 1.1])
def test_every_fold_has_a_stiffness_and_a_length_of_its_own(angle):
    """Of unlike fabrics and edges: energy sum 1/2 k l (2 sin(angle / 2))^2, moments k sin(angle).

    With the halves apart as well: a gap between them bends nothing.
    """
    rest, faces, n = strips(0.01, 0.006, "graded")
    plain = hem(rest, faces, n, 1.0)
    k = np.geomspace(0.1, 5.0, len(plain.near))
    folds = Folds(
        dataclasses.replace(plain, stiffness=k),
        edges_of(rest, faces),
        slope_rows(rest, faces, edges_of(rest, faces)),
    )
    assert np.ptp(plain.length) > 0.3 * plain.length.mean()
    x, far = rest[:, 0] - LENGTH / 2, np.arange(len(rest)) >= n
    turned = np.column_stack([
        np.where(far, np.cos(angle) * x + 0.003, x), rest[:, 1] - 0.001 * far,
        np.where(far, np.sin(angle) * x - 0.002, 0.0),
    ])  # fmt: skip
    np.testing.assert_allclose(folds.moments(turned), k * np.sin(angle), rtol=1e-9)
    energy = 0.5 * (k @ plain.length) * (2 * np.sin(angle / 2)) ** 2
    assert folds.value(turned, np.zeros_like(turned)) == pytest.approx(energy, rel=1e-9)


def test_only_the_mean_over_what_is_sewn_to_an_edge_counts():
    """The far half twisted, so that no two of its edges slope alike: each row by its shares."""
    rest, faces, n = strips(0.01, 0.006, "graded")
    plain = hem(rest, faces, n, 1.0)
    k = np.linspace(1.0, 2.0, len(plain.near))
    edges = edges_of(rest, faces)
    folds = Folds(dataclasses.replace(plain, stiffness=k), edges, slope_rows(rest, faces, edges))
    x, y = rest.T
    far = np.arange(len(rest)) >= n
    z = np.where(far, 1e-3 * (x - LENGTH / 2) * (1 + 40 * y), 0.0)
    flat = np.column_stack([rest, z])
    middle = rest[plain.far, 1].mean(axis=1)
    slope = np.bincount(plain.row, plain.weight * 1e-3 * (1 + 40 * middle))
    np.testing.assert_allclose(folds.moments(flat), k * slope, rtol=2e-3)
    energy = 0.5 * (k * plain.length) @ slope**2
    assert folds.value(flat, np.zeros_like(flat)) == pytest.approx(energy, rel=4e-3)
    assert energy != pytest.approx(0.5 * (k * plain.length).mean() * (slope**2).sum(), rel=0.02)
    assert np.ptp(slope) > 0.5 * slope.mean()


@pytest.mark.parametrize(("root", "end"), [(6e-3, 1.5e-3), (2e-3, 9e-3)])
def test_cantilever_of_two_fabrics(root, end):
    """Tip under unit force: each part bends by its own stiffness, the fold turns by M / k."""
    k, half = 0.6, LENGTH / 2
    rest, faces, n = strips(0.01, 0.006)
    fabric_of = [fabrics.isotropic(bend=b, poisson=0.0) for b in (root, end)]
    owner = (faces[:, 0] >= n).astype(int)
    sheet = ElasticSheet(
        rest, faces, owner, fabric_of, hem=hem(rest, faces, n, k), clamped=rest[:, 0] < 1e-9
    )
    exact = (LENGTH**3 - half**3) / (3 * root) + half**3 / (3 * end) + half**2 / k
    assert deflection(rest, n, sheet) == pytest.approx(exact / WIDTH, rel=0.025)


def test_inner_edges_are_no_rim():
    rest, faces, n = strips(0.02, 0.02)
    edges = edges_of(rest, faces)
    good = hem(rest, faces, n, 1.0)
    inner = edges.ends[~edges.free][:1].repeat(len(good.near), axis=0)
    bad = model.Hem(**{f: getattr(good, f) for f in good.__slots__} | {"near": inner})
    with pytest.raises(InputError, match="edges inside a panel, expected edges of the rim"):
        Folds(bad, edges, slope_rows(rest, faces, edges))
