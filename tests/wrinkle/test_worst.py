"""A groove of known place, length and depth is found, cut and explained."""

from dataclasses import replace

import numpy as np
import pytest

from seatlook import wrinkle
from seatlook.errors import InputError
from seatlook.model import Anchor, Points, Stitching
from seatlook.wrinkle.worst import cause_of
from support.wrinkle_samples import SIZE, shaped


def groove(x0, y0, *, depth=0.0015, width=0.006, length=0.03):
    """A dent: Gaussian across, flat along with smooth ends."""

    def dent(X):
        across = np.exp(-(((X[:, 0] - x0) / width) ** 2))
        end = 1 / (1 + ((X[:, 1] - y0) / (0.5 * length)) ** 8)
        return -depth * across * end

    return dent  # fmt: skip


def cover_with(*dents, **options):
    def shape(X):
        return np.column_stack([X, sum((d(X) for d in dents), np.zeros(len(X)))])

    return shaped(shape, h=0.002, **options)


def judged(solution):
    return wrinkle.wrinkle_indices(
        *wrinkle.surface_strains(solution), solution.cover.thickness, 20.0, "tensor"
    )


def test_two_grooves_are_ranked_and_measured():
    deep, low = groove(0.04, 0.06), groove(0.09, 0.06, depth=0.0011, length=0.02)
    solution = cover_with(deep, low)
    found = wrinkle.worst_wrinkles(solution, judged(solution))
    assert len(found) >= 2
    first, second = found[:2]
    assert first.rest[0] == pytest.approx(0.04, abs=0.002)
    assert second.rest[0] == pytest.approx(0.09, abs=0.002)
    np.testing.assert_allclose(first.uv, first.rest + 0.01)
    assert first.position[2] == pytest.approx(-0.0015, abs=0.0002)
    assert first.depth == pytest.approx(0.0015, rel=0.05)
    assert second.depth == pytest.approx(0.0011, rel=0.05)
    assert abs(first.along[1]) > 0.99
    assert first.length == pytest.approx(0.03, rel=0.25)
    assert first.width < 0.01
    assert first.w2_max > 1
    assert first.w2_area > second.w2_area
    assert (first.panel, first.zone) == ("P0", "P0")
    assert wrinkle.worst_wrinkles(solution, judged(solution), count=1)[0].rest[0] == first.rest[0]


def test_smooth_cover_has_no_wrinkles():
    solution = cover_with(groove(0.06, 0.06, depth=1e-5))
    assert wrinkle.worst_wrinkles(solution, judged(solution)) == ()


def test_section_shows_the_profile():
    solution = cover_with(groove(0.05, 0.06))
    cut = wrinkle.section(
        solution.cover, solution.positions, panel=0, middle=np.array([0.05, 0.06]),
        direction=np.array([2.0, 0.0]), half_length=0.02,
    )  # fmt: skip
    exact = -0.0015 * np.exp(-((cut.along / 0.006) ** 2))
    np.testing.assert_allclose(cut.height, exact, atol=5e-5)
    assert cut.depth == pytest.approx(0.0015, rel=0.03)
    assert cut.along[0] == pytest.approx(-0.02)
    np.testing.assert_allclose(cut.points[:, 1], 0.06, atol=1e-9)


def test_section_ends_where_the_panel_does():
    solution = cover_with(groove(0.05, 0.06))
    options = {"panel": 0, "direction": np.array([0.0, 1.0]), "half_length": 0.05}
    cut = wrinkle.section(
        solution.cover, solution.positions, middle=np.array([0.05, 0.1]), **options
    )
    assert cut.along[-1] == pytest.approx(SIZE - 0.1, abs=0.001)
    with pytest.raises(InputError, match="expected a point of panel P0"):
        wrinkle.section(solution.cover, solution.positions, middle=np.array([0.5, 0]), **options)
    options["half_length"] = 0.0
    with pytest.raises(InputError, match="section: got direction 1, half length 0"):
        wrinkle.section(solution.cover, solution.positions, middle=np.array([0, 0]), **options)


def line(solution, axis, at):
    """Points on the vertices of the outline at ``rest[axis] = at``, in order."""
    rest = solution.cover.rest
    on = np.flatnonzero(np.abs(rest[:, axis] - at) < 1e-9)
    on = on[np.argsort(rest[on, 1 - axis])]
    return Points(vertices=np.column_stack([on, on]), weights=np.tile([1.0, 0.0], (len(on), 1)))


