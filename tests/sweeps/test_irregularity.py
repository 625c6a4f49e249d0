"""Irregular covers: each input does to the cover what its name says; causes come back."""

from __future__ import annotations

import csv

import numpy as np
import pytest

from seatlook.cli import run
from seatlook.errors import InputError
from seatlook.io.sweep import Tolerance, read_sweep
from seatlook.mesh import face_areas
from seatlook.sweeps.cell import plan
from seatlook.sweeps.irregularity import draw, irregular, rank_correlation
from seatlook.sweeps.probability import chance
from support.scene_files import write_two_panels
from support.scenes import two_panels


def tolerance(kind: str, of: str | None = None, **change: object) -> Tolerance:
    values = {"name": kind, "kind": kind, "of": of, "distribution": "normal", "spread": 1.0}
    return Tolerance(**(values | change))


def test_draws_follow_their_distributions():
    inputs = [tolerance("foam_mm", spread=2.0), tolerance("foam_mm", distribution="uniform")]
    values = draw(inputs, 400, seed=3)
    assert values.shape == (400, 2)
    assert values[:, 0].std() == pytest.approx(2.0, rel=0.03)
    assert np.abs(values[:, 0]).max() <= 6.0
    assert values[:, 1].min() == pytest.approx(-1.0, abs=0.01)
    assert abs(np.corrcoef(values.T)[0, 1]) < 0.15
    assert (draw(inputs, 400, seed=3) == values).all()
    assert (draw(inputs, 400, seed=4) != values).any()


def test_a_seam_sewn_inside_its_line_takes_area_and_keeps_its_corners():
    scene = two_panels()
    made = irregular(scene, [tolerance("seam_offset_mm", "middle")], [2.0])
    # Only the ends of the drawn line are points; they stay, so a line without points in between
    # cannot move: give it some.
    assert np.allclose(made.pattern.panel("LEFT").outline, scene.pattern.panel("LEFT").outline)
    fine = with_points(scene)
    made = irregular(fine, [tolerance("seam_offset_mm", "middle")], [2.0])
    lost = area(fine.pattern.panel("LEFT").outline) - area(made.pattern.panel("LEFT").outline)
    assert lost == pytest.approx(0.002 * 0.1 * 2 / np.pi, rel=0.01)
    assert made.pattern.panel("RIGHT") is fine.pattern.panel("RIGHT")


def test_ease_makes_one_side_longer_by_its_share():
    scene = two_panels()
    made = irregular(scene, [tolerance("ease_percent", "middle")], [3.0])
    lengths = [made.pattern.edge_length(n) for n in ("LEFT.seam", "RIGHT.seam")]
    assert lengths == pytest.approx([0.103, 0.1])


def test_hooks_go_down_and_foam_grows():
    scene = two_panels()
    inputs = [tolerance("hook_depth_mm", "wire"), tolerance("foam_mm")]
    made = irregular(scene, inputs, [4.0, 3.0])
    assert np.allclose(made.foam.curves["wire"] - scene.foam.curves["wire"], [0, 0, -0.004])
    assert made.foam.curves["rail"] is scene.foam.curves["rail"]
    shift = np.linalg.norm(made.foam.vertices - scene.foam.vertices, axis=1)
    assert np.allclose(shift, 0.003)
    assert (
        face_areas(made.foam.vertices, made.foam.faces).sum()
        > face_areas(scene.foam.vertices, scene.foam.faces).sum()
    )


@pytest.mark.parametrize("kind", ["seam_offset_mm", "ease_percent", "hook_depth_mm"])
def test_an_unknown_seam_or_curve_is_named(kind):
    with pytest.raises(InputError, match=f"irregularity.input {kind}: got 'nowhere'"):
        irregular(two_panels(), [tolerance(kind, "nowhere")], [1.0])


def test_the_input_that_matters_is_found():
    inputs = draw([tolerance("foam_mm")] * 3, 60, seed=1)
    result, noise = rank_correlation(inputs, np.exp(2 * inputs[:, 1]) + 0.1 * inputs[:, 0])
    assert result[1] > 0.95
    assert np.abs(result[[0, 2]]).max() < 2 * noise
    assert noise == pytest.approx(1.96 / np.sqrt(59))
    assert np.isnan(rank_correlation(inputs, np.ones(60))[0]).all()


