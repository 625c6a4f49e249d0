"""What is written can be read again, whatever things are called."""

import csv
import dataclasses
import json
import struct
import tomllib
import warnings
from types import MappingProxyType

import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from seatlook.io.curves import read_curves, write_curves
from seatlook.io.export.csv import write_csv
from seatlook.io.export.glb import write_glb
from seatlook.io.export.result import read_result, write_result
from seatlook.io.lsdyna.deck.reader import read_keyword
from seatlook.io.lsdyna.dynain import write_dynain
from seatlook.io.material import read_material
from seatlook.io.pattern.dxf import read_dxf
from seatlook.io.pattern.dxf_write import write_dxf
from seatlook.io.pattern.seams import read_seams, write_seams
from seatlook.io.scene.read import load_scene
from seatlook.io.table import write_table
from seatlook.io.toml import index_lines, quoted, toml_key
from seatlook.model import Edge, Panel, Pattern, Seam
from support.io_samples import as_placed, cover, solution
from support.scene_files import TEXT, write_two_panels

# Whatever a text holds but half a pair, which no file can.
ANY = st.text(min_size=1, max_size=12) | st.sampled_from(
    ['a"b', "a\nb", "=1+1", "🪡", "a#b", "'", "\\", "\\U+0041", "é", "座套", "a.b", "\u2028", "-1",
     "@SUM(A1)", "\x7f", "\r\n", '"""', "'''", "[x]", "\ufeff", "%%d", "^J", "a\\Pb"]
)  # fmt: skip
# A name stands between others on a line: blanks around it and its lines are not part of it.
NAME = ANY.map(lambda name: " ".join(name.split())).filter(bool)
few = settings(
    max_examples=25, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
many = settings(few, max_examples=1000)


@pytest.mark.parametrize(
    "count", [50, pytest.param(1000, marks=pytest.mark.validate)], ids=["50", "1000"]
)
def test_toml_holds_any_name(count):
    @settings(few, max_examples=count)
    @given(st.lists(ANY, unique=True, min_size=1, max_size=4), ANY)
    def hold(names, text):
        lines = [f"{toml_key(name)} = {quoted(text)}" for name in names]
        content = "\n".join(lines)
        assert tomllib.loads(content) == dict.fromkeys(names, text)
        assert index_lines(content) == {(name,): k for k, name in enumerate(names, start=1)}

    hold()


def outline(x):
    return np.array([[x, 0.0], [x + 0.2, 0.0], [x + 0.2, 0.3], [x, 0.3]])


def pattern(names, seam, edges):
    panels = tuple(
        Panel(name=name, outline=outline(0.0), corners=np.arange(4), cut_outline=outline(0.0),
              grain=np.array([0.0, 1.0]), internal_lines=MappingProxyType(
                  {seam: np.array([[0.05, 0.1], [0.15, 0.1]])}))
        for name in names
    )  # fmt: skip
    sides = {e: Edge(name=e, panel=n, start=1, end=2) for e, n in zip(edges, names, strict=True)}
    sewn = Seam(name=seam, a=edges[0], b=(edges[1],), reverse=True, pitch=0.005)
    return Pattern(panels=panels, edges=MappingProxyType(sides), seams=(sewn,))


PAIR = st.lists(NAME, unique=True, min_size=2, max_size=2)


def drawn_again(folder, names, seam, edges):
    """Write DXF and seams, read both."""
    first = pattern(names, seam, edges)
    write_dxf(first, folder / "p.dxf", style="s")
    write_seams(first, folder / "s.toml", notes={seam: "a note"})
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        panels = read_dxf(folder / "p.dxf")
    again = read_seams(folder / "s.toml", panels)
    assert [p.name for p in again.panels] == names
    assert list(again.edges) == edges
    assert [s.name for s in again.seams] == [seam]
    assert all(list(p.internal_lines) == [seam] for p in again.panels)


@few
@given(PAIR, NAME, PAIR)
@example(["a\\U+0041", "🪡"], "=1+1", ['"', "'"])
def test_patterns_of_any_names(tmp_path, names, seam, edges):
    drawn_again(tmp_path, names, seam, edges)


@pytest.mark.validate
@many
@given(PAIR, NAME, PAIR)
def test_many_patterns_of_any_names(tmp_path, names, seam, edges):
    drawn_again(tmp_path, names, seam, edges)


def curves_again(folder, names):
    curves = {name: np.array([[0.1, 0.2, 1 / 3], [0.4, 0.5, k]]) for k, name in enumerate(names)}
    write_curves(curves, folder / "c.toml")
    again = read_curves(folder / "c.toml")
    assert list(again) == names
    assert all(np.allclose(again[n], curves[n], rtol=1e-15, atol=0) for n in names)


@few
@given(st.lists(ANY, unique=True, min_size=1, max_size=3))
def test_curves_of_any_names(tmp_path, names):
    curves_again(tmp_path, names)


def result_again(folder, names, text):
    first = solution()
    first = dataclasses.replace(
        first,
        cover=dataclasses.replace(first.cover, panel_names=tuple(names), scene_digest=text),
        multipliers=MappingProxyType({text: np.ones((2, 3)), "": np.zeros((1, 3))}),
        reason=text,
    )
    write_result(first, folder / "r.npz")
    again = read_result(folder / "r.npz")
    assert (again.cover.panel_names, again.reason) == (tuple(names), text)
    assert [*again.multipliers] == [text, ""]
    assert again.positions.tobytes() == first.positions.tobytes()


@few
@given(st.lists(ANY, unique=True, min_size=2, max_size=2), ANY)
def test_results_of_any_names(tmp_path, names, text):
    result_again(tmp_path, names, text)


def table_again(folder, rows):
    write_table(folder / "t.csv", ("name", "value"), [(name, k) for k, name in enumerate(rows)])
    with (folder / "t.csv").open(encoding="utf-8", newline="") as file:
        read = [row[0] for row in csv.reader(file)][1:]
    assert [text.removeprefix("'") for text in read] == rows
    # No cell begins a formula, but for numbers.
    assert not [t for t in read if t[:1] in "=@\t\r" or (t[:1] in "+-" and not _number(t))]


def _number(text):
    try:
        return float(text) is not None
    except ValueError:
        return False


@few
@given(st.lists(ANY, min_size=1, max_size=5))
@example(["=1+1", "'=1", "-1", "-a", "+1e3", "@x", "\t=1"])
def test_tables_of_any_names(tmp_path, names):
    table_again(tmp_path, names)


@few
@given(st.lists(ANY, unique=True, min_size=2, max_size=2))
def test_exported_covers_of_any_names(tmp_path, names):
    exported_again(tmp_path, names)


def exported_again(folder, names):
    placed = as_placed(dataclasses.replace(cover(), panel_names=tuple(names)))
    write_csv(placed, (), folder / "c.csv")
    with (folder / "c.csv").open(encoding="utf-8", newline="") as file:
        panels = [row["panel"].removeprefix("'") for row in csv.DictReader(file)]
    assert panels == [names[0], names[0], names[1]]
    write_glb(placed, (), folder / "c.glb")
    content = (folder / "c.glb").read_bytes()
    (length,) = struct.unpack_from("<I", content, 12)
    nodes = [n["name"] for n in json.loads(content[20 : 20 + length])["nodes"] if "mesh" in n]
    assert nodes == names
    write_dynain(placed, folder / "c.k")
    read = read_keyword(folder / "c.k")
    assert len(read.shells) == 3


def scene_again(folder, name, rig, stage):
    text = TEXT.replace('"two panels"', quoted(name)).replace(
        'name = "bulb"', f"name = {quoted(rig)}"
    )
    text = text.replace('"cover"', quoted(stage))
    scene = load_scene(write_two_panels(folder, text=text))
    assert (scene.name, scene.rigs[1].name, scene.stages[1].name) == (name, rig, stage)
    assert scene.hooks[0].stage == stage


@few
@given(ANY, ANY.filter(lambda n: n != "sun"), ANY.filter(lambda n: n != "sew"))
def test_scenes_of_any_names(tmp_path, name, rig, stage):
    scene_again(tmp_path, name, rig, stage)


@few
@given(ANY)
def test_materials_of_any_source(tmp_path, text):
    from seatlook.io.material import materials_dir

    content = (materials_dir() / "suede.toml").read_text(encoding="utf-8")
    content = content.split("[source]")[0] + f"[source]\nalbedo = {quoted(text)}\n"
    (tmp_path / "m.toml").write_text(content, encoding="utf-8")
    assert read_material(tmp_path / "m.toml").source["albedo"] == text


@pytest.mark.validate
@many
@given(st.lists(ANY, unique=True, min_size=2, max_size=2), ANY)
def test_much_of_any_names(tmp_path, names, text):
    curves_again(tmp_path, names)
    result_again(tmp_path, names, text)
    table_again(tmp_path, [*names, text])
    exported_again(tmp_path, names)
