"""Whatever the surface, its faces, the fabric, an ease or a short panel: it becomes flat."""

import warnings

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from PIL import Image

from seatlook import io, mesh
from seatlook.errors import InputWarning
from seatlook.flattening import cut_along, flatten
from seatlook.flattening.cutting import opened
from seatlook.flattening.strain_map import write_strain_maps
from support.curved_panels import half_ellipsoid
from support.seat_surfaces import box_cushion, cap, on_cap, undivided


@pytest.fixture(autouse=True)
def quiet():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        yield


def sound(surface, result, *, eased=()):
    """No face turned, and the lines of seams that are not eased equally long."""
    for patch in surface.patches():
        assert (mesh.face_vectors(result.flat[patch.name], patch.faces)[:, 2] > 0).all()
    for seam in result.seams:
        if seam.seam not in eased:
            assert abs(seam.difference) < 5e-5


def cut_cap(size, *, saddle=False):
    lines = {
        "across": np.linspace((-0.16, -0.03), (0.16, 0.05), 12),
        "dart": np.linspace((0.0, -0.16), (0.01, -0.07), 6),
    }
    surface = undivided(*cap(half=0.16, size=size, saddle=saddle))
    if saddle:  # a dart has nothing to take up there
        del lines["dart"]
    return cut_along(surface, {k: on_cap(v, saddle=saddle) for k, v in lines.items()})


@pytest.mark.parametrize("size", [0.008, 0.010, 0.012])
@pytest.mark.parametrize("saddle", [False, True])
def test_domes_and_saddles_of_any_face_size(size, saddle):
    surface = cut_cap(size, saddle=saddle)
    sound(surface, flatten(surface))


@pytest.mark.parametrize("material", io.list_materials())
def test_a_boxed_cushion_of_every_material(material):
    surface = opened(box_cushion(size=0.015))
    fabric = io.read_material(material).fabric
    result = flatten(surface, fabrics=dict.fromkeys(surface.panel_names, fabric))
    sound(surface, result)


@pytest.mark.parametrize("ease", [-0.03, 0.02, 0.04])
@pytest.mark.parametrize("short", [0.0, 0.04])
def test_a_boxed_cushion_with_an_ease_and_a_short_panel(ease, short):
    surface = opened(box_cushion(size=0.015))
    result = flatten(surface, ease={"BAND_1-TOP": ease}, short={"BASE": short} if short else {})
    eased = {"BAND_1-TOP"} | ({"BAND_1-BASE", "BAND_2-BASE"} if short else set())
    sound(surface, result, eased=eased)
    (seam,) = (s for s in result.seams if s.seam == "BAND_1-TOP")
    assert seam.a == pytest.approx((1 + ease) * seam.b, rel=1e-4)


@settings(max_examples=8, deadline=None, derandomize=True)
@given(
    stretch=st.floats(1.0, 12.0),
    turn=st.floats(0.0, 3.0),
    seed=st.integers(0, 99),
)
def test_needles_are_no_hindrance(stretch, turn, seed):
    """Faces many times as long as wide, in any direction, and vertices that are out of place."""
    c, s = np.cos(turn), np.sin(turn)
    away = np.array([[c, -s], [s, c]])
    vertices, faces = cap(half=0.12, size=0.02)
    fine = vertices[:, :2] @ away * [1.0, 1.0 / stretch] @ away.T
    rng = np.random.default_rng(seed)
    inner = np.setdiff1d(np.arange(len(vertices)), mesh.boundary_loops(faces)[0])
    moved = fine.copy()
    moved[inner] += (
        rng.uniform(-0.1, 0.1, (len(inner), 2)) @ away * 0.02 * [1, 1 / stretch] @ away.T
    )
    surface = undivided(on_cap(moved), faces)
    sound(surface, flatten(surface))


def test_panels_of_very_unequal_size():
    surface = cut_along(
        undivided(*cap(half=0.16, size=0.012)),
        {
            "a": on_cap(np.linspace((-0.16, 0.14), (0.16, 0.15), 12)),
            "b": on_cap(np.linspace((-0.145, 0.1404), (-0.15, 0.16), 4)),
        },
    )
    sound(surface, flatten(surface))


def test_a_proposed_dart_is_drawn_in_the_picture(tmp_path):
    surface = undivided(*half_ellipsoid(0.09))
    result = flatten(surface)
    assert len(result.excess) == 1
    (path,) = write_strain_maps(surface, result, tmp_path)
    pixels = np.asarray(Image.open(path).convert("RGB"))[60:, :740]
    assert (pixels.max(axis=2) < 40).sum() > 100
