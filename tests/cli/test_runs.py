"""Runs that cannot mix: names, kept results, pages, files of the user."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import pytest
from PIL import Image

from seatlook import io
from seatlook.cli import run
from seatlook.pbr.picture import RUN_KEY
from support.scene_files import write_two_panels

pytestmark = [pytest.mark.render, pytest.mark.first]


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    folder = tmp_path / "scene"
    folder.mkdir()
    return write_two_panels(folder)


def evaluate(scene: Path, out: Path, *words: str) -> int:
    always = ["--no-score", "--quiet", "--preview"]
    return run(["evaluate", str(scene), "--out", str(out), *always, *words])


def test_textures_whose_names_make_one_file_name_get_two_pictures(scene, tmp_path):
    materials = io.materials_dir()
    for name in ("a b", "a-b"):
        shutil.copy(materials / "suede.toml", scene.with_name(f"{name}.toml"))
    textures = 'gallery.textures=["a b.toml","a-b.toml"]'
    rigs = ['rig.0.name="Sun"', 'rig.1.name="sun "']
    words = [w for change in (textures, *rigs) for w in ("--set", change)]
    assert evaluate(scene, tmp_path / "out", *words) == 0
    pictures = list((tmp_path / "out/images").rglob("*.png"))
    assert len(pictures) == 4
    page = (tmp_path / "out/index.html").read_text()
    assert all(str(p.relative_to(tmp_path / "out")) in page for p in pictures)


@pytest.mark.parametrize(
    "change",
    [["--element-size-mm", "19"], ["--seed", "4"], ["--set", 'panel.LEFT.material="suede"']],
)
def test_resume_takes_a_result_of_all_that_goes_in_only(scene, tmp_path, change):
    out = tmp_path / "out"
    assert evaluate(scene, out) == 0
    first = (out / "result.npz").read_bytes()
    assert evaluate(scene, out, "--resume") == 0
    assert (out / "result.npz").read_bytes() == first
    assert evaluate(scene, out, "--resume", *change) == 0
    assert (out / "result.npz").read_bytes() != first
    # A result that was put there by hand is read, and made anew where it is another.
    assert evaluate(scene, out, "--resume") == 0


def test_page_result_and_pictures_name_one_run(scene, tmp_path):
    out = tmp_path / "out"
    assert evaluate(scene, out) == 0
    digest = io.read_result(out / "result.npz").cover.scene_digest
    assert digest in (out / "index.html").read_text()
    for path in [*(out / "images").rglob("*.png"), *(out / "maps").glob("*.png")]:
        assert Image.open(path).text[RUN_KEY] == digest, path


def test_the_page_of_an_earlier_run_is_gone_while_the_next_one_writes(scene, tmp_path, monkeypatch):
    out = tmp_path / "out"
    assert evaluate(scene, out) == 0
    from seatlook.chain import evaluation

    def stopped(*_args: object, **_options: object) -> None:
        assert not (out / "index.html").exists()
        raise KeyboardInterrupt

    monkeypatch.setattr(evaluation, "draw_maps", stopped)
    assert evaluate(scene, out, "--seed", "3") == 130
    assert not (out / "index.html").exists()
    monkeypatch.undo()
    assert evaluate(scene, out) == 0


@pytest.mark.parametrize(
    "change",
    [
        "accept.A.w2_p95=1",
        "rig=[]",
        "gallery.textures=[]",
        "camera.views=[]",
        'accept."LEFT interior".w2_p95=1',
        f'rig.0.name="{"x" * 300}"',
    ],
)
def test_what_check_passes_evaluate_accepts(scene, tmp_path, change, capsys):
    words = ["--set", change]
    checked = run(["check", str(scene), *words])
    out = tmp_path / "out"
    done = evaluate(scene, out, *words)
    said = capsys.readouterr().err
    if checked == 0:
        assert done in (0, 1), said
    else:
        assert (checked, done) == (2, 2)
        assert not out.exists()


@pytest.mark.filterwarnings("ignore::seatlook.errors.InputWarning")
def test_evaluate_and_demo_overwrite_nothing_of_the_users(scene, tmp_path, capsys):
    out = tmp_path / "out"
    assert evaluate(scene, out) == 0
    (out / "zones.csv").write_text("my own notes")
    assert evaluate(scene, out) == 2
    assert "zones.csv, edited or not written by seatlook" in capsys.readouterr().err
    assert (out / "zones.csv").read_text() == "my own notes"
    assert evaluate(scene, out, "--force") == 0
    out = str(tmp_path / "demo")
    words = ["demo", "--shape", "headrest", "--files-only", "--out", out, "--quiet"]
    assert run(words) == 0
    text = (tmp_path / "demo/scene.toml").read_text()
    assert run(words) == 0
    (tmp_path / "demo/scene.toml").write_text(text + "# MY EDIT\n")
    assert run(words) == 2
    assert "MY EDIT" in (tmp_path / "demo/scene.toml").read_text()
    assert run([*words, "--force"]) == 0
    assert not re.search("MY EDIT", (tmp_path / "demo/scene.toml").read_text())
