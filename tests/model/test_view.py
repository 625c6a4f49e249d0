"""Named views show all of a seat, whatever its size and place, and the demo as they always did."""

import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.model import VIEWS, framed_view, named_view
from seatlook.seats import demo_foam_mesh

WHOLE = sorted(set(VIEWS) - {"detail"})


def box(size, at=(0.0, 0.0, 0.0)):
    """Corners (8, 3) of a box."""
    corners = np.stack(np.meshgrid(*[[-0.5, 0.5]] * 3), axis=-1).reshape(-1, 3)
    return corners * size + at


SEATS = {
    "headrest": box((0.28, 0.13, 0.176)),
    "cushion": box((0.5, 0.56, 0.12), at=(3.0, -2.0, 1.0)),
    "backrest": box((0.5, 0.12, 0.65)),
    "saddle": box((0.25, 0.75, 0.15)),
    "bench": box((1.4, 0.5, 0.2)),
    "model": box((0.05, 0.056, 0.012)),
}


@pytest.mark.parametrize("size", [(1280, 720), (480, 640)])
@pytest.mark.parametrize("view", WHOLE)
@pytest.mark.parametrize("seat", SEATS)
def test_all_of_a_seat_is_in_the_picture(seat, view, size):
    camera = framed_view(view, SEATS[seat], size=size)
    pixels = np.array([camera.pixel(corner) for corner in SEATS[seat]])
    assert (pixels > 0).all()
    assert (pixels < size).all()
    # Nor is it lost in it: on one axis it takes two fifths of the picture.
    assert (np.ptp(pixels, axis=0) / size).max() > 0.4


@pytest.mark.parametrize("size", [(1280, 720), (480, 640)])
@pytest.mark.parametrize("view", WHOLE)
@pytest.mark.parametrize("shape", ["headrest", "backrest"])
def test_the_cover_of_a_small_seat_is_in_the_picture_too(shape, view, size):
    """It is larger than the foam that is framed: by 2 mm on each side of a seat 150 mm wide."""
    foam = SEATS[shape] * (0.15 / np.ptp(SEATS[shape], axis=0).max())
    camera = framed_view(view, foam, size=size)
    cover = foam * (1.0 + 0.004 / np.ptp(foam, axis=0))
    pixels = np.array([camera.pixel(corner) for corner in cover])
    assert (pixels > 0).all()
    assert (pixels < size).all()


@pytest.mark.parametrize("view", VIEWS)
def test_pictures_grow_with_the_seat(view):
    small = framed_view(view, SEATS["cushion"])
    large = framed_view(view, 3.0 * SEATS["cushion"])
    a, b = (camera.position - camera.target for camera in (small, large))
    assert b == pytest.approx(3.0 * a, rel=0.01)
    assert large.pixels_per_degree == small.pixels_per_degree


@pytest.mark.parametrize("thickness", [0.0006, 0.0015, 0.004])
def test_the_demo_is_seen_from_where_it_always_was(thickness):
    vertices = demo_foam_mesh(cover_thickness=thickness).vertices
    middle = (vertices.min(axis=0) + vertices.max(axis=0)) / 2
    for view in ("driver_door", "front_34", "top", "detail"):
        framed, named = framed_view(view, vertices), named_view(view, target=middle)
        assert np.array_equal(framed.position, named.position), view


def test_an_unknown_view_is_refused():
    with pytest.raises(InputError, match=r"camera.view: got side"):
        framed_view("side", SEATS["cushion"])
