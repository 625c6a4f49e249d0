"""An oblique groove on an unevenly meshed panel that lies anyhow in space: no axis is special."""

import itertools

import numpy as np
import pytest

from seatlook import wrinkle
from seatlook.model import Points, Stitching
from support.wrinkle_samples import pattern_of, shaped

SIZE, H, GRAIN = (0.14, 0.1), 0.002, 0.6
ANGLE = np.radians(35.0)
ALONG = np.array([np.cos(ANGLE), np.sin(ANGLE)])
ACROSS = np.array([-ALONG[1], ALONG[0]])
MIDDLE = np.array([0.05, 0.047])
DEPTH, WIDTH, LENGTH = 0.0015, 0.006, 0.04
# The panel's axes and outside in space.
FRAME = np.linalg.qr(np.random.default_rng(4).normal(size=(3, 3)))[0]
FRAME *= np.linalg.det(FRAME)
PLACE = np.array([0.3, -0.2, 0.7])


def height(
    X, *, middle=MIDDLE, angle=ANGLE, depth=DEPTH, width=WIDTH, length=LENGTH, slope=0.0, flare=0.0
):
    """Height (k,) of a dent: Gaussian across, long along; forwards deeper, and wider."""
    s = (X - middle) @ [np.cos(angle), np.sin(angle)]
    t = (X - middle) @ [-np.sin(angle), np.cos(angle)]
    end = 1 / (1 + (s / (0.5 * length)) ** 8)
    wide = width * np.exp(flare * s / length)
    return -depth * (1 + slope * s / length) * np.exp(-((t / wide) ** 2)) * end


def in_space(X, z):
    return PLACE + np.column_stack([X, z]) @ FRAME.T


def grooved(*dents, panels=1, **cover):
    def shape(X):
        return in_space(X, sum(height(X, **dent) for dent in dents))

    return shaped(shape, h=H, kind="graded", size=SIZE, grain=GRAIN, panels=panels, **cover)


def indexed(solution):
    return wrinkle.wrinkle_indices(
        *wrinkle.surface_strains(solution), solution.cover.thickness, 20.0, "tensor"
    )


@pytest.fixture(scope="module")
def sample():
    """A groove that is deepest forwards of its middle: solution, indices, its worst wrinkle."""
    solution = grooved({"slope": 0.8})
    indices = indexed(solution)
    (worst,) = wrinkle.worst_wrinkles(solution, indices, count=1)
    return solution, indices, worst


def points_of(cover, faces, per_side=6):
    """Points (k, 2) that share every face among themselves evenly, and the area of each."""
    i, j = np.meshgrid(np.arange(per_side), np.arange(per_side))
    low = np.stack([i, j], axis=-1)[i + j < per_side] + 1 / 3
    high = np.stack([i, j], axis=-1)[i + j < per_side - 1] + 2 / 3
    a, b = (np.concatenate([low, high]) / per_side).T
    corner = np.stack([1 - a - b, a, b], axis=1)
    points = np.einsum("sc,fcd->fsd", corner, cover.rest[cover.faces[faces]])
    area = np.repeat(cover.rest_area[faces] / len(corner), len(corner))
    return points.reshape(-1, 2), area


def test_direction_place_and_depth(sample):
    _, _, worst = sample
    assert abs(worst.along @ ALONG) > np.cos(np.radians(1.5))
    assert np.linalg.norm(worst.along) == pytest.approx(1.0)
    off = worst.rest - MIDDLE
    assert abs(off @ ACROSS) < 0.0012
    # Where it is deepest: forwards, before its end.
    assert 0.2 * LENGTH < off @ ALONG < 0.5 * LENGTH
    np.testing.assert_allclose(worst.uv, pattern_of(worst.rest[None], GRAIN)[0], atol=1e-12)
    away = (worst.position - PLACE) @ FRAME
    np.testing.assert_allclose(away[:2], worst.rest, atol=1e-4)
    assert away[2] == pytest.approx(height(worst.rest[None], slope=0.8)[0], abs=1e-4)
    s = np.linspace(-0.5, 0.5, 400)[:, None] * LENGTH
    deepest = -height(MIDDLE + s * ALONG, slope=0.8).min()
    assert worst.depth == pytest.approx(deepest, rel=0.05)
    assert deepest > 1.2 * DEPTH


