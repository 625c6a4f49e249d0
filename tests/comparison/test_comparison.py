"""Variants side by side: same camera, exposure and range; names, tables and pages."""

from __future__ import annotations

import builtins
import json
import re
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType

import pytest

import seatlook
from seatlook import compare, io
from seatlook.chain import case as module
from seatlook.chain.case import Case
from seatlook.chain.local import solve_scene
from seatlook.cli import run
from seatlook.comparison.compare import Comparison, variant_names
from seatlook.comparison.visibility import VariantScores, score_variants
from seatlook.comparison.widgets import sliders
from seatlook.errors import InputError
from seatlook.model.scene import Limit
from seatlook.report.comparison_page import write_comparison
from seatlook.wrinkle import INDICES
from support.scene_files import write_two_panels

pytestmark = pytest.mark.render


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return write_two_panels(tmp_path_factory.mktemp("compare")).parent


@pytest.fixture(scope="module")
def comparison(folder: Path) -> Comparison:
    scene = io.load_scene(folder / "scene.toml")
    other = io.load_scene(folder / "scene.toml", changes=['pattern.material="suede"'])
    return compare({"pvc": scene, "suede cover": other}, keep=str(folder / "kept"))


def test_pictures_are_named_drawn_once_and_at_one_exposure(comparison):
    one = comparison["pvc", "suede", "bulb"]
    assert one is comparison["pvc", "suede", "bulb"]
    assert one.png.startswith(b"\x89PNG")
    assert comparison["suede cover", "suede", "bulb"].ev100 == one.ev100 == 5.0
    assert (comparison.textures, comparison.rigs) == (("pvc", "suede"), ("sun", "bulb"))


@pytest.mark.parametrize(
    ("names", "message"),
    [
        (("pcv", "suede", "sun"), "variant: got 'pcv', expected one of pvc, suede cover"),
        (("pvc", "sued", "sun"), "did you mean 'suede'?"),
        (("pvc", "suede", "son"), "rig: got 'son', expected one of sun, bulb"),
        (("pvc", "suede"), r"expected \[variant, texture, rig\]"),
    ],
)
def test_a_wrong_name_is_answered_with_the_known_ones(comparison, names, message):
    with pytest.raises(InputError, match=message):
        comparison[names]


def test_the_largest_difference_stands_first(comparison):
    table = comparison.table("w2_mean")
    assert table.heads == ("zone", "w2_mean: pvc", "w2_mean: suede cover", "suede cover - pvc")
    away = [abs(row[3]) for row in table.rows]
    assert away == sorted(away, reverse=True)
    assert away[0] > 0
    assert all(row[3] == row[2] - row[1] for row in table.rows)
    with pytest.raises(InputError, match="did you mean 'w2_mean'"):
        comparison.table("w2_men")


def test_html_shows_every_picture_without_scripts(comparison):
    html = comparison._repr_html_()
    assert html.count("data:image/png;base64,") == 4
    assert "EV 5" in html
    assert "<script" not in html
    both = comparison.show(("pvc", "suede", "sun"), ("suede cover", "suede", "sun"))
    assert both._repr_html_().count("data:image/png;base64,") == 2
    assert repr(both) == "Contrast(A: pvc, suede, sun; B: suede cover, suede, sun)"
    assert repr(comparison).startswith("Comparison(2 x 2 x 2: pvc, suede cover;")


def test_without_ipywidgets_sliders_say_what_to_install(comparison, monkeypatch):
    real = builtins.__import__

    def absent(name: str, *args: object, **options: object) -> object:
        if name == "ipywidgets":
            raise ImportError(name)
        return real(name, *args, **options)

    monkeypatch.setattr(builtins, "__import__", absent)
    with pytest.raises(InputError, match=r'pip install "seatlook\[notebook\]"'):
        sliders(comparison)


def test_the_page_says_first_what_differs(comparison, tmp_path):
    page = write_comparison(comparison, tmp_path).read_text()
    assert page.index("What changed</h3>") < page.index('id="appearance"')
    differences = page[page.index('id="differences"') : page.index('id="appearance"')]
    assert "all panels: thickness_mm" in differences
    assert "texture suede: " not in differences
    assert len(list(tmp_path.glob("variants/*/*/*.png"))) == 8
    assert len(list(tmp_path.glob("maps/*/*.png"))) == 2 * len(INDICES)


