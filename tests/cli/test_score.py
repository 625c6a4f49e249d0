"""Scoring from the command line: what it refuses, and a whole run with a limit that is missed."""

from __future__ import annotations

import json
import shutil
from pathlib import Path

import pytest

from seatlook import io
from seatlook.cli import run
from seatlook.errors import InputError

LIMITS = """
[[zones.box]]
name = "seat"
panel = "INSERT"
low_mm = [-120.0, -200.0]
high_mm = [120.0, 200.0]
class = "A"

[accept.A]
vwi = 0.001

[accept."INSERT interior"]
vwi = 1e6
"""


@pytest.fixture
def scene(demo_scene: Path, tmp_path: Path) -> Path:
    folder = shutil.copytree(demo_scene.parent, tmp_path / "demo")
    return folder / "scene.toml"


def test_a_search_needs_a_folder_for_its_charts(capsys):
    assert run(["score", "seat.toml", "--search-light"]) == 2
    assert "--search-light: got no --out, expected a folder" in capsys.readouterr().err


@pytest.mark.render
def test_without_a_result_it_says_how_to_make_one(scene, capsys):
    assert run(["score", str(scene)]) == 2
    printed = capsys.readouterr().err
    assert "result.npz: got no such file" in printed
    assert f"seatlook solve {scene} --out" in printed


def test_limits_on_the_score_are_read_and_none_on_a_seam(scene):
    text = scene.read_text()
    scene.write_text(text + LIMITS)
    limits = io.load_scene(scene).limits
    maxima = {(limit.zone, limit.measure): limit.maximum for limit in limits}
    assert maxima == {("A", "vwi"): 0.001, ("INSERT interior", "vwi"): 1e6}
    scene.write_text(text + '\n[accept."seam INSERT-REAR"]\nequivalent_height_mm = 0.1\n')
    line = len(scene.read_text().splitlines())
    with pytest.raises(InputError) as error:
        io.load_scene(scene)
    assert f"scene.toml:{line}: " in str(error.value)
    assert "got a seam band, expected an interior, a box or a class" in str(error.value)


@pytest.mark.validate
@pytest.mark.render
def test_a_missed_limit_ends_with_one_and_all_is_left_in_the_folder(scene, capsys):
    text = scene.read_text() + LIMITS
    text = text.replace("[camera]\n", "[camera]\nsize = [480, 270]\n")
    scene.write_text(text.replace("element_size_mm = 20.0", "element_size_mm = 14.0"))
    result, out = scene.with_name("result.npz"), scene.with_name("score")
    assert run(["solve", str(scene), "--out", str(result), "--preview"]) == 0
    capsys.readouterr()
    words = ["--texture", "black-leather", "--texture", "suede", "--rig", "sun"]
    assert run(["score", str(scene), *words, "--out", str(out), "--json"]) == 1
    printed = capsys.readouterr()
    assert "A: vwi is " in printed.err
    assert "INSERT interior" not in printed.err
    data = json.loads(printed.out)
    assert [(cell["texture"], cell["rig"]) for cell in data["cells"]] == [
        ("black-leather", "sun"),
        ("suede", "sun"),
    ]
    assert [limit["kept"] for limit in data["limits"]] == [False, True]
    assert data["null_vwi"] < 0.1
    assert json.loads((out / "score.json").read_text())["cells"] == data["cells"]
    assert len(list(out.glob("maps/visibility-*.png"))) == 2
