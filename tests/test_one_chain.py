"""One question, one answer: the same W2 and zones, or the same refusal, by every way to ask."""

from __future__ import annotations

import csv
import json
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import seatlook
from seatlook import io
from seatlook.cli import run
from seatlook.errors import InputError
from seatlook.sweeps.cell import plan, run_cell
from support.scene_files import TEXT, write_two_panels

pytestmark = pytest.mark.render
ROOT = Path(__file__).parents[1]
# No pose, thresholds by bending radius, two materials: what each way had a rule of its own for.
TIES = r"\[placement\.\w+\]\n.*?\n\n|\[\[hook\]\]\n.*?\n\n|\[\[frame\]\]\n.*?\n\n"
BARE = re.sub(TIES, "", TEXT, flags=re.DOTALL).replace(
    "[foam]", '[panel.RIGHT]\nmaterial = "soft.toml"\n\n[foam]', 1
)


def write_scene(folder: Path) -> Path:
    path = write_two_panels(folder, text=BARE)
    for name, radius in (("stiff", 60.0), ("soft", 20.0)):
        text = (io.materials_dir() / "pvc.toml").read_text()
        text = re.sub(r"(?m)^(c_threshold_per_mm|first_wrinkle_radius_mm).*\n", "", text)
        text = text.replace("[fabric]", f"[fabric]\nfirst_wrinkle_radius_mm = {radius}", 1)
        (folder / f"{name}.toml").write_text(text)
    path.write_text(BARE.replace('material = "pvc"', 'material = "stiff.toml"', 1))
    return path


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder = tmp_path_factory.mktemp("chain")
    scene = write_scene(folder)
    assert "placement" not in scene.read_text()
    assert run(["evaluate", str(scene), "--out", str(folder / "out"), "--no-score", "--quiet"]) in (
        0,
        3,
    )
    return folder


@pytest.fixture(scope="module")
def expected(folder: Path) -> list[dict[str, str]]:
    with (folder / "out/zones.csv").open(newline="") as file:
        return list(csv.DictReader(file))


def as_text(rows) -> list[dict[str, str]]:
    return [{key: str(value) for key, value in row.values().items()} for row in rows]


def test_python_step_by_step(folder, expected):
    scene = seatlook.load_scene(folder / "scene.toml")
    solution = seatlook.solve(seatlook.assemble(scene))
    assert as_text(seatlook.assess(solution).zones) == expected
    indices = seatlook.wrinkle_map(solution.cover.criteria, solution)
    kept = seatlook.read_result(folder / "out/result.npz")
    assert indices.w2.tobytes() == seatlook.assess(kept).indices.w2.tobytes()
    # The thresholds of both materials went in.
    assert solution.cover.criteria.thresholds == pytest.approx((1 / 0.06, 1 / 0.02))


def test_a_case(folder, expected):
    seat = seatlook.open(folder / "scene.toml")
    assert as_text(seat.assessment.zones) == expected


def test_wrinkle_of_the_result_alone(folder, expected, capsys):
    assert run(["wrinkle", str(folder / "out/result.npz"), "--json"]) in (0, 3)
    zones = json.loads(capsys.readouterr().out)["zones"]
    assert [{k: str(v) for k, v in row.items()} for row in zones] == expected


def test_compare(folder, expected):
    scene = folder / "scene.toml"
    comparison = seatlook.compare({"a": scene, "b": scene}, keep=folder / "kept")
    for case in comparison.variants.values():
        assert as_text(case.assessment.zones) == expected
    seat = seatlook.open(scene)
    assert seat.compare(scene).table("w2_mean").rows[0][3] == 0.0


def test_a_sweep(folder, expected, tmp_path):
    (tmp_path / "sweep.toml").write_text(f'schema = 1\nscene = "{folder / "scene.toml"}"\n')
    (cell,) = plan(io.sweep.read_sweep(tmp_path / "sweep.toml"))
    assert run_cell(cell.name, cell.spec, str(tmp_path)) == ""
    zones = json.loads((tmp_path / f"{cell.name}.json").read_text())["zones"]
    assert [{k: str(row[k]) for k in expected[0]} for row in zones] == expected


