"""The registry of indices: one entry, and everything that lists indices has it."""

from __future__ import annotations

import csv
import math
from pathlib import Path

import numpy as np
import pytest
import trimesh

import seatlook
from seatlook.errors import InputError
from seatlook.io.scene.keys import scene_keys
from seatlook.wrinkle import INDICES, Index, figure_names, register
from support.scene_files import TEXT, write_two_panels

ROOT = Path(__file__).parents[2]


@pytest.fixture
def slope():
    """An index that nobody has heard of: how steep a face lies."""

    def steepness(surface):
        p = surface.solution.positions[surface.solution.cover.faces]
        normal = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
        return np.degrees(np.arccos(normal[:, 2] / np.linalg.norm(normal, axis=1)))

    index = register(
        Index(
            name="slope",
            symbol="Slope",
            unit="deg",
            limits=(0.0, 180.0),
            meaning="how steep the cover lies",
            of=steepness,
            statistics=("mean", "p95"),
            ends=(0.0, 90.0),
        )
    )
    yield index
    del INDICES["slope"]


@pytest.mark.render
def test_an_index_added_at_run_time_is_everywhere(slope, tmp_path):
    text = TEXT + '\n[accept."LEFT interior"]\nslope_deg_mean = 1000.0\n'
    seat = seatlook.open(write_two_panels(tmp_path, text=text))
    outcome = seat.evaluate(tmp_path / "out", score=False)
    values = seat.assessment.values("slope")
    assert values.max() > 0.1
    # maps and page
    assert (tmp_path / "out/maps/slope.png").is_file()
    page = outcome.page.read_text()
    assert "how steep the cover lies" in page
    assert "Slope mean [deg]" in page
    # zones and limits
    with (tmp_path / "out/zones.csv").open(newline="") as file:
        rows = {row["zone"]: row for row in csv.DictReader(file)}
    for row in seat.assessment.zones:
        assert float(rows[row.zone]["slope_deg_mean"]) == row["slope_deg_mean"]
    (verdict,) = outcome.evaluation.verdicts
    inner = next(row for row in seat.assessment.zones if row.zone == "LEFT interior")
    assert verdict.value == inner["slope_deg_mean"]
    # exports, under one name
    for ending in (".csv", ".vtp", ".glb"):
        seat.export(tmp_path / f"seat{ending}")
    with (tmp_path / "seat.csv").open(newline="") as file:
        assert [float(r["_SLOPE_DEG"]) for r in csv.DictReader(file)] == values.tolist()
    assert 'Name="_SLOPE_DEG"' in (tmp_path / "seat.vtp").read_text()
    meshes = trimesh.load(tmp_path / "seat.glb").geometry.values()
    assert all("_SLOPE_DEG" in mesh.vertex_attributes for mesh in meshes)


def test_limits_know_the_figures_of_the_moment(slope):
    assert slope.figures == ("slope_deg_mean", "slope_deg_p95")
    assert set(slope.figures) < set(figure_names()) < set(scene_keys()["accept"].table.keys)


def test_entries_are_complete_and_names_are_not_taken_twice(slope):
    names = [index.export_name for index in INDICES.values()]
    assert len(set(names)) == len(names)
    for name, index in INDICES.items():
        assert name == index.name
        assert index.meaning
        assert index.limits[0] < index.limits[1]
        assert index.figures
    with pytest.raises(InputError, match="index: got 'slope', expected a new name"):
        register(slope)
    with pytest.raises(InputError, match="expected a name of small letters"):
        Index(name="W 9", symbol="", unit="1", limits=(0, 1), meaning="", of=lambda s: s)


def test_an_index_of_another_shape_is_refused(two_panels_solution):
    index = Index(
        name="odd", symbol="odd", unit="1", limits=(0.0, math.inf), meaning="odd",
        of=lambda s: np.zeros(3),
    )  # fmt: skip
    surface = seatlook.assess(two_panels_solution).surface
    with pytest.raises(InputError, match=r"index odd: got shape \(3,\), expected"):
        index.values(surface)


def test_values_stay_in_their_limits(two_panels_solution):
    assessment = seatlook.assess(two_panels_solution)
    for name, index in INDICES.items():
        low, high = index.limits
        values = assessment.values(name)
        assert (values >= low).all(), name
        assert (values <= high).all(), name


def test_the_reference_lists_every_index_with_symbol_unit_and_meaning():
    text = " ".join((ROOT / "docs/reference/indices.md").read_text().split())
    for index in INDICES.values():
        row = f"| `{index.name}` | {index.symbol} | {index.unit} | {index.meaning} |"
        assert row in text, row


@pytest.fixture(scope="module")
def two_panels_solution(tmp_path_factory):
    return seatlook.open(write_two_panels(tmp_path_factory.mktemp("two"))).solve()
