"""Covers whose panels are finer in some places: seams hold whatever the two sides are."""

import numpy as np
import pytest

from seatlook.assembly import assemble
from seatlook.assembly.grading import Grading
from support.scenes import two_panels


def corner_fine(width, depth, finest, coarsest):
    """Fine in the lower left corner, coarse in the upper right one."""
    u, v = (a.ravel() for a in np.meshgrid(np.linspace(0, width, 9), np.linspace(0, depth, 9)))
    share = np.clip(np.hypot(u, v) / np.hypot(width, depth), 0.0, 1.0)
    return Grading(np.column_stack([u, v]), finest + (coarsest - finest) * share)


@pytest.fixture(scope="module")
def graded():
    return assemble(
        two_panels(),
        sizes={
            "LEFT": corner_fine(0.1, 0.1, 0.004, 0.012),
            "RIGHT": corner_fine(0.08, 0.1, 0.003, 0.01),
        },
    )


def test_sizes_are_linear_between_places_and_the_nearest_beyond():
    grading = corner_fine(0.1, 0.1, 0.004, 0.012)
    np.testing.assert_allclose(grading(grading.points), grading.sizes)
    beyond = grading(np.array([[-0.5, -0.5], [0.6, 0.7]]))
    np.testing.assert_allclose(beyond, [grading.finest, grading.coarsest])


def test_a_seam_has_at_most_one_stitch_to_a_segment_of_its_coarser_side(graded):
    """More would make the finer side follow chords, and lock the seam against bending."""
    for seam in graded.stitchings:
        for side in (seam.a, seam.b):
            segment = np.sort(side.vertices, axis=1)[1:-1]  # both ends lie on corners
            _, count = np.unique(segment, axis=0, return_counts=True)
            coarser = count.max()
            assert coarser <= 2
        both = [
            np.unique(np.sort(side.vertices, axis=1), axis=0, return_counts=True)[1].mean()
            for side in (seam.a, seam.b)
        ]
        assert min(both) <= 1.2


def test_both_sides_of_a_seam_meet_and_its_length_is_kept(graded):
    seam = graded.stitchings[0]
    assert seam.length.sum() == pytest.approx(0.1)
    far = seam.b.at(graded.uv)
    near = seam.a.at(graded.uv)
    np.testing.assert_allclose(near[[0, -1], 1], [0.0, 0.1], atol=1e-9)
    # RIGHT is sewn on upside down in neither way: equal shares of both lengths meet.
    np.testing.assert_allclose(np.abs(np.diff(near[:, 1])), np.abs(np.diff(far[:, 1])), atol=1e-9)


def test_panels_without_a_grading_stay_as_they_are():
    plain = assemble(two_panels())
    half = assemble(two_panels(), sizes={"RIGHT": corner_fine(0.08, 0.1, 0.003, 0.01)})
    left = [np.unique(c.faces[c.panel == 0]) for c in (plain, half)]
    np.testing.assert_array_equal(plain.uv[left[0]], half.uv[left[1]])
