"""The library is typed for its users: wrong calls are errors, and no public name is Any."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

import seatlook
from seatlook import io, mesh, pbr

ROOT = Path(__file__).parents[1]
WRONG = {
    "seatlook.assemble(3)": 'Argument 1 to "assemble" has incompatible type "int"',
    'io.write_result(42, None, "x")': "Too many arguments",
    'io.write_result(42, "x.npz")': 'Argument 1 to "write_result" has incompatible type "int"',
    "seatlook.open(1)": 'Argument 1 to "open" has incompatible type "int"',
    'seatlook.open("a.toml").render(rig=7)': 'Argument "rig" to "render" of "Case"',
    'seatlook.demo("out", ese={})': 'Unexpected keyword argument "ese"',
    "seatlook.nothing": 'has no attribute "nothing"',
}


def checked(folder: Path, lines: list[str]) -> str:
    file = folder / "user.py"
    file.write_text("\n".join(["import seatlook", "from seatlook import io, pbr", *lines, ""]))
    # What "make check" knows of the files of the library is taken over: strict there as here.
    words = ["--config-file", str(ROOT / "pyproject.toml"), "--no-pretty", str(file)]
    done = subprocess.run(
        [sys.executable, "-m", "mypy", *words],
        cwd=ROOT, capture_output=True, text=True, check=False,
    )  # fmt: skip
    return done.stdout + done.stderr


@pytest.fixture(scope="module")
def report(tmp_path_factory: pytest.TempPathFactory) -> list[str]:
    names = [f"seatlook.{n}" for n in seatlook.__all__]
    names += [f"io.{n}" for n in io.__all__] + [f"pbr.{n}" for n in pbr.__all__]
    lines = [*WRONG, *(f"reveal_type({name})" for name in names)]
    text = checked(tmp_path_factory.mktemp("typed"), lines)
    return [line for line in text.splitlines() if re.match(r".*user\.py:\d", line)]


@pytest.mark.parametrize("call", WRONG)
def test_a_wrong_call_is_an_error(report, call):
    line = 3 + list(WRONG).index(call)
    said = " ".join(text for text in report if f"user.py:{line}:" in text)
    assert WRONG[call] in said


def test_no_public_name_is_any(report):
    revealed = [text for text in report if "Revealed type is" in text]
    count = len(seatlook.__all__) + len(io.__all__) + len(pbr.__all__)
    assert len(revealed) == count
    loose = [t for t in revealed if re.search(r'Revealed type is "(Any|builtins\.object)"', t)]
    assert loose == []


@pytest.mark.parametrize("package", [seatlook, io, mesh, pbr], ids=lambda p: p.__name__)
def test_the_lazy_door_and_the_typed_one_lead_to_the_same_names(package):
    text = Path(package.__file__).read_text()
    typed = re.findall(
        r"(?m)^ {4}(?:from [\w.]+ import )?.*? as (\w+),?$", text.partition("\n# name")[0]
    )
    assert sorted(typed) == sorted(package._PUBLIC) == sorted(package.__all__)


def test_the_marker_is_shipped():
    assert (ROOT / "src/seatlook/py.typed").read_text() == ""