@pytest.mark.render
def test_a_sweep_of_irregular_covers_leaves_a_map_and_its_causes(tmp_path, capsys):
    write_two_panels(tmp_path)
    (tmp_path / "sweep.toml").write_text(
        'schema = 1\nscene = "scene.toml"\n[irregularity]\ndraws = 5\n'
        '[[irregularity.input]]\nname = "ease"\nkind = "ease_percent"\nof = "middle"\nspread = 3\n'
        '[[irregularity.input]]\nname = "foam"\nkind = "foam_mm"\nspread = 0.01\n'
    )
    out = tmp_path / "out"
    assert run(["sweep", str(tmp_path / "sweep.toml"), "--out", str(out), "--preview"]) == 0
    assert "5 of 5 covers converged; " in capsys.readouterr().err
    heads, first, second = (out / "inputs.csv").read_text().splitlines()
    assert heads == "input,rank_correlation,rank_correlation_of_size,noise"
    assert {first.split(",")[0], second.split(",")[0]} == {"ease", "foam"}
    assert (out / "probability.png").read_bytes().startswith(b"\x89PNG")
    table = csv.DictReader((out / "probability.csv").read_text().splitlines())
    zones = {row["zone"]: row for row in table}
    assert {row["converged"] for row in zones.values()} == {"5"}
    assert all(row["largest"] == row["largest_if_left_out_above"] for row in zones.values())
    # A cell that failed is a cover without W2.
    name = next((out / "cells").glob("*.npy")).stem
    (out / f"cells/{name}.json").rename(out / f"cells/{name}.failed.json")
    result = chance(plan(read_sweep(tmp_path / "sweep.toml")), out / "cells")
    assert (result.converged, result.left_out) == (4, 1)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "schema: got nothing, expected a whole number"),
        ('schema = 1\nscene = "none.toml"\n', "there is none at"),
        ('schema = 1\nscene = "scene.toml"\n[axis]\n"mesh.seed" = 3\n', "expected a list of val"),
        (
            'schema = 1\nscene = "scene.toml"\n[irregularity]\ndraws = 9\n'
            '[[irregularity.input]]\nname = "a"\nkind = "foam"\nspread = 1\n',
            "got 'foam', expected one of seam_offset_mm, ease_percent, hook_depth_mm, foam_mm",
        ),
        (
            'schema = 1\nscene = "scene.toml"\n[irregularity]\ndraws = 9\n'
            '[[irregularity.input]]\nname = "a"\nkind = "ease_percent"\nspread = 1\n',
            "input[0].of: got None, expected a seam or curve",
        ),
    ],
)
def test_faults_of_a_sweep_file_are_named(tmp_path, text, message):
    write_two_panels(tmp_path)
    (tmp_path / "sweep.toml").write_text(text)
    with pytest.raises(InputError) as caught:
        read_sweep(tmp_path / "sweep.toml")
    assert message in str(caught.value)


def area(outline: np.ndarray) -> float:
    x, y = outline.T
    return 0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1))


def with_points(scene):
    """Put points every millimetre on LEFT's outline."""
    from dataclasses import replace
    from types import MappingProxyType

    panel = scene.pattern.panel("LEFT")
    outline = np.concatenate(
        [
            a + (b - a) * np.linspace(0, 1, 100, endpoint=False)[:, None]
            for a, b in zip(panel.outline, np.roll(panel.outline, -1, axis=0), strict=True)
        ]
    )
    finer = replace(panel, outline=outline, corners=100 * panel.corners, cut_outline=outline)
    edges = {
        name: replace(e, start=100 * e.start, end=100 * e.end) if e.panel == "LEFT" else e
        for name, e in scene.pattern.edges.items()
    }
    pattern = replace(
        scene.pattern,
        panels=tuple(finer if p is panel else p for p in scene.pattern.panels),
        edges=MappingProxyType(edges),
    )
    return replace(scene, pattern=pattern)
