"""The README's example and commands are run as they stand."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from seatlook.cli import app

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")


@pytest.mark.render
def test_the_example_runs(demo_scene, tmp_path):
    (example,) = re.findall(r"```python\n(.*?)```", README, re.S)
    assert len([line for line in example.splitlines() if line]) <= 14
    shutil.copytree(demo_scene.parent, tmp_path / "out" / "demo")
    scene = tmp_path / "out" / "demo" / "scene.toml"
    scene.write_text(scene.read_text().replace("[camera]", "[camera]\nsize = [96, 54]"))
    done = subprocess.run(
        [sys.executable, "-c", example], cwd=tmp_path, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert re.fullmatch(r"W2 is above 1 on \d+\.\d% of the elements\n", done.stdout)
    assert (tmp_path / "seat.png").read_bytes().startswith(b"\x89PNG")


def test_every_command_and_target_it_names_exists():
    commands = set(re.findall(r"(?:bin/|`)seatlook ([a-z]+)", README))
    assert commands <= {name for name in app if not name.startswith("-")}
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    for target in re.findall(r"^    make (\w+)", README, re.M):
        assert re.search(rf"^{target}:", makefile, re.M)


@pytest.mark.parametrize(
    "page",
    [
        "README.md",
        "CONTRIBUTING.md",
        *(f"docs/{p.name}" for p in sorted((ROOT / "docs").glob("*.md"))),
    ],
)
def test_links_lead_to_files(page):
    text = (ROOT / page).read_text(encoding="utf-8")
    for target in re.findall(r"\]\(([^)#]+?)(?:#[^)]*)?\)", text):
        if not target.startswith("https:"):
            assert (ROOT / page).parent.joinpath(target).exists(), target


def test_the_functions_of_the_equations_exist():
    text = (ROOT / "docs/equations.md").read_text(encoding="utf-8")
    names = set(re.findall(r"`(seatlook\.[a-z_.]+)`", text))
    assert len(names) >= 8
    code = "import pkgutil\n" + "\n".join(f"pkgutil.resolve_name('{n}')" for n in sorted(names))
    subprocess.run([sys.executable, "-c", code], check=True, env=os.environ)
