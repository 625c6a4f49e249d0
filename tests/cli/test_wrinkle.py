"""The wrinkle command on results and on LS-DYNA files, as a user meets it."""

import csv
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from seatlook import io
from seatlook.cli import run
from seatlook.wrinkle import INDICES
from support.wrinkle_samples import shaped, wave

pytestmark = pytest.mark.first

DATA = Path(__file__).parents[1] / "data"
STRIP, DECK = DATA / "bent_strip.d3plot", DATA / "bent_strip_dynain.k"
MAPS = {*INDICES, "w_stretch-own", "w_compression-own"}
WITHOUT_DESIGN = MAPS - {name for name, index in INDICES.items() if index.whole_shape}
TEXTURE = {"stretch_along", "stretch_across", "shear", "grain_drift", "checker"}


def seatlook(*words, cwd):
    return subprocess.run(
        [sys.executable, "-m", "seatlook", "wrinkle", *map(str, words)],
        cwd=cwd, capture_output=True, text=True, env=dict(os.environ), check=False,
    )  # fmt: skip


def table(path):
    with path.open(newline="", encoding="utf-8") as file:
        return list(csv.DictReader(file))


def told(capsys, *words):
    assert run(["wrinkle", *map(str, words), "--json"]) == 0
    return json.loads(capsys.readouterr().out)


