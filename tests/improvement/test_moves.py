"""What moves together."""

import numpy as np
import pytest

from seatlook.improvement.moves import Move, moves_of
from seatlook.improvement.propose import sentence

MM = 1e-3


def of_edge(candidates, name):
    return [c for c in candidates if c.kind == "offset" and c.name == name]


def test_the_best_run_of_an_edge_moves_as_one(changes, candidates):
    stretches = of_edge(candidates, "INSERT.BOLSTER_L")
    assert len(stretches) > 3
    slope = dict.fromkeys(stretches, -1.0) | {stretches[1]: 2.0, stretches[2]: 3.0}
    (move,) = moves_of(changes, slope)
    assert list(move.share) == stretches[1:3]
    assert move.total(slope) == pytest.approx(5.0)
    assert move.places[0][0] != "its beginning"
    assert move.places[0][1] != "its end"


def test_mirrored_edges_move_together_where_both_gain(changes, candidates):
    left, right = (of_edge(candidates, f"INSERT.BOLSTER_{side}") for side in "LR")
    slope = dict.fromkeys([*left, *right], 1.0)
    (pair,) = moves_of(changes, slope)
    assert set(pair.names) == {"INSERT.BOLSTER_L", "INSERT.BOLSTER_R"}
    assert pair.total(slope) == pytest.approx(len(left) + len(right))
    assert len(moves_of(changes, slope, pairs=False)) == 2


def test_a_fault_on_one_side_moves_alone(changes, candidates):
    left, right = (of_edge(candidates, f"INSERT.BOLSTER_{side}") for side in "LR")
    slope = dict.fromkeys(left, 1.0) | dict.fromkeys(right, 0.1)
    moves = moves_of(changes, slope)
    assert sorted(move.names for move in moves) == [("INSERT.BOLSTER_L",), ("INSERT.BOLSTER_R",)]


@pytest.mark.parametrize(
    ("kind", "amount", "expected"),
    [
        ("offset", -2 * MM, "edge A, from notch 1 to its end: take 2.0 mm out of the panel there"),
        ("offset", 2 * MM, "let 2.0 mm into the panel there"),
        ("length", 3 * MM, "edge A: make it 3.0 mm longer"),
        ("hook", 3 * MM, "hook A: pull it 3.0 mm deeper"),
        ("hook", -3 * MM, "hook A: let it come up by 3.0 mm"),
        ("foam", 4 * MM, "foam below A: build it up by 4.0 mm"),
        ("foam", -4 * MM, "foam below A: take 4.0 mm off it"),
    ],
)
def test_sentences_are_in_the_words_of_the_trade(kind, amount, expected):
    move = Move(kind=kind, names=("A",), places=(("notch 1", "its end"),), share={})
    assert expected in sentence(move, amount, 0.2)
    assert "20 %" in sentence(move, amount, 0.2)


def test_slopes_of_a_pair_add_up(changes, candidates):
    lengths = [c for c in candidates if c.kind == "length"]
    slope = {c: float(v) for c, v in zip(lengths, np.linspace(1.0, 2.0, len(lengths)), strict=True)}
    moves = moves_of(changes, slope)
    assert sum(move.total(slope) for move in moves) == pytest.approx(sum(slope.values()))
