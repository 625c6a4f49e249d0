"""Where wrinkles show: two panels side by side in a hand-made picture of 20 x 40 pixels."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from seatlook.visibility.places import FLAT, SHOWS, places

# Faces 0 to 9 are panel A from left to right, 10 to 19 panel B; a face is 2 pixels wide.
COUNT, HEIGHT = 20, 20
CENTRE = np.column_stack([0.01 * np.arange(COUNT), np.zeros(COUNT)])
PANEL = np.repeat([0, 1], COUNT // 2)
FACES = np.arange(3 * COUNT).reshape(-1, 3)
FACE = np.broadcast_to(np.repeat(np.arange(COUNT), 2), (HEIGHT, 2 * COUNT))
CELLS = (("black", "sun"), ("black", "bulb"), ("suede", "sun"))
VALLEY = np.full(COUNT, 2 * FLAT)
# The face of a wrinkle of 20 mm is a square degree.
PIXELS_PER_DEGREE = np.sqrt(2 * HEIGHT)


def scored(**maps):
    """A score with D of some cells given as a value per face; 0.1 elsewhere."""
    cover = SimpleNamespace(
        rest=np.repeat(CENTRE, 3, axis=0), faces=FACES, panel=PANEL, panel_names=("A", "B"),
        zone=PANEL, zone_names=("A interior", "B interior"),
    )  # fmt: skip
    positions = np.column_stack([np.repeat(CENTRE, 3, axis=0), np.zeros(3 * COUNT)])
    view = SimpleNamespace(
        solution=SimpleNamespace(cover=cover, positions=positions),
        camera=SimpleNamespace(pixels_per_degree=PIXELS_PER_DEGREE),
        region=SimpleNamespace(face=FACE, mask=np.ones(FACE.shape, bool), zone=PANEL[FACE]),
    )
    sights = {}
    for cell in CELLS:
        seen = np.full(COUNT, 0.1)
        for face, value in maps.get("_".join(cell), {}).items():
            seen[face] = value
        zones = {name: float(seen[k == PANEL].mean()) for k, name in enumerate(cover.zone_names)}
        sights[cell] = SimpleNamespace(
            score=SimpleNamespace(map=seen[FACE]), zones=zones, mask=np.ones(FACE.shape, bool)
        )
    return SimpleNamespace(view=view, grid=SimpleNamespace(sights=sights))


def wrinkle(face, *, length=0.02):
    return SimpleNamespace(
        rest=CENTRE[face], position=np.append(CENTRE[face], 0.0), length=length,
        panel="AB"[PANEL[face]], kind="wrinkle", zone=f"{'AB'[PANEL[face]]} interior",
    )  # fmt: skip


def test_a_smooth_picture_shows_nothing_but_lists_the_wrinkle():
    (place,) = places(scored(), [wrinkle(4)], VALLEY)
    assert (place.rank, place.shows, place.hidden_by) == (1, False, ("black", "suede"))


def test_a_wrinkle_is_seen_in_its_worst_look_and_light_and_hidden_by_another():
    near = {3: SHOWS + 2, 4: SHOWS + 2, 5: SHOWS + 2}
    (place,) = places(scored(black_bulb=near, suede_sun={4: 0.5}), [wrinkle(4)], VALLEY)
    assert place.worst == ("black", "bulb")
    assert place.vwi["black", "bulb"] == pytest.approx(SHOWS + 2)
    assert place.shows
    assert place.hidden_by == ("suede",)


def test_only_pixels_of_its_own_panel_and_near_it_count():
    (first,) = places(scored(black_sun={10: 50.0, 11: 50.0}), [wrinkle(9)], 0 * VALLEY)
    assert not first.shows
    (second,) = places(scored(black_sun={0: 50.0}), [wrinkle(9, length=0.2)], VALLEY)
    assert second.shows


def test_what_shows_most_stands_first_and_a_zone_counts_once():
    near, far = dict.fromkeys(range(10), 1.01 * SHOWS), dict.fromkeys(range(10, 20), 9.0)
    score = scored(black_sun=near | far)
    found = places(score, [wrinkle(4)], VALLEY)
    assert [(p.rank, p.zone) for p in found] == [(None, "B interior"), (1, "A interior")]
    assert found[0].position[0] >= CENTRE[10, 0]


def test_a_zone_without_valleys_shows_no_wrinkle():
    score = scored(black_sun=dict.fromkeys(range(10, 20), 9.0))
    assert [p.zone for p in places(score, [], VALLEY)] == ["B interior"]
    assert places(score, [], 0.9 * VALLEY / 2) == ()


def test_what_lies_at_a_tie_is_no_place():
    tie = wrinkle(4)
    tie.kind = "tie"
    near = {3: 9.0, 4: 9.0, 5: 9.0}
    assert [p.rank for p in places(scored(black_sun=near), [tie, wrinkle(4)], VALLEY)] == [2]


def test_a_wrinkle_out_of_view_is_left_out():
    score = scored()
    score.view.region.mask[:] = PANEL[FACE] == 1
    assert places(score, [wrinkle(4)], VALLEY) == ()
