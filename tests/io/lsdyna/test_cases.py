"""Files as programs write them, each with the curvature that it must give."""

from pathlib import Path

import pytest

from seatlook.chain.shell_states import wrinkle_states

DATA = Path(__file__).parents[2] / "data" / "lsdyna"


def curvature(name, **reading):
    """Curvature of the last state [1/mm], number of shells, notes."""
    figures = wrinkle_states(DATA / name, **reading)
    return figures["states"][-1]["c"], figures["shells"], figures["notes"]


@pytest.mark.parametrize(
    ("name", "shells"),
    [
        ("d0_control", 24),
        ("d1_titles_internal", 24),
        ("d2_strflg11_maxint5", 24),
        ("d3_strflg11_maxint3", 24),
        ("d7b_d3part_ndim5", 24),
        ("d8_only_strain_thickness", 24),
        ("d9_with_velocities", 24),
    ],
)
def test_a_d3plot(name, shells):
    c, count, notes = curvature(f"d3plot/{name}")
    assert c == pytest.approx(-0.005, rel=1e-6)
    assert (count, notes) == (shells, [])


@pytest.mark.parametrize(
    ("name", "what"),
    [
        ("d4_rigid_zero", "with thickness 0 in every state, as rigid parts are written,"),
        ("d7_dcomp_ndim5", "of rigid parts"),
    ],
)
def test_rigid_shells_are_left_out_and_named(name, what):
    c, count, notes = curvature(f"d3plot/{name}", thickness=0.001)
    assert c == pytest.approx(-0.005, rel=1e-6)
    assert (count, notes) == (12, [f"12 shells {what} are left out: part 12 'dummy tool'"])


def test_a_part_is_chosen_by_its_own_title():
    assert curvature("d3plot/d1_titles_internal", parts=["seat cover"])[1] == 12
