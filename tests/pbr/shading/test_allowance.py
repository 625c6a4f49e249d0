"""Allowances below a seam: how far they lift the cloth beside it, by the kind of the seam."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from seatlook.model import Foam, Hem, SeamKind, Thread
from seatlook.pbr.shading.allowance import profile, sides_of
from seatlook.pbr.shading.seam import pack_thread
from seatlook.pbr.shading.surface import drawn_surface
from support.boxes import rounded_block
from support.reference import sewn_relief
from support.reference.sewn_sheet import sewn
from support.scenes import foam_material

THICKNESSES = (0.0007, 0.0012, 0.0045)


def heights(solution, side):
    """Distance from the seam and height [m] of the drawn cloth on side a or b."""
    surface = drawn_surface(solution)
    x = surface.mesh.vertices[: surface.vertices]
    uv = surface.mesh.uv[: surface.vertices]
    inner = np.abs(uv[:, 1]) < 0.03
    own = inner & (uv[:, 0] < 1e-9 if side == "a" else uv[:, 0] > 0)
    panel = np.zeros(len(x), dtype=int)
    panel[surface.mesh.faces[: surface.faces]] = surface.mesh.panel[: surface.faces, None]
    own = inner & (panel == "ab".index(side))
    return np.abs(uv[own, 0]), x[own, 2]


@pytest.mark.parametrize("thickness", THICKNESSES)
@pytest.mark.parametrize(
    ("kind", "sides"),
    [("plain", "ab"), ("French", "ab"), ("top stitch 1", "a"), ("top stitch 2", "a")],
)
def test_the_cloth_is_higher_beside_a_seam(kind, sides, thickness):
    solution, thread = (
        sewn(kind=SeamKind(kind=kind), thickness=thickness),
        pack_thread(Thread(), rows=2),
    )
    rows = dict(zip("ab", sides_of(solution.cover).rows, strict=True))
    for side in "ab":
        distance, height = heights(solution, side)
        assert height[distance < 1e-9] == pytest.approx(0.0, abs=1e-6)
        assert height[distance > 0.011] == pytest.approx(0.0, abs=1e-6)
        band = (distance >= 0.003) & (distance <= 0.006)
        assert band.sum() > 30
        if side not in sides:
            assert height == pytest.approx(0.0, abs=1e-6)
            continue
        # Section with the relief that is drawn on it, against the cloth 13 mm away.
        for d, z in zip(distance[band], height[band], strict=True):
            for arc in (0.0, 0.0011, 0.0025):
                relief = sewn_relief.height(thread, rows[side], d, 0.03 + arc)
                relief -= sewn_relief.height(thread, rows[side], 0.013, 0.03 + arc)
                assert 0.0005 <= z + relief <= 0.0015


def test_a_lapped_panel_lies_over_the_other():
    for side, over, under in (("a", "a", "b"), ("b", "b", "a")):
        solution = sewn(kind=SeamKind(kind="lapped", side=side), thickness=0.0014)
        distance, height = heights(solution, over)
        assert height[distance < 0.007] == pytest.approx(0.00112, abs=2e-5)
        assert heights(solution, under)[1] == pytest.approx(0.0, abs=1e-6)


def test_the_other_side_is_stitched_where_the_scene_says_so():
    kind = SeamKind(kind="top stitch 2", side="b")
    assert sides_of(sewn(kind=kind).cover).rows.tolist() == [0.0, 2.0]
    surface = drawn_surface(sewn(kind=kind))
    rows, uv = surface.mesh.seam[: surface.vertices, 2], surface.mesh.uv[: surface.vertices]
    near = np.isfinite(rows) & (np.abs(uv[:, 0]) > 1e-6)
    assert (rows[near] == np.where(uv[near, 0] > 0, 2.0, 0.0)).all()


@pytest.mark.parametrize(("share", "rows"), [(1.0, [0.0, 0.0]), (0.2, [1.0, 1.0])])
def test_a_hooked_seam_is_plain_and_flat(share, rows):
    solution = sewn(hooked=share)
    assert sides_of(solution.cover).rows.tolist() == rows
    assert (heights(solution, "a")[1].max() > 1e-4) == (rows[0] > 0)
    named = sewn(hooked=share, kind=SeamKind(kind="French"))
    assert sides_of(named.cover).rows.tolist() == [1.0, 1.0]


def test_the_solver_lifts_a_cover_with_a_hem():
    solution = sewn()
    m, n = len(solution.cover.faces), len(solution.cover.rest)
    none, some = np.zeros((0, 2), dtype=np.int64), np.zeros(0)
    hem = Hem(
        bending=np.zeros((m, 3, 3)), density=np.zeros(m), lift=np.zeros(n), near=none, far=none,
        row=np.zeros(0, dtype=np.int64), weight=some, length=some, stiffness=some,
    )  # fmt: skip
    surface = drawn_surface(replace(solution, cover=replace(solution.cover, hem=hem)))
    assert surface.mesh.vertices[: surface.vertices, 2] == pytest.approx(0.0, abs=1e-12)


def test_a_score_sees_the_shape_that_was_solved():
    bare = drawn_surface(sewn(kind=SeamKind(kind="top stitch 2")), built=False)
    assert bare.mesh.vertices[: bare.vertices, 2] == pytest.approx(0.0, abs=1e-12)
    rows = bare.mesh.seam[: bare.vertices, 2]
    assert set(rows[np.isfinite(rows)]) == {1.0}


def test_the_allowance_does_not_move_the_foam_below():
    solution = sewn(kind=SeamKind(kind="top stitch 2"))
    vertices, faces = rounded_block(np.array([0.09, 0.07, 0.04]), 0.0, 0.004)
    foam = Foam(vertices=vertices - [0.0, 0.0, 0.042], faces=faces, material=foam_material())
    carried = replace(solution, cover=replace(solution.cover, foam=foam))
    drawn = [drawn_surface(carried, built=built).mesh for built in (True, False)]
    lifted, bare = (mesh.vertices[-foam.faces.size :] for mesh in drawn)
    np.testing.assert_array_equal(lifted, bare)
    assert np.abs(drawn[0].vertices - drawn[1].vertices).max() > 1e-3


def test_a_moved_shape_is_lifted_as_its_own():
    first = sewn(kind=SeamKind(kind="top stitch 1"))
    x = first.positions + [0.0, 0.0, 1.0] * (0.05 * first.positions[:, :1] ** 2 + 0.01)
    moved = replace(first, positions=x)
    shared = drawn_surface(moved, like=drawn_surface(first)).mesh.vertices
    np.testing.assert_allclose(shared, drawn_surface(moved).mesh.vertices, atol=1e-12)


def test_profiles_are_smooth_shares():
    d = np.linspace(0.0, 0.02, 4001)
    for lapped in (False, True):
        share = profile(d, lapped=lapped)
        assert share.min() == 0.0
        assert share.max() == 1.0
        assert np.abs(np.diff(share, 2)).max() < 1e-4
