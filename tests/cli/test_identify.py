"""The command identify: what it prints, writes and shows."""

from __future__ import annotations

import json

import pytest

from seatlook.cli import run
from seatlook.io import read_material
from support.lab_files import write_tests


@pytest.fixture(scope="module")
def tests(tmp_path_factory):
    return write_tests(tmp_path_factory.mktemp("laboratory"))


def test_numbers_are_in_the_units_of_their_keys(tests, tmp_path, capsys):
    out = tmp_path / "cloth.toml"
    assert run(["identify", str(tests), "--out", str(out), "--json"]) == 0
    found = {one["key"]: one for one in json.loads(capsys.readouterr().out)["findings"]}
    fabric = read_material(out).fabric
    assert found["thickness_mm"]["value"] == pytest.approx([1e3 * fabric.thickness])
    assert found["warp_n_per_m"]["value"] == pytest.approx(fabric.warp.stiffness, rel=1e-6)
    assert found["thickness_mm"]["standard_error"] is None
    assert run(["identify", str(tests), "--out", str(out), "--force"]) == 0
    row = next(
        row for row in capsys.readouterr().out.splitlines() if row.startswith("thickness_mm")
    )
    assert float(row.split()[1]) == pytest.approx(1e3 * fabric.thickness)


def test_the_page_names_the_material_and_its_numbers(tests, tmp_path, capsys):
    out = tmp_path / "cloth.toml"
    assert run(["identify", str(tests), "--out", str(out), "--report", str(tmp_path / "page")]) == 0
    text = (tmp_path / "page/index.html").read_text(encoding="utf-8")
    assert "<h1>cloth, from tests</h1>" in text
    thickness = 1e3 * read_material(out).fabric.thickness
    row = text[text.index("thickness_mm") :].split("</tr>")[0]
    assert f">{thickness:.4g}<" in row
    assert text.count("<figure>") == 3  # not of what a table alone tells
    capsys.readouterr()
