"""A scene started from a pattern and a foam of one's own: what is guessed, and what is said."""

from __future__ import annotations

import itertools
import json
import re
import shutil
import warnings
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType

import numpy as np
import pytest
from PIL import Image

from seatlook import assemble, io
from seatlook.assembly.seam_guess import propose_seams
from seatlook.assembly.unfolding import CLEAR, lay_out
from seatlook.cli import run
from seatlook.cli._app import _format_warning
from seatlook.errors import InputError, InputWarning
from seatlook.model import Edge, Foam, Panel, Pattern
from seatlook.solver.foam.distance import distance_field
from support.dxf_sheet import Sheet

DATA = Path(__file__).parents[1] / "data"


@pytest.fixture(scope="module")
def own(demo_scene: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with nothing but a pattern and a foam."""
    folder = tmp_path_factory.mktemp("own")
    shutil.copy(demo_scene.with_name("pattern.dxf"), folder / "cover.dxf")
    shutil.copy(demo_scene.with_name("foam.obj"), folder / "foam.obj")
    return folder


@pytest.fixture(scope="module")
def started(own: Path) -> Path:
    assert (
        run(["init", str(own / "cover.dxf"), str(own / "foam.obj"), "--out", str(own / "a")]) == 0
    )
    return own / "a"


def sewn(pattern: Pattern) -> set[frozenset[tuple[str, int, int]]]:
    """Seams as sets of stretches, whatever edges and seams are called."""
    ends = {e.name: (e.panel, e.start, e.end) for e in pattern.edges.values()}
    return {frozenset(ends[name] for name in (s.a, *s.b)) for s in pattern.seams}


def test_all_seams_of_the_demo_are_found_and_no_other(demo_scene):
    true = io.load_scene(demo_scene).pattern
    found = propose_seams(true.panels)
    # One panel is cut 1 % small: lengths agree to a percent only.
    assert sewn(found.pattern) == sewn(true)
    assert len(found.free) == 4
    assert set(found.reasons) == {s.name for s in found.pattern.seams}


def test_one_edge_on_three_is_found_by_notches_at_the_joints():
    true = io.read_pattern(
        DATA / "seat_cushion_demo_aama.dxf", DATA / "seat_cushion_demo.seams.toml"
    )
    found = propose_seams(true.panels)
    assert sewn(found.pattern) == sewn(true)
    assert sorted(len(s.b) for s in found.pattern.seams) == [1, 1, 3]


def test_the_scene_is_complete_and_its_comments_stay(started):
    scene = io.load_scene(started / "scene.toml", changes=["mesh.element_size_mm=20"])
    cover = assemble(scene)
    assert len(scene.pattern.seams) == 14
    assert [frame.name for frame in scene.frames] == ["border"]
    assert len(cover.panel_names) == 7
    text = (started / "scene.toml").read_text()
    assert "The seams are guessed: read them over." in text
    assert "# [[hook]]" in text
    seams = (started / "seams.toml").read_text()
    assert seams.count("# probability ") == 14
    assert seams.count("mm; notches at") + seams.count("mm; no notch; free") == 32
    assert seams.count("; free\n") == 4
    assert "notches meet" in seams


def test_panels_start_clear_of_the_foam_and_joined_at_their_seams(started):
    scene = io.load_scene(started / "scene.toml")
    field = distance_field(scene.foam.vertices, scene.foam.faces)
    placed = {}
    for panel in scene.pattern.panels:
        pose = scene.placement[panel.name]
        placed[panel.name] = pose
        x = panel.outline @ pose.rotation[:, :2].T + pose.translation
        assert field.at(x)[0].min() > 0.9 * CLEAR
        # The visible side looks away from the foam.
        middle = x.mean(axis=0) - scene.foam.vertices.mean(axis=0)
        assert pose.rotation[:, 2] @ middle > 0
    gaps = []
    for seam in scene.pattern.seams:
        ends = []
        for name in (seam.a, *seam.b):
            pose = placed[scene.pattern.edges[name].panel]
            line = scene.pattern.edge_points(name)
            ends.append(line.mean(axis=0) @ pose.rotation[:, :2].T + pose.translation)
        gaps.append(float(np.linalg.norm(ends[0] - np.mean(ends[1:], axis=0))))
    assert sorted(gaps)[5] < 0.02  # the six that carry a panel, each a slightly curved line


def test_free_edges_are_pulled_to_one_closed_curve_of_their_length(started):
    scene = io.load_scene(started / "scene.toml")
    (frame,) = scene.frames
    panels = [scene.pattern.edges[name].panel for name in frame.edges]
    assert panels == ["FRONT", "SIDE_L", "REAR", "SIDE_R"]
    curve = scene.foam.curves[frame.curve]
    np.testing.assert_allclose(curve[0], curve[-1], atol=1e-9)
    edges = [scene.pattern.edge_length(name) for name in frame.edges]
    np.testing.assert_allclose(np.diff(frame.junctions), edges, rtol=0.06)


def test_the_border_lies_where_the_design_has_it(started, demo_scene):
    own = io.load_scene(demo_scene)
    scene = io.load_scene(started / "scene.toml")
    (guessed,), true = scene.frames, own.frames[0]
    found, meant = scene.foam.curves[guessed.curve], own.foam.curves[true.curve]
    assert abs(found[:, 2].mean() - meant[:, 2].mean()) < 0.01
    first = [own.pattern.edges[name].panel for name in true.edges].index("FRONT")
    arc = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(meant, axis=0), axis=1))])
    corner = [np.interp(true.junctions[first], arc, column) for column in meant.T]
    assert np.linalg.norm(found[0] - corner) < 0.02


def test_wires_are_hooked_to_the_seams_above_them(own, demo_scene, capsys):
    words = ["init", str(own / "cover.dxf"), str(own / "foam.obj"), "--out", str(own / "b")]
    assert run([*words, "--wires", str(demo_scene.with_name("wires.toml")), "--json"]) == 0
    said = capsys.readouterr()
    assert len(json.loads(said.out)) == 14
    scene = io.load_scene(own / "b" / "scene.toml")
    assert {hook.wire for hook in scene.hooks} == {"trench_left", "trench_right"}
    for hook in scene.hooks:
        side = "L" if hook.wire.endswith("left") else "R"
        assert hook.line == f"INSERT-BOLSTER_{side}"


def test_a_foam_in_other_axes_is_told_by_its_size(own, tmp_path, capsys):
    body = io.read_foam(own / "foam.obj", material=io.read_foam_material("foam-seat"), unit="mm")
    x, y, z = body.vertices.T
    io.write_obj(np.column_stack([x, z, -y]), body.faces, tmp_path / "turned.obj")
    words = ["init", str(own / "cover.dxf"), str(tmp_path / "turned.obj"), "--out"]
    run([*words, str(tmp_path / "a")])
    assert "if its file's vertical axis is y, say --up y" in capsys.readouterr().err
    run([*words, str(tmp_path / "b"), "--up", "y"])
    said = capsys.readouterr().err
    assert "say --up" not in said
    width, depth, height = np.ptp(body.vertices, axis=0) * 1e3
    assert f"foam: {width:.0f} mm wide, {depth:.0f} mm deep, {height:.0f} mm high" in said


def test_check_says_how_to_go_on_and_puts_the_largest_ease_first(started, capsys):
    assert run(["check", str(started / "scene.toml"), "--element-size-mm", "20"]) == 0
    said = capsys.readouterr()
    assert "nothing wrong; to solve and draw it: seatlook evaluate" in said.err
    lines = said.out.splitlines()
    first = next(k for k, line in enumerate(lines) if line.split()[:2] == ["number", "seam"])
    rows = list(itertools.takewhile(lambda line: line.split()[0] != "number", lines[first + 1 :]))
    shares = [abs(float(row.split()[-5])) for row in rows]
    assert shares == sorted(shares, reverse=True)
    assert shares[0] > 0.5


def test_the_pattern_is_drawn_with_the_names_of_all_edges(started):
    text = (started / "pattern.svg").read_text()
    pattern = io.load_scene(started / "scene.toml").pattern
    for edge in pattern.edges.values():
        own = edge.name.removeprefix(f"{edge.panel}.")
        assert re.search(rf">\d+  {own}  {1e3 * pattern.edge_length(edge.name):.1f} mm", text)
    for panel in pattern.panels:
        assert f">{panel.name}</text>" in text
    with Image.open(started / "pattern.png") as picture:
        assert picture.size[0] == 1600


def one_panel(path: Path, width: float) -> Path:
    square = np.array([[0.0, 0.0], [width, 0.0], [width, 0.4], [0.0, 0.4]])
    panel = Panel(
        name="ALONE", outline=square, corners=np.arange(4), cut_outline=square,
        grain=np.array([0.0, 1.0]),
    )  # fmt: skip
    other = replace(panel, name="OTHER", outline=square * [0.71, 0.83], cut_outline=square)
    none: MappingProxyType[str, Edge] = MappingProxyType({})
    io.write_dxf(Pattern(panels=(panel, other), edges=none, seams=()), path)
    return path


def test_what_cannot_be_guessed_is_written_as_far_as_it_goes_and_listed(own, tmp_path, capsys):
    cut = one_panel(tmp_path / "cut.dxf", 0.5)
    out = tmp_path / "out"
    assert run(["init", str(cut), str(own / "foam.obj"), "--out", str(out)]) == 0
    said = capsys.readouterr().err
    assert "missing: seams that join OTHER to ALONE; until then they lie beside the foam" in said
    scene = io.load_scene(out / "scene.toml")
    assert len(scene.pattern.edges) == 8
    assert set(scene.placement) == {"ALONE", "OTHER"}
    assert (out / "pattern.svg").exists()


def test_a_pattern_out_of_scale_with_its_foam_is_named(own, tmp_path, capsys):
    cut = one_panel(tmp_path / "cut.dxf", 5.0)
    words = ["init", str(cut), str(own / "foam.obj"), "--out", str(tmp_path / "out")]
    with pytest.warns(InputWarning) as notes:
        assert run(words) == 0
    said = [str(note.message) for note in notes]
    assert any("out of scale? (500 mm at a tenth of the scale)" in text for text in said)
    assert any("piece ALONE: a size of 5000 mm is unusual" in text for text in said)
    assert "the pattern is too large for it" in capsys.readouterr().err


def test_warnings_are_said_without_places_in_the_program():
    text = warnings.formatwarning("x", InputWarning, "file.py", 3)
    assert "file.py" in text
    assert _format_warning("x", InputWarning, "file.py", 3) == "note: x\n"
    assert "file.py" in _format_warning("x", UserWarning, "file.py", 3)


def test_edits_are_not_written_over(started, own, capsys):
    words = ["init", str(own / "cover.dxf"), str(own / "foam.obj"), "--out", str(started)]
    before = (started / "scene.toml").read_bytes()
    assert run(words) == 2
    assert "expected a new one, or --force" in capsys.readouterr().err
    assert (started / "scene.toml").read_bytes() == before


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (["--top", "INSRT"], "--top: got 'INSRT', expected one of INSERT,"),
        (["--material", "leather"], "--"),
        (["--unit", "m"], "expected"),
        (["--foam-material", "foam"], "foam"),
    ],
)
def test_wrong_words_leave_nothing(own, tmp_path, capsys, change, message):
    out = tmp_path / "out"
    words = ["init", str(own / "cover.dxf"), str(own / "foam.obj"), "--out", str(out)]
    assert run([*words, *change]) == 2
    assert message.strip("-") in capsys.readouterr().err
    assert not out.exists()


def test_a_panel_that_nothing_joins_is_named(demo_scene):
    scene = io.load_scene(demo_scene)
    alone = Pattern(
        panels=scene.pattern.panels,
        edges=scene.pattern.edges,
        seams=tuple(s for s in scene.pattern.seams if "REAR" not in s.name),
    )
    with pytest.raises(InputError, match="got none that joins REAR to INSERT"):
        lay_out(alone, scene.foam)


@pytest.mark.parametrize("size", [(0.28, 0.13, 0.18), (0.5, 0.15, 0.7), (0.13, 0.5, 0.7)])
def test_the_largest_panel_faces_the_broad_side_of_a_foam_that_stands(demo_scene, size):
    scene = io.load_scene(demo_scene)
    body = scene.foam
    own = np.ptp(body.vertices, axis=0)
    # A cushion stood up on its rear, or on its side.
    order = [0, 2, 1] if size[1] < size[0] else [2, 1, 0]
    stood = (body.vertices / own)[:, order] * size
    faces = body.faces[:, ::-1]
    foam = Foam(vertices=np.ascontiguousarray(stood), faces=faces, material=body.material)
    layout = lay_out(scene.pattern, foam, partial=True)
    pose = layout.poses[layout.first]
    facing = [0.0, -1.0, 0.0] if size[1] < size[0] else [1.0, 0.0, 0.0]
    np.testing.assert_allclose(pose.rotation[:, 2], facing, atol=1e-12)
    np.testing.assert_allclose(pose.rotation[:, 1], [0.0, 0.0, 1.0], atol=1e-12)
    field = distance_field(foam.vertices, foam.faces)
    line = scene.pattern.panel(layout.first).outline @ pose.rotation[:, :2].T + pose.translation
    assert field.at(line)[0].min() > 0.0
    assert layout.borders
    for border in layout.borders:
        assert np.isfinite(border.curve).all()


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["mesh.seed"], "--set: got 'mesh.seed', expected KEY=VALUE"),
        (["rig.sn.ev100=3"], "expected a row from 0 to 1, or one of sun, bulb (did you mean 'sun'"),
        (["rig.9.ev100=3"], "expected a row from 0 to 1"),
        (["mesh.sed=3"], "mesh.sed: got unknown key, expected one of element_size_mm, "),
        (["mesh.seed=high"], "mesh.seed: got 'high', expected a whole number"),
        (["name.of=3"], "expected name to be a table"),
    ],
)
def test_a_key_set_wrongly_is_told(started, capsys, words, message):
    changes = [part for word in words for part in ("--set", word)]
    assert run(["check", str(started / "scene.toml"), *changes]) == 2
    assert message in capsys.readouterr().err


def test_keys_are_set_over_those_of_the_file(started):
    path = started / "scene.toml"
    plain = io.load_scene(path)
    changed = io.load_scene(
        path,
        changes=["mesh.seed=7", "rig.bulb.light.0.lumen=400", "pattern.material=suede-laminate"],
    )
    assert changed.seed == 7
    assert changed.rigs[1].lights[0].intensity == plain.rigs[1].lights[0].intensity / 2
    assert {m.name for m in changed.materials.values()} == {"suede-laminate"}
    assert changed.digest != plain.digest
    assert io.load_scene(path, changes=["mesh.seed=7"]).digest != changed.digest


def test_a_dry_run_lists_the_cells_and_makes_nothing(started, tmp_path, capsys):
    words = ["evaluate", str(started / "scene.toml"), "--out", str(tmp_path / "o"), "--dry-run"]
    assert run([*words, "--json"]) == 0
    cells = json.loads(capsys.readouterr().out)
    assert len(cells) == 3 * 2
    assert cells[0]["ev100"] == pytest.approx(15.3, abs=0.5)
    assert not (tmp_path / "o").exists()


def test_encoding_and_grain_go_into_the_scene(own, tmp_path, capsys):
    files = [str(own / "cover.dxf"), str(own / "foam.obj"), "--out"]
    options = ["--encoding", "gb18030", "--grain-deg", "30"]
    assert run(["init", *files, str(tmp_path / "a"), *options]) == 0
    scene = tmp_path / "a/scene.toml"
    text = scene.read_text()
    assert 'encoding = "gb18030"\n' in text
    assert "grain_deg = 30.0\n" in text
    # Its panels have grain lines, which count.
    assert {tuple(p.grain.tolist()) for p in io.load_scene(scene).pattern.panels} == {(0.0, 1.0)}
    assert run(["init", *files, str(tmp_path / "b"), "--encoding", "klingon"]) == 2
    assert "encoding: got 'klingon'" in capsys.readouterr().err
    scene.write_text(text.replace("gb18030", "klingon"))
    with pytest.raises(InputError, match="encoding: got 'klingon'"):
        io.load_scene(scene)


def test_the_pattern_is_reported_layer_by_layer(own, tmp_path, capsys):
    files = [str(own / "cover.dxf"), str(own / "foam.obj"), "--out", str(tmp_path / "a")]
    assert run(["init", *files]) == 0
    said = capsys.readouterr().err
    assert "cover.dxf: 7 pieces, a unit is 1 mm" in said
    report = io.report_dxf(own / "cover.dxf")
    for piece in report.pieces:
        assert f"{piece.name}: layers with lines, points or texts" in said
    for left, count in report.left.items():
        assert f"not read: {count} {left.kind} on layer {left.layer} ({left.reason})" in said


def test_how_the_foam_is_mended_goes_into_the_scene(own, tmp_path, capsys):
    foam = io.read_foam_surface(own / "foam.obj", unit="mm")
    bottom = foam.vertices[foam.faces][..., 2].max(axis=1) < foam.vertices[:, 2].min() + 1e-6
    assert bottom.any()
    io.write_obj(foam.vertices, foam.faces[~bottom], own / "open.obj")
    files = [str(own / "cover.dxf"), str(own / "open.obj"), "--out", str(tmp_path / "a")]
    assert run(["init", *files]) == 2
    assert "close fills the holes" in capsys.readouterr().err
    assert run(["init", *files, "--close"]) == 0
    assert "openings closed flat" in capsys.readouterr().err
    scene = tmp_path / "a/scene.toml"
    assert "close = true\n" in scene.read_text()
    closed = io.load_scene(scene).foam
    size = np.ptp(closed.vertices, axis=0)
    assert size == pytest.approx(np.ptp(foam.vertices, axis=0))


def test_an_allowance_goes_into_the_scene(tmp_path, own):
    pattern = own / "cut.dxf"
    sheet = Sheet(pattern)
    block = sheet.block("A")
    sheet.line(block, [(0, 0), (400, 0), (400, 300), (0, 300)], layer="Schnitt 1")
    sheet.insert("A")
    sheet.document.saveas(pattern)
    files = [str(pattern), str(own / "foam.obj"), "--out", str(tmp_path / "a")]
    assert run(["init", *files, "--allowance-mm", "12", "--layer", "Schnitt 1=CUT"]) == 0
    (panel,) = io.load_scene(tmp_path / "a/scene.toml").pattern.panels
    assert 1e3 * np.ptp(panel.outline, axis=0) == pytest.approx([376, 276])
    assert 1e3 * np.ptp(panel.cut_outline, axis=0) == pytest.approx([400, 300])
