import re
import shutil
from pathlib import Path

import pytest

from seatlook.errors import InputWarning
from seatlook.io.scene.keys import scene_keys
from seatlook.io.scene.read import load_scene
from seatlook.io.surface.design import write_obj
from seatlook.wrinkle import figure_names
from support.example_scene import BLOCKS, EXAMPLE
from support.io_samples import box

ROOT = Path(__file__).parents[3]
FIGURES = ", ".join(figure_names())


def test_documented_example(load, folder):
    scene = load()
    assert scene.name == "cushion, suede insert"
    assert scene.path == folder / "scene.toml"
    assert [p.name for p in scene.pattern.panels] == ["CENTER", "BOLSTER_R", "BOLSTER_L", "FRONT"]
    assert scene.materials["CENTER"].name == "suede-laminate"
    assert scene.materials["FRONT"].name == "leather-laminate"
    assert scene.materials["FRONT"] is scene.materials["BOLSTER_L"]
    assert scene.pattern.panel("CENTER").grain == pytest.approx([0.0, 1.0])
    assert scene.element_size == pytest.approx(0.006)
    assert scene.smallest_notch == pytest.approx(0.005)
    assert scene.foam.material.name == "foam-seat"
    assert set(scene.foam.curves) == {"wire left", "wire across", "frame front"}
    front = scene.placement["FRONT"]
    assert (front.rotation @ [0, 0, 1]).tolist() == [0.0, -1.0, 0.0]
    assert front.translation == pytest.approx([-0.26, -0.26, -0.02])
    assert [(s.name, s.start, s.end) for s in scene.stages][1] == ("hook", 0.2, 0.4)
    assert scene.hooks[1].line == "CENTER/line1"
    assert scene.frames[0].edges == ("FRONT.bottom",)
    assert [r.name for r in scene.rigs] == ["sun", "bulb right"]
    assert scene.rigs[0].lights[0].intensity == 97_000
    assert scene.rigs[1].lights[0].vector.tolist() == [-0.4, -0.3, 0.9]
    assert scene.rigs[1].ev100 == 2.5
    assert [c.name for c in scene.cameras] == ["front_34", "top", "seam close up"]
    assert scene.cameras[0].target == pytest.approx([0, 0, 0.05])
    assert list(scene.textures) == ["as built", "black-leather", "bright-leather", "suede"]
    assert scene.textures["as built"] is None
    assert scene.boxes[0].high == pytest.approx([0.25, 0.2])
    assert scene.c_threshold == pytest.approx(20.0)
    assert [(x.zone, x.measure, x.maximum) for x in scene.limits] == [
        ("A", "w2_area_share", 0.02),
        ("BOLSTER_R interior", "w2_p95", 1.0),
        ("BOLSTER_R interior", "w_compression_mean", 0.2),
    ]


def test_smallest_scene_takes_the_defaults(load):
    scene = load("""
        schema = 1
        pattern = { file = "cover.dxf", seams = "cover.seams.toml", material = "suede" }
        foam = { file = "foam.obj", unit = "mm", material = "foam-seat" }
        mesh.element_size_mm = 8
        [[stage]]
        name = "sew"
        start_s = 0
        end_s = 1
        [[rig]]
        name = "sky"
        ambient_cd_m2 = 100
        [wrinkle]
        curvature = "paper"
    """)
    assert scene.name == "scene"
    assert scene.c_threshold == 10.0
    assert [c.name for c in scene.cameras] == ["front_34"]
    assert dict(scene.textures) == {"as built": None}
    assert not scene.placement
    assert not scene.foam.curves


