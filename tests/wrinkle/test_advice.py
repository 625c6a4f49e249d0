"""Advice names the edge, the way and the millimetres, or says nothing."""

from dataclasses import replace

import numpy as np
import pytest

from seatlook.wrinkle import advice_on, advise, seam_excess
from seatlook.wrinkle.worst import Wrinkle
from support.wrinkle_samples import SIZE, sewn, stretched_along


def strained(a, b, **options):
    return sewn(
        stretched_along(lambda d: np.full_like(d, a), lambda d: np.full_like(d, b)), **options
    )


def wrinkle(**change):
    plain = {
        "panel": "P0", "zone": "P0", "rest": np.array([0.06, 0.06]), "uv": np.array([0.07, 0.07]),
        "position": np.array([0.06, 0.06, 0.0]), "along": np.array([1.0, 0.0]), "length": 0.03,
        "width": 0.01, "depth": 0.002, "reach": 0.02, "excess": 0.002, "waves": 0.001,
        "scatter": 0.0002, "w2_max": 2.0, "w2_area": 1e-4, "stretch_share": 0.2,
        "cause": "compression", "near_kind": "seam", "near": "P0-P1", "distance": 0.06,
    }  # fmt: skip
    return Wrinkle(**(plain | change))


def told(solution, *wrinkles, resolved=True):
    stretches = [replace(s, resolved=resolved) for s in seam_excess(solution)]
    return advise(solution, stretches, wrinkles)


# The cover's strain is that of most seams: here of one seam's two sides, so their mean.
def test_a_seam_is_advised_on_with_its_longer_side():
    (advice,) = told(strained(-0.02, 0.01))
    assert (advice.action, advice.panel, advice.seam) == ("take out", "P0", "P0-P1")
    assert advice.amount == pytest.approx(0.03 * SIZE, rel=0.01)
    assert "P0 is 3.6 \u00b1" in advice.sentence
    assert "take 3.6 mm out of the edge of P0" in advice.sentence
    assert advice.place == "from the free end to the other free end"
    (other,) = told(strained(0.01, -0.02))
    assert other.panel == "P1"


@pytest.mark.parametrize(
    ("a", "b", "action", "panel", "confidence"),
    [
        (-0.025, 0.004, "take out", "P0", "high"),
        (0.006, 0.036, "let out", "P1", "high"),
        (-0.01, 0.02, "take out", "P0", "medium"),
        (0.004, -0.025, "take out", "P1", "high"),
    ],
)
def test_the_side_that_is_off_from_the_rest_of_the_cover_is_the_one_to_cut(
    a, b, action, panel, confidence
):
    """With more seams the cover's own strain, here 0.5 %, tells which of two sides is wrong."""
    solution = strained(a, b)
    usual = replace(seam_excess(strained(0.005, 0.005))[0], seam="other")
    advice = advise(solution, [*seam_excess(solution), *[usual] * 4], [])
    (one,) = advice
    assert (one.action, one.panel, one.confidence) == (action, panel, confidence)
    assert ("half of it" in one.sentence) == (confidence == "medium")


@pytest.mark.parametrize(("a", "b", "u"), [(-0.02, 0.01, 130), (0.01, -0.02, 210)])
def test_a_seam_of_one_panel_says_which_of_its_edges(a, b, u):
    """Borders at x = 120 and 200 mm, the pattern moved by 10; half way up, so v = 70."""
    solution = strained(a, b)
    (stretch,) = seam_excess(solution)
    tube = replace(stretch, long_panel="P0", short_panel="P0")
    (advice,) = advise(solution, [tube], [])
    assert advice.panel == "P0"
    assert f"take 3.6 mm out of the edge of P0 at pattern u, v = {u}, 70 mm" in advice.sentence
    assert f"longer than P0 at pattern u, v = {340 - u}, 70 mm" in advice.sentence


@pytest.mark.parametrize(
    ("a", "b"), [(0.0, 0.0), (0.01, 0.01), (-0.002, 0.002), (0.008, 0.0125), (0.0, 0.0049)]
)
def test_a_good_seam_has_no_advice(a, b):
    assert told(strained(a, b)) == ()


def test_nothing_is_said_where_the_mesh_does_not_resolve_it():
    assert told(strained(-0.02, 0.01), resolved=False) == ()
    assert told(strained(0.0, 0.0), wrinkle(resolved=False)) == ()
    assert advice_on(wrinkle(resolved=False), 1, ()) == (
        "none: the mesh does not resolve this wrinkle"
    )


def test_nothing_is_said_within_the_scatter():
    (stretch,) = seam_excess(strained(-0.02, 0.01))
    assert advise(strained(-0.02, 0.01), [replace(stretch, scatter=0.004)], []) == ()


@pytest.mark.parametrize("kind", ["tie", "corner", "spot"])
def test_ties_corners_and_single_elements_have_none(kind):
    one = wrinkle(kind=kind)
    advice = told(strained(0.0, 0.0), one)
    assert advice == ()
    assert advice_on(one, 1, advice).startswith("none: it is ")


def test_neighbouring_stretches_are_one_correction():
    solution = strained(-0.02, 0.01, notches=(0.25, 0.5, 0.75))
    assert len(seam_excess(solution)) == 4
    (advice,) = told(solution)
    assert advice.amount == pytest.approx(0.03 * SIZE, rel=0.01)
    assert advice.place == "from the free end to the other free end"


def test_a_seam_explains_the_wrinkles_beside_it():
    solution = strained(-0.02, 0.01)
    near = wrinkle(position=np.array([0.1, 0.06, 0.0]))
    far = wrinkle(panel="P1", near="", position=np.array([0.31, 0.06, 0.0]),
                  rest=np.array([0.31, 0.06]))  # fmt: skip
    first, second = told(solution, near, far)
    assert (first.seam, first.wrinkles) == ("P0-P1", (1,))
    assert (second.seam, second.wrinkles, second.panel) == ("", (2,), "P1")
    assert advice_on(near, 1, (first, second)) == first.sentence
    assert advice_on(far, 2, (first, second)) == second.sentence


def test_a_wrinkle_alone_is_taken_out_between_the_edges_across_it():
    one = wrinkle(along=np.array([0.0, 1.0]))
    (advice,) = told(strained(0.0, 0.0), one)
    assert (advice.action, advice.amount) == ("take out", one.excess)
    assert "2.0 \u00b1 0.2 mm too much cloth across the wrinkle" in advice.sentence
    assert "between the edge to P1 and its free edge" in advice.sentence
    assert told(strained(0.0, 0.0), replace(one, scatter=0.003)) == ()


def test_a_pulled_wrinkle_is_loosened():
    """A strip along the wrinkle that is 3 % longer than the rest of its panel."""

    def shape(X):
        first = (X[:, 0] < 0.16) & (np.abs(X[:, 1] - 0.06) < 0.012)
        return np.column_stack([X[:, 0] * np.where(first, 1.03, 1.0), X[:, 1], 0 * X[:, 0]])

    solution = sewn(shape)
    pulled = wrinkle(cause="stretch", stretch_share=0.9, width=0.008, length=0.05)
    (advice,) = advise(solution, [], [pulled])
    assert advice.action == "loosen"
    assert advice.amount == pytest.approx(0.03 * 0.05, rel=0.1)
    assert "build the foam up" in advice.sentence
