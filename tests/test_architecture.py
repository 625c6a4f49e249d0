"""What keeps the house in order: import contract, light start, public names, sizes, packaging."""

from __future__ import annotations

import ast
import importlib
import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]
SOURCES = sorted((ROOT / "src" / "seatlook").rglob("*.py"))
HEAVY = ("numba", "scipy", "vtk", "vtkmodules", "pyvista", "trimesh")


def python(code: str, **environment: str) -> str:
    """Run code in a fresh interpreter and return what it printed."""
    done = subprocess.run(
        [sys.executable, "-c", code],
        capture_output=True,
        text=True,
        check=True,
        env={**os.environ, **environment},
    )
    return done.stdout.strip()


def test_import_contract():
    done = subprocess.run(
        [Path(sys.executable).with_name("lint-imports")], capture_output=True, text=True, cwd=ROOT
    )
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize(
    "code",
    [
        "import seatlook; seatlook.__all__",
        "from seatlook.cli import run; assert run(['--help']) == 0",
        "from seatlook.cli import run; assert run(['demo', '--help']) == 0",
        "from seatlook.cli import run; assert run(['evaluate', '--help']) == 0",
    ],
)
def test_nothing_heavy_is_loaded_before_it_is_needed(code):
    loaded = python(f"{code}\nimport sys\nprint('loaded:', *sorted(sys.modules))")
    names = loaded.rpartition("loaded:")[2].split()
    assert "seatlook" in names
    assert not set(HEAVY) & set(names)


def test_public_names_exist_and_are_told_once():
    package = importlib.import_module("seatlook")
    assert len(package.__all__) == len(set(package.__all__)) <= 25
    for name in package.__all__:
        assert getattr(package, name).__doc__, name
    with pytest.raises(AttributeError, match="has no attribute 'rendr'"):
        _ = package.rendr


@pytest.mark.parametrize("path", SOURCES, ids=lambda p: str(p.relative_to(ROOT / "src")))
def test_files_and_functions_stay_small(path):
    text = path.read_text(encoding="utf-8")
    assert len(text.splitlines()) <= 400
    limit = 80 if "kernels" in path.parts else 40
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, ast.FunctionDef):
            assert _code_lines(node) <= limit, f"{path.name}:{node.lineno} {node.name}"


def _code_lines(function: ast.FunctionDef) -> int:
    """Lines from the first statement after the docstring to the last."""
    documented = ast.get_docstring(function) is not None
    body = function.body[1:] if documented else function.body
    return (body[-1].end_lineno or 0) - body[0].lineno + 1 if body else 0


def test_an_editable_install_finds_the_materials_of_the_repository():
    found = python("from seatlook.io import materials_dir; print(materials_dir())")
    assert Path(found) == ROOT / "materials"


@pytest.fixture(scope="module")
def installed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Build a wheel and unpack it where nothing of the repository is near."""
    folder = tmp_path_factory.mktemp("wheel")
    pip = [sys.executable, "-m", "pip", "--disable-pip-version-check", "--quiet"]
    build = [*pip, "wheel", str(ROOT), "--no-deps", "--no-build-isolation", "-w", str(folder)]
    subprocess.run(build, check=True)
    (wheel,) = folder.glob("*.whl")
    target = folder / "site"
    subprocess.run([*pip, "install", "--no-deps", "--target", str(target), str(wheel)], check=True)
    return target


def test_a_wheel_carries_materials_and_templates(installed):
    code = (
        "from seatlook.io import list_materials, materials_dir\n"
        "from seatlook.io import read_material\n"
        "print(materials_dir(), *[read_material(n).name for n in list_materials()])"
    )
    folder, *names = python(code, PYTHONPATH=str(installed)).split()
    assert Path(folder) == installed / "seatlook" / "materials"
    assert sorted(names) == sorted(
        p.stem for p in (ROOT / "materials").glob("*.toml") if "[fabric]" in p.read_text()
    )
    shipped = {p.name for p in (installed / "seatlook/report/templates").iterdir()}
    assert {"page.html.j2", "page.css", "page.js"} <= shipped


def test_a_wheel_carries_every_file_of_the_source(installed):
    source = ROOT / "src"
    wanted = {
        p.relative_to(source)
        for p in source.rglob("*")
        if p.is_file() and "__pycache__" not in p.parts and p.suffix not in (".nbi", ".nbc")
    }
    assert {p for p in wanted if not (installed / p).is_file()} == set()
