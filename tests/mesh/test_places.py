"""Words for the places of lines: unique, and the same however the lines are drawn."""

import itertools

import numpy as np
import pytest

from seatlook import mesh
from seatlook.mesh.places import place_words

STROKE = np.array([[-0.03, 0.0, 0.01], [0.0, 0.02, 0.0], [0.03, 0.0, -0.01]])


def at(*place):
    return STROKE + np.array(place)


@pytest.mark.parametrize(
    ("places", "words"),
    [
        ([(0, 0, 0)], [""]),
        ([(0.2, 0, 0), (-0.2, 0, 0.1)], ["left", "right"]),
        ([(0, -0.2, 0), (0, 0.2, 0)], ["front", "rear"]),
        ([(0, 0, 0.3), (0, 0.1, 0)], ["top", "bottom"]),
        ([(0.2, 0, 0), (0, 0, 0), (-0.2, 0, 0)], ["left", "middle", "right"]),
        (
            [(0.2, 0.1, 0), (0.2, -0.1, 0), (-0.2, 0.1, 0), (-0.2, -0.1, 0)],
            ["left.rear", "left.front", "right.rear", "right.front"],
        ),
    ],
)
def test_lines_are_told_apart_by_where_they_lie(places, words):
    assert place_words([at(*place) for place in places]) == tuple(words)


def test_rings_round_one_middle_are_inner_and_outer():
    turn = np.linspace(0.0, 2.0 * np.pi, 60)
    ring = np.column_stack([np.cos(turn), np.sin(turn), 0.0 * turn])
    assert place_words([0.2 * ring, 0.1 * ring]) == ("outer", "inner")


@pytest.mark.parametrize("seed", range(20))
def test_words_are_unique_and_stay_when_lines_are_drawn_anew(seed):
    rng = np.random.default_rng(seed)
    places = rng.uniform(-0.3, 0.3, (int(rng.integers(2, 9)), 3))
    lines = [at(*place) for place in places]
    words = place_words(lines)
    assert len(set(words)) == len(words)
    assert not any(character.isdigit() for word in words for character in word)
    for spacing in (0.003, 0.011):
        drawn = [mesh.resample(line, spacing)[::-1] for line in lines]
        assert place_words(drawn) == words
    order = rng.permutation(len(lines))
    assert place_words([lines[k] for k in order]) == tuple(words[k] for k in order)


def test_the_mirror_image_has_the_mirrored_words():
    lines = [at(x, y, 0.0) for x, y in itertools.product((-0.2, 0.2), (-0.1, 0.1))]
    mirrored = place_words([line * [-1, 1, 1] for line in lines])
    swap = {"left": "right", "right": "left"}
    there = [".".join(swap.get(w, w) for w in word.split(".")) for word in place_words(lines)]
    assert list(mirrored) == there