@pytest.mark.parametrize(("mode", "c"), [("paper", 0.01), ("tensor", 0.02)])
def test_the_bent_strip_from_both_formats(mode, c, tmp_path):
    """Arch and valley, with their sign, from a process of its own."""
    for name in ("bent_strip.d3plot", "bent_strip.d3plot01"):
        shutil.copy(DATA / name, tmp_path)
    done = seatlook("bent_strip.d3plot", "--mode", mode, "--json", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    states = json.loads(done.stdout)["states"]
    assert [s["c"] for s in states] == pytest.approx([0.0, c, -c], rel=0.01, abs=1e-9)
    words = (DECK, "--thickness-mm", 1.2, "--mode", mode, "--json")
    deck = json.loads(seatlook(*words, cwd=tmp_path).stdout)
    assert [s["c"] for s in deck["states"]] == pytest.approx([-c], rel=0.01)
    assert deck["c_threshold_per_mm"] == c
    assert deck["criterion"] == f"{mode}, {c:g} per mm"
    head, *rows = seatlook(*words[:-1], cwd=tmp_path).stdout.splitlines()
    assert head.split()[-1] == "criterion"
    assert all(row.endswith(f"{mode}, {c:g} per mm") for row in rows)


def test_options_reach_the_figures(capsys):
    base = ("--mode", "tensor")
    assert told(capsys, STRIP, *base, "--facing", 0, 0, -1)["states"][1]["c"] == pytest.approx(
        -0.02, rel=0.01
    )
    metres = told(capsys, STRIP, *base, "--length-unit", "cm")["states"][1]
    assert metres["c"] == pytest.approx(0.002, rel=0.01)
    radius = told(capsys, STRIP, *base, "--bending-radius-mm", 25)
    assert radius["c_threshold_per_mm"] == pytest.approx(0.04)
    assert radius["states"][2]["w2"] == pytest.approx(0.5, rel=0.01)
    # The strip's 1.2 % on either side: ln(1 + 2 E) / 2 against E.
    c = [told(capsys, STRIP, *base, "--strain", s)["states"][1]["c"] for s in ("green", "log")]
    half = 0.01198824
    expected = np.sinh(2 * half) / (2 * half)
    assert c[0] / c[1] == pytest.approx(expected, rel=1e-4)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ([DECK], "bent_strip_dynain.k: thickness: got none for 800 shells of part 1, first 1"),
        ([STRIP, "--part", "back"], "parts: got 'back', expected a part with shells: 1"),
        ([STRIP, "--state", "3", "--out", "o"], "state: got 3, expected 0 to 2"),
        ([STRIP, "--facing", "0", "0", "0"], "--facing: got 0 0 0, expected a direction"),
        ([STRIP, "--against", "x.npz"], "--against: got"),
        ([STRIP, "--length-unit", "m"], "nodes: got an extent of 100 m"),
        ([STRIP, "--export", "c.step"], "expected one of .vtp, .csv, .glb, .k, .radioss.k, .npz"),
        (["no.npz"], "no.npz"),
        (["no"], "no: file: got no such file, expected a d3plot or a keyword deck"),
        (
            [STRIP, "--bending-radius-mm", "20", "--c-threshold-per-mm", "0.01"],
            "--bending-radius-mm: got --c-threshold-per-mm as well, expected one of them",
        ),
    ],
)
def test_bad_input_ends_with_2_and_leaves_nothing(words, message, capsys, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert run(["wrinkle", *map(str, words)]) == 2
    said = capsys.readouterr()
    assert message in said.err
    assert said.out == ""
    assert "Traceback" not in said.err
    assert list(tmp_path.iterdir()) == []


def test_options_of_shells_are_refused_for_a_result(tmp_path, capsys):
    io.write_result(shaped(wave(0.0, 0.06), h=0.02), tmp_path / "a.npz")
    assert run(["wrinkle", str(tmp_path / "a.npz"), "--part", "1", "--thickness-mm", "1"]) == 2
    said = capsys.readouterr().err
    assert "--part: got ('1',), expected nothing" in said
    assert "--thickness-mm: got 1.0, expected nothing" in said


@pytest.mark.render
def test_a_state_becomes_maps_a_picture_and_files(tmp_path):
    """The arch seen from below is a valley; every file that is promised is there and right."""
    words = (STRIP, "--mode", "tensor", "--state", 1, "--facing", 0, 0, -1, "--out", "out")
    exports = [w for s in (".vtp", ".csv", ".glb", ".k", ".npz") for w in ("--export", f"cover{s}")]
    done = seatlook(*words, *exports, cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    folder = tmp_path / "out/state-1"
    assert {p.stem for p in (folder / "maps").iterdir()} == WITHOUT_DESIGN | TEXTURE
    page = (folder / "index.html").read_text()
    for part in ("bent_strip.d3plot, state 1", "C mean [1/mm]", "Checker", "side light"):
        assert part in page
    picture = np.asarray(Image.open(folder / "picture.png").convert("L"))
    assert picture.shape == (720, 1280)
    assert picture[300:420, 560:720].std() > 3  # grain and highlight, not a flat field
    red, _, blue = np.asarray(Image.open(folder / "maps/w1.png"))[360, 640].astype(int)
    assert blue > red + 50
    shells = table(folder / "elements.csv")
    assert len(shells) == 800
    assert all(float(row["c_per_mm"]) == pytest.approx(-0.02, rel=0.01) for row in shells)
    again = json.loads(seatlook("cover.k", "--mode", "tensor", "--json", cwd=tmp_path).stdout)
    assert again["states"][0]["c"] == pytest.approx(-0.02, rel=0.02)
    assert io.read_result(tmp_path / "cover.npz").cover.panel_names == ("part 1",)
    assert all((tmp_path / f"cover{s}").stat().st_size > 10_000 for s in (".vtp", ".csv", ".glb"))


@pytest.fixture(scope="module")
def waves(tmp_path_factory):
    folder = tmp_path_factory.mktemp("waves")
    for name, amplitude in (("flat", 0.0002), ("deep", 0.0012)):
        io.write_result(shaped(wave(amplitude, 0.06), h=0.005), folder / f"{name}.npz")
    return folder


def test_a_result_is_judged_without_its_scene(waves, capsys):
    words = waves / "deep.npz", "--mode", "tensor", "--c-threshold-per-mm"
    deep = told(capsys, *words, 0.01)
    (zone,) = deep["zones"]
    peak = 0.0012 * (2 * np.pi / 0.06) ** 2 / 10.0
    # Valleys of a sine cover half the sheet: its mean over the period is peak / pi.
    assert zone["w2_mean"] == pytest.approx(peak / np.pi, rel=0.05)
    # The design keeps 76 % of a wave of 60 mm, and all of it at the held outline.
    assert 0.2 < zone["w2_net_mean"] / zone["w2_mean"] < 0.4
    assert 1 <= len(deep["worst"]) <= 5
    worst = deep["worst"][0]
    assert worst["depth_mm"] == pytest.approx(2.4, rel=0.15)
    assert worst["near"] is None
    assert worst["distance_mm"] is None
    assert {row["measure"] for row in deep["distortion"]} >= {"stretch_along", "shear_deg"}
    own = told(capsys, *words, 0.02)
    assert own["zones"][0]["w2_mean"] == pytest.approx(0.5 * zone["w2_mean"])


@pytest.mark.render
def test_two_results_are_compared_in_one_range(waves, tmp_path, capsys):
    words = [waves / "deep.npz", "--against", waves / "flat.npz", "--mode", "tensor"]
    found = told(capsys, *words, "--bending-radius-mm", 100, "--out", tmp_path)
    (zone,) = found["difference"]
    assert zone["difference"] == pytest.approx(zone["mean"] - zone["other"])
    assert zone["mean"] / zone["other"] == pytest.approx(6.0, rel=0.05)
    maps = {p.stem for p in (tmp_path / "maps").iterdir()}
    assert maps == {"w2_this", "w2_other", "w2_difference"} | MAPS | TEXTURE
    assert {p.name for p in tmp_path.glob("*.csv")} == {
        "zones.csv",
        "worst.csv",
        "seam-excess.csv",
        "advice.csv",
        "sections.csv",
        "distortion.csv",
    }
    cuts = table(tmp_path / "sections.csv")
    assert min(float(row["height_mm"]) for row in cuts) == pytest.approx(-2.4, rel=0.15)


@pytest.mark.validate
@pytest.mark.render
def test_a_real_result_runs_through_to_maps_and_a_picture(tmp_path):
    path = Path(__file__).parents[3] / "shared/data/fetched/lasso_simple_d3plot/d3plot"
    if not path.exists():
        pytest.skip("third-party sample absent")
    done = seatlook(path, "--out", "out", "--json", cwd=tmp_path)
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout)["shells"] == 4696
    folder = tmp_path / "out/state-0"
    assert {p.stem for p in (folder / "maps").iterdir()} == WITHOUT_DESIGN | TEXTURE
    assert np.asarray(Image.open(folder / "picture.png").convert("L")).std() > 5
