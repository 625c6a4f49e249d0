"""Seams guessed from panels alone: what is found, what is left open, what is never sewn."""

from __future__ import annotations

import time
from collections.abc import Sequence
from dataclasses import replace
from types import MappingProxyType

import numpy as np
import pytest

from seatlook.assembly.panel_names import hand, named_variants
from seatlook.assembly.seam_guess import SURE, Proposal, propose_seams
from seatlook.assembly.seam_guess.outlines import find_stops
from seatlook.flattening import flatten
from seatlook.io.pattern.mirror import mirrored
from seatlook.model import Notch, Panel, Pattern
from seatlook.seats import Cushion, demo_design


def panel(
    name: str, points_mm: Sequence[tuple[float, float]], *, corners: int | None = None
) -> Panel:
    """A panel with a corner at each of its first points, which is at every one by default."""
    outline = 1e-3 * np.array(points_mm, dtype=np.float64)
    return Panel(
        name=name,
        outline=outline,
        corners=np.arange(len(outline) if corners is None else corners),
        cut_outline=outline.copy(),
        grain=np.array([0.0, 1.0]),
    )


def rectangle(name: str, width: float, height: float) -> Panel:
    return panel(name, [(0, 0), (width, 0), (width, height), (0, height)])


def stretches(pattern: Pattern) -> set[frozenset[tuple[str, int, int]]]:
    """Seams as sets of stretches, whatever edges and seams are called."""
    ends = {e.name: (e.panel, e.start, e.end) for e in pattern.edges.values()}
    return {frozenset(ends[name] for name in (s.a, *s.b)) for s in pattern.seams}


def sewn(proposal: Proposal) -> set[frozenset[str]]:
    return {frozenset((s.a, *s.b)) for s in proposal.pattern.seams}


def with_notches(pattern: Pattern, share: float, seed: int) -> tuple[Panel, ...]:
    """Keep a share of the notches, drawn at random; a negative share keeps a single one."""
    rng = np.random.default_rng(seed)
    count = sum(len(p.notches) for p in pattern.panels)
    kept = rng.random(count) < share
    if share < 0:
        kept[rng.integers(count)] = True
    rest = iter(kept)
    return tuple(
        replace(p, notches=tuple(n for n in p.notches if next(rest))) for p in pattern.panels
    )


@pytest.fixture(scope="module", params=[0, 1, 2])
def cushion(request: pytest.FixtureRequest) -> Pattern:
    """Flat panels of cushions of other sizes than the demo's."""
    shape = (
        Cushion(width=0.42, depth=0.5),
        Cushion(width=0.6, depth=0.5, trench=0.16),
        Cushion(width=0.5, depth=0.7, height=0.15),
    )[request.param]
    return flatten(demo_design(shape, element_size=0.012)).pattern


@pytest.mark.parametrize("share", [1.0, 0.5, -1.0, 0.0])
def test_seams_of_cushions_are_found_with_all_half_one_and_no_notches(cushion, share):
    found = propose_seams(with_notches(cushion, share, seed=3))
    true = stretches(cushion)
    guessed = stretches(found.pattern)
    assert len(guessed & true) >= 13  # of 14
    assert not guessed - true
    assert all(s.reverse for s in found.pattern.seams)
    assert min(found.probabilities.values()) >= SURE


def test_a_dart_is_proposed_and_a_slit_is_not():
    def darted(half: float) -> Panel:
        return panel(
            "P",
            [(0, 0), (200 - half, 0), (200, 80), (200 + half, 0), (400, 0), (400, 300), (0, 300)],
        )

    found = propose_seams([darted(20.0)])
    assert sewn(found) == {frozenset({"P.right", "P.left"})}
    assert "a dart" in next(iter(found.reasons.values()))
    assert not propose_seams([darted(2.0)]).pattern.seams