def test_the_page_holds_every_variant_to_be_turned(comparison, folder, tmp_path):
    def content(out):
        page = write_comparison(comparison, out).read_text(encoding="utf-8")
        (text,) = re.findall(r'<script type="application/json" id="viewer-content">(.*?)<', page)
        return json.loads(text)

    first = content(folder / "kept")
    (other,) = first["others"]
    assert (first["name"], other["name"]) == ("pvc", "suede cover")
    assert other["files"] == ["scene.toml", "kept/suede-cover/result.npz"]
    # Tables and lights are those of the page; of another variant there is what is its own.
    assert "albedos" in first["buffers"]["places"]
    assert "albedos" not in other["buffers"]["places"]
    assert "rigs" not in other
    assert [(m["low"], m["high"]) for m in first["maps"]] == [
        (m["low"], m["high"]) for m in other["maps"]
    ]
    # Results that are not in the folder are named in no command.
    assert content(tmp_path)["files"] == []


def test_names_that_make_one_file_name_get_two_folders(comparison, tmp_path):
    first, second = comparison.variants.values()
    named = replace(comparison, variants=MappingProxyType({"ease 4.0": first, "ease 4.0%": second}))
    write_comparison(named, tmp_path)
    assert len(list(tmp_path.glob("variants/*"))) == len(list(tmp_path.glob("maps/*"))) == 2
    assert len(list(tmp_path.glob("variants/*/*/*.png"))) == 8


def test_changes_are_named_once_and_long_heads_are_never_cut(comparison, tmp_path):
    long = "a name of a variant as people write it into their scenes, with a date"
    first, second = comparison.variants.values()
    named = replace(comparison, variants=MappingProxyType({"pvc": first, long: second}))
    page = write_comparison(named, tmp_path).read_text()
    assert "Change: difference from pvc." in page
    assert f">change: {long}</th>" in page
    assert "line-clamp" not in page
    assert "ellipsis" not in page
    assert f"{long} - pvc" not in page


def test_the_page_has_wrinkles_parameters_and_answers_of_each_variant(comparison, tmp_path):
    page = write_comparison(comparison, tmp_path).read_text()
    assert "Changed: all panels: material pvc → suede." in page
    assert "w2_mean: pvc" not in page
    assert "--tolerance 0.1 solves each variant to a known error." in page
    assert 'id="wrinkles"' in page
    assert "Distortion of the texture" not in page
    for name in ("pvc", "suede cover"):
        assert f">{name}, scene</summary>" in page
    assert page.count("Copy as TOML") >= 2 * 3
    rows = [page.index(f'<th scope="row">{row}') for row in (
        "pvc: pvc", "suede cover: pvc", "pvc: suede", "suede cover: suede",
    )]  # fmt: skip
    assert rows == sorted(rows)
    chosen = re.findall(r'<option value="\w+" selected>([^<]*)</option>', page)
    assert chosen == ["pvc: pvc, sun", "suede cover: pvc, sun"]


def test_scores_are_marked_and_the_widest_difference_opens_the_page(comparison, tmp_path):
    vwi = {
        (variant, texture, rig): 1.0 + 2.0 * (variant == "suede cover" and rig == "bulb") * n
        for variant in comparison.variants
        for n, texture in enumerate(comparison.textures, 1)
        for rig in comparison.rigs
    }
    scores = VariantScores(
        variants=tuple(comparison.variants),
        vwi=MappingProxyType(vwi),
        refused=MappingProxyType({"other": "too smooth"}),
    )
    assert scores.widest == ("suede cover", "suede", "bulb")
    assert scores.table().rows[0] == ("suede", "bulb", 1.0, 5.0, 4.0)
    page = write_comparison(comparison, tmp_path, scores=scores).read_text()
    assert page.index("Worse: VWI of pictures") < page.index('id="appearance"')
    more = "suede cover shows more than pvc, most in suede under bulb: VWI 1 → 5; 1 more below."
    assert more in page
    assert "Nowhere it shows less." in page
    assert "VWI 5: most visible of all" in page
    assert "other has no score: too smooth" in page
    assert 'id="visibility"' not in page
    chosen = re.findall(r'<option value="\w+" selected>([^<]*)</option>', page)
    assert chosen == ["pvc: suede, bulb", "suede cover: suede, bulb"]