def test_example_files_of_the_page_read(folder, load):
    assert len(BLOCKS) == 3
    sample = (folder / "cover.seams.toml").read_text()
    head, seam = BLOCKS[1].split("[[seam]]")
    start = sample.index('[edge."FRONT.top"]')
    stop = sample.index('[edge."FRONT.left"]')
    last = sample.rindex("[[seam]]")
    text = sample[:start] + head + sample[stop:last] + "[[seam]]" + seam
    (folder / "cover.seams.toml").write_text(text)
    wires = "".join(
        f'\n[curve."{n}"]\npoints_mm = [[-150, 0, 80], [150, 0, 80]]\n'
        for n in ("wire across", "frame front")
    )
    (folder / "curves.toml").write_text(BLOCKS[2] + wires)
    write_obj(*box(height=0.08), folder / "foam.obj")
    scene = load()
    assert scene.pattern.seams[-1].name == "front"
    assert scene.foam.curves["wire left"].tolist() == [[0.15, -0.23, 0.06], [0.15, 0.23, 0.06]]


def test_digest_is_of_contents_not_of_paths(load, folder, tmp_path_factory):
    before = load().digest
    elsewhere = tmp_path_factory.mktemp("elsewhere")
    shutil.copytree(folder, elsewhere / "copy")
    assert load_scene(elsewhere / "copy" / "scene.toml").digest == before
    curves = folder / "curves.toml"
    curves.write_text(curves.read_text().replace("0.15", "0.15") + "\n")
    assert load().digest != before


def test_paths_are_seen_from_the_scene(load, folder, monkeypatch):
    load()
    material = folder / "own.toml"
    shutil.copy(ROOT / "materials" / "pvc.toml", material)
    text = EXAMPLE.replace('"suede-laminate"', '"own.toml"')
    (folder / "scene.toml").write_text(text)
    monkeypatch.chdir(folder.parent)
    scene = load_scene(f"{folder.name}/scene.toml")
    assert scene.materials["CENTER"].name == "own"


def test_unknown_key(refused):
    got, line = refused(("element_size_mm", "elementsize_mm"))
    assert got == [
        f"scene.toml:{line('[mesh]')}: mesh.element_size_mm: got nothing, expected a number "
        "(or tolerance_percent, and the mesh follows from the error it may have)",
        f"scene.toml:{line('elementsize_mm')}: mesh.elementsize_mm: got unknown key, expected one "
        "of element_size_mm, tolerance_percent, smallest_notch_mm, seed "
        "(did you mean 'element_size_mm'?)",
    ]


def test_a_tolerance_takes_the_place_of_an_element_size(load, folder):
    load()
    text = EXAMPLE.replace("element_size_mm = 6.0", "tolerance_percent = 5")
    (folder / "scene.toml").write_text(text.replace("element_size_mm = 4.0", ""))
    assert load_scene(folder / "scene.toml").tolerance == pytest.approx(0.05)


def test_a_tolerance_beside_a_size_is_refused(refused):
    got, line = refused(("element_size_mm = 6.0", "element_size_mm = 6.0\ntolerance_percent = 5"))
    assert got == [
        f"scene.toml:{line('tolerance_percent')}: mesh.tolerance_percent: got element_size_mm as "
        "well, expected one of them (delete one: with a tolerance the mesh follows from the error "
        "it may have)",
        f"scene.toml:{line('element_size_mm = 4.0')}: panel.CENTER.element_size_mm: got a size, "
        "expected none beside mesh.tolerance_percent (delete it: the mesh follows from the "
        "tolerance)",
    ]


@pytest.mark.parametrize("percent", ["0", "0.5", "80", "-5"])
def test_a_tolerance_out_of_bounds_is_refused(refused, percent):
    got, line = refused(
        ("element_size_mm = 6.0", f"tolerance_percent = {percent}"),
        ("element_size_mm = 4.0", ""),
    )
    assert got == [
        f"scene.toml:{line('tolerance_percent')}: mesh.tolerance_percent: got {percent}, "
        "expected 1 to 50"
    ]


def test_wrong_type(refused):
    got, line = refused(("seed = 0 ", 'seed = "x" '))
    assert got == [f"scene.toml:{line('seed')}: mesh.seed: got 'x', expected a whole number"]


def test_missing_scene(tmp_path, problems):
    assert problems(load_scene, tmp_path / "none.toml") == [
        "none.toml: file: got no such file, expected a file"
    ]


