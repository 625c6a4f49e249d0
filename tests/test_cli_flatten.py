"""A user's own surface and seam lines on the command line."""

import csv
import subprocess
import sys

import numpy as np
import pytest

from meshes import rectangle
from seatlook import io

LINES = """
[curve.welt]
points_mm = [[0, 113, {z}], [230, 187, 0], [400, 71, 0]]
"""


@pytest.fixture
def form(tmp_path):
    flat, faces = rectangle("uns", 0.4, 0.3, 0.03)
    io.write_obj(np.column_stack([flat, np.zeros(len(flat))]), faces, tmp_path / "form.obj")
    return tmp_path


def flatten(folder, *, z):
    (folder / "lines.toml").write_text(LINES.format(z=z))
    words = ["flatten", "form.obj", "--seam-lines", "lines.toml", "--out", "out"]
    return subprocess.run(
        [sys.executable, "-m", "seatlook", *words],
        cwd=folder,
        capture_output=True,
        text=True,
        check=False,
    )


def test_a_surface_without_groups_becomes_a_pattern_along_its_lines(form):
    done = flatten(form, z=0)
    assert done.returncode == 0, done.stderr
    pattern = io.read_pattern(form / "out/pattern.dxf", form / "out/seams.toml")
    exact = np.hypot(230, 74) + np.hypot(170, 116)
    (seam,) = pattern.seams
    assert seam.name == "welt"
    assert {edge.panel for edge in pattern.edges.values()} == {"PANEL_1", "PANEL_2"}
    assert 1e3 * pattern.edge_length(seam.a) == pytest.approx(exact, abs=0.05)
    with (form / "out/seam-lengths.csv").open() as file:
        (row,) = csv.DictReader(file)
    assert row["seam"] == "welt"
    assert float(row["design_mm"]) == pytest.approx(exact, abs=1e-3)
    assert len(list((form / "out").glob("strain-*.png"))) == 2
    panels = io.read_surface(form / "out/panels.obj", unit="mm")
    assert panels.panel_names == ("PANEL_1", "PANEL_2")


def test_a_line_off_the_surface_is_refused_with_file_and_key(form):
    done = flatten(form, z=5)
    assert done.returncode == 2
    assert (
        "lines.toml: curve.welt.points_mm[0]: got 5.00 mm, expected within 2 mm of the surface"
        in " ".join(done.stderr.split())
    )
    assert not (form / "out/pattern.dxf").exists()
