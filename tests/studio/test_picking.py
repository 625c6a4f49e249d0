"""Four picks sew two lines: the end on the other one is found."""

from __future__ import annotations

import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.io.scene.read import load_pattern
from seatlook.seats.files import write_demo
from seatlook.studio.pattern_state import seam_values
from seatlook.studio.picking import partner


@pytest.fixture(scope="module")
def pattern(tmp_path_factory):
    return load_pattern(write_demo(tmp_path_factory.mktemp("demo")))


def picks(pattern, seam, rng):
    """Start, end, start and a place on the way, as a hand clicks: some mm beside."""
    shake = lambda place: [v + float(rng.uniform(-3, 3)) for v in place]  # noqa: E731
    first, second = seam["first"], seam["second"]
    points = 1e3 * pattern.edge_points(second["edges"][0])
    points = points[::-1] if seam["reverse"] else points
    return (
        {"panel": first["panel"], "start": shake(first["from_mm"]), "end": shake(first["to_mm"])},
        {"panel": second["panel"], "start": shake(second["from_mm"]),
         "toward": shake(points[max(1, len(points) // 3)])},
    )  # fmt: skip


def test_every_seam_of_the_demo_is_found_by_its_picks(pattern):
    from dataclasses import replace

    rng, unsewn = np.random.default_rng(3), replace(pattern, seams=())
    for seam in seam_values(pattern):
        found = partner(unsewn, *picks(pattern, seam, rng))
        assert found["second"]["to_mm"] == seam["second"]["to_mm"], seam["name"]
        assert found["reverse"] is True
        assert found["lengths_mm"] == seam["lengths_mm"]
        assert found["ease_percent"] == pytest.approx(seam["ease_percent"], abs=2e-3)
        assert found["warnings"] == []


def test_the_other_direction_is_said_to_turn_a_panel_over(pattern):
    seam = seam_values(pattern)[0]
    first, second = picks(pattern, seam, np.random.default_rng(0))
    swapped = {**first, "start": first["end"], "end": first["start"]}
    found = partner(pattern, swapped, second)
    assert found["reverse"] is False
    assert any("turns one panel over" in text for text in found["warnings"])
    assert any(seam["name"] in text for text in found["warnings"])


@pytest.mark.parametrize(
    ("first", "second"),
    [
        ({"panel": "NO", "start": [0, 0], "end": [1, 1]}, {}),
        ({"panel": "INSERT", "start": [0, 0], "end": [0, 0]}, {}),
        ({"panel": "INSERT", "start": [0, 0], "end": "here"}, {}),
        ({"panel": "INSERT", "start": [0, 0], "end": [280, 0]}, {"panel": "FRONT", "start": None}),
        (
            {"panel": "INSERT", "start": [0, 0], "end": [280, 0]},
            {"panel": "FRONT", "start": [0, float("nan")], "toward": [1, 1]},
        ),
    ],
)
def test_picks_that_say_nothing_are_refused(pattern, first, second):
    with pytest.raises(InputError):
        partner(pattern, first, second)
