"""A groove of known place, length and depth is found, cut and explained."""

import numpy as np
import pytest

from seatlook import wrinkle
from seatlook.errors import InputError
from seatlook.model import Anchor, Points, Stitching
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
    assert first.ease == pytest.approx(0.0, abs=1e-9)
    assert first.advice == "fabric in excess: take length out of the panel beside the wrinkle"
    assert second.panel == "P1"
    assert second.cause == "stretch"
    assert second.advice.startswith("uneven stretch: balance the in-plane stress at ")


def test_unequal_sewn_lines_are_named():
    def excess(X):
        return np.column_stack([0.94 * X, groove(0.02, 0.06)(X)])

    plain = shaped(excess, h=0.003, panels=2)
    rest = plain.cover.rest
    a = line(plain, 0, 0.0)
    ends = np.flatnonzero((rest[:, 0] == 0.2) & (np.minimum(rest[:, 1], SIZE - rest[:, 1]) < 1e-9))
    low, high = ends[np.argsort(rest[ends, 1])]
    share = np.linspace(0.0, 0.96, len(a))
    b = Points(
        vertices=np.tile([low, high], (len(a), 1)), weights=np.column_stack([1 - share, share])
    )
    seam = Stitching(name="side", a=a, b=b, length=np.full(len(a), 0.003), stage="end")
    solution = shaped(excess, h=0.003, panels=2, stitchings=(seam,))
    (worst,) = wrinkle.worst_wrinkles(solution, judged(solution), count=1)
    assert worst.ease == pytest.approx(1 / 0.96 - 1, rel=1e-6)
    assert worst.advice == (
        "fabric in excess: make the two lines of seam side equally long; they differ by 4.2 %"
    )
