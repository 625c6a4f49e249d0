"""What keeps the house in order: import contract, light start, public names, sizes, packaging."""

from __future__ import annotations

import importlib
import os
import subprocess
import sys
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from cyclopts import App

from seatlook.cli import app
from support.source import circles, functions, import_graph

ROOT = Path(__file__).parents[1]
PACKAGE = ROOT / "src" / "seatlook"
SOURCES = sorted(PACKAGE.rglob("*.py"))
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
    assert len(package.__all__) == len(set(package.__all__)) <= 40
    for name in package.__all__:
        assert getattr(package, name).__doc__, name
    with pytest.raises(AttributeError, match="has no attribute 'rendr'"):
        _ = package.rendr


def test_no_room_has_the_name_of_a_public_name():
    """A package and a function of one name hide each other, by what is imported first."""
    rooms = {path.stem for path in (ROOT / "src" / "seatlook").iterdir()}
    assert not rooms & {*importlib.import_module("seatlook").__all__}


def test_no_import_goes_in_a_circle():
    """Imports inside functions and imports for types count as well."""
    assert circles(import_graph(PACKAGE)) == []


def test_a_circle_is_found_where_there_is_one(tmp_path):
    room = tmp_path / "house" / "room"
    room.mkdir(parents=True)
    for folder in (room, room.parent):
        (folder / "__init__.py").write_text("")
    lazy = "def f():\n    from house.room import b\n"
    typed = "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    import house.c\n"
    (room / "a.py").write_text(lazy)
    (room / "b.py").write_text(typed)
    (room.parent / "c.py").write_text("from house.room.a import f\nimport json\n")
    (room.parent / "d.py").write_text("from house import c\n")
    assert circles(import_graph(room.parent)) == [["house.c", "house.room.a", "house.room.b"]]


def test_no_folder_is_a_heap():
    count = Counter(path.parent for path in SOURCES if path.name != "__init__.py")
    heaps = {
        str(folder.relative_to(PACKAGE)): number
        for folder, number in count.items()
        if number > 15 and folder.name not in ("cli", "kernels")
    }
    assert heaps == {}


def test_files_stay_short():
    lines = {p.relative_to(PACKAGE): len(p.read_text("utf-8").splitlines()) for p in SOURCES}
    assert {path: count for path, count in lines.items() if count >= 400} == {}


def test_functions_stay_short_with_few_parameters():
    """Kernels may be longer and take many arrays, commands take an option for each parameter."""
    commands = {f"{c.__module__}.{c.__name__}" for c in _commands(app)}
    kernels, others = [], []
    for function in functions(PACKAGE):
        (kernels if ".kernels." in function.module else others).append(function)
    long = [f for f in kernels if f.lines > 80] + [f for f in others if f.lines > 40]
    wide = {f"{f.module}.{f.name}" for f in others if f.parameters >= 8} - commands
    assert long == []
    assert wide == set()


def _commands(group: App) -> Iterator[Callable[..., Any]]:
    for name in group:
        if not name.startswith("-"):
            command = group[name]
            if command.default_command is not None:
                yield command.default_command
            yield from _commands(command)


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
