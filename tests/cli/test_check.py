"""The command check: what it tells, draws and refuses."""

from __future__ import annotations

import json
import re
import subprocess
import sys

import pytest

from seatlook.cli import run
from support.commands import HIDDEN


def test_check_tells_what_would_be_solved(demo_scene, capsys):
    assert run(["check", str(demo_scene), "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert (found["panels"], found["seams"], found["hooks_and_frames"]) == (7, 14, 3)
    assert found["element_size_mm"] == pytest.approx(20, rel=0.15)
    ratio = found["wavelength_mm"] / found["element_size_mm"]
    assert found["wavelength_over_element_size"] == pytest.approx(ratio)
    assert found["expected_status"] == "converged, not resolved"
    assert found["criterion"] == "tensor, 0.02 per mm"
    waves = {wave["material"]: wave for wave in found["waves"]}
    assert not waves["leather-laminate"]["resolved"]
    least = min(wave["wavelength_over_element_size"] for wave in waves.values())
    assert least == pytest.approx(ratio, rel=0.05)
    ease = {row["seam"]: row for row in found["ease"]}
    # The rear panel is cut 1 % narrower across its grain; the insert's rear edge is not.
    assert ease["INSERT-REAR"]["ease_percent"] == pytest.approx(1.0, abs=0.15)
    assert ease["INSERT-REAR"]["ease_mm"] == pytest.approx(2.5, abs=0.4)
    assert abs(ease["INSERT-BOLSTER_L"]["ease_percent"]) < 0.01
    assert ease["INSERT-BOLSTER_L"]["notches_a"] == 3
    assert all(row["matched"] for row in found["ease"])
    assert run(["check", str(demo_scene), "--element-size-mm", "40"]) == 0
    text = capsys.readouterr().out
    assert "element_size_mm" in text
    assert "ease_percent" in text


@pytest.fixture
def own_demo(demo_scene, tmp_path):
    """Scene of a copy of the demo's files, without what commands left beside them."""
    folder = tmp_path / "own"
    folder.mkdir()
    for file in demo_scene.parent.iterdir():
        if file.suffix in (".toml", ".obj", ".dxf"):
            (folder / file.name).write_bytes(file.read_bytes())
    return folder / "scene.toml"


@pytest.mark.render
def test_check_draws_the_start_beside_the_scene(own_demo, capsys):
    picture = own_demo.parent / "check" / "assembly.png"
    assert run(["check", str(own_demo), "--json"]) == 0
    said = capsys.readouterr()
    found = json.loads(said.out)
    assert found["drawing"] == str(picture)
    assert str(picture) in said.err
    assert sorted(int(row["number"]) for row in found["ease"]) == list(range(1, 15))
    assert [row["number"] for row in found["held"]] == ["H1", "H2", "F1"]
    assert found["held"][0]["pulled_to"] == "trench_left"
    assert 30 < found["held"][0]["gap_mm"] < 50
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert [file.name for file in picture.parent.iterdir()] == ["assembly.png"]


@pytest.mark.render
def test_check_draws_what_it_refuses(own_demo, capsys):
    seams = own_demo.with_name("seams.toml")
    seams.write_text(seams.read_text().replace("reverse = true", "reverse = false", 1))
    assert run(["check", str(own_demo)]) == 2
    said = capsys.readouterr()
    assert said.out == ""
    first, *refused = said.err.splitlines()
    assert first.endswith("assembly.png")
    assert "whose ties cross" in refused[0]
    assert (own_demo.parent / "check" / "assembly.png").exists()


def test_check_passes_where_the_drawing_cannot_be_written(own_demo, capsys):
    (own_demo.parent / "check").write_text("a file where the folder would be")
    assert run(["check", str(own_demo), "--json"]) == 0
    said = capsys.readouterr()
    assert json.loads(said.out)["drawing"] is None
    assert re.search(r"(?m)^not drawn: .*assembly\.png: got .*, expected a folder that", said.err)


def test_check_passes_without_a_gl_library(own_demo):
    done = subprocess.run(
        [sys.executable, "-c", HIDDEN, "check", str(own_demo), "--json"],
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0
    assert json.loads(done.stdout)["drawing"] is None
    assert (
        len([line for line in done.stderr.splitlines() if "not drawn: no GL library" in line]) == 1
    )
    assert "nothing wrong" in done.stderr
    assert not (own_demo.parent / "check").exists()
