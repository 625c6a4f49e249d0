import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.flattening.surface import DesignSurface, sides

# A 4 x 2 grid of unit squares, each of two triangles, vertices numbered row by row.
COLUMNS, ROWS = 4, 2


def grid(labels, names):
    x, y = np.meshgrid(np.arange(COLUMNS + 1.0), np.arange(ROWS + 1.0))
    faces = []
    for j in range(ROWS):
        for i in range(COLUMNS):
            a = j * (COLUMNS + 1) + i
            b, c, d = a + 1, a + COLUMNS + 2, a + COLUMNS + 1
            faces += [[a, b, c], [a, c, d]]
    return DesignSurface(
        vertices=np.column_stack([x.ravel(), y.ravel(), 0 * x.ravel()]),
        faces=np.array(faces),
        panel=np.repeat(labels, 2),
        panel_names=names,
    )


def test_sides_of_two_panels_side_by_side():
    surface = grid([0, 0, 1, 1, 0, 0, 1, 1], ("A", "B"))
    result = {side.name: side.vertices.tolist() for side in sides(surface.patches())}
    assert result == {
        "A.B": [2, 7, 12],
        "A.free": [12, 11, 10, 5, 0, 1, 2],
        "B.A": [12, 7, 2],
        "B.free": [2, 3, 4, 9, 14, 13, 12],
    }


def test_sides_split_where_three_panels_meet_and_say_where():
    """B and C lie on top of A; D below the whole row would be free."""
    surface = grid([0, 0, 0, 0, 1, 2, 2, 1], ("A", "B", "C"))
    with pytest.raises(InputError, match="panel B: got 2 boundary curves, Euler number 2"):
        surface.patches()
    surface = grid([0, 1, 1, 0, 0, 0, 0, 0], ("A", "B"))
    names = [side.name for side in sides(surface.patches())]
    assert sorted(names) == ["A.B", "A.free", "B.A", "B.free"]
    surface = grid([0, 1, 0, 2, 0, 0, 0, 2], ("A", "B", "C"))
    names = [side.name for side in sides(surface.patches()) if side.panel == "A"]
    assert sorted(names) == ["A.B", "A.C", "A.free.left", "A.free.right"]


def test_indices_of_a_side_are_the_patch_s_own():
    surface = grid([0, 0, 1, 1, 0, 0, 1, 1], ("A", "B"))
    for patch in surface.patches():
        for side in sides(surface.patches()):
            if side.panel == patch.name:
                assert (patch.source[side.indices(patch)] == side.vertices).all()


def test_a_panel_with_a_hole_is_refused():
    surface = DesignSurface(
        vertices=np.array(
            [[0, 0, 0], [3, 0, 0], [0, 3, 0], [1, 0.8, 0], [1.2, 0.8, 0], [1, 1, 0]], float
        ),
        faces=np.array([[0, 1, 4], [0, 4, 3], [1, 2, 5], [1, 5, 4], [2, 0, 3], [2, 3, 5]]),
        panel=np.zeros(6, int),
        panel_names=("A",),
    )
    with pytest.raises(InputError, match=r"panel A: got 2 boundary curves.*without holes"):
        surface.patches()


def test_labels_are_checked():
    with pytest.raises(
        InputError, match=r"DesignSurface.panel: got shape \(16,\), labels \[0, 3\]"
    ):
        grid([0, 0, 3, 3, 0, 0, 3, 3], ("A", "B"))
