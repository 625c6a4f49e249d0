"""Each recipe of CONTRIBUTING is followed, and the new thing is found where the recipe says.

What is a file or a line is added to a copy of the source; what needs compiled kernels is added to
the running program, since a copy would compile them anew.
"""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
import tomllib
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from scipy.sparse import csc_array

from seatlook import io, model
from seatlook.errors import InputError
from seatlook.solver import (
    Load,
    Sheet,
    SheetSettings,
    SolverSettings,
    Support,
    solve,
    solve_sheet,
)
from seatlook.solver.element.elastic import ElasticSheet
from seatlook.solver.methods import choice
from seatlook.solver.methods.lbfgs import Lbfgs
from support import fabrics, io_samples, meshes
from support.covers import cover, flat_foam, sheet
from support.scene_files import TEXT, write_two_panels

ROOT = Path(__file__).parents[1]
CONTRIBUTING = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
TABLE = re.findall(r"^\| ([a-z ]+) \| (.*) \| (.*) \|$", CONTRIBUTING, re.M)[1:]


def test_every_recipe_has_a_test_and_every_test_a_recipe():
    tested = {name.removeprefix("test_recipe_") for name in globals() if "test_recipe" in name}
    of_table = {name.replace(" ", "_") for name, _, _ in TABLE}
    assert of_table == tested


def test_the_order_of_the_rooms_is_that_of_the_contract():
    settings = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))
    (contract,) = (
        c
        for c in settings["tool"]["importlinter"]["contracts"]
        if c.get("containers") == ["seatlook"]
    )
    (block,) = re.findall(r"^ {6}(cli > .*(?:\n {6}.*)*)", CONTRIBUTING, re.M)
    assert " ".join(block.split()) == " > ".join(contract["layers"][1:])


@dataclass(frozen=True)
class Clone:
    """A copy of the source and the materials, to be changed and run."""

    folder: Path

    def insert(self, file: str, before: str, line: str) -> None:
        """Add ``line`` before the one place where ``before`` stands in a file of the package."""
        path = self.folder / "src" / "seatlook" / file
        text = path.read_text(encoding="utf-8")
        assert text.count(before) == 1, f"{file}: {before}"
        path.write_text(text.replace(before, line + before), encoding="utf-8")

    def write(self, file: str, text: str) -> None:
        """Add a file to the copy."""
        path = self.folder / file
        assert not path.exists()
        path.write_text(text, encoding="utf-8")

    def run(self, *words: str) -> str:
        """Run the copy's Python with some arguments and return what it prints."""
        done = subprocess.run(
            [sys.executable, *words],
            cwd=self.folder,
            capture_output=True,
            text=True,
            check=False,
            env={**os.environ, "PYTHONPATH": str(self.folder / "src")},
        )
        assert done.returncode == 0, done.stdout + done.stderr
        return done.stdout

    def scene(self, *changes: tuple[str, str]) -> Path:
        """Write the scene of two panels with some text replaced; return its path."""
        text = TEXT
        for old, new in changes:
            assert old in text
            text = text.replace(old, new, 1)
        folder = self.folder / "scene"
        folder.mkdir()
        return write_two_panels(folder, text=text)

    def load(self, scene: Path, expression: str) -> str:
        """Load a scene by the copy and return the value of an expression of ``scene``."""
        code = f"from seatlook import load_scene; scene = load_scene({str(scene)!r})"
        return self.run("-c", f"{code}; print({expression})").strip()


@pytest.fixture
def clone(tmp_path: Path) -> Clone:
    ignored = shutil.ignore_patterns("__pycache__")
    shutil.copytree(ROOT / "src", tmp_path / "src", ignore=ignored)
    shutil.copytree(ROOT / "materials", tmp_path / "materials")
    return Clone(tmp_path)


def test_recipe_material(clone):
    text = (ROOT / "materials" / "pvc.toml").read_text(encoding="utf-8")
    clone.write("materials/linen.toml", text.replace("thickness_mm = 1.1", "thickness_mm = 0.7", 1))
    assert re.search(
        r"^linen +cover +0\.7 ", clone.run("-m", "seatlook", "materials", "list"), re.M
    )
    scene = clone.scene(('material = "pvc"', 'material = "linen"'))
    found = clone.load(scene, "[m.fabric.thickness for m in scene.materials.values()]")
    assert found == "[0.0007, 0.0007]"


