"""Sewn lines still agree after a correction of one of them."""

import ezdxf
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from seatlook import io
from seatlook.improvement.changes import added
from seatlook.improvement.corrected import length_rows
from seatlook.improvement.moves import followed
from seatlook.improvement.moves import moves_of as gather

MM = 1e-3
SEWN = 0.05 * MM


def cut(candidates):
    return [c for c in candidates if c.kind in ("offset", "length")]


def with_followers(changes, candidate, amount, frozen=frozenset()):
    follows = changes.partners.followers(candidate, frozen)
    return {candidate: amount} | {c: amount * v for c, v in follows.items()}


def eases(changes, pattern):
    return np.array([MM * row["ease_mm"] for row in length_rows(changes.drawn, pattern)])


@settings(max_examples=40, deadline=None)
@given(seed=st.integers(0, 2**16), count=st.integers(1, 3), size=st.floats(0.5, 5.0))
def test_offsets_leave_every_difference_as_it_was(changes, candidates, seed, count, size):
    rng = np.random.default_rng(seed)
    own = [c for c in candidates if c.kind == "offset"]
    picked = [own[k] for k in rng.choice(len(own), count, replace=False)]
    signs = rng.choice([-1.0, 1.0], count)
    amounts = added(
        *(with_followers(changes, c, s * size * MM) for c, s in zip(picked, signs, strict=True))
    )
    after = eases(changes, changes.pattern(amounts))
    assert np.abs(after - changes.partners.drawn).max() < SEWN


@settings(max_examples=30, deadline=None)
@given(seed=st.integers(0, 2**16), size=st.floats(-10.0, 10.0))
def test_a_length_changes_the_ease_of_its_own_seam_only(changes, candidates, seed, size):
    own = [c for c in candidates if c.kind == "length"]
    own = [c for c in own if changes.partners.seam_of(c) is not None]
    candidate = own[seed % len(own)]
    after = eases(changes, changes.pattern(with_followers(changes, candidate, size * MM)))
    change = after - changes.partners.drawn
    seam = changes.partners.seam_of(candidate)
    sign = 1.0 if changes.drawn.seams[seam].a == candidate.name else -1.0
    assert change[seam] == pytest.approx(sign * size * MM, abs=SEWN)
    assert np.abs(np.delete(change, seam)).max() < SEWN


def test_without_followers_lengths_do_not_agree(changes, candidates):
    """The test above can fail: the same offsets alone move lines apart by millimetres."""
    worst = max(
        np.abs(eases(changes, changes.pattern({c: 4 * MM})) - changes.partners.drawn).max()
        for c in candidates
        if c.kind == "offset"
    )
    assert worst > 1 * MM


def test_slopes_of_differences_are_those_of_the_drawing(changes, candidates):
    step = 1e-6
    for candidate in cut(candidates)[::7]:
        up, down = (
            changes.partners._measured(changes.partners._moved({candidate: s * step}))
            for s in (1.0, -1.0)
        )
        expected = (up - down) / (2 * step)
        assert changes.partners.slope(candidate) == pytest.approx(expected, abs=1e-6)


def test_a_line_that_is_too_long_is_closed_by_what_it_is_too_long(changes, candidates):
    line = next(c for c in candidates if c.name == "INSERT.BOLSTER_L" and c.kind == "length")
    (move,) = gather(changes, {line: 1.0})
    follows = {line: changes.partners.followers(line)}
    made = with_followers(changes, line, 8 * MM)
    closes = followed(changes, move, follows, made).closes
    seam = changes.partners.seam_of(line)
    drawn = changes.partners.drawn[seam] * (1 if changes.drawn.seams[seam].a == line.name else -1)
    assert closes == pytest.approx(-8 * MM - drawn, abs=SEWN)
    after = eases(changes, changes.pattern(added(made, with_followers(changes, line, closes))))
    assert after[seam] == pytest.approx(0.0, abs=SEWN)
    others = np.delete(after - changes.partners.drawn, seam)
    assert np.abs(others).max() < SEWN


def test_what_is_frozen_does_not_follow(changes, candidates):
    frozen = frozenset({"FRONT.INSERT", "FRONT.SIDE_L"})
    panel = next(k for k, p in enumerate(changes.drawn.panels) if p.name == "FRONT")
    impossible = 0
    for candidate in cut(candidates):
        follows = changes.partners.followers(candidate, frozen)
        if follows is None:
            impossible += 1
            continue
        after = changes.pattern({c: 2 * MM * v for c, v in follows.items()})
        for name in frozen:
            edge = after.edges[name]
            points = edge.points(after.panels[panel])
            assert np.array_equal(points, changes.drawn.edge_points(name))
    assert impossible < len(cut(candidates))


def test_a_corrected_drawing_reads_back_with_equal_partners(changes, candidates, tmp_path):
    rng = np.random.default_rng(5)
    own = [c for c in candidates if c.kind == "offset"]
    picked = [own[k] for k in rng.choice(len(own), 4, replace=False)]
    after = changes.pattern(added(*(with_followers(changes, c, 3 * MM) for c in picked)))
    io.write_dxf(after, tmp_path / "pattern.dxf")
    io.write_seams(after, tmp_path / "seams.toml")
    written = io.read_pattern(tmp_path / "pattern.dxf", tmp_path / "seams.toml")
    assert np.abs(eases(changes, written) - changes.partners.drawn).max() < SEWN
    audit = ezdxf.readfile(tmp_path / "pattern.dxf").audit()
    assert not audit.errors
    assert not audit.fixes
