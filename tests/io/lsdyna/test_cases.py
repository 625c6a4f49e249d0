"""Files as programs write them, each with the curvature that it must give."""

from pathlib import Path

import pytest

from seatlook.chain.shells.states import wrinkle_states

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


@pytest.mark.parametrize(
    "name",
    [
        "k0_control",
        "k1_nplane_nthick_blank",
        "k2_strain_set",
        "k3_windows_include",
        "k3b_unix_include",
        "k6b_only_transform",
        "k9_openradioss_dynain",
        "k16_beta",
    ],
)
def test_a_deck(name):
    c, count, notes = curvature(f"k/{name}.k")
    assert c == pytest.approx(-0.005, rel=1e-6)
    assert (count, notes) == (4, [])


def test_exponents_without_a_letter():
    assert curvature("k/k14_fortran3.k")[0] == pytest.approx(-0.004004, rel=1e-3)


def test_an_included_part_with_new_numbers_is_half_of_the_model(problems):
    """The part that its shells get is defined nowhere: no thickness is invented for it."""
    path = DATA / "k" / "k6_include_transform.k"
    assert problems(wrinkle_states, path) == [
        "k6_include_transform.k: thickness: got none for 4 shells of part 1001, first 1001, "
        "expected *SECTION_SHELL, *PART_COMPOSITE or *ELEMENT_SHELL_THICKNESS of this part "
        "(IDPOFF of *INCLUDE_TRANSFORM changes the numbers of parts; or say the thickness)"
    ]
    c, count, notes = curvature("k/k6_include_transform.k", thickness=0.001)
    assert c == pytest.approx(-0.005, rel=1e-6)
    assert (count, notes) == (8, [])


def test_a_composite_part_does_not_stop_the_others():
    c, count, notes = curvature("k/k7_composite.k")
    assert c == pytest.approx(-0.0025, rel=1e-6)
    assert count == 8
    assert notes == ["4 shells have no strains in the deck and count as unstrained: part 2"]
    assert curvature("k/k7_composite.k", parts=[1])[0] == pytest.approx(-0.005, rel=1e-6)


def test_a_parameter_stands_for_its_number():
    assert curvature("k/k11_parameter.k")[0] == pytest.approx(-0.005, rel=1e-6)


def test_a_flat_bag_is_not_bent_beside_itself():
    path = DATA / "k" / "k15_flat_bag.k"
    (state,) = wrinkle_states(path, reference=path)["states"]
    assert (state["c_min"], state["c"], state["c_max"]) == (0, 0, 0)
