"""A wrinkle is marked where it is seen; else it is said in which view, or that it is hidden."""

import numpy as np
import pytest

from seatlook.chain.framing import marks
from seatlook.model import framed_view
from support.wrinkle_samples import SIZE, shaped

TOP = np.array([SIZE / 2, SIZE / 2, 0.0])


def level(X):
    return np.column_stack([X, np.zeros(len(X))])


def upright(X):
    """Two sheets that stand one behind the other, both facing the front."""
    second = X[:, 0] > 0.16
    x = np.where(second, X[:, 0] - 0.2, X[:, 0])
    return np.column_stack([x, np.where(second, 0.02, 0.0), X[:, 1]])


def test_what_the_camera_sees_is_marked_in_it():
    solution = shaped(level)
    camera = framed_view("top", solution.positions)
    (mark,) = marks(solution, [TOP], camera)
    assert mark.camera is camera
    assert (mark.x, mark.y) == pytest.approx(camera.pixel(TOP))


def test_what_is_out_of_the_picture_is_looked_for_in_another_view():
    solution = shaped(level)
    far = framed_view("top", solution.positions + np.array([5.0, 0.0, 0.0]))
    (mark,) = marks(solution, [TOP], far)
    assert mark.camera is not far
    assert mark.camera is not None


def test_what_stands_behind_is_hidden_from_the_front_and_seen_from_above():
    solution = shaped(upright, panels=2)
    hidden, shown = np.array([0.06, 0.02, 0.06]), np.array([0.06, 0.0, 0.06])
    front = framed_view("front_34", solution.positions)
    one, other = marks(solution, [hidden, shown], front)
    assert other.camera is front
    assert one.camera is not front


def test_what_no_view_sees_says_so():
    """The visible side of a sheet that lies on its face."""
    solution = shaped(lambda X: np.column_stack([X[:, 0], -X[:, 1], np.zeros(len(X))]))
    camera = framed_view("top", solution.positions)
    (mark,) = marks(solution, [TOP * [1.0, -1.0, 1.0]], camera)
    assert mark.camera is None
    assert marks(solution, [], camera) == ()