@pytest.mark.parametrize("degrees", [8.0, 62.0, 100.0, 127.0, 171.0])
def test_along_follows_the_groove_all_round(degrees):
    angle = np.radians(degrees)
    solution = grooved({"angle": angle, "middle": np.array([0.07, 0.05])})
    (worst,) = wrinkle.worst_wrinkles(solution, indexed(solution), count=1)
    assert abs(worst.along @ [np.cos(angle), np.sin(angle)]) > np.cos(np.radians(1.5))


def test_the_deepest_place_need_not_be_the_most_curved():
    """A steep groove, sharp at its near end and deep at its wide far end."""
    angle = np.radians(93.0)
    dent = {"angle": angle, "slope": 0.9, "flare": 0.8, "length": 0.05}
    middle = np.array([0.07, 0.05])
    solution = grooved(dent | {"middle": middle})
    indices = indexed(solution)
    (worst,) = wrinkle.worst_wrinkles(solution, indices, count=1)
    forwards = np.array([np.cos(angle), np.sin(angle)])
    s = np.linspace(-0.5, 0.5, 400)[:, None] * dent["length"]
    z = height(middle + s * forwards, middle=middle, **dent)
    off = worst.rest - middle
    assert off @ forwards > 0.2 * dent["length"]
    assert abs(off @ [-forwards[1], forwards[0]]) < 0.002
    assert worst.depth == pytest.approx(-z.min(), rel=0.06)
    sharpest = solution.cover.rest[solution.cover.faces[indices.w2.argmax()]].mean(axis=0)
    assert (sharpest - middle) @ forwards < 0.0


LEVEL, SHEET = 20.0, 0.14


def sine_sheet(degrees, *, wavelength=0.04, amplitude=0.0016, h=0.0025, kind="uns"):
    """A sheet in waves that run obliquely over it, a valley through its middle."""
    angle, middle = np.radians(degrees), np.full(2, SHEET / 2)
    across = np.array([-np.sin(angle), np.cos(angle)])

    def shape(X):
        z = -amplitude * np.cos(2 * np.pi / wavelength * ((X - middle) @ across))
        return in_space(X, z)

    solution = shaped(shape, h=h, kind=kind, size=SHEET)
    found = wrinkle.worst_wrinkles(solution, indexed(solution), count=9)
    return min(found, key=lambda w: abs((w.rest - middle) @ across))


@pytest.mark.parametrize("degrees", [0.0, 10.0, 20.0, 30.0, 45.0, 60.0, 75.0, 90.0])
def test_sine_wrinkles_are_measured_alike_in_every_direction(degrees):
    amplitude, k = 0.0016, 2 * np.pi / 0.04
    middle = sine_sheet(degrees)
    along = np.array([np.cos(np.radians(degrees)), np.sin(np.radians(degrees))])
    assert abs(middle.along @ along) > np.cos(np.radians(3.0))
    assert middle.kind == "wrinkle"
    assert middle.depth == pytest.approx(2 * amplitude, rel=0.05)
    assert middle.length == pytest.approx(SHEET / np.abs(along).max(), rel=0.05)
    assert middle.width == pytest.approx(2 * np.arccos(LEVEL / (amplitude * k**2)) / k, rel=0.05)
    t = np.linspace(0.0, 2 * np.pi / k, 4001)
    excess = np.hypot(np.diff(t), np.diff(amplitude * np.cos(k * t))).sum() - t[-1]
    assert middle.excess == pytest.approx(excess, rel=0.05)
    assert middle.waves == pytest.approx(middle.excess, rel=0.01)


@pytest.mark.parametrize("wavelength", [0.024, 0.06, 0.08])
def test_a_section_reaches_from_crest_to_crest_of_any_wave(wavelength):
    amplitude = 1.6 * LEVEL * (wavelength / (2 * np.pi)) ** 2
    middle = sine_sheet(35.0, wavelength=wavelength, amplitude=amplitude, h=wavelength / 14)
    assert middle.depth == pytest.approx(2 * amplitude, rel=0.05)
    assert 0.5 * wavelength < middle.reach < wavelength


@pytest.mark.parametrize("kind", ["right", "alternating", "crossed"])
def test_a_regular_mesh_turns_no_wrinkle(kind):
    middle = sine_sheet(30.0, kind=kind)
    assert abs(middle.along @ [np.cos(np.pi / 6), 0.5]) > np.cos(np.radians(3.0))
    assert middle.depth == pytest.approx(0.0032, rel=0.05)