def test_the_page(folder, expected):
    page = (folder / "out/index.html").read_text()
    worst = max((r for r in expected if r["zone"] != "free edge"), key=lambda r: float(r["w2_p95"]))
    assert worst["zone"] in page


def test_every_way_names_mode_and_threshold(folder, expected, capsys):
    """Both materials' own thresholds, in every table, and the other mode where it is asked for."""
    said = {row["zone"]: row["criterion"] for row in expected}
    assert said["LEFT interior"] == "tensor, 0.0167 per mm"
    assert said["RIGHT interior"] == "tensor, 0.05 per mm"
    assert "tensor, 0.0167 to 0.05 per mm" in said.values()
    page = (folder / "out/index.html").read_text()
    assert all(criterion in page for criterion in said.values())
    result = str(folder / "out/result.npz")
    assert run(["wrinkle", result]) in (0, 3)
    printed = capsys.readouterr().out
    assert all(criterion in printed for criterion in said.values())
    assert run(["wrinkle", result, "--mode", "paper", "--json"]) in (0, 3)
    zones = json.loads(capsys.readouterr().out)["zones"]
    assert all(row["criterion"].startswith("paper, ") for row in zones)
    assert not any(key in zones[0] for key in ("area", "element_size"))


def test_one_refusal_by_all_ways(tmp_path, capsys):
    scene = write_scene(tmp_path)
    seams = tmp_path / "seams.toml"
    seams.write_text(re.sub(r"(?s)\[\[seam\]\].*", "", seams.read_text()))
    message = r"none that joins"
    with pytest.raises(InputError, match=message):
        seatlook.assemble(seatlook.load_scene(scene))
    with pytest.raises(InputError, match=message):
        seatlook.open(scene).check()
    with pytest.raises(InputError, match=message):
        seatlook.compare([scene, scene])
    for words in (
        ["check", str(scene)],
        ["evaluate", str(scene), "--out", str(tmp_path / "o")],
        ["solve", str(scene), "--out", str(tmp_path / "a.npz")],
        ["compare", str(scene), str(scene), "--out", str(tmp_path / "c")],
        ["precision", str(scene)],
    ):
        assert run(words) == 2, words
        assert re.search(message, capsys.readouterr().err), words


def test_a_result_stands_for_a_scene_only_as_it_was(folder, tmp_path):
    scene = seatlook.load_scene(folder / "scene.toml")
    result = seatlook.read_result(folder / "out/result.npz")
    good = replace(result, status="converged", reason="")
    from seatlook.chain.files import reusable

    assert reusable(good, scene)
    assert not reusable(replace(good, status="not converged"), scene)
    assert not reusable(replace(good, settings="revision 0"), scene)
    for changed in (
        replace(scene, seed=1),
        replace(scene, element_size=0.019),
        replace(scene, curvature="paper"),
        replace(scene, rigs=scene.rigs[:1]),
        replace(scene, digest="0"),
    ):
        assert not reusable(good, changed)


def test_nothing_of_the_chain_is_written_twice():
    """One call, one definition each; the count is of the source."""
    source = {p: p.read_text() for p in (ROOT / "src").rglob("*.py")}
    for pattern, count in {
        r"(?<!def )\bwrinkle_indices\(": 1,
        r"def reusable\(": 1,
        r"def file_names\(": 1,
        r"def door\(": 1,
        r"def arc_length\(": 1,
        r"DEFAULT_THRESHOLD: Mapping": 1,
        r"importlib\.import_module": 2,
    }.items():
        calls = [
            (p.name, m) for p, text in source.items()
            for m in re.findall(pattern, re.sub(r"(?m)^\s*(>>>|\.\.\.) .*$", "", text))
        ]  # fmt: skip
        assert len(calls) == count, (pattern, calls)


def test_w2_of_two_ways_is_equal_bit_for_bit(folder):
    one = seatlook.open(folder / "scene.toml", result=folder / "out/result.npz")
    other = seatlook.open(folder / "scene.toml")
    assert np.array_equal(one.assessment.indices.w2, other.assessment.indices.w2)
