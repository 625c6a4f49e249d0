"""Covers at rest that are not where a cover belongs: inside, below, beside, or under bare foam."""

import re

import numpy as np
import pytest

from seatlook import model
from seatlook.results.conditions import conditions
from seatlook.results.resolution import resolution
from seatlook.solver import solve
from support.covers import cover, flat_foam, foam, row, sheet, sphere, vertices_as_points

pytestmark = pytest.mark.failure

DROP = model.Stage(name="drop", start=0.0, end=0.2)
SIZE, H = 0.18, 0.015


def held(z, *, below, at=(-0.09, -0.09), **change):
    """Square sheet whose four sides are held at height ``z`` (a number, or a function of x, y)."""
    X, T, x = sheet(SIZE, SIZE, H, at=at)
    level = z if callable(z) else lambda p: np.full(len(p), z)
    x[:, 2] = level(x)
    sides = {
        "left": row(X, 0, 0.0),
        "right": row(X, 0, SIZE),
        "front": row(X, 1, 0.0)[1:-1],
        "rear": row(X, 1, SIZE)[1:-1],
    }
    frames = tuple(
        model.Anchor(
            name=name,
            kind="frame",
            points=vertices_as_points(side),
            target=x[side],
            length=np.full(len(side), H),
            stage="drop",
        )
        for name, side in sides.items()
    )
    return solve(cover([(X, T, x)], foam=below, anchors=frames, stages=[DROP], h=H, **change))


def broken(solution):
    """Conditions of the solver that do not hold; what the mesh carries is another question."""
    found = conditions(solution, resolution(solution))
    return {held.figure for held in found if held.figure in solution.figures and not held.kept}


def ridged(height):
    """Block whose top has a ridge along y, 40 mm wide at its foot."""
    x = np.array([-0.15, -0.02, 0.0, 0.02, 0.15])
    z = np.array([0.0, 0.0, height, 0.0, 0.0])
    ends = [np.column_stack([x, np.full(5, y), z]) for y in (-0.15, 0.15)]
    base = [end * [1, 1, 0] - [0, 0, 0.1] for end in ends]
    vertices = np.concatenate([*ends, *base])
    faces = []
    for k in range(4):
        a, b, c, d = k, k + 1, 5 + k, 6 + k
        faces += [[a, b, d], [a, d, c]]  # top
        faces += [[10 + a, 10 + d, 10 + b], [10 + a, 10 + c, 10 + d]]  # bottom
        faces += [[a, 10 + a, 10 + b], [a, 10 + b, b]]  # front
        faces += [[c, d, 10 + d], [c, 10 + d, 10 + c]]  # rear
    faces += [[0, 5, 15], [0, 15, 10], [4, 14, 19], [4, 19, 9]]
    return foam(vertices, np.array(faces))


def pillow(side):
    """Two squares sewn all round over a lens of foam, 300 x 300 x 120 mm."""
    vertices, faces = sphere(1.0, 4)
    h = 0.018
    X, T, x = sheet(side, side, h, z=0.08, at=(-side / 2, -side / 2))
    back = X * [-1, 1] + [side, 0], T[:, ::-1], x * [1, 1, -1]
    rim = np.unique(np.concatenate([row(X, k, end) for k in (0, 1) for end in (0.0, side)]))
    seam = model.Stitching(
        name="rim",
        a=vertices_as_points(rim),
        b=vertices_as_points(rim + len(X)),
        length=np.full(len(rim), h),
        stage="drop",
    )
    sewn = cover(
        [(X, T, x), back],
        foam=foam(vertices * [0.15, 0.15, 0.06], faces),
        stitchings=[seam],
        stages=[DROP],
        h=h,
        thickness=1e-3,
        bending_warp=5e-5,
        bending_weft=5e-5,
        bending_twist=2.5e-5,
    )
    return solve(sewn)


def test_a_taut_pillow_covers_its_foam():
    s = pillow(0.30)
    assert s.status == "converged", s.reason
    assert 0.05 < s.figures["buried_10mm"] < 0.15
    assert s.figures["bare_foam"] < 0.01


def test_a_pillow_far_too_small():
    """Its foam sticks out where the rim cuts through it; all forces are in balance."""
    s = pillow(0.25)
    assert s.figures["residual"] <= 1e-3
    assert s.status == "not converged"
    assert broken(s) == {"buried_10mm", "buried_20mm", "bare_foam"}


def test_a_cover_on_its_foam_covers_it():
    s = held(-0.002, below=flat_foam())
    assert s.status == "converged", s.reason
    assert not broken(s)
    assert s.figures["buried_10mm"] == s.figures["bare_foam"] == 0.0
    assert 0.0015 < s.figures["gap_p95"] < 0.0025


def test_a_ridge_below_a_taut_cover_does_no_harm():
    """Some of it presses deeper than 10 mm, and next to it the cover bridges a hollow."""
    s = held(0.0, below=ridged(0.03))
    assert s.status == "converged", s.reason
    assert 0.0 < s.figures["buried_10mm"] < 0.05
    assert s.figures["gap_p95"] > 0.005


@pytest.mark.parametrize(
    ("depth", "figures", "reason"),
    [
        (0.015, {"buried_10mm"}, r"^33.* % of the cover lies more than 10 mm deep in the foam"),
        (0.030, {"buried_10mm", "buried_20mm", "bare_foam"}, r"down to 30 mm; .* cm2 of foam lie"),
    ],
)
def test_a_cover_buried_in_its_foam(depth, figures, reason):
    """Its frame runs through the foam: all forces are in balance, and the foam holds out."""
    s = held(-depth, below=flat_foam())
    assert s.figures["residual"] <= 1e-3
    assert s.figures["contact_compression_max"] < 0.6
    assert s.status == "not converged"
    assert broken(s) == figures
    assert s.reason.count("panel 0") == len(figures - {"buried_20mm"})
    assert s.figures["gap_p95"] > 0.9 * depth
    assert re.search(reason, s.reason), s.reason


@pytest.mark.parametrize(
    ("z", "at", "distance"),
    [(-0.16, (-0.09, -0.09), 60), (-0.05, (0.2, -0.09), 53)],
    ids=["below", "beside"],
)
def test_a_cover_that_hangs_below_or_beside_its_foam(z, at, distance):
    """It is said that it does not touch, not that forces differ by a hundred percent."""
    s = held(z, below=flat_foam(), at=at)
    assert s.status == "not converged"
    assert s.reason.startswith("the cover does not touch the foam: the nearest place, in panel ")
    assert s.reason.endswith(f" is {distance} mm away")
    assert "differ" not in s.reason
    assert "untouched" in broken(s)


def test_a_cover_that_touches_with_its_edge_only():
    s = held(-0.05, below=flat_foam(), at=(0.1495, -0.09))
    assert s.figures["residual"] <= 1e-3
    assert s.status == "not converged"
    assert "does not touch the foam but with 3.27 % of its area (at least 5 %)" in s.reason


def test_foam_that_sticks_out_above_its_cover():
    """The cover lies against the lower face, its visible side to the foam: nothing is deep."""
    s = held(-0.1, below=flat_foam())
    assert s.figures["buried_10mm"] == 0.0
    assert s.figures["residual"] <= 1e-3
    assert s.status == "not converged"
    assert "cm2 of foam lie bare above the cover (at most 5 % of its area)" in s.reason
    assert "up to 103 mm high, most of it above panel panel 0" in s.reason
    assert broken(s) >= {"bare_foam"}