def test_compressed_cloth_adds_to_the_excess():
    """Waves of a sheet that is 2 % shorter across them than it was cut."""
    k = 2 * np.pi / 0.04

    def shape(X):
        return np.column_stack([0.98 * X[:, 0], X[:, 1], -0.0016 * np.cos(k * (X[:, 0] - 0.07))])

    solution = shaped(shape, h=0.0025, size=SHEET)
    found = wrinkle.worst_wrinkles(solution, indexed(solution), count=9)
    middle = min(found, key=lambda w: abs(w.rest[0] - 0.07))
    # Of a wave of 40 mm 0.8 mm are missing, and the sine is as much longer than its chord as
    # slopes that are steeper by 2 % make it; the slopes take back what the membrane was short of.
    step = np.linspace(0.0, 0.04, 4001)
    steep = np.hypot(0.98, 0.0016 * k * np.sin(k * step))
    exact = np.trapezoid(steep - 0.98, step) + np.trapezoid(np.maximum(1 - steep, 0.0), step)
    assert middle.excess == pytest.approx(exact, rel=0.05)
    assert 0.3 * middle.excess < middle.waves < 0.9 * middle.excess


def test_length_along_the_groove_and_area_over_length(sample):
    solution, indices, worst = sample
    inside = np.flatnonzero(indices.w2 > 1.0)
    # One region: all of it is within the groove.
    centres = solution.cover.rest[solution.cover.faces[inside]].mean(axis=1) - MIDDLE
    assert np.abs(centres @ ACROSS).max() < WIDTH
    points, area = points_of(solution.cover, inside)
    s = (points - area @ points / area.sum()) @ worst.along
    assert worst.length == pytest.approx(np.sqrt(12 * (area @ s**2) / area.sum()), rel=0.01)
    assert worst.width == pytest.approx(area.sum() / worst.length, rel=0.01)
    assert 4 * worst.width < worst.length < 1.3 * LENGTH


def test_integrals_are_over_the_area(sample):
    solution, indices, worst = sample
    inside = indices.w2 > 1.0
    area = solution.cover.rest_area[inside]
    assert area.max() > 2.5 * area.min()
    assert worst.w2_area == pytest.approx(indices.w2[inside] @ area, rel=1e-12)
    assert worst.w2_max == indices.w2[inside].max()
    share = indices.w_stretch[inside] @ area / (indices.w2[inside] @ area)
    assert worst.stretch_share == pytest.approx(share, rel=1e-12)
    plain = indices.w_stretch[inside].sum() / indices.w2[inside].sum()
    assert abs(share - plain) > 1e-3


def test_section_across_is_the_profile_of_the_groove(sample):
    solution, _, worst = sample
    cut = wrinkle.section_across(solution, worst)
    across = np.array([-worst.along[1], worst.along[0]])
    line = worst.rest + cut.along[:, None] * across
    exact = height(line, slope=0.8)
    np.testing.assert_allclose(cut.points, in_space(line, exact), atol=8e-5)
    np.testing.assert_allclose(cut.height, exact, atol=8e-5)
    # A Gaussian's valley ends at its width over the root of 2.
    assert cut.along[-1] == -cut.along[0] == worst.reach
    assert worst.reach == pytest.approx(3 * WIDTH / np.sqrt(2), abs=1.5 * H)
    assert np.diff(cut.along) == pytest.approx(np.full(len(line) - 1, 0.2 * H), rel=0.1)


def test_section_ends_where_an_oblique_line_leaves_the_panel():
    solution = grooved({})
    middle, direction = np.array([0.11, 0.06]), np.array([2.0, 1.0])
    cut = wrinkle.section(
        solution.cover, solution.positions, panel=0, middle=middle, direction=direction,
        half_length=0.09,
    )  # fmt: skip
    unit = direction / np.sqrt(5.0)
    # To the right edge in one direction; the lower edge is farther away than the half length.
    assert cut.along[-1] == pytest.approx((SIZE[0] - middle[0]) / unit[0], abs=0.2 * H)
    assert cut.along[0] == pytest.approx(-0.09)
    line = middle + cut.along[:, None] * unit
    np.testing.assert_allclose(cut.points, in_space(line, height(line)), atol=8e-5)


