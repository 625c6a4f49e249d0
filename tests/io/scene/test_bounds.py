"""Numbers and names that no seat has are refused where they are read, with their line."""

import json

import numpy as np
import pytest

from seatlook.io.export.result import read_result, write_result
from seatlook.io.npz import read_npz, write_npz
from seatlook.io.scene.read import load_scene
from support.io_samples import solution
from support.scene_files import TEXT, write_two_panels


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("lumen = 800.0", "lumen = 1e308", "Light.intensity: got 7.957747154594768e+306"),
        ("position_mm = [300.0,", "position_mm = [1e300,", "Light.vector: got 1e+297"),
        ("end_s = 0.4", "end_s = 1e308", "stage[0].end_s: got 1e+308"),
        (
            "start_s = 0.2\nend_s = 0.6",
            "start_s = 0.2\nend_s = 0.20000001",
            "stage[1].stage cover: got start 0.2, end 0.20000001",
        ),
        ("ev100 = 5.0", "ev100 = 1e6", "rig[1].ev100: got 1000000.0"),
        ('textures = ["pvc", "suede"]', 'textures = ["pvc", "pvc"]', "gallery.textures: got 'pvc'"),
        (
            'textures = ["pvc", "suede"]',
            'surroundings = "sweeps"',
            "gallery.surroundings: got 'sweeps'",
        ),
        ("element_size_mm = 20.0", "element_size_mm = 1e-9", "mesh.element_size_mm: got 1e-09"),
        (
            "[camera]",
            "[wrinkle]\nc_threshold_per_mm = 1e-320\n[camera]",
            "wrinkle.c_threshold_per_mm: got 1e-320",
        ),
        ("[102.0, 0.0, 5.0]", "[1e308, 0.0, 5.0]", "placement.RIGHT.translation_mm: got [1e+308"),
        ("[camera]", "[thread]\npitch_mm = 1e-300\n[camera]", "thread.pitch_mm: got 1e-300"),
    ],
)
def test_numbers_that_cannot_be(tmp_path, problems, old, new, message):
    assert old in TEXT
    path = write_two_panels(tmp_path, text=TEXT.replace(old, new, 1))
    (got,) = problems(load_scene, path)
    place, _, said = got.partition(": ")
    assert place.startswith("scene.toml:")
    assert message in said


@pytest.mark.parametrize("name", ["free edge", "seam middle", "LEFT interior", "A"])
def test_a_box_called_like_a_zone_that_there_is(tmp_path, problems, name):
    box = f'[[zones.box]]\nname = "{name}"\npanel = "LEFT"\nlow_mm = [0, 0]\nhigh_mm = [9, 9]\n'
    (got,) = problems(load_scene, write_two_panels(tmp_path, text=TEXT + box))
    assert f"zones.box[0].name: got '{name}', expected a name of its own" in got


def changed(path, *, meta=None, **arrays):
    """Write a result whose arrays, or whose tree, are others."""
    write_result(solution(), path)
    content = read_npz(path, expected="arrays") | arrays
    tree = json.loads(str(content["meta"]))
    if meta is not None:
        meta(tree["solution"])
    write_npz(content | {"meta": np.array(json.dumps(tree))}, path)
    return path


FACES = np.array([[0, 1, 2], [0, 2, 3], [4, 5, 6]])


@pytest.mark.parametrize(
    ("arrays", "message"),
    [
        ({"cover.faces": -FACES}, "Cover.faces: got index range"),
        ({"cover.faces": FACES + 0.5}, "Cover.faces: got fractions"),
        ({"cover.faces": FACES[:0]}, "Cover.faces: got none"),
        ({"cover.panel": np.array([0, 0, 2])}, "Cover.panel: got index range"),
        ({"cover.stitchings.0.a.vertices": np.array([[0, 99], [1, 2]])}, "seam s: got vertex 99"),
        ({"cover.stitchings.0.a.vertices": np.array([[0, -1], [1, 2]])}, "Points.vertices: got"),
        ({"strain_top": np.full((3, 2, 2), 1e300)}, "Solution.strain_top: got 1e+300"),
        ({"positions": np.full((7, 3), 1e200)}, "Solution.positions: got 1e+200"),
        ({"cover.rest": np.full((7, 2), np.nan)}, "Cover.rest: got 14 nan or inf"),
    ],
)
def test_arrays_of_results_that_cannot_be(tmp_path, problems, arrays, message):
    (got,) = problems(read_result, changed(tmp_path / "r.npz", **arrays))
    assert got.startswith(f"r.npz: {message}")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda tree: tree.update(status="fine"), "Solution.status: got 'fine'"),
        (lambda tree: tree.update(reason=3), "Solution.reason: got 3"),
        (lambda tree: tree["cover"].update(seed="x"), "Cover.seed: got 'x'"),
        (
            lambda tree: tree["cover"].update(panel_names=["a", 3]),
            "Cover.panel_names: got ('a', 3)",
        ),
        (lambda tree: tree["cover"].update(element_size=True), "Cover.element_size: got true"),
        (lambda tree: tree["cover"].update(foam={"map": {}}), "Cover.foam: got mappingproxy({})"),
    ],
)
def test_values_of_results_of_another_type(tmp_path, problems, change, message):
    (got,) = problems(read_result, changed(tmp_path / "r.npz", meta=change))
    assert got.startswith(f"r.npz: {message}")
