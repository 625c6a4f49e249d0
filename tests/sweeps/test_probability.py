"""The probability that a cover wrinkles, with covers that have no answer."""

from __future__ import annotations

import json

import numpy as np
import pytest

from seatlook.assembly import assemble
from seatlook.errors import InputError
from seatlook.model import Criteria
from seatlook.sweeps.cell import Cell
from seatlook.sweeps.probability import Chance, chance, zone_chances
from support import scenes

W2 = {"flat": [0.2, 0.3], "folded": [1.4, 0.3], "worse": [2.0, 1.1]}


def cells(folder, **status):
    """Leave what cells leave; "" stands for one that failed, None for one not run yet."""
    made = []
    for name, value in status.items():
        made.append(Cell(name=name, spec=json.dumps({"inputs": [], "values": []})))
        if value == "":
            (folder / f"{name}.failed.json").write_text('{"error": "SolverError"}')
        elif value is not None:
            np.save(folder / f"{name}.npy", W2.get(name, [9.0, 9.0]))
            zone = {"zone": "insert", "area_cm2": 1.0, "w2_mean": 0.5, "w2_p95": 1.0}
            zone |= {"w2_area_share": 0.0, "w_stretch_mean": 0.1, "w_compression_mean": 0.4}
            result = {"variant": "", "status": value, "set": [], "inputs": [], "values": []}
            (folder / f"{name}.json").write_text(json.dumps(result | {"zones": [zone]}))
    return made


def test_covers_without_an_answer_widen_the_probability(tmp_path):
    made = cells(
        tmp_path, flat="converged", folded="converged", worse="converged",
        stuck="not converged", broken="", waiting=None,
    )  # fmt: skip
    covers = chance(made, tmp_path)
    assert (covers.converged, covers.left_out, covers.covers) == (3, 2, 5)
    assert covers.share == pytest.approx([2 / 3, 1 / 3])
    assert covers.low == pytest.approx([2 / 5, 1 / 5])
    assert covers.high == pytest.approx([4 / 5, 3 / 5])


def test_the_bounds_meet_where_all_converged(tmp_path):
    covers = chance(cells(tmp_path, flat="converged", folded="converged"), tmp_path)
    assert covers.left_out == 0
    assert (covers.low == covers.share).all()
    assert (covers.high == covers.share).all()


def test_without_a_converged_cover_nothing_is_said(tmp_path):
    with pytest.raises(InputError, match="none of 2 covers converged"):
        chance(cells(tmp_path, stuck="not converged", broken=""), tmp_path)


def test_zones_have_means_by_area_with_both_bounds():
    cover = assemble(scenes.two_panels())
    share = np.where(cover.zone == cover.zone.max(), 0.5, 0.0)
    rows = zone_chances(Chance(share=share, converged=8, left_out=2), cover, Criteria())
    assert {row["criterion"] for row in rows} == {"tensor, 0.02 per mm"}
    assert [row["zone"] for row in rows] == [
        name for k, name in enumerate(cover.zone_names) if (cover.zone == k).any()
    ]
    last = rows[-1]
    assert (last["converged"], last["left_out"]) == (8, 2)
    assert last["probability"] == pytest.approx(0.5)
    assert last["probability_if_left_out_below"] == pytest.approx(0.4)
    assert last["probability_if_left_out_above"] == pytest.approx(0.6)
    assert rows[0]["largest"] == 0.0
    assert rows[0]["largest_if_left_out_above"] == pytest.approx(0.2)
