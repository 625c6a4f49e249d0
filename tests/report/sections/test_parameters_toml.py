"""What the page offers to copy reads back as the material and the settings it shows."""

from __future__ import annotations

import tomllib

import numpy as np
import pytest

from seatlook import io
from seatlook.report.sections.parameters import parameter_toml
from support.scene_files import write_two_panels


@pytest.fixture
def scene(tmp_path):
    return io.load_scene(write_two_panels(tmp_path))


def test_a_cover_copied_is_the_same_cover(scene, tmp_path):
    text = parameter_toml(scene)["cover pvc"]
    path = tmp_path / "copied.toml"
    path.write_text(text)
    copied, own = io.read_material(str(path)), scene.materials["LEFT"]
    for name in ("thickness", "density", "bending_warp", "bending_weft", "poisson"):
        assert getattr(copied.fabric, name) == pytest.approx(getattr(own.fabric, name), rel=1e-12)
    assert np.allclose(copied.fabric.warp.stiffness, own.fabric.warp.stiffness, rtol=1e-12)
    assert np.allclose(copied.fabric.warp.strain, own.fabric.warp.strain)
    assert np.array_equal(copied.appearance.albedo, own.appearance.albedo)
    assert copied.appearance.texture == own.appearance.texture


def test_settings_are_in_the_units_of_the_file(scene):
    values = tomllib.loads(parameter_toml(scene)["scene"])
    assert values["mesh"] == {"element_size_mm": 20.0, "smallest_notch_mm": 5.0, "seed": 0}
    assert values["wrinkle"] == {"curvature": "tensor", "c_threshold_per_mm": 0.02}


def test_every_text_is_toml(scene):
    for text in parameter_toml(scene).values():
        assert tomllib.loads(text)
