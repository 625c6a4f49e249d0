import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.solver.element.elastic import ElasticSheet
from seatlook.solver.element.shell import Shell
from support import fabrics, meshes, naive, taylor

RADIUS = 0.5


def cylinder(X):
    """A map that is true to length."""
    turn = X[:, 1] / RADIUS
    return np.column_stack([X[:, 0], RADIUS * np.sin(turn), RADIUS * np.cos(turn)])


def ball(X):
    """A part of the unit ball, by longitude and latitude."""
    along, up = X.T
    return np.column_stack([np.sin(along) * np.cos(up), np.sin(up), np.cos(along) * np.cos(up)])


def shell(shape, kind="uns", h=0.1, fabric=None, **options):
    X, T = meshes.rectangle(kind, 1.0, 0.8, h)
    natural = shape(X)
    fabric = fabric or fabrics.isotropic(poisson=0.3)
    return X, natural, Shell(X, T, fabric, natural=natural, **options)


def gradient(energy, x):
    out = np.zeros_like(x)
    energy.value(x, out)
    return out


def rate(sizes, errors):
    return np.polyfit(np.log(sizes), np.log(errors), 1)[0]


@pytest.mark.parametrize("shape", [cylinder, ball])
@pytest.mark.parametrize("kind", ["uns", "sliver"])
@pytest.mark.parametrize("clamped", [False, True])
def test_nothing_holds_a_shell_where_it_is_free_of_stress(shape, kind, clamped):
    X, T = meshes.rectangle(kind, 1.0, 0.8, 0.1)
    held = {"clamped": X[:, 0] < 1e-9} if clamped else {}
    _, natural, s = shell(shape, kind, fabric=fabrics.woven(), **held)
    bend = np.abs(gradient(s.bending, 1.01 * natural)).max()
    pull = np.abs(gradient(s.membrane, 1.01 * natural)).max()
    # Free, it may lie anywhere; clamped, it is where it was.
    rng = np.random.default_rng(1)
    x = natural if clamped else natural @ fabrics.rotation(rng).T + rng.standard_normal(3)
    assert abs(s.bending.value(x, np.zeros_like(x))) < 1e-18
    assert np.abs(gradient(s.bending, x)).max() < 1e-9 * bend
    assert np.abs(gradient(s.membrane, x)).max() < 1e-9 * pull
    np.testing.assert_allclose(s.curvatures(x), 0.0, atol=1e-9)
    np.testing.assert_allclose(s.strains(x), 0.0, atol=1e-12)
    assert len(T) == len(s.area)


@pytest.mark.parametrize("shape", [cylinder, ball])
@pytest.mark.parametrize("clamped", [False, True])
def test_energy_gradient_and_hessian_agree(shape, clamped):
    X, _ = meshes.rectangle("sliver", 1.0, 0.8, 0.15)
    held = {"clamped": X[:, 0] < 1e-9} if clamped else {}
    _, natural, s = shell(shape, "sliver", 0.15, **held)
    x = natural + 0.02 * np.random.default_rng(2).standard_normal(natural.shape)
    for energy in (s.bending, s.membrane):
        first, second = taylor.slopes(energy, x, size=1e-3)
        assert first > 1.95
        assert second > 1.7
        H = energy.hessian(x)
        assert abs(H - H.T).max() < 1e-9 * abs(H).max()


def test_projected_hessian_has_no_negative_eigenvalue():
    _, natural, s = shell(ball, h=0.2)
    x = natural + 0.02 * np.random.default_rng(3).standard_normal(natural.shape)
    values = np.linalg.eigvalsh(s.bending.hessian(x, definite=True).toarray())
    assert values[0] > -1e-9 * values[-1]
    assert np.linalg.eigvalsh(s.bending.hessian(x).toarray())[0] < -1e-6 * values[-1]


@pytest.mark.parametrize("shape", [cylinder, ball])
def test_bending_equals_its_twin(shape):
    """Loops over triangles and edges, one at a time."""
    X, natural, s = shell(shape, "sliver", 0.2)
    x = natural + 0.03 * np.random.default_rng(4).standard_normal(natural.shape)
    b = s.bending
    dense = b._second.toarray().reshape(len(s.faces), 3, -1)
    stiffness = np.tile(fabrics.isotropic(poisson=0.3).bending_matrix, (len(s.faces), 1, 1))
    stiffness = np.swapaxes(b.measure, 1, 2) @ stiffness @ b.measure
    value = naive.shell_bending(dense, b.natural, x, s, stiffness)
    assert b.value(x, np.zeros_like(x)) == pytest.approx(value, rel=1e-12)
    assert len(X) == dense.shape[2]


@pytest.mark.parametrize("shape", [cylinder, ball])
def test_rows_within_the_shape_are_those_of_the_flat_mesh_less_what_lies_in_it(shape):
    X, natural, s = shell(shape, "uns", 0.2)
    flat = ElasticSheet(X, s.faces, np.zeros(len(s.faces)), [fabrics.isotropic(poisson=0.3)])
    inner = ~s.edges.free[s.edges.of_face].any(axis=1)
    H = flat._curvature.at(natural)[inner]
    p = natural[s.faces[inner]]
    d = np.linalg.inv(np.diff(X[s.faces[inner]], axis=1)) @ np.diff(p, axis=1)
    for t in range(len(H)):
        part = np.linalg.lstsq(d[t].T, H[t].T, rcond=None)[0]
        expected = H[t] - part.T @ d[t]
        np.testing.assert_allclose(s._curvature.at(natural)[inner][t], expected, atol=1e-10)


