"""Turntable and picture sheet: what is in them, and that a stopped run goes on."""

from __future__ import annotations

from dataclasses import replace
from types import MappingProxyType

import numpy as np
import pytest
from PIL import Image

from seatlook import pbr
from seatlook.chain.showing import Turn, draw_sheet, draw_turntable
from seatlook.errors import InputError
from seatlook.model import Appearance, Rig, bulb, sun
from support import scenes
from support.reference.lit_sheets import GREY, above, sheet

pytestmark = pytest.mark.render
DARK = Appearance(albedo=np.array([0.05, 0.02, 0.01]), roughness=0.4)
SUN = Rig(name="sun", lights=(sun(elevation_deg=30.0, azimuth_deg=60.0),))
BULB = Rig(name="a bulb", lights=(bulb(position_mm=(150, 60, 250)),))
CAMERA = replace(above(size=(64, 48), fov=20.0), position=np.array([0.0, -0.8, 0.6]))
SMALL = Turn(pictures=4, seconds=1.0, width=48, quality="draft")


@pytest.fixture(scope="module")
def solution():
    return sheet(lambda x, y: 0.02 * np.cos(30 * x) + 0 * y, steps=12)


def frames(path):
    with Image.open(path) as film:
        for k in range(film.n_frames):
            film.seek(k)
            yield np.asarray(film.convert("RGB")).astype(int)


def turntable(solution, path, turn=SMALL, **options):
    return draw_turntable(solution, GREY, [path], rig=SUN, camera=CAMERA, turn=turn, **options)


def test_the_seat_turns_below_a_standing_light(solution, tmp_path):
    turntable(solution, tmp_path / "a.apng")
    turntable(solution, tmp_path / "b.apng", replace(SMALL, lights_turn=True))
    turns, stays = (list(frames(tmp_path / name)) for name in ("a.apng", "b.apng"))
    assert len(turns) == len(stays) == 4
    np.testing.assert_array_equal(turns[0], stays[0])
    # From behind the sheet is the same, but lit from its other side if the light goes with it.
    assert np.abs(turns[2] - turns[0]).mean() < 1.5
    assert np.abs(turns[1] - turns[0]).mean() > 3.0
    assert np.abs(stays[2] - stays[0]).mean() > 3.0
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.apng", "b.apng"]


def test_a_stopped_turntable_goes_on_and_is_the_same(solution, tmp_path, monkeypatch):
    whole = turntable(solution, tmp_path / "whole.apng")[0].read_bytes()
    drawn, render = [], pbr.render

    def stop(*arguments, **options):
        if len(drawn) == 2:
            raise KeyboardInterrupt
        drawn.append(options["camera"].position)
        return render(*arguments, **options)

    monkeypatch.setattr(pbr, "render", stop)
    path = tmp_path / "again.apng"
    with pytest.raises(KeyboardInterrupt):
        turntable(solution, path)
    assert not path.exists()
    kept = tmp_path / "again.pictures"
    assert len(list(kept.iterdir())) == 2
    (kept / "001.png").write_bytes((kept / "001.png").read_bytes()[:300])  # half a file
    steps = []
    monkeypatch.setattr(pbr, "render", lambda *a, **o: steps.append(1) or render(*a, **o))
    turntable(solution, path)
    assert len(steps) == 3
    assert path.read_bytes() == whole
    assert not kept.exists()


def test_pictures_of_another_light_are_not_taken(solution, tmp_path):
    path = tmp_path / "a.apng"
    keep = replace(SMALL, keep=True)
    turntable(solution, path, keep)
    low = Rig(name="sun", lights=(sun(elevation_deg=20.0, azimuth_deg=0.0),))
    draw_turntable(solution, GREY, [path], rig=low, camera=CAMERA, turn=keep)
    fresh = tmp_path / "fresh.apng"
    draw_turntable(solution, GREY, [fresh], rig=low, camera=CAMERA, turn=SMALL)
    assert path.read_bytes() == fresh.read_bytes()
    assert len(list((tmp_path / "a.pictures").iterdir())) == 4


def test_a_bulb_that_goes_round_does_not_flicker(solution, tmp_path):
    turn = replace(SMALL, lights_turn=True)
    path = tmp_path / "a.apng"
    draw_turntable(solution, GREY, [path], rig=BULB, camera=CAMERA, turn=turn)
    means = [picture.mean() for picture in frames(path)]
    assert max(means) < 1.1 * min(means)


@pytest.mark.parametrize("wrong", [{"pictures": 1}, {"width": 8}, {"seconds": 0.0}])
def test_turns_that_cannot_be_are_refused(wrong):
    with pytest.raises(InputError, match=f"{next(iter(wrong))}: got .* expected"):
        Turn(**wrong)


def test_sheet_holds_every_texture_under_every_rig(solution, tmp_path):
    looks = MappingProxyType({"grey": GREY, "dark": DARK})
    scene = replace(scenes.two_panels(), rigs=(SUN, BULB), textures=looks)
    views = [CAMERA, replace(CAMERA, name="other", position=np.array([0.7, -0.2, 0.7]))]
    path = draw_sheet(
        solution, scene, tmp_path / "sheet.png", cameras=views, width=40, quality="draft"
    )
    page = np.asarray(Image.open(path)).astype(int)
    assert page.shape == (28 + 6 * 3 + 2 * 30, 150 + 6 * 5 + 4 * 40, 3)
    for row, appearance in enumerate(looks.values()):
        for column, (rig, view) in enumerate((r, v) for r in scene.rigs for v in views):
            small = replace(view, size=(40, 30))
            image = pbr.render(solution, appearance, rig=rig, camera=small, quality="draft")
            y, x = 34 + row * 36, 156 + column * 46
            np.testing.assert_array_equal(page[y : y + 30, x : x + 40], image.to_srgb())
    assert [p.name for p in tmp_path.iterdir()] == ["sheet.png"]
