"""Strips, rectangles and tunnels as a scene gives them."""

import numpy as np
import pytest

from seatlook.io.scene.read import load_scene
from seatlook.model import rectangle, strip, tunnel, two_sided_rectangle
from support.scene_files import TEXT, write_two_panels

LAMP = '\n[[rig]]\nname = "lamps"\n[[rig.light]]\nkind = "{}"\n{}\n'


def lights(tmp_path, kind, keys):
    path = write_two_panels(tmp_path, text=TEXT + LAMP.format(kind, keys))
    return load_scene(path).rigs[-1].lights


@pytest.mark.parametrize(
    ("kind", "keys", "expected"),
    [
        ("strip", "position_mm = [0, 0, 900]", (strip(position_mm=(0, 0, 900)),)),
        (
            "rectangle",
            "position_mm = [9, 0, 900]\ntarget_mm = [0, 0, 1]\nalong = [0, 1, 0]\nsize_mm = [9, 5]",
            (
                rectangle(
                    position_mm=(9, 0, 900), target_mm=(0, 0, 1), along=(0, 1, 0), size_mm=(9, 5)
                ),
            ),
        ),
        ("tunnel", "lumen = 9000\nazimuth_deg = 30", tunnel(lumen=9000, azimuth_deg=30)),
        ("tunnel", "", tunnel()),
        (
            "two_sided_rectangle",
            "position_mm = [0, 0, 900]",
            (two_sided_rectangle(position_mm=(0, 0, 900)),),
        ),
    ],
)  # fmt: skip
def test_lamps_of_a_scene(tmp_path, kind, keys, expected):
    got = lights(tmp_path, kind, keys)
    assert len(got) == len(expected)
    for one, other in zip(got, expected, strict=True):
        assert (one.name, one.intensity, one.two_sided) == (
            other.name, other.intensity, other.two_sided,
        )  # fmt: skip
        np.testing.assert_array_equal(one.sides, other.sides)
        np.testing.assert_array_equal(one.vector, other.vector)


@pytest.mark.parametrize(
    ("kind", "keys", "message"),
    [
        ("strip", "", "position_mm: got nothing"),
        ("strip", "position_mm = [0, 0, 900]\nsize_mm = [9, 9, 9]", "size_mm: got [9, 9, 9]"),
        ("strip", "position_mm = [0, 0, 900]\nalong = [0, 0, 2]", "along: got [0.0, 0.0, 2.0]"),
        ("rectangle", "position_mm = [0, 0, 900]\nsize_mm = [0, 9]", "size_mm: got [0.0, 9.0]"),
        ("tunnel", "position_mm = [0, 0, 900]", "position_mm: "),
        ("tunnel", "radius_mm = 0", "target_mm: got"),
    ],
)
def test_lamps_that_a_scene_cannot_have(tmp_path, problems, kind, keys, message):
    path = write_two_panels(tmp_path, text=TEXT + LAMP.format(kind, keys))
    (got,) = problems(load_scene, path)
    assert message in got