def test_a_strip_closes_round_a_round_top():
    angle = np.linspace(0, 2 * np.pi, 120, endpoint=False)
    top = panel("TOP", [(200 * np.cos(a), 200 * np.sin(a)) for a in angle], corners=1)
    girth = 120 * 2 * 200 * np.sin(np.pi / 120)
    found = propose_seams([top, rectangle("STRIP", girth, 80)])
    closing = frozenset({"STRIP.right", "STRIP.left"})
    given = sewn(found) | {frozenset((d.a, *d.b)) for d in found.doubtful}
    assert closing in given
    assert any("TOP" in name for seam in given for name in seam)


@pytest.mark.parametrize("names", [("INSERT", "INSERT_perforated"), ("TOP v1", "TOP v2")])
def test_variants_of_one_piece_are_never_sewn_together(names):
    pieces = [rectangle(names[0], 300, 460), rectangle(names[1], 300, 460)]
    pieces += [rectangle("SIDE_L", 90, 460), rectangle("SIDE_R", 90, 460)]
    found = propose_seams(pieces)
    for a, *b in [(s.a, *s.b) for s in found.pattern.seams] + [(d.a, *d.b) for d in found.doubtful]:
        panels = {name.rpartition(".")[0] for side in (a, *b) for name in side.split(" + ")}
        assert not set(names) <= panels


def test_corners_cut_off_inside_an_edge_are_merged():
    # The long edge of A has a facet of 12 degrees in it; together its parts are as long as B's.
    a = panel("A", [(0, 0), (466, 0), (543, 16), (543, 300), (0, 300)])
    long = 466 + np.hypot(77, 16)
    b = panel("B", [(0, 0), (long, 0), (long - 40, 210), (25, 190)])
    found = propose_seams([a, b])
    guesses = [(s.a, *s.b) for s in found.pattern.seams] + [(d.a, *d.b) for d in found.doubtful]
    of_b = [pair for pair in guesses if any(name.startswith("B.") for name in pair)]
    assert all(not (len(pair) == 2 and "466" in pair[0]) for pair in of_b)
    lengths = [found.pattern.edge_length(n) for s in found.pattern.seams for n in (s.a, *s.b)]
    assert all(abs(x - 0.466) > 1e-3 for x in lengths)


def test_corners_of_a_facet_are_one_stop():
    square = panel("S", [(0, 0), (300, 0), (300, 190), (297, 197), (290, 200), (0, 200)])
    assert find_stops(square).tolist() == [0, 1, 3, 5]


def test_a_step_in_an_edge_is_no_corner():
    step = [(0, 0), (300, 0), (300, 90), (292, 90), (292, 98), (300, 98), (300, 200), (0, 200)]
    assert find_stops(panel("S", step)).tolist() == [0, 1, 6, 7]


def test_mirrored_pieces_take_mirrored_places(cushion):
    left = next(p for p in cushion.panels if p.name == "BOLSTER_L")
    right = next(p for p in cushion.panels if p.name == "BOLSTER_R")
    assert (hand(left.name), hand(right.name)) == ("left", "right")
    turned = replace(mirrored(left), name="BOLSTER_R", notches=())
    panels = tuple(
        turned if p.name == "BOLSTER_R" else replace(p, notches=()) for p in cushion.panels
    )
    names = {s.name for s in propose_seams(panels).pattern.seams}
    assert {"INSERT-BOLSTER_L", "INSERT-BOLSTER_R"} <= names


@pytest.mark.parametrize(
    ("one", "other", "variants"),
    [
        ("INSERT", "INSERT_perforated", True),
        ("Pattern2D_1", "Pattern2D_2", True),
        ("skirt_front", "skirt_back", False),
        ("SIDE_L", "SIDE_R", False),
        ("FRONT", "REAR", False),
    ],
)
def test_variants_are_told_by_name(one, other, variants):
    assert named_variants(one, other) is variants


def test_panels_that_nothing_joins_are_left_open():
    found = propose_seams([rectangle("A", 300, 200), rectangle("B", 411, 97)])
    assert not found.pattern.seams
    assert len(found.free) == 8


