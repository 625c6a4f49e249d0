"""A user's own surface and seam lines on the command line."""

import csv
import json
import subprocess
import sys

import numpy as np
import pytest

from seatlook import io
from seatlook.cli import run
from support.meshes import rectangle

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


def test_flatten_for_a_fabric_leaves_pictures_and_seam_lengths(demo_scene, tmp_path, capsys):
    surface = str(demo_scene.with_name("design.obj"))
    words = ["flatten", surface, "--out", str(tmp_path), "--json"]
    assert run([*words, "--material", "leather-laminate"]) == 0
    rows = json.loads(capsys.readouterr().out)
    assert all(row["energy_mj"] > 0 for row in rows)
    assert len(list(tmp_path.glob("strain-*.png"))) == len(rows) == 7
    with (tmp_path / "seam-lengths.csv").open() as file:
        seams = list(csv.DictReader(file))
    assert len(seams) == 14
    assert max(abs(float(seam["difference_mm"])) for seam in seams) < 0.05
    assert run([*words, "--material", "lether"]) == 2
    assert "lether" in capsys.readouterr().err


def test_flatten_writes_a_pattern_and_its_strains(demo_scene, tmp_path, capsys):
    surface = demo_scene.with_name("design.obj")
    assert run(["flatten", str(surface), "--out", str(tmp_path), "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)
    assert {row["panel"] for row in rows} >= {"INSERT", "BOLSTER_L", "REAR"}
    assert all(
        row["strain_smallest"] <= row["strain_mean"] <= row["strain_largest"] for row in rows
    )
    pattern = io.read_pattern(tmp_path / "pattern.dxf", tmp_path / "seams.toml")
    assert len(pattern.seams) == 14
    assert "[placement.INSERT]" in (tmp_path / "placement.toml").read_text()
