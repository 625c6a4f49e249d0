"""What one side of a seam has too much, on sheets that were strained by a known amount."""

import numpy as np
import pytest

from seatlook.model import Stitching
from seatlook.wrinkle import seam_excess
from support.covers import points_along, row
from support.wrinkle_samples import SIZE, sewn, shaped, stretched_along


def even(strain):
    return lambda distance: np.full_like(distance, strain)


@pytest.mark.parametrize(
    ("a", "b"), [(-0.02, 0.01), (0.01, -0.02), (-0.03, -0.01), (0.005, 0.035), (0.0, 0.0004)]
)
def test_excess_is_the_difference_of_both_sides(a, b):
    (stretch,) = seam_excess(sewn(stretched_along(even(a), even(b))))
    length = SIZE * (1 + 0.5 * (a + b))
    assert stretch.length == pytest.approx(length, rel=1e-9)
    assert stretch.excess == pytest.approx(abs(b - a) * length, rel=1e-6)
    long, short = (0, 1) if a < b else (1, 0)
    assert (stretch.long_panel, stretch.short_panel) == (f"P{long}", f"P{short}")
    assert stretch.compression + stretch.tension == pytest.approx(stretch.excess)
    assert stretch.compression == pytest.approx((min(max(a, b), 0) - min(a, b, 0)) * length)
    assert (stretch.long_strain, stretch.short_strain) == pytest.approx((min(a, b), max(a, b)))
    assert stretch.scatter < 1e-6
    assert stretch.waves == pytest.approx(0.0, abs=1e-9)
    assert stretch.place == "from the free end to the other free end"


@pytest.mark.parametrize("fade", [0.01, 0.02, 0.06])
def test_a_strain_that_fades_is_taken_at_the_seam(fade):
    """As beside a stiff seam, where waves take the compression up a little way inside."""
    solution = sewn(stretched_along(lambda d: 0.01 - 0.03 * np.exp(-d / fade), even(0.01)), h=0.004)
    (stretch,) = seam_excess(solution)
    assert stretch.excess == pytest.approx(0.03 * SIZE, rel=0.25)
    assert stretch.long_panel == "P0"
    assert abs(stretch.excess - 0.03 * SIZE) < 1.5 * stretch.scatter


def test_lengths_of_the_pattern_are_not_read():
    """Lines that differ by 4 % when cut, on panels that lie flat and unstrained."""
    flat = stretched_along(even(0.0), even(0.0))
    plain = shaped(flat, panels=2)
    rest = plain.cover.rest
    at = np.linspace(0.0, 1.0, 25)
    a, b = points_along(rest, row(rest, 0, SIZE), at), points_along(rest, row(rest, 0, 0.2), at)
    short = points_along(rest, row(rest, 0, 0.2), 0.96 * at)
    for far in (b, short):
        seam = Stitching(name="s", a=a, b=far, length=np.full(25, 0.005), stage="end")
        (stretch,) = seam_excess(shaped(flat, panels=2, stitchings=(seam,)))
        assert stretch.excess == pytest.approx(0.0, abs=1e-9)


def test_each_stretch_between_notches_is_read_for_itself():
    """A panel that is compressed in the middle third of the seam only."""

    def shape(X):
        first = X[:, 0] < 0.16
        y = X[:, 1]
        third = SIZE / 3
        pressed = y - 0.02 * np.clip(y - third, 0.0, third)
        return np.column_stack([X[:, 0], np.where(first, pressed, y), np.zeros(len(X))])

    low, middle, high = seam_excess(sewn(shape, h=0.004, notches=(1 / 3, 2 / 3)))
    assert [s.place for s in (low, middle, high)] == [
        "from the free end to notch 1",
        "from notch 1 to notch 2",
        "from notch 2 to the other free end",
    ]
    assert middle.excess == pytest.approx(0.02 * SIZE / 3, rel=0.2)
    assert middle.long_panel == "P0"
    assert max(low.excess, high.excess) < 0.2 * middle.excess


def test_uneven_strain_is_scatter():
    rng = np.random.default_rng(3)

    def rough(size):
        return lambda distance: size * rng.standard_normal(len(distance))

    one, two = (
        seam_excess(sewn(stretched_along(rough(size), even(0.0))))[0] for size in (1e-4, 1e-3)
    )
    assert two.scatter > 5 * one.scatter > 0
    assert two.excess < two.scatter


def test_waves_are_those_of_a_line_inside_the_panel():
    amplitude, k = 0.0008, 2 * np.pi / 0.02

    def shape(X):
        first = X[:, 0] < 0.16
        wave = np.where(first, amplitude * np.sin(k * X[:, 1]), 0.0)
        return np.column_stack([X[:, 0], X[:, 1] * np.where(first, 0.95, 1.0), wave])

    (stretch,) = seam_excess(sewn(shape, h=0.0025))
    assert stretch.long_panel == "P0"
    # Arc minus chord of a sine, steeper by what the panel is shorter; what the filter takes for
    # the shape that was meant; eight elements to a wave cut its corners by another 6 %.
    wave = 1.0 - 0.5 ** ((0.045 / (0.95 * 0.02)) ** 2)
    exact = 0.25 * (amplitude * wave * k) ** 2 * SIZE / 0.95
    assert stretch.waves == pytest.approx(exact, rel=0.1)
    # The waves take up what would else be compression.
    assert stretch.compression == pytest.approx(0.05 * SIZE - stretch.waves, rel=0.12)


def test_faces_that_are_not_resolved_are_told():
    solution = sewn(stretched_along(even(-0.02), even(0.01)))
    bad = np.zeros(len(solution.cover.faces), dtype=bool)
    centre = solution.cover.rest[solution.cover.faces].mean(axis=1)
    bad[np.linalg.norm(centre - [0.21, 0.06], axis=1).argmin()] = True
    assert not seam_excess(solution, unresolved=bad)[0].resolved
    assert seam_excess(solution)[0].resolved
