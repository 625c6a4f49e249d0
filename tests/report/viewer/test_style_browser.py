"""The scripts of viewer and studio keep their types and their style."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from seatlook.report.viewer import script

pytestmark = pytest.mark.browser

ROOT = Path(__file__).parents[3]
MODULES = [
    Path(script.__file__).with_name("script"),
    ROOT / "src/seatlook/studio/page/script",
]
TOOLS = Path(sys.prefix) / "three/node_modules"


def run(folder, *command):
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_types_are_kept():
    run(ROOT, TOOLS / ".bin/tsc", "--project", ".ci/tsconfig.json")


@pytest.mark.parametrize("modules", MODULES, ids=["viewer", "studio"])
def test_rules_are_kept(tmp_path, modules):
    shutil.copytree(modules, tmp_path / "script")
    shutil.copy(ROOT / ".ci/eslint.config.mjs", tmp_path)
    (tmp_path / "node_modules").symlink_to(TOOLS)
    run(tmp_path, TOOLS / ".bin/eslint", "script")


def test_no_module_is_longer_than_a_file_of_python_may_be():
    lines = {
        path: path.read_text().count("\n") for modules in MODULES for path in modules.rglob("*.js")
    }
    assert max(lines.values()) <= 400, lines
