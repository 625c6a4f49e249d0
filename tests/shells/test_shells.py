"""A finite-element result in, figures per state out."""

import json
from pathlib import Path

import numpy as np
import pytest

from seatlook.chain.shells.states import ShellCriteria, wrinkle_states
from seatlook.errors import InputError
from support.d3plot_samples import d3plot, quad_strip

DATA = Path(__file__).parents[1] / "data"


@pytest.mark.parametrize(("mode", "c"), [("paper", 0.01), ("tensor", 0.02)])
def test_bent_strip(mode, c):
    """Flat, arch, valley: sign and size per state, from the d3plot and from the keywords."""
    figures = wrinkle_states(DATA / "bent_strip.d3plot", ShellCriteria(curvature=mode))
    assert [s["c"] for s in figures["states"]] == pytest.approx([0.0, c, -c], rel=0.01)
    assert [s["time"] for s in figures["states"]] == [0.0, 1.0, 2.0]
    for state in figures["states"]:
        assert state["c_max"] - state["c_min"] < 1e-6
        assert state["source"] == "strains"
        assert state["parts"][0]["c"] == state["c"]
    assert figures["states"][2]["w2"] == pytest.approx(1.0, rel=0.01)
    assert figures["states"][1]["w2"] == pytest.approx(0.0, abs=1e-12)
    deck = wrinkle_states(
        DATA / "bent_strip_dynain.k", ShellCriteria(curvature=mode), thickness=0.0012
    )
    assert [s["c"] for s in deck["states"]] == pytest.approx([-c], rel=0.01)
    assert json.loads(json.dumps(figures)) == figures


def test_parts_and_threshold(tmp_path):
    nodes, shells = quad_strip()
    e = len(shells)
    rng = np.random.default_rng(0)
    inner, outer = rng.normal(0, 0.01, (2, e, 6))
    state = (0.0, nodes, np.full(e, 1.2), inner, outer)
    path = tmp_path / "d3plot"
    part = np.array([1, 1, 1, 2, 2, 2, 2])
    names = {11: "insert", 12: "bolster"}
    path.write_bytes(d3plot(nodes, shells, [state], part=part, names=names))
    whole = wrinkle_states(path)
    (here,) = whole["states"]
    assert [(p["part"], p["name"]) for p in here["parts"]] == [(11, "insert"), (12, "bolster")]
    assert sum(p["area_mm2"] for p in here["parts"]) == pytest.approx(here["area_mm2"])
    assert here["area_mm2"] == pytest.approx(600.0)
    bolster = wrinkle_states(path, ShellCriteria(c_threshold=5.0), parts=["bolster"])
    assert bolster["c_threshold_per_mm"] == 0.005
    assert bolster["states"][0]["c"] == pytest.approx(here["parts"][1]["c"])
    assert bolster["states"][0]["w2"] == pytest.approx(2 * here["parts"][1]["w2"])


def test_a_shell_without_area_is_named_with_file_and_state(tmp_path):
    nodes, shells = quad_strip()
    e = len(shells)
    zero, t = np.zeros((e, 6)), np.full(e, 1.2)
    flat = nodes.copy()
    flat[shells[1] - 1] = flat[shells[1][0] - 1]
    path = tmp_path / "d3plot"
    path.write_bytes(d3plot(nodes, shells, [(0, nodes, t, zero, zero), (1, flat, t, zero, zero)]))
    with pytest.raises(InputError) as caught:
        wrinkle_states(path)
    assert str(caught.value).startswith(f"{path}: state 1: shells: got 1 without area, first 102,")


@pytest.mark.validate
def test_a_real_result_runs_through():
    path = Path(__file__).parents[3] / "shared/data/fetched/lasso_simple_d3plot/d3plot"
    if not path.exists():
        pytest.skip("third-party sample absent")
    figures = wrinkle_states(path)
    assert figures["shells"] == 4696
    assert abs(figures["states"][0]["c"]) < 1e-9