@pytest.mark.parametrize(
    ("old", "new", "key"),
    [
        ('"cover.dxf"', '"caver.dxf"', "pattern.file"),
        ('"cover.seams.toml"', '"caver.dxf"', "pattern.seams"),
        ('"foam.obj"', '"caver.dxf"', "foam.file"),
        ('"curves.toml"', '"caver.dxf"', "foam.curves"),
        ('"suede-laminate"', '"caver.toml"', "panel.CENTER.material"),
    ],
)
def test_missing_file(refused, folder, old, new, key):
    got, _ = refused((old, new))
    name = new.strip('"')
    assert len(got) == 1
    assert re.fullmatch(
        rf"scene\.toml:\d+: {key}: got '{name}', expected a file \(there is none at .*{name}\)",
        got[0],
    )


def test_hook_without_wire(refused):
    got, line = refused(('wire = "wire left"\n', ""))
    assert got == [f"scene.toml:{line('[[hook]]')}: hook[0].wire: got nothing, expected a text"]
    got, line = refused(('wire = "wire left"', 'wire = "wire lft"'))
    assert got == [
        f"scene.toml:{line('wire = ')}: hook[0].wire: got 'wire lft', expected one of wire left, "
        "wire across, frame front (did you mean 'wire left'?)"
    ]


def test_hook_without_any_curve(refused):
    got, line = refused(('curves = "curves.toml"', ""))
    assert got[0] == (
        f"scene.toml:{line('wire = ')}: hook[0].wire: got 'wire left', "
        "expected a curve of the foam; there are none"
    )


def test_names_that_do_not_exist_are_reported_together(refused):
    got, _ = refused(
        ('line = "left bolster"', 'line = "left bolstr"'),
        ('stage = "cover"', 'stage = "covr"'),
        ('edges = ["FRONT.bottom"]', 'edges = ["FRONT.bottm"]'),
        ("[panel.CENTER]", "[panel.CENTRE]"),
        ("[placement.FRONT]", "[placement.FRNT]"),
        ('"black-leather"', '"black-lether"'),
        ('[accept."BOLSTER_R interior"]', '[accept."BOLSTER_R inside"]'),
        ('panel = "CENTER"', 'panel = "CENTR"'),
        ('views = ["front_34", "top"]', 'views = ["front_35", "top"]'),
        ('kind = "sun"', 'kind = "son"'),
    )
    hints = {
        "panel.CENTRE": "'CENTER'",
        "placement.FRNT": "'FRONT'",
        "hook[0].line": "'left bolster'",
        "frame[0].edges": "'FRONT.bottom'",
        "frame[0].stage": "'cover'",
        "rig[0].light[0].kind": "'sun'",
        "camera.views": "'front_34'",
        "gallery.textures": "'black-leather'",
        "zones.box[0].panel": "'CENTER'",
        "accept.BOLSTER_R inside": "'BOLSTER_R interior'",
    }
    assert [g.split(": ")[1] for g in got] == list(hints)
    for message, hint in zip(got, hints.values(), strict=True):
        assert message.endswith(f"(did you mean {hint}?)")
        assert re.match(r"scene\.toml:\d+: ", message)


def test_problems_of_several_files_are_reported_together(refused, folder):
    seams = folder / "cover.seams.toml"
    seams.write_text(seams.read_text().replace('["BOLSTER_R.inner"]', '["BOLSTER_R.iner"]', 1))
    curves = folder / "curves.toml"
    curves.write_text(curves.read_text().replace("points_mm", "point_mm", 1))
    got, _ = refused(("elevation_deg = 70.0", "elevation_deg = 170.0"))
    assert [g.split(":")[0] for g in got] == [
        "cover.seams.toml", "curves.toml", "curves.toml", "scene.toml",
    ]  # fmt: skip
    assert "got 'BOLSTER_R.iner', expected" in got[0]
    assert "rig[0].light[0].sun.elevation_deg: got 170.0, expected -90 to 90" in got[3]


