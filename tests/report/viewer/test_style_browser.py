"""The viewer's script keeps its types and its style."""

from __future__ import annotations

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from seatlook.report.viewer import script

pytestmark = pytest.mark.browser

ROOT = Path(__file__).parents[3]
MODULES = Path(script.__file__).with_name("script")
TOOLS = Path(sys.prefix) / "three/node_modules"


def run(folder, *command):
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr


def test_types_are_kept():
    run(ROOT, TOOLS / ".bin/tsc", "--project", ".ci/tsconfig.json")


def test_rules_are_kept(tmp_path):
    shutil.copytree(MODULES, tmp_path / "script")
    shutil.copy(ROOT / ".ci/eslint.config.mjs", tmp_path)
    (tmp_path / "node_modules").symlink_to(TOOLS)
    run(tmp_path, TOOLS / ".bin/eslint", "script")


def test_no_module_is_longer_than_a_file_of_python_may_be():
    lines = {path.name: path.read_text().count("\n") for path in MODULES.rglob("*.js")}
    assert max(lines.values()) <= 400, lines
