"""From a design surface to a scene: flatten with a foam, and init from what flatten left."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import numpy as np
import pytest

from seatlook import io
from seatlook.chain.case import Case
from seatlook.cli import run
from seatlook.flattening.lie import read_lie
from seatlook.seats import write_demo


@pytest.fixture(scope="module")
def seat(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Files of a seat as a user has them: surface, foam, wires."""
    folder = tmp_path_factory.mktemp("seat")
    write_demo(folder / "demo", surface_size=0.02, element_size_mm=20.0)
    for name in ("design.obj", "foam.obj", "wires.toml"):
        shutil.copy(folder / "demo" / name, folder / name)
    return folder


def flatten(seat: Path, out: Path, *words: str) -> int:
    return run(["flatten", str(seat / "design.obj"), "--out", str(out), *words])


@pytest.fixture(scope="module")
def scene(seat: Path) -> Path:
    words = ("--foam", str(seat / "foam.obj"), "--wires", str(seat / "wires.toml"))
    assert flatten(seat, seat / "whole", *words) == 0
    return seat / "whole" / "scene.toml"


def test_the_scene_of_a_surface_is_whole_and_contradicts_nothing(scene):
    read = io.load_scene(scene, changes=["mesh.element_size_mm=20"])
    Case(read).check()
    assert {hook.wire: hook.lines for hook in read.hooks} == {
        "trench_left": ("INSERT-BOLSTER_L",),
        "trench_right": ("INSERT-BOLSTER_R",),
    }
    (frame,) = read.frames
    assert len(frame.edges) == 4
    border = read.foam.curves[frame.curve]
    assert (border[0] == border[-1]).all()
    assert set(read.placement) == {panel.name for panel in read.pattern.panels}
    assert read.design is not None


def test_every_border_point_is_pulled_to_where_it_lies_on_the_surface(scene):
    read = io.load_scene(scene, changes=["mesh.element_size_mm=20"])
    cover = Case(read).cover
    (anchor,) = (a for a in cover.anchors if a.kind == "frame")
    design = read.design.vertices
    away = np.linalg.norm(anchor.target[:, None] - design, axis=2).min(axis=1)
    assert away.max() < 0.012  # of the vertices, which are 20 mm apart


def test_without_a_foam_it_says_what_is_missing_and_init_goes_on(seat, scene, capsys):
    out = seat / "pattern"
    assert flatten(seat, out) == 0
    assert f"no scene yet, as there is no foam: seatlook init --from {out}" in " ".join(
        capsys.readouterr().err.split()
    )
    assert not (out / "scene.toml").exists()
    assert run(["init", "--from", str(out)]) == 2
    assert "foam: got 0 of foam.obj" in capsys.readouterr().err
    for name in ("foam.obj", "wires.toml"):
        shutil.copy(seat / name, out / name)
    assert run(["init", "--from", str(out), "--json"]) == 0
    rows = json.loads(capsys.readouterr().out)
    assert [row["to"] for row in rows] == ["trench_left", "trench_right", "border"]
    one, other = (path.read_text().splitlines() for path in (scene, out / "scene.toml"))
    differ = {a.split(" =")[0] for a, b in zip(one, other, strict=True) if a != b}
    # Places were read from millimetres: their last digits may differ.
    assert {line for line in differ if line[0] != "#"} - {"translation_mm"} == {"name", "file"}
    assert run(["init", "--from", str(out)]) == 2
    assert "expected a new one, or --force" in capsys.readouterr().err


def test_the_foam_and_the_folder_may_be_elsewhere(seat, tmp_path, capsys):
    out = seat / "again"
    assert flatten(seat, out) == 0
    words = ["init", "--from", str(out), str(seat / "foam.obj"), "--out", str(tmp_path / "s")]
    assert run(words) == 0
    read = io.load_scene(tmp_path / "s" / "scene.toml", changes=["mesh.element_size_mm=20"])
    assert read.hooks == ()
    assert len(read.pattern.seams) == 14
    assert run(["init", "--from", str(tmp_path), str(seat / "foam.obj")]) == 2
    assert "--from: got a folder without pattern.dxf" in capsys.readouterr().err


def test_an_edited_scene_stays(seat, scene, capsys):
    before = scene.read_bytes()
    assert flatten(seat, scene.parent, "--foam", str(seat / "foam.obj")) == 2
    assert "expected a new one, or --force" in capsys.readouterr().err
    assert scene.read_bytes() == before


def test_how_it_lies_is_read_as_it_was_written(scene):
    lie = read_lie(scene.with_name("placement.toml"))
    read = io.load_scene(scene)
    for name, pose in lie.poses.items():
        np.testing.assert_array_equal(pose.rotation, read.placement[name].rotation)
    assert set(lie.seams) == {seam.name for seam in read.pattern.seams}
    assert [border.name for border in lie.borders] == ["border"]


@pytest.mark.parametrize("unit", ["mm", "cm", "m", "inch"])
def test_units_and_axes_count_for_surface_and_foam_alike(seat, tmp_path, unit):
    scale = {"mm": 1.0, "cm": 0.1, "m": 0.001, "inch": 1 / 25.4}[unit]
    for name in ("design.obj", "foam.obj"):
        lines = []
        for line in (seat / name).read_text().splitlines():
            kind, *numbers = line.split()
            if kind == "v":
                x, y, z = (scale * float(number) for number in numbers)
                line = f"v {x!r} {z!r} {-y!r}"  # y up
            lines.append(line)
        (tmp_path / name).write_text("\n".join(lines) + "\n")
    words = ["--foam", str(tmp_path / "foam.obj"), "--unit", unit, "--up", "y"]
    assert flatten(tmp_path, tmp_path / "out", *words) == 0
    read = io.load_scene(tmp_path / "out" / "scene.toml", changes=["mesh.element_size_mm=20"])
    assert np.ptp(read.foam.vertices, axis=0) == pytest.approx([0.497, 0.559, 0.121], abs=0.005)
    Case(read).check()