def test_recipe_light(clone):
    clone.insert(
        "model/light/lamps.py",
        "LIGHTS: dict",
        "def torch(*, candela: float, place_mm: tuple[float, float, float]) -> Light:\n"
        "    vector = np.asarray(place_mm) / 1e3\n"
        '    return Light(name="torch", intensity=candela, vector=vector, near=True)\n\n\n',
    )
    clone.insert("model/light/lamps.py", '"sun": sun', '"torch": torch, ')
    light = '[[rig.light]]\nkind = "torch"\ncandela = 7.0\nplace_mm = [1, 2, 3]\n\n'
    scene = clone.scene(("[[rig.light]]", light + "[[rig.light]]"))
    found = clone.load(
        scene, "[(v.name, v.intensity, v.vector[2]) for v in scene.rigs[0].lights][0]"
    )
    assert found == "('torch', 7.0, np.float64(0.003))"


def test_recipe_view(clone):
    clone.insert(
        "model/light/camera.py", '"driver_door": (75', '"rear_45": (150.0, 40.0, 1.9),\n        '
    )
    scene = clone.scene(('views = ["top"]', 'views = ["rear_45"]'))
    found = clone.load(scene, "scene.cameras[0].name, scene.cameras[0].position[1] > 0")
    assert found == "rear_45 True"


class Gather:
    """Springs [N/m] from every vertex to the mean of all: a small term without a resultant."""

    def __init__(self, stiffness: float) -> None:
        self.k = stiffness

    def value(self, x, gradient):
        away = x - x.mean(axis=0)
        gradient += self.k * away
        return 0.5 * self.k * float((away**2).sum())

    def stiffness(self):
        return None

    def hessian(self, x, *, definite=False):
        one = np.eye(len(x)) - 1.0 / len(x)
        return csc_array(self.k * np.kron(one, np.eye(3)))


def test_recipe_energy_term(monkeypatch):
    own = ElasticSheet.energies.fget

    def lengths(stiffness):
        """Extent of a cover on its foam and of a bare strip, with the term added."""
        term = Gather(stiffness)
        monkeypatch.setattr(ElasticSheet, "energies", property(lambda s: (*own(s), term)))
        square = solve(laid(), strict=True).positions
        strip, support, load = hanging()
        tip = solve_sheet(strip, support=support, load=load, strict=True).positions
        return np.array([np.ptp(square[:, 0]), np.ptp(tip[:, 0])])

    free, gathered, more = lengths(0.0), lengths(1.0), lengths(2.0)
    assert (gathered < free - 5e-5).all()
    assert (more < gathered - 5e-5).all()


def laid() -> model.Cover:
    """A square just above level foam."""
    X, T, x = sheet(0.16, 0.16, 0.04, z=0.004, at=(-0.08, -0.08))
    drop = model.Stage(name="drop", start=0.0, end=0.2)
    return cover([(X, T, x)], foam=flat_foam(), stages=[drop], h=0.04)


def hanging() -> tuple[Sheet, Support, Load]:
    """A strip held at one end, under its weight."""
    X, T = meshes.rectangle("uns", 1.0, 0.2, 0.2)
    strip = Sheet(X, T, fabrics.isotropic(1e4, 1.0, density=1.0, thickness=0.02))
    return strip, Support(clamped=X[:, 0] < 1e-9), Load(gravity=(0, 0, -0.2))


def test_recipe_solver_method(monkeypatch):
    calls = []

    class Counting(Lbfgs):
        def minimise(self, *arguments, **options):
            calls.append(1)
            return super().minimise(*arguments, **options)

    with pytest.raises(InputError, match="'lbfgs', 'newton', 'explicit' or Explicit"):
        SolverSettings(method="counting")
    monkeypatch.setitem(choice.MINIMISERS, "counting", Counting)
    square = laid()
    found = solve(square, settings=SolverSettings(method="counting"), strict=True)
    np.testing.assert_array_equal(found.positions, solve(square, strict=True).positions)
    assert (of_cover := len(calls)) > 5
    strip, support, load = hanging()
    solve_sheet(strip, support=support, load=load, settings=SheetSettings(method="counting"))
    assert len(calls) > of_cover


def test_recipe_reader_of_patterns(clone):
    clone.write(
        "src/seatlook/io/pattern/renamed.py",
        "from seatlook.io.pattern.dxf import read_dxf\n\n\n"
        "def read_renamed(path, **options):\n"
        '    return read_dxf(path.with_suffix(".dxf"), **options)\n',
    )
    clone.insert(
        "io/pattern/seams.py",
        "# A new pattern format",
        "from seatlook.io.pattern.renamed import read_renamed\n\n",
    )
    clone.insert("io/pattern/seams.py", '".dxf": read_dxf}', '".cut": read_renamed, ')
    scene = clone.scene(('file = "pattern.dxf"', 'file = "pattern.cut"'))
    (scene.parent / "pattern.cut").write_text("a format of one's own")
    assert clone.load(scene, "[p.name for p in scene.pattern.panels]") == "['LEFT', 'RIGHT']"