def test_cause_neighbour_and_advice():
    dents = (groove(0.03, 0.06), groove(0.2 + 0.06, 0.06, depth=0.0012))

    def shape(X):
        # The second panel is stretched along its warp; the first is in excess both ways.
        one = X[:, 0] < 0.19
        scale = np.where(one, 0.94, 1.03), np.where(one, 0.94, 1.0)
        return np.column_stack([X * np.stack(scale, axis=1), sum(d(X) for d in dents)])

    plain = shaped(shape, h=0.003, panels=2)
    a, b = line(plain, 0, 0.0), line(plain, 0, 0.2)
    k = min(len(a), len(b))
    short = Points(vertices=b.vertices[:k], weights=b.weights[:k])
    seam = Stitching(name="bolster", a=Points(vertices=a.vertices[:k], weights=a.weights[:k]),
                     b=short, length=np.full(k, 0.003), stage="end")  # fmt: skip
    top = line(plain, 1, SIZE)
    target = plain.positions[top.vertices[:, 0]]
    hook = Anchor(name="rear wire", kind="hook", points=top, target=target,
                  length=np.ones(len(top)), stage="end")  # fmt: skip
    solution = shaped(shape, h=0.003, panels=2, stitchings=(seam,), anchors=(hook,))
    first, second = wrinkle.worst_wrinkles(solution, judged(solution), count=2)
    assert (first.cause, first.near_kind, first.near) == ("compression", "seam", "bolster")
    assert first.distance == pytest.approx(0.03, rel=0.12)
    assert (second.panel, second.cause) == ("P1", "stretch")


@pytest.mark.parametrize(
    ("share", "cause"),
    [(0.0, "compression"), (0.399, "compression"), (0.4, "both"), (0.495, "both"),
     (0.505, "both"), (0.6, "both"), (0.601, "stretch"), (1.0, "stretch")],
)  # fmt: skip
def test_neither_cause_is_named_alone_near_one_half(share, cause):
    assert cause_of(share) == cause


def tied(at, *dents, wavelengths=()):
    """Kinds of the dents of a sheet that is tied in one vertex, the largest dent first."""
    plain = cover_with(*dents)
    rest = plain.cover.rest
    vertex = int(np.linalg.norm(rest - at, axis=1).argmin())
    ring = Anchor(
        name="wire", kind="hook", points=Points(vertices=[[vertex, vertex]], weights=[[1.0, 0.0]]),
        target=plain.positions[[vertex]], length=[0.01], stage="end",
    )  # fmt: skip
    solution = cover_with(*dents, anchors=(ring,))
    found = wrinkle.worst_wrinkles(solution, judged(solution), wavelengths=wavelengths)
    return [w.kind for w in found], found


@pytest.mark.parametrize(
    ("off", "kind"), [(0.002, "tie"), (0.009, "tie"), (0.015, "wrinkle"), (0.03, "wrinkle")]
)
def test_what_lies_at_a_tie_is_no_wrinkle(off, kind):
    """Nearer than a quarter of 48 mm; from the deepest place, wherever along the groove."""
    dent = groove(0.06, 0.06, length=0.012)
    kinds, found = tied(np.array([0.06 + off, 0.06]), dent, wavelengths=(0.048,))
    assert kinds[0] == kind
    assert len(found) == 1


def test_without_foam_the_wrinkles_own_wave_counts():
    dent = groove(0.06, 0.06, length=0.02)
    assert tied(np.array([0.062, 0.06]), dent)[0] == ["tie"]
    assert tied(np.array([0.09, 0.06]), dent)[0] == ["wrinkle"]


@pytest.mark.parametrize(("x", "kind"), [(0.007, "corner"), (0.03, "wrinkle")])
def test_what_lies_at_a_corner_is_no_wrinkle(x, kind):
    (first, *_) = wrinkle.worst_wrinkles(
        solution := cover_with(groove(x, x, length=0.01)), judged(solution), wavelengths=(0.048,)
    )
    assert first.kind == kind


def test_wrinkles_come_before_what_is_larger_at_a_tie():
    large, small = groove(0.04, 0.06, depth=0.003), groove(0.09, 0.06)
    kinds, found = tied(np.array([0.04, 0.06]), large, small, wavelengths=(0.048,))
    assert found[0].kind == "wrinkle"
    assert found[0].rest[0] == pytest.approx(0.09, abs=0.004)
    assert "tie" in kinds[1:]
    assert found[1].w2_area > found[0].w2_area


def test_a_place_of_one_element_is_a_spot():
    solution = cover_with(groove(0.06, 0.06, depth=1e-5))
    indices = judged(solution)
    w2 = np.zeros(len(indices.w2))
    centre = solution.cover.rest[solution.cover.faces].mean(axis=1)
    w2[np.linalg.norm(centre - 0.05, axis=1).argmin()] = 3.0
    (one,) = wrinkle.worst_wrinkles(solution, replace(indices, w2=w2), wavelengths=(0.02,))
    assert one.kind == "spot"
    assert one.length < 2 * solution.cover.element_size