def test_the_straight_edge_rests_on_the_two_highest_points():
    """Two ridges of unequal height with a hollow between, all oblique; against all chords."""

    def profile(t):
        return 0.004 * np.exp(-(((t + 0.014) / 0.006) ** 2)) + 0.0025 * np.exp(
            -(((t - 0.012) / 0.005) ** 2)
        )

    def shape(X):
        return in_space(X, profile((X - MIDDLE) @ ACROSS))

    solution = shaped(shape, h=H, kind="graded", size=SIZE)
    lifted = solution.positions + 0.0007 * FRAME[:, 2]
    cut = wrinkle.section(
        solution.cover, solution.positions, panel=0, middle=MIDDLE, direction=-3.0 * ACROSS,
        half_length=0.025, design=lifted,
    )  # fmt: skip
    t = -cut.along
    z = profile(t)
    edge = z.copy()
    for a, b in itertools.combinations(range(len(t)), 2):
        between = slice(a, b + 1)
        share = (t[between] - t[a]) / (t[b] - t[a])
        edge[between] = np.maximum(edge[between], z[a] + share * (z[b] - z[a]))
    np.testing.assert_allclose(cut.height, z - edge, atol=1.3e-4)
    assert cut.depth == pytest.approx((edge - z).max(), rel=0.03)
    np.testing.assert_allclose(cut.intended, cut.height + 0.0007, atol=5e-5)


def test_vertices_beside_a_section_are_those_near_its_line(sample):
    solution, _, worst = sample
    half = worst.reach
    across = np.array([-worst.along[1], worst.along[0]])
    line = worst.rest + np.linspace(-half, half, 2001)[:, None] * across
    rest = solution.cover.rest
    distance = np.min([np.linalg.norm(rest - p, axis=1) for p in line], axis=0)
    near = wrinkle.beside_sections(solution.cover, [worst], 0.007)
    sure = np.abs(distance - 0.007) > 1e-6
    assert (near == (distance < 0.007))[sure].all()
    assert 50 < near.sum() < 0.2 * len(rest)


def test_ranked_by_the_integral_not_by_the_worst_face():
    """A short sharp groove has the larger W2, a long soft one the larger integral."""
    soft = {"middle": np.array([0.05, 0.055]), "depth": 0.0013, "width": 0.007, "length": 0.06}
    sharp = {"middle": np.array([0.1, 0.04]), "width": 0.0045, "length": 0.012}
    solution = grooved(soft, sharp)
    first, second = wrinkle.worst_wrinkles(solution, indexed(solution), count=2)
    assert first.w2_max < second.w2_max
    assert first.w2_area > 1.3 * second.w2_area
    assert np.linalg.norm(first.rest - soft["middle"]) < 0.03
    assert np.linalg.norm(second.rest - sharp["middle"]) < 0.006


def test_ranked_by_area_not_by_the_number_of_faces():
    """Two steep grooves: the larger on coarse elements, the smaller on twice as many fine ones."""
    steep = {"angle": np.radians(95.0), "width": 0.005, "depth": 0.0012}
    large = steep | {"middle": np.array([0.07, 0.05]), "length": 0.042}
    small = steep | {"middle": np.array([0.035, 0.05]), "length": 0.036}
    solution = grooved(large, small)
    indices = indexed(solution)
    first, second = wrinkle.worst_wrinkles(solution, indices, count=2)
    assert abs(first.rest[0] - 0.07) < 0.004
    assert abs(second.rest[0] - 0.035) < 0.004
    assert first.w2_area > 1.05 * second.w2_area
    x = solution.cover.rest[solution.cover.faces].mean(axis=1)[:, 0]
    inside = indices.w2 > 1.0
    counted = [indices.w2[inside & (np.abs(x - at) < 0.015)].sum() for at in (0.07, 0.035)]
    assert counted[1] > 1.2 * counted[0]


def test_nearest_seam_is_measured_in_space(sample):
    """Stitches between the ends of the upper outline, none of them at a vertex."""
    solution, _, worst = sample
    rest = solution.cover.rest
    low, high = (np.flatnonzero((rest == [x, SIZE[1]]).all(axis=1))[0] for x in (0.0, SIZE[0]))
    share = np.linspace(0.01, 0.99, 50)
    side = Points(
        vertices=np.tile([low, high], (50, 1)), weights=np.column_stack([1 - share, share])
    )
    seam = Stitching(name="top", a=side, b=side, length=np.full(50, 0.003), stage="end")
    sewn = grooved({"slope": 0.8}, stitchings=(seam,))
    (again,) = wrinkle.worst_wrinkles(sewn, indexed(sewn), count=1)
    stitch = np.column_stack([SIZE[0] * share, np.full(50, SIZE[1])])
    exact = np.linalg.norm(in_space(stitch, height(stitch, slope=0.8)) - worst.position, axis=1)
    assert (again.near_kind, again.near) == ("seam", "top")
    assert again.distance == pytest.approx(exact.min(), rel=1e-3)
    assert exact.min() < 0.8 * exact[[0, -1]].min()
