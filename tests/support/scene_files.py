"""The scene of two panels, as files on disk: the smallest that a user could have written."""

from __future__ import annotations

from pathlib import Path

from seatlook import io
from support.scenes import two_panels

TEXT = """schema = 1
name = "two panels"

[pattern]
file = "pattern.dxf"
seams = "seams.toml"
material = "pvc"

[foam]
file = "foam.obj"
unit = "mm"
material = "foam-seat"
curves = "curves.toml"

[mesh]
element_size_mm = 20.0

[placement.LEFT]
axes = ["+x", "+y"]
translation_mm = [0.0, 0.0, 5.0]

[placement.RIGHT]
axes = ["+x", "+y"]
translation_mm = [102.0, 0.0, 5.0]

[[stage]]
name = "sew"
start_s = 0.0
end_s = 0.4

[[stage]]
name = "cover"
start_s = 0.2
end_s = 0.6

[[hook]]
name = "hook"
line = "middle"
wire = "wire"
stage = "cover"

[[frame]]
name = "rail"
edges = "LEFT.rim"
curve = "rail"
stage = "cover"

[[rig]]
name = "sun"

[[rig.light]]
kind = "sun"
elevation_deg = 50.0
azimuth_deg = 30.0

[[rig]]
name = "bulb"
ev100 = 5.0

[[rig.light]]
kind = "bulb"
lumen = 800.0
position_mm = [300.0, 0.0, 500.0]

[camera]
views = ["top"]
size = [96, 54]

[gallery]
textures = ["pvc", "suede"]
"""


def write_two_panels(folder: Path, *, text: str = TEXT) -> Path:
    """Write scene.toml and the files it names; return its path."""
    scene = two_panels()
    io.write_dxf(scene.pattern, folder / "pattern.dxf", style="two")
    io.write_seams(scene.pattern, folder / "seams.toml")
    io.write_obj(scene.foam.vertices, scene.foam.faces, folder / "foam.obj")
    io.write_curves(scene.foam.curves, folder / "curves.toml")
    (folder / "scene.toml").write_text(text)
    return folder / "scene.toml"
