"""From a scene to a gallery, and the commands that go on from its result."""

from __future__ import annotations

import csv
import json
import re
import shutil
from html import unescape
from pathlib import Path

import pytest

from seatlook.wrinkle import INDICES
from support.commands import seatlook

pytestmark = pytest.mark.first


@pytest.fixture(scope="module")
def evaluated(demo_scene: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Evaluate the coarse demo once; one of its two limits cannot be kept."""
    folder = tmp_path_factory.mktemp("evaluated")
    shutil.copytree(demo_scene.parent, folder, dirs_exist_ok=True)
    scene = folder / "scene.toml"
    text = scene.read_text().replace('"driver_door", "top"]', '"top"]\nsize = [96, 54]')
    text += '\n[accept."INSERT interior"]\nw2_mean = 1e-9\n[accept."REAR interior"]\nw2_mean = 50\n'
    scene.write_text(
        text.replace('["black-leather", "bright-leather", "suede"]', '["suede", "pvc"]')
    )
    done = seatlook("evaluate", "scene.toml", "--out", ".", "--no-score", "--preview", cwd=folder)
    (folder / "stdout").write_text(done.stdout)
    # On a laden machine there are lines of a log, one a minute.
    said = [line for line in done.stderr.splitlines() if not re.match(r"\d+ min: ", line)]
    (folder / "stderr").write_text("\n".join([str(done.returncode), *said]))
    return folder


@pytest.mark.render
def test_evaluate_leaves_a_whole_gallery_and_names_the_missed_limit(evaluated):
    code, *told, gallery, first, second, status = (evaluated / "stderr").read_text().splitlines()
    assert code == "1"
    foretold = [line for line in told if line.startswith("will not be resolved: ")]
    # What the page begins with stands at the end of the log, word for word.
    answer, page = told[len(foretold) :], unescape((evaluated / "index.html").read_text())
    assert len(answer) >= 2
    assert all(line in page for line in answer)
    assert any(line.startswith("Do not build on this yet: ") for line in answer)
    reasons = [line.removeprefix("will not be resolved: ") for line in foretold]
    assert status == f"converged, not resolved: {'; '.join(reasons)}"
    assert first.startswith("INSERT interior: w2_mean is ")
    assert first.endswith(", not resolved, the limit is 1e-09")
    # No limit is kept by a cover that its mesh does not resolve.
    assert second.startswith("REAR interior: w2_mean is ")
    assert second.endswith(", not resolved, the limit is 50")
    assert "leather-laminate: elements of 20" in status
    assert gallery == "gallery: index.html"
    heads, *rows = (evaluated / "stdout").read_text().splitlines()
    assert heads.split()[:3] == ["zone", "area_cm2", "w2_mean"]
    assert any(row.startswith("INSERT interior") for row in rows)
    assert len(list(evaluated.glob("images/*/*.png"))) == 6
    # A map may lie there a second time, in a range of its own.
    maps = {path.stem.removesuffix("-own") for path in evaluated.glob("maps/*.png")}
    indices = set(INDICES)
    texture = {"stretch_along", "stretch_across", "shear", "grain_drift", "checker"}
    assert maps == indices | texture | {"gap", "deviation"}
    page = (evaluated / "index.html").read_text()
    for part in (
        "suede under bulb left",
        "W_compression",
        "judgement",
        "texture pvc",
        "Gap",
        "Shape against the foam",
        "Shape against the design",
        "Seam lines",
        "ease [mm]",
    ):
        assert part in page
    assert '<td class="missed">NO</td>' in page
    assert "the mesh is too coarse to show" in page


@pytest.mark.render
def test_a_result_is_judged_and_drawn_again_without_solving(evaluated, tmp_path):
    words = ["wrinkle", "result.npz", "--scene", "scene.toml", "--json", "--preview"]
    exports = [tmp_path / "seat.vtp", tmp_path / "seat.csv"]
    table = seatlook(*words, *(f"--export={path}" for path in exports), cwd=evaluated)
    assert table.returncode == 0, table.stderr
    assert all(path.stat().st_size > 1000 for path in exports)
    wrong = seatlook(*words, "--export", "seat.xyz", cwd=evaluated)
    assert wrong.returncode == 2
    assert "seat.xyz: file: got '.xyz', expected one of .vtp, .csv, .glb" in wrong.stderr
    zones = json.loads(table.stdout)["zones"]
    first = (evaluated / "stdout").read_text()
    assert len(zones) == len(first.splitlines()) - 1
    assert f"{zones[-1]['w2_mean']:.4g}" in first

    words = ["render", "scene.toml", "result.npz", "--out", str(tmp_path), "--rig", "sun"]
    done = seatlook(*words, "--texture", "suede", "--no-maps", cwd=evaluated)
    assert done.returncode == 0, done.stderr
    (again,) = tmp_path.rglob("*.png")
    assert again.read_bytes() == (evaluated / "images/sun/suede.png").read_bytes()


@pytest.mark.render
def test_shape_and_seam_lines_are_compared_with_the_design(evaluated, tmp_path):
    with (evaluated / "seam-lines.csv").open() as file:
        kept = {row["seam"]: row for row in csv.DictReader(file)}
    assert len(kept) == 14
    words = ["shape", "scene.toml", "result.npz", "--json"]
    zones = seatlook(*words, "--out", str(tmp_path), cwd=evaluated)
    assert zones.returncode == 0, zones.stderr
    rows = {row["zone"]: row for row in json.loads(zones.stdout)}
    assert rows["INSERT interior"]["measured_percent"] == pytest.approx(100)
    for row in rows.values():
        assert row["lowest_mm"] <= row["mean_mm"] <= row["highest_mm"]
        assert row["p95_mm"] <= max(-row["lowest_mm"], row["highest_mm"]) + 1e-9
    for name in ("shape.csv", "seam-lines.csv", "maps/deviation.png"):
        assert (tmp_path / name).read_bytes() == (evaluated / name).read_bytes()
    seams = json.loads(seatlook(*words, "--seams", cwd=evaluated).stdout)
    for row in seams:
        assert 0 < row["mean_mm"] < row["largest_mm"]
        assert row["mean_mm"] == pytest.approx(float(kept[row["seam"]]["mean_mm"]))
    text = (evaluated / "scene.toml").read_text()
    bare_text = text.replace('[design]\nfile = "panels.obj"\nunit = "mm"', "[design]")
    (evaluated / "bare.toml").write_text(bare_text)
    bare = seatlook("shape", "bare.toml", "result.npz", cwd=evaluated)
    assert bare.returncode == 2
    assert "bare.toml: design: got nothing, expected a table [design] with a file" in bare.stderr


@pytest.mark.render
@pytest.mark.parametrize(
    ("angle", "message"),
    [("90", "got no panorama in sun, bulb left, bulb right"), ("400", "got 400.0, expected -360")],
)
def test_render_turns_only_panoramas(evaluated, tmp_path, angle, message):
    words = ["render", "scene.toml", "result.npz", "--out", str(tmp_path / "out")]
    done = seatlook(*words, "--panorama-azimuth-deg", angle, cwd=evaluated)
    assert done.returncode == 2
    assert f"--panorama-azimuth-deg: {message}" in done.stderr


@pytest.mark.render
def test_render_looks_from_where_it_is_told(evaluated, tmp_path):
    words = ["render", "scene.toml", "result.npz", "--rig", "sun", "--texture", "suede"]
    words += ["--no-maps", "--quality", "draft", "--target-mm", "0", "0", "0", "--position-mm"]
    for name, place, code in (
        ("left", ("1500.0", "-1500.0", "1500.0"), 0),
        ("right", ("-1500.0", "-1500.0", "1500.0"), 0),
        ("above", ("0", "0", "1500.0"), 2),
    ):
        done = seatlook(*words, *place, "--out", str(tmp_path / name), cwd=evaluated)
        assert done.returncode == code, done.stderr
    assert "right above or below the target" in done.stderr
    left, right = (next((tmp_path / n).rglob("*.png")).read_bytes() for n in ("left", "right"))
    assert left != right


@pytest.mark.render
def test_render_refuses_a_rig_the_scene_does_not_have(evaluated, tmp_path):
    out = tmp_path / "out"
    words = ["render", "scene.toml", "result.npz", "--out", str(out), "--rig", "son"]
    done = seatlook(*words, cwd=evaluated)
    assert done.returncode == 2
    assert "rig: got 'son', expected one of sun, bulb left, bulb right" in done.stderr
    assert not out.exists()
