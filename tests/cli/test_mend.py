"""From a file of any program to a foam, in one command."""

import json
from pathlib import Path

import numpy as np
import pytest
import trimesh

from seatlook import io
from seatlook.cli import run
from support.rough_surfaces import scan, volume, whole_seat

SEATS = Path(__file__).parents[3] / "shared/data/fetched/seats"


def mend(capsys, *words):
    assert run(["mend", *map(str, words), "--json"]) == 0
    return json.loads(capsys.readouterr().out)


def test_a_raw_scan_becomes_a_foam_and_says_what_was_mended(tmp_path, capsys):
    trimesh.Trimesh(*scan(7), process=False).export(tmp_path / "scan.ply")
    rows = mend(
        capsys, tmp_path / "scan.ply", "--out", tmp_path / "foam.obj", "--close", "--smooth-mm", 15
    )
    assert {tuple(row) for row in rows} == {("number", "what", "place")}
    assert any(row["what"].startswith("holes filled smoothly") for row in rows)
    assert all(row["place"].endswith(" m") for row in rows)
    foam = io.read_foam_surface(tmp_path / "foam.obj", unit="mm")
    assert foam.mended == ()


def test_a_whole_seat_of_two_bodies_becomes_one_foam(tmp_path, capsys):
    vertices, faces = whole_seat()
    trimesh.Trimesh(1e3 * vertices, faces, process=False).export(tmp_path / "seat.stl")
    assert run(["mend", str(tmp_path / "seat.stl"), "--out", str(tmp_path / "foam.obj")]) == 2
    assert "unite makes one of them" in capsys.readouterr().err
    assert not (tmp_path / "foam.obj").exists()
    rows = mend(capsys, tmp_path / "seat.stl", "--out", tmp_path / "foam.obj", "--unite")
    assert [row["number"] for row in rows if row["what"] == "bodies united"] == [2]
    foam = io.read_foam_surface(tmp_path / "foam.obj", unit="mm")
    assert foam.mended == ()
    assert np.ptp(foam.vertices, axis=0) == pytest.approx([0.9, 1.2, 1.0])


@pytest.mark.skipif(not SEATS.is_dir(), reason="no fetched seats here")
@pytest.mark.parametrize(
    ("name", "round_mm", "litres"),
    [("chair_back_cushion.obj", 1558, 13.3), ("chair_seat_cushion_open.obj", 2126, 32.5)],
)
def test_upholstered_parts_of_a_chair(tmp_path, capsys, name, round_mm, litres):
    rows = mend(capsys, SEATS / name, "--out", tmp_path / "foam.obj", "--close")
    assert [row["what"] for row in rows] == [
        f"openings closed flat, the largest {round_mm} mm round"
    ]
    foam = io.read_foam_surface(tmp_path / "foam.obj", unit="mm")
    assert foam.mended == ()
    assert 1e3 * volume(foam.vertices, foam.faces) == pytest.approx(litres, rel=0.02)


def test_the_file_to_write_is_named_first(tmp_path, capsys):
    trimesh.creation.box(extents=(0.5, 0.4, 0.1)).export(tmp_path / "a.ply")
    assert run(["mend", str(tmp_path / "a.ply"), "--out", str(tmp_path / "foam.stl")]) == 2
    assert "expected a name that ends in .obj" in capsys.readouterr().err
