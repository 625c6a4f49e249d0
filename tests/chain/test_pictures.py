"""What ``seatlook render`` leaves of each picture: display, and radiance where asked for."""

from __future__ import annotations

from dataclasses import replace
from types import MappingProxyType

import numpy as np
import pytest
from PIL import Image

from seatlook.chain.draw import Canvas, Exposures, draw_pictures
from seatlook.errors import InputError
from seatlook.exr import read_exr
from seatlook.model import Rig, bulb
from seatlook.model.progress import silent
from support import scenes
from support.reference.lit_sheets import GREY, above, flat, sheet

pytestmark = pytest.mark.render
# A bright spot below a bulb, far above white.
RIG = Rig(name="near", lights=(bulb(position_mm=(0, 0, 60)),), ev100=5.0)


@pytest.fixture(scope="module")
def scene():
    looks = MappingProxyType({"grey": GREY})
    return replace(scenes.two_panels(), rigs=(RIG,), textures=looks)


@pytest.fixture(scope="module")
def solution():
    return sheet(flat, steps=8)


def draw(scene, solution, out, **options):
    canvas = Canvas(solution=solution, camera=above(size=(32, 24), fov=12.0), out=out)
    draw_pictures(scene, canvas, silent, exposures=Exposures(**options))
    return np.asarray(Image.open(out / "images/near/grey.png")).astype(float)


def test_tone_curve_rolls_off_what_the_default_cuts(scene, solution, tmp_path):
    cut = draw(scene, solution, tmp_path / "a")
    rolled = draw(scene, solution, tmp_path / "b", tone="neutral")
    assert cut.max() == 255
    assert (rolled[cut == 255] <= 255).all()
    assert rolled.mean() < cut.mean()
    with pytest.raises(InputError, match="tone: got 'filmic', expected one of clamp, neutral"):
        draw(scene, solution, tmp_path / "c", tone="filmic")


@pytest.mark.parametrize("suffix", ["npy", "exr"])
def test_radiance_is_kept_beside_the_picture(scene, solution, tmp_path, suffix):
    draw(scene, solution, tmp_path, radiance=suffix, quality="T1")
    path = tmp_path / f"images/near/grey.{suffix}"
    radiance = np.load(path) if suffix == "npy" else read_exr(path)
    assert radiance.shape == (24, 32, 3)
    # Below the bulb: candela over distance squared, over pi, of a grey of one half.
    expected = 0.5 * 800 / (4 * np.pi) / 0.06**2 / np.pi
    assert radiance[12, 16, 1] == pytest.approx(expected * RIG.lights[0].colour[1], rel=0.1)


@pytest.mark.parametrize("name", ["plain", "sweep"])
def test_a_picture_says_what_the_scene_has_around_the_seat(scene, solution, tmp_path, name):
    around = replace(scene, surroundings=name)
    shown = draw(around, solution, tmp_path, quality="T1")
    with Image.open(tmp_path / "images/near/grey.png") as file:
        assert file.text.get("seatlook surroundings", "plain") == name
    assert shown.shape == (24, 32, 3)


def test_a_scene_knows_its_surroundings(scene):
    with pytest.raises(InputError, match="surroundings: got 'studio', expected one of plain"):
        replace(scene, surroundings="studio")