def test_notches_that_do_not_meet_make_a_seam_less_sure():
    def probability(at: float) -> float:
        far = replace(
            panel("B", [(0, 0), (460, 0), (400, 150), (30, 140)]),
            notches=tuple(Notch(position=np.array([0.460 - x, 0.0])) for x in (at, at + 0.1)),
        )
        near = replace(
            panel("A", [(0, 0), (460, 0), (431, 250), (71, 220)]),
            notches=tuple(Notch(position=np.array([x, 0.0])) for x in (0.1, 0.2)),
        )
        found = propose_seams([near, far])
        sure = found.probabilities.values()
        return max([*sure, *(d.probability for d in found.doubtful)], default=0.0)

    assert probability(0.1) > probability(0.3) + 0.1


def test_thirty_panels_take_a_few_seconds():
    rng = np.random.default_rng(5)
    pieces = []
    for k in range(15):
        width, height = rng.uniform(120, 400), rng.uniform(200, 600)
        skew = rng.uniform(-60, 60)
        quad = [(0, 0), (width, 0), (width + skew, height), (skew / 2, height)]
        pieces += [
            panel(f"PART{k}_L", quad),
            replace(mirrored(panel(f"x{k}", quad)), name=f"PART{k}_R"),
        ]
    start = time.process_time()
    found = propose_seams(pieces)
    assert time.process_time() - start < 10.0
    assert isinstance(found.rivals, MappingProxyType)


def test_the_same_panels_give_the_same_guess(cushion):
    first, second = (propose_seams(with_notches(cushion, 0.0, seed=1)) for _ in range(2))
    assert first.reasons == second.reasons


@pytest.mark.parametrize("seed", range(4))
def test_a_strip_round_a_top_is_closed(seed):
    rng = np.random.default_rng(seed)
    radius, height = rng.uniform(150, 400), rng.uniform(50, 200)
    turn = np.linspace(0, 2 * np.pi, 161)[:-1]
    disc = radius * np.column_stack([np.sin(turn), -np.cos(turn)])
    girth = float(np.linalg.norm(np.diff(disc, axis=0, append=disc[:1]), axis=1).sum())
    top = panel("TOP", disc.tolist(), corners=1)
    slant = 0.015 * girth
    corners = [(0, 0), (girth + 2 * slant, 0), (girth + slant, height), (slant, height)]
    side = panel("SIDE", corners)
    found = propose_seams([top, side])
    panels = sorted(sorted(e.rpartition(".")[0] for e in pair) for pair in sewn(found))
    assert panels == [["SIDE", "SIDE"], ["SIDE", "TOP"]]


def test_a_dart_among_other_panels_that_has_no_twin_is_not_sure():
    slit = [(0, 0), (190, 0), (200, 150), (210, 0), (400, 0), (370, 520), (40, 500)]
    other = [(0, 0), (310, 0), (290, 130), (15, 120)]
    found = propose_seams([panel("FRONT_SKIRT", slit), panel("YOKE", other)])
    assert not any(len({e.rpartition(".")[0] for e in pair}) == 1 for pair in sewn(found))


def test_seams_between_the_same_panels_have_names_of_their_place():
    one = panel("A", [(0, 0), (300, 0), (340, 210), (0, 260)])
    other = replace(mirrored(panel("x", [(0, 0), (300, 0), (340, 210), (0, 260)])), name="B")
    found = propose_seams([one, other])
    names = [seam.name for seam in found.pattern.seams]
    assert len(names) == len(set(names))
    assert not any(name[-1].isdigit() for name in names)


def test_reasons_count_notches_as_one_says_it():
    pattern = flatten(demo_design(Cushion(), element_size=0.012)).pattern
    words = " ".join(
        reason
        for share, seed in ((1.0, 0), (0.5, 3), (0.5, 4), (-1.0, 1))
        for reason in propose_seams(with_notches(pattern, share, seed)).reasons.values()
    )
    assert "1 notch meets" in words
    assert "notch meets;" in words
    for odd in ("1 notches", "0 notches", "0 do not", "1 do not", "1 corners"):
        assert odd not in words
