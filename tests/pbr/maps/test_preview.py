"""Quick pictures: hand-computed light, who is who, and that nothing to see is an error."""

import dataclasses

import numpy as np
import pytest

from seatlook.errors import RenderError
from seatlook.model import Foam
from seatlook.model.colour import srgb_encode
from seatlook.pbr import render_preview
from seatlook.pbr.maps.preview import _LIGHT, _PAPER, _SKY, _TINTS
from support.boxes import rounded_block
from support.reference.lit_sheets import above, flat, sheet
from support.scenes import foam_material

pytestmark = pytest.mark.render
CAMERA = above(size=(160, 120), fov=20)


def test_level_sheet_takes_the_cosine_of_the_light():
    solution = sheet(flat, steps=8, panels=2)
    picture = render_preview(solution, camera=CAMERA)
    cosine = _LIGHT[2] / np.linalg.norm(_LIGHT)
    expected = 255 * srgb_encode(_TINTS[:2] * (_SKY + (1 - _SKY) * cosine))
    shown = np.stack([picture[60, 60], picture[60, 100]]).astype(float)
    assert np.abs(np.sort(shown, axis=0) - np.sort(expected, axis=0)).max() <= 1
    assert np.abs(picture[2, 2].astype(float) - 255 * srgb_encode(np.array(_PAPER))).max() <= 1


def test_slopes_towards_the_light_are_brighter():
    """A ridge along y: the camera's left side, where the light stands, against its right."""
    solution = sheet(lambda x, y: 0.02 * np.cos(x / 0.03) + 0 * y, steps=24)
    row = render_preview(solution, camera=CAMERA)[60].astype(float).sum(axis=1)
    covered = np.flatnonzero(np.abs(row - row[0]) > 30)
    middle = (covered[0] + covered[-1]) // 2
    assert row[middle - 12] > 1.2 * row[middle + 12]


def test_foam_is_seen_beside_the_cover():
    solution = sheet(flat, steps=8)
    x = np.array(solution.positions)
    low, high = x.min(axis=0), x.max(axis=0)
    vertices, faces = rounded_block(np.array([*(1.3 * (high - low)[:2]), 0.03]), 0.0, 0.006)
    vertices = vertices + np.append((low + high)[:2] / 2, -0.05)
    foam = Foam(vertices=vertices, faces=faces, material=foam_material())
    carried = dataclasses.replace(solution, cover=dataclasses.replace(solution.cover, foam=foam))
    bare, both = (render_preview(s, camera=CAMERA).astype(int) for s in (solution, carried))
    changed = np.abs(bare - both).sum(axis=2) > 30
    assert changed.sum() > 200
    assert not changed[60, 80]


def test_nothing_in_the_picture_is_an_error():
    away = dataclasses.replace(CAMERA, target=2 * CAMERA.position - CAMERA.target)
    with pytest.raises(RenderError, match="nothing is in the picture"):
        render_preview(sheet(flat, steps=4), camera=away)