def test_a_variant_that_cannot_be_scored_says_why(comparison):
    # A picture of 96 pixels is far too coarse for the gate.
    scores = score_variants(comparison)
    assert set(scores.refused) | {name for name, _, _ in scores.vwi} == set(comparison.variants)
    assert all("expected" in reason for reason in scores.refused.values())
    assert "texture" in scores._repr_html_()


def test_a_kept_result_is_taken_if_it_may_stand_for_the_scene(folder, comparison, monkeypatch):
    solved = []

    def counted(scene, *words, **options):
        solved.append(scene)
        return solve_scene(scene, *words, **options)

    monkeypatch.setattr(module, "solve_scene", counted)
    scenes = {name: v.scene for name, v in comparison.variants.items()}
    compare(scenes, keep=str(folder / "kept"))
    assert solved == []
    scenes["pvc"] = replace(scenes["pvc"], c_threshold=21.0)
    compare(scenes, keep=str(folder / "kept"))
    assert len(solved) == 1
    path = folder / "kept" / "pvc" / "result.npz"
    io.write_result(replace(io.read_result(path), status="not converged", reason="no"), path)
    compare(scenes, keep=str(folder / "kept"))
    assert len(solved) == 2


def test_variants_are_told_apart(folder):
    scene = io.load_scene(folder / "scene.toml")

    def names(*scenes):
        return variant_names([Case(one) for one in scenes])

    assert names(scene, replace(scene, name="b")) == ("two panels", "b")
    assert names(scene, replace(scene, path=Path("x/other.toml"))) == ("scene", "other")
    assert names(scene, scene) == ("1 two panels", "2 two panels")


def test_a_comparison_in_a_folder_is_one_call(comparison, tmp_path):
    scenes = {name: case.scene for name, case in comparison.variants.items()}
    paths = {name: tmp_path / f"{k}.npz" for k, name in enumerate(scenes)}
    result = comparison.first.solution
    io.write_result(result, paths["pvc"])
    stuck = replace(result, status="not converged", reason="too hard")
    io.write_result(stuck, paths["suede cover"])
    outcome = seatlook.compare_into(scenes, tmp_path / "out", results=paths, score=False)
    assert outcome.page == tmp_path / "out" / "index.html"
    assert outcome.scores is None
    assert len(list((tmp_path / "out" / "variants").rglob("*.png"))) == 2 * 2 * 2
    assert outcome.resolutions["suede cover"].sentence == "not converged: too hard"
    assert outcome.resolutions["pvc"].status == "converged, not resolved"


def test_a_comparison_is_refused_before_its_first_solve(comparison, tmp_path):
    scenes = {name: case.scene for name, case in comparison.variants.items()}
    unknown = Limit(zone="nowhere", measure="w2_mean", maximum=1.0)
    scenes["suede cover"] = replace(scenes["suede cover"], limits=(unknown,))
    with pytest.raises(InputError, match="nowhere"):
        seatlook.compare_into(scenes, tmp_path / "out")
    assert not (tmp_path / "out").exists()
    with pytest.raises(InputError, match="results: got 'none', expected one of pvc, suede cover"):
        seatlook.compare_into(comparison.variants, tmp_path / "out", results={"none": "a.npz"})
    assert not (tmp_path / "out").exists()


def test_compare_on_the_command_line(folder, tmp_path, capsys):
    scene = str(folder / "scene.toml")
    words = ["compare", scene, scene, "--out", str(tmp_path / "out")]
    assert run([*words, "--dry-run"]) == 0
    assert len(capsys.readouterr().out.splitlines()) == 1 + 2 * 2 * 2
    assert not (tmp_path / "out").exists()
    assert run(["compare", scene, "--out", str(tmp_path / "out")]) == 2
    assert "expected two or more" in capsys.readouterr().err
    assert run([*words, "--result", "none=a.npz"]) == 2
    assert "--result: got 'none=a.npz', expected NAME=RESULT.npz" in capsys.readouterr().err