def test_recipe_reader_of_foams(clone):
    clone.write(
        "src/seatlook/io/renamed.py",
        "import trimesh\n\n\ndef load_renamed(path):\n"
        '    return trimesh.load_mesh(path.with_suffix(".obj"), process=False)\n',
    )
    clone.insert(
        "io/surface/formats.py",
        "\n\ndef _refusal",
        '\nfrom seatlook.io.renamed import load_renamed\n\nREADERS[".block"] = load_renamed\n',
    )
    scene = clone.scene(('file = "foam.obj"', 'file = "foam.block"'))
    (scene.parent / "foam.block").write_text("a format of one's own")
    assert int(clone.load(scene, "len(scene.foam.faces)")) > 3


def test_recipe_export(clone):
    clone.write(
        "src/seatlook/io/export/count.py",
        "def write_count(solution, fields, path):\n"
        "    faces = len(fields[0].values)\n"
        '    path.write_text(f"{faces} faces of {len(solution.positions)} vertices")\n',
    )
    clone.insert(
        "io/export/writers.py",
        "# A new export",
        "from seatlook.io.export.count import write_count\n\n",
    )
    clone.insert("io/export/writers.py", '".vtp": write_vtp', '".count": write_count,\n    ')
    solved = io_samples.solution()
    io.write_result(solved, clone.folder / "seat.npz")
    clone.run("-m", "seatlook", "wrinkle", "seat.npz", "--preview", "--export", "seat.count")
    faces, vertices = len(solved.cover.faces), len(solved.positions)
    text = (clone.folder / "seat.count").read_text()
    assert text == f"{faces} faces of {vertices} vertices"


def test_recipe_wrinkle_index_or_measure(clone):
    clone.write(
        "src/seatlook/wrinkle/steepness.py",
        "import numpy as np\n"
        "def steepness(surface):\n"
        "    p = surface.solution.positions[surface.solution.cover.faces]\n"
        "    n = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])\n"
        "    return 1.0 - np.abs(n[:, 2]) / np.linalg.norm(n, axis=1)\n",
    )
    entry = (
        '    Index(name="steepness", symbol="Steepness", unit="1", limits=(0.0, 1.0),\n'
        '          meaning="0 level, 1 upright", of=steepness),\n'
    )
    clone.insert("wrinkle/registry.py", ")\nINDICES: dict", entry)
    line = "from seatlook.wrinkle.steepness import steepness\n"
    clone.insert("wrinkle/registry.py", "from seatlook.wrinkle.surface import Surface", line)
    io.write_result(io_samples.solution(), clone.folder / "seat.npz")
    words = ["seatlook", "wrinkle", "seat.npz", "--preview", "--export", "seat.csv", "--json"]
    zones = json.loads(clone.run("-m", *words))["zones"]
    assert all(0.0 <= zone["steepness_mean"] <= 1.0 for zone in zones)
    assert "_STEEPNESS" in (clone.folder / "seat.csv").read_text()


def test_recipe_render_quality(clone):
    line = '    "T5": Quality(factor=5, rays=4, strata=16, relief=8, bounces=3, error=0.0100),\n'
    clone.insert("pbr/quality.py", "}\nQUALITIES: dict", line)
    found = clone.run(
        "-c",
        "from seatlook.pbr.quality import quality_named, quality_within\n"
        "found = quality_named('T5'), quality_within(0.015), quality_within(0.02)\n"
        "print(*[quality.factor for quality in found])",
    )
    assert found == "5 5 4\n"


def test_recipe_command(clone):
    clone.write(
        "src/seatlook/cli/_greet.py",
        "def greet(name: str) -> None:\n"
        '    """Greet somebody.\n\n    Example: seatlook greet Anna\n    """\n'
        '    print("hello,", name)\n',
    )
    clone.insert("cli/__init__.py", "app.command(_demo.demo)", "app.command(_greet.greet)\n")
    clone.insert("cli/__init__.py", "    _init,\n", "    _greet,\n")
    assert re.search(r"^.*greet +Greet somebody", clone.run("-m", "seatlook", "--help"), re.M)
    assert clone.run("-m", "seatlook", "greet", "Anna") == "hello, Anna\n"
