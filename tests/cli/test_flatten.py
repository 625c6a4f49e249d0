"""A user's own surface and seam lines on the command line."""

import csv
import json
import shlex
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


def name_panels(form, **points):
    tables = "".join(f"[panel.{name}]\npoint_mm = {place}\n" for name, place in points.items())
    text = LINES.format(z=0) + tables
    (form / "lines.toml").write_text(text)
    lines = str(form / "lines.toml")
    return run(
        ["flatten", str(form / "form.obj"), "--out", str(form / "named"), "--seam-lines", lines]
    )


def test_panels_may_be_named_by_a_point_in_each(form):
    assert name_panels(form, INSERT=[200, 40, 0], BOLSTER_L=[200, 250, 4]) == 0
    pattern = io.read_pattern(form / "named/pattern.dxf", form / "named/seams.toml")
    assert {panel.name for panel in pattern.panels} == {"INSERT", "BOLSTER_L"}
    assert {"INSERT.BOLSTER_L", "BOLSTER_L.INSERT", "INSERT.free"} <= set(pattern.edges)


@pytest.mark.parametrize(
    ("points", "message"),
    [
        ({"A": [200, 40, 30]}, "panel.A.point_mm: got one farther away, expected a point at most"),
        (
            {"A": [200, 40, 0], "B": [210, 40, 0]},
            "panel.B.point_mm: got a point in the same panel as A",
        ),
        ({"PANEL_2": [200, 40, 0]}, "panel.PANEL_2: got a name that two panels have"),
    ],
)
def test_names_of_panels_that_cannot_be_are_refused(form, capsys, points, message):
    assert name_panels(form, **points) == 2
    said = " ".join(capsys.readouterr().err.split())
    assert message in said
    assert "lines.toml" in said


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
        row["strain_smallest_percent"]
        <= row["strain_mean_percent"]
        <= row["strain_largest_percent"]
        for row in rows
    )
    pattern = io.read_pattern(tmp_path / "pattern.dxf", tmp_path / "seams.toml")
    assert len(pattern.seams) == 14
    assert "[placement.INSERT]" in (tmp_path / "placement.toml").read_text()


def test_a_bare_panel_has_no_cover(form):
    text = LINES.format(z=0) + "[panel.BASE]\npoint_mm = [200, 250, 4]\nbare = true\n"
    (form / "lines.toml").write_text(text)
    lines = str(form / "lines.toml")
    command = ["flatten", str(form / "form.obj"), "--out", str(form / "bare")]
    assert run([*command, "--seam-lines", lines]) == 0
    pattern = io.read_pattern(form / "bare/pattern.dxf", form / "bare/seams.toml")
    assert len(pattern.panels) == 1
    assert pattern.seams == ()


@pytest.mark.parametrize("fault", ["fin", "twice"])
def test_a_surface_that_must_be_mended_is_refused_with_the_command_that_does_it(
    tmp_path, monkeypatch, capsys, fault
):
    """The command is copied from the message as it is; what it writes is flattened."""
    monkeypatch.chdir(tmp_path)
    flat, faces = rectangle("uns", 40.0, 30.0, 3.0)
    points = np.column_stack([flat[:, 0], np.zeros(len(flat)), -flat[:, 1]])
    middle = int(np.linalg.norm(flat - [20.0, 15.0], axis=1).argmin())
    ring = np.flatnonzero((faces == middle).any(axis=1))
    if fault == "fin":
        points = np.vstack([points, points[middle] + [0.0, 0.5, 0.0]])
        faces = np.vstack([faces, [*faces[ring[0], :2], len(points) - 1]])
    else:
        faces = np.vstack([faces, faces[ring[:1]]])
    io.write_obj(1e-3 * points, faces, tmp_path / "my form.obj")
    assert run(["flatten", "my form.obj", "--unit", "cm", "--up", "y", "--out", "out"]) == 2
    said = capsys.readouterr().err
    command = said[said.index("seatlook mend") : said.index("--sheet") + len("--sheet")]
    assert command.startswith(
        "seatlook mend 'my form.obj' --unit cm --up y --out 'my form-mended.obj'"
    )
    assert run(shlex.split(command)[1:]) == 0
    assert run(["flatten", "my form-mended.obj", "--out", "out"]) == 0
