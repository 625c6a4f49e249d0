"""What two scenes differ in, key by key: every kind of input of a scene."""

from __future__ import annotations

from dataclasses import replace

import pytest

from seatlook import io
from seatlook.model.table import Table
from seatlook.report.sections.inputs import different_inputs, in_words
from support.scene_files import write_two_panels


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    return write_two_panels(tmp_path_factory.mktemp("inputs"))


def rows(file, *changes):
    scenes = {"a": io.load_scene(file), "b": io.load_scene(file, changes=changes)}
    return {row[0]: row[1:] for row in different_inputs(scenes).rows}


def test_the_same_scene_differs_in_nothing(file):
    assert rows(file) == {}
    table = different_inputs({"a": io.load_scene(file), "b": io.load_scene(file)})
    assert in_words(table) == "Nothing that goes in is different."


@pytest.mark.parametrize(
    ("change", "key", "after"),
    [
        ("mesh.seed=3", "seed", "3"),
        ("mesh.element_size_mm=9", "element_size_mm", "9"),
        ("hem=true", "hem", "True"),
        ('wrinkle.curvature="paper"', "curvature", "paper"),
        ("stage.0.end_s=0.31", "stage.sew.end_s", "0.31"),
    ],
)
def test_a_setting_is_named_by_its_key_with_both_values(file, change, key, after):
    if change.startswith("stage"):
        scene = io.load_scene(file)
        first, *others = scene.stages
        other = replace(scene, stages=(replace(first, end=0.31), *others))
        found = {r[0]: r[1:] for r in different_inputs({"a": scene, "b": other}).rows}
        key = f"stage.{first.name}.end_s"
    else:
        found = rows(file, change)
    assert found[key][1] == after
    assert found[key][0] != after
    assert all(name == key or "w2" not in name for name in found)


def test_a_material_of_all_panels_is_one_row_with_its_values_below(file):
    found = rows(file, 'pattern.material="suede"')
    assert found["all panels: material"] == ("pvc", "suede")
    assert found["all panels: thickness_mm"][0] != found["all panels: thickness_mm"][1]
    table = Table(heads=("input", "a", "b"), rows=tuple((k, *v) for k, v in found.items()))
    assert in_words(table) == "Changed: all panels: material pvc → suede."


def test_a_wider_panel_and_a_longer_edge_are_said_in_millimetres(file):
    scene = io.load_scene(file)
    panel, *others = scene.pattern.panels
    wider = replace(
        panel, outline=panel.outline * [1.02, 1.0], cut_outline=panel.cut_outline * [1.02, 1.0]
    )
    pattern = replace(scene.pattern, panels=(wider, *others))
    found = different_inputs({"a": scene, "b": replace(scene, pattern=pattern)}).rows
    assert found == ((f"panel {panel.name}: size_mm", "100.0 x 100.0", "102.0 x 100.0"),)
    taller = replace(
        panel, outline=panel.outline * [1.0, 1.02], cut_outline=panel.cut_outline * [1.0, 1.02]
    )
    pattern = replace(scene.pattern, panels=(taller, *others))
    found = different_inputs({"a": scene, "b": replace(scene, pattern=pattern)}).rows
    assert ("edge LEFT.seam: length_mm", "100.0", "102.0") in found


def test_a_foam_of_another_shape_is_seen(file):
    scene = io.load_scene(file)
    foam = replace(scene.foam, vertices=scene.foam.vertices * 1.01)
    (row,) = different_inputs({"a": scene, "b": replace(scene, foam=foam)}).rows
    assert row[0] == "foam: surface"


def test_values_that_look_alike_are_written_with_every_digit(file):
    found = rows(file, "mesh.smallest_notch_mm=5.0001")
    assert found["smallest_notch_mm"] == ("5", "5.0001")


def test_materials_stand_first_and_the_edge_that_changes_most_before_others(file):
    scene = io.load_scene(file, changes=('pattern.material="suede"', "mesh.seed=5"))
    left, right = scene.pattern.panels
    stretched = [
        replace(p, outline=p.outline * [1.0, s], cut_outline=p.cut_outline * [1.0, s])
        for p, s in ((left, 1.01), (right, 1.04))
    ]
    pattern = replace(scene.pattern, panels=tuple(stretched))
    table = different_inputs({"a": io.load_scene(file), "b": replace(scene, pattern=pattern)})
    keys = [row[0] for row in table.rows]
    edges = [key for key in keys if key.startswith("edge ")]
    assert keys[0] == "all panels: material"
    assert keys.index("seed") < keys.index(edges[0])
    assert edges[0] == "edge RIGHT.seam: length_mm"
    assert "edge RIGHT.seam 100.0 → 104.0 mm" in in_words(table)