def test_shape_is_measured_with_a_rate_and_a_bound():
    """Length, angle and curvature of a cylinder (none lost) and of a ball (from its map)."""
    sizes, errors = np.array([0.2, 0.1, 0.05]), []
    for h in sizes:
        X, _, s = shell(cylinder, h=h)
        length = abs(s.shape.measure - np.eye(3)).max()
        flat = np.pad(X, ((0, 0), (0, 1)))
        inner = ~s.edges.free[s.edges.of_face].any(axis=1)
        bend = abs(s.curvatures(flat)[inner, 1, 1] + 1 / RADIUS).max()
        X, _, s = shell(ball, h=h)
        area = abs(s.area.sum() - np.sin(0.8))
        errors.append([length, bend * RADIUS, area / np.sin(0.8)])
    length, bend, area = np.array(errors).T
    assert rate(sizes, length) > 3.5
    assert length[-1] < 1e-5
    assert rate(sizes, bend) > 1.8
    assert bend[-1] < 2e-3
    assert rate(sizes, area) > 1.8
    assert area[-1] < 1e-3


@pytest.mark.parametrize("kind", meshes.KINDS)
def test_patch_of_a_cylinder_stretched_along_its_axis(kind):
    """Strain is uniform, and so is the stress: hardly anything pulls on a vertex inside."""
    X, natural, s = shell(cylinder, kind, fabric=fabrics.isotropic(1000.0, 1e-6))
    x = natural * [1.01, 1.0, 1.0]
    expected = [0.5 * (1.01**2 - 1), 0.0, 0.0]
    assert abs(s.membrane.strain(x) - expected).max() < 2e-6
    force = gradient(s.membrane, x)
    inside = ((X > 0.25) & (X < [0.75, 0.55])).all(axis=1)
    bar = {"cross": 0.02, "sliver": 0.03}.get(kind, 1e-3)
    assert abs(force[inside]).max() < bar * abs(force).max()


@pytest.mark.parametrize("kind", meshes.KINDS)
def test_patch_of_a_cylinder_pressed_flat(kind):
    """The same moment everywhere, but for the scatter of the curvature that is measured."""
    X, _, s = shell(cylinder, kind)
    force = gradient(s.bending, np.pad(X, ((0, 0), (0, 1))))
    inside = ((X > 0.25) & (X < [0.75, 0.55])).all(axis=1)
    assert inside.sum() > 5
    bar = {"alt": 0.03, "sliver": 0.12}.get(kind, 0.01)
    assert abs(force[inside]).max() < bar * abs(force).max()


def test_a_shape_that_is_flat_changes_nothing():
    X, T = meshes.rectangle("uns", 1.0, 0.8, 0.15)
    flat = np.pad(X, ((0, 0), (0, 1)))
    x = flat + 0.02 * np.random.default_rng(5).standard_normal(flat.shape)
    plain, same = (Shell(X, T, fabrics.woven(), natural=natural) for natural in (None, flat))
    for one, other in zip(plain.energies, same.energies, strict=True):
        assert one.value(x, np.zeros_like(x)) == pytest.approx(other.value(x, np.zeros_like(x)))
        np.testing.assert_allclose(gradient(one, x), gradient(other, x), rtol=1e-9, atol=1e-9)


def test_fabric_and_size_do_not_depend_on_the_map():
    """The same ball by two maps: as heavy, and as stiff against being blown up."""
    X, T = meshes.rectangle("uns", 1.0, 0.8, 0.04)
    Y = np.column_stack([X[:, 0], np.arctanh(np.sin(X[:, 1]))])
    energies = []
    for rest in (X, Y):
        s = Shell(rest, T, fabrics.isotropic(poisson=0.3), natural=ball(X))
        x = 1.05 * ball(X)
        zero = np.zeros_like(x)
        energies.append([s.mass.sum(), s.membrane.value(x, zero), s.bending.value(x, zero)])
    np.testing.assert_allclose(energies[0], energies[1], rtol=0.01)
    strain = 0.5 * (1.05**2 - 1)
    exact = np.sin(0.8) * 0.5 * 1000.0 * 2 * (1.0 + 0.3) * strain**2
    assert energies[0][1] == pytest.approx(exact, rel=2e-3)


@pytest.mark.parametrize(
    ("natural", "message"),
    [
        (np.zeros((4, 2)), r"natural: got \(4, 2\), expected \(4, 3\) finite positions"),
        (np.full((4, 3), np.nan), "finite positions"),
        (np.zeros((4, 3)), "natural: got 2 triangles without area, first 0"),
    ],
)
def test_a_shape_that_is_none_is_refused(natural, message):
    X, T = meshes.rectangle("right", 1.0, 1.0, 1.0)
    with pytest.raises(InputError, match=message):
        Shell(X, T, fabrics.isotropic(), natural=natural)