def test_problem_of_a_material_is_named_once(refused, folder):
    text = (ROOT / "materials" / "pvc.toml").read_text()
    (folder / "own.toml").write_text(text.replace("[0.03, 0.03, 0.03]", "[0.03, 1.03, 0.03]"))
    got, _ = refused(('material = "leather-laminate"', 'material = "own.toml"'))
    assert len(got) == 1
    assert re.fullmatch(
        r"own\.toml:\d+: appearance\.albedo: got .*, expected numbers from 0 to 1", got[0]
    )


def test_dxf_without_units(refused, folder):
    dxf = folder / "cover.dxf"
    dxf.write_text(dxf.read_text().replace("Units: METRIC", "no unit"))
    with pytest.warns(InputWarning, match="names no unit: read in mm, as its longest line is 544"):
        got, _ = refused(("seed = 0", "seed = -1"))
    assert len(got) == 1


def test_panel_without_material(refused):
    got, _ = refused(('material = "leather-laminate"', ""))
    assert got == [
        f"scene.toml: panel.{name}.material: got nothing, expected a material, here or in [pattern]"
        for name in ("BOLSTER_R", "BOLSTER_L", "FRONT")
    ]


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ('axes = ["+x", "+z"]', 'axes = ["+x", "-x"]',
         "placement.FRONT.axes: got ['+x', '-x'], expected two different axes out of +x, -x, +y, "
         "-y, +z, -z"),
        ('axes = ["+x", "+z"]\n', "",
         "placement.FRONT: got neither, expected one of axes and rotation"),
        ('axes = ["+x", "+z"]', "rotation = [[1, 0, 0], [0, 1, 0], [0, 0, -1]]",
         "placement.FRONT.Pose.rotation: got [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]],"
         " expected a proper rotation matrix"),
        ("end_s = 0.4", "end_s = 0.1",
         "stage[1].stage hook: got start 0.2, end 0.1, expected 0 <= start < end"),
        ("high_mm = [250.0, 200.0]", "high_mm = [250.0, 20.0]",
         "zones.box[0].high_mm: got [250.0, 20.0], expected above low_mm, [50.0, 50.0]"),
        ("ev100 = 2.5 ", "ev100 = 99 ", "rig[1].ev100: got 99, expected -10 to 30"),
        ("lumen = 800.0", "lumens = 800.0",
         "rig[1].light[0].lumens: got unknown key, expected one of kind, lumen, position_mm, "
         "radius_mm, temperature_k, name (did you mean 'lumen'?)"),
        ("lumen = 800.0", "temperature_k = 800.0",
         "rig[1].light[0].temperature_k: got 800.0, expected 1667 to 25000"),
        ("lumen = 800.0", "lumen = 0",
         "rig[1].light[0].Light.intensity: got 0.0, expected a number above 0"),
        ("ambient_cd_m2 = 3000.0\n\n[[rig.light]]\nkind = \"sun\"\nelevation_deg = 70.0\n"
         "azimuth_deg = 30.0", "", "rig[0].rig sun: got no light, expected a light or sky"),
        ("vertical_fov_deg = 12.0", "up = [-150.0, 500.0, -400.0]",
         "camera.custom[0].up: got [-150.0, 500.0, -400.0], expected a direction across the line "
         "of sight"),
        ("w2_p95 = 1.0", "w2_max = 1.0",
         f"accept.BOLSTER_R interior.w2_max: got unknown key, expected one of {FIGURES}, "
         "vwi, equivalent_height_mm (did you mean 'w2_mean'?)"),
        ("schema = 1", "schema = 2", "schema: got 2, expected 1 to 1"),
    ],
)  # fmt: skip
def test_bad_values(refused, old, new, message):
    got, _ = refused((old, new))
    assert [re.sub(r"^scene\.toml:\d+: ", "", g) for g in got] == [message]


def test_limits_name_figures_of_the_zone_table():
    limits = {"w2_mean", "w2_p95", "w2_area_share", "w2_net_mean", "excess_strain_percent_mean"}
    assert limits <= set(figure_names()) <= set(scene_keys()["accept"].table.keys)
