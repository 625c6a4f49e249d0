"""Seams: closed, backed by the allowance, with coordinates for the thread."""

from __future__ import annotations

import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.model import Rig, Thread, sun
from seatlook.pbr.kernels.stitch import seam_relief
from seatlook.pbr.shading.seam import pack_thread
from seatlook.pbr.shading.studio import Studio
from seatlook.pbr.shading.surface import drawn_surface
from support.reference.lit_sheets import GREY, above, flat, sheet
from support.reference.sewn_sheet import sewn

TOP_STITCH = pack_thread(Thread())
RIG = Rig(name="noon", lights=(sun(elevation_deg=80, azimuth_deg=0),))


def test_gap_is_closed_half_way_from_both_sides():
    surface = drawn_surface(sewn())
    mesh = surface.mesh
    n = surface.vertices
    line = np.flatnonzero(mesh.seam[:n, 0] < 1e-9)
    assert len(line) > 40
    assert np.allclose(mesh.vertices[line, 0], 0.0001, atol=1e-9)


def test_only_the_sewn_edge_has_a_seam():
    surface = drawn_surface(sewn())
    seam, x = surface.mesh.seam[: surface.vertices], surface.mesh.uv[: surface.vertices]
    near = np.isfinite(seam[:, 0])
    assert np.allclose(seam[near, 0], np.abs(x[near, 0]), atol=1e-9)
    assert np.abs(x[~near, 0]).min() >= 0.0139
    # Length along runs with the outline: up on the left panel, down on the right one.
    left = near & (x[:, 0] < 0)
    assert np.allclose(seam[left, 1], x[left, 1] + 0.05, atol=1e-6)


def test_allowance_hangs_inward_below_the_seam():
    surface = drawn_surface(sewn())
    added = surface.mesh.vertices[surface.vertices :]
    assert len(added) > 40
    assert np.allclose(added[:, 2], -0.003, atol=1e-6)
    assert surface.opaque > surface.faces


def test_nothing_is_seen_through_the_seam():
    camera = above(distance=0.2, size=(400, 20), fov=1.2)
    image = Studio(sewn(gap=0.0008)).render(GREY, rig=RIG, camera=camera)
    assert image.cover.min() == 1.0


def test_unsewn_cover_has_no_allowance():
    surface = drawn_surface(sheet(flat, steps=4))
    assert surface.opaque == surface.faces
    assert np.isinf(surface.mesh.seam[:, 0]).all()


def test_relief_of_thread_groove_and_hole():
    fine = 1e-5
    middle = seam_relief(TOP_STITCH, TOP_STITCH.offset, 0.5 * TOP_STITCH.pitch, fine)
    assert middle[3] == 1.0
    assert middle[0] == pytest.approx(0.0, abs=1e-9)
    side = seam_relief(TOP_STITCH, TOP_STITCH.offset + 0.0003, 0.5 * TOP_STITCH.pitch, fine)
    assert side[0] < -0.5  # falls away from the middle of the thread
    hole = seam_relief(TOP_STITCH, TOP_STITCH.offset, 0.0, fine)
    assert hole[3] == 0.0
    assert hole[2] < 0.5
    into = seam_relief(TOP_STITCH, 0.0, 0.5 * TOP_STITCH.pitch, fine)
    assert into[0] > 0.5  # rises away from the seam
    far = seam_relief(TOP_STITCH, 0.0135, 0.5 * TOP_STITCH.pitch, fine)
    assert abs(far[0]) < 1e-4
    assert far[2] == pytest.approx(1.0, abs=1e-6)


def test_stitches_show_at_their_pitch():
    image = Studio(sewn(gap=0.0)).render(
        GREY, rig=RIG, camera=above(size=(60, 600), fov=5.0, at=(0.005, 0.0, 0.0))
    )
    column = image.radiance[:, 28:32, 1].mean(axis=1).astype(float)
    spectrum = np.abs(np.fft.rfft((column - column.mean()) * np.hanning(600)))
    seen = 2 * np.tan(np.radians(2.5))
    assert spectrum.argmax() == pytest.approx(seen / TOP_STITCH.pitch, abs=1.0)


def seen_thread(**change):
    """Middle of a stitch [share of the sheet's own radiance], in three colours."""
    studio = Studio(sewn(gap=0.0), thread=Thread(**change))
    fine = above(distance=0.3, size=(40, 40), fov=1.0, at=(0.005, 0.0025, 0.0))
    stitch = studio.render(GREY, rig=RIG, camera=fine).radiance[19:21, 19:21].mean(axis=(0, 1))
    plain = studio.render(GREY, rig=RIG, camera=above(size=(8, 8), fov=1.0, at=(0.03, 0.03, 0.0)))
    return stitch / plain.radiance.mean(axis=(0, 1))


def test_thread_has_its_own_colour():
    red = seen_thread(colour=np.array([0.5, 0.05, 0.02]))
    assert red == pytest.approx([1.0, 0.1, 0.04], rel=0.25)
    assert red[0] / red[1] == pytest.approx(10.0, rel=0.1)
    tonal = seen_thread()
    assert tonal == pytest.approx(np.full(3, 1.06), rel=0.1)


def test_plain_seam_has_neither_stitch_nor_hole():
    assert seen_thread(width=0.0) == pytest.approx(np.ones(3), rel=0.01)
    plain = pack_thread(Thread(width=0.0))
    for along in (0.0, 0.0025):
        away, onward, share, covered = seam_relief(plain, 0.005, along, 1e-5)
        assert (onward, covered) == (0.0, 0.0)
        assert share == pytest.approx(1.0, abs=1e-3)
        assert away < 0.02


def test_stitch_longer_than_its_pitch():
    with pytest.raises(InputError, match=r"Thread.length: got 6 mm, expected at most the pitch, 5"):
        Thread(length=0.006)
