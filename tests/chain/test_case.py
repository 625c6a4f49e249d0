"""A seat in Python: names or objects, short in print, a picture in a notebook."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import seatlook
from seatlook import io
from seatlook.errors import InputError
from seatlook.model import VIEWS, framed_view
from support.scene_files import write_two_panels

pytestmark = pytest.mark.render


@pytest.fixture(scope="module")
def seat(tmp_path_factory):
    seat = seatlook.open(write_two_panels(tmp_path_factory.mktemp("case")))
    seat.solve()
    return seat


def pixels(seat, *args, **options):
    small = replace(seat.camera(None), size=(48, 27))
    return seat.render(*args, **{"camera": small, "quality": "draft"} | options).radiance


def test_each_step_is_made_once(seat):
    assert seat.solution is seat.solution
    assert seat.cover is seat.solution.cover or seat.cover == seat.solution.cover
    assert seat.assessment is seat.assessment
    assert seat.assessment.values("w2") is seat.assessment.values("w2")
    assert seat.current


def test_names_and_objects_mean_the_same(seat):
    suede = io.read_material("suede")
    bulb = seat.rig("bulb")
    by_name = pixels(seat, "suede", rig="bulb")
    assert np.array_equal(by_name, pixels(seat, suede, rig=bulb))
    assert np.array_equal(by_name, pixels(seat, suede.appearance, rig=bulb))
    # A supplied material that the scene does not name, and a view that it does not name.
    assert not np.array_equal(by_name, pixels(seat, "black-leather", rig="bulb"))
    detail = framed_view("detail", seat.scene.foam.vertices)
    assert np.array_equal(seat.camera("detail").position, detail.position)
    assert seat.rig(None) is seat.scene.rigs[0]


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"texture": "sued"}, r"texture: got 'sued', expected one of .*did you mean 'suede'"),
        ({"rig": "son"}, r"rig: got 'son', expected one of sun, bulb"),
        ({"camera": "topp"}, r"view: got 'topp'.*did you mean 'top'"),
    ],
)
def test_a_wrong_name_is_answered_with_the_nearest(seat, options, message):
    with pytest.raises(InputError, match=message):
        seat.render(**options)


def test_print_is_short_and_a_notebook_shows_a_picture(seat):
    for value in (seat, seat.scene, seat.cover, seat.solution, seat.assessment):
        assert len(repr(value)) < 300
        assert "array(" not in repr(value)
    html = seat._repr_html_()
    assert html.startswith('<img alt="two panels, pvc"')
    assert "data:image/png;base64," in html
    fresh = seatlook.open(seat.scene)
    assert repr(fresh).endswith("not solved yet)")
    assert fresh._repr_html_().startswith("<pre>Seat(")


def test_a_result_is_taken_as_it_is_and_says_whether_it_is_current(seat, tmp_path):
    io.write_result(seat.solution, tmp_path / "r.npz")
    again = seatlook.open(seat.scene, result=tmp_path / "r.npz")
    assert again.current
    assert np.array_equal(again.assessment.indices.w2, seat.assessment.indices.w2)
    other = seatlook.open(seat.scene, seed=5, result=tmp_path / "r.npz")
    assert not other.current


def test_element_size_scales_panels_own_sizes(seat):
    scene = replace(seat.scene, element_sizes=type(seat.scene.element_sizes)({"LEFT": 0.01}))
    half = seatlook.open(scene, element_size=scene.element_size / 2).scene
    assert half.element_sizes["LEFT"] == pytest.approx(0.005)


def test_exports_and_three_dimensions(seat, tmp_path):
    for ending in (".vtp", ".csv", ".glb", ".npz"):
        assert seat.export(tmp_path / f"seat{ending}").stat().st_size > 100
    view = seat.view_3d("w_compression", size=(64, 36))
    assert view.actors
    view.close()
    with pytest.raises(InputError, match="index: got 'w3', expected one of w1, w2"):
        seat.view_3d("w3")
    assert set(VIEWS) >= {"top", "detail"}


def test_without_a_design_the_shape_is_refused_with_the_file(seat):
    with pytest.raises(InputError, match=r"scene\.toml: design: got nothing, expected a table"):
        seat.shape()
