"""Parts, sections, sets and plies of a deck, in every way they may be written."""

import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.io.lsdyna.deck.reader import read_keyword


def card(*fields, width=10):
    return "".join(str(field).rjust(width) for field in fields)


PART = ["*PART", "cover", card(1, 5)]
PARTS = [*PART, "*PART", "back", card(2, 5)]
SECTION = ["*SECTION_SHELL", card(5, 2), card(2, 2, 2, 2)]
SHELLS = ["*ELEMENT_SHELL", card(1, 1, 1, 2, 5, 4, width=8), card(2, 2, 2, 3, 6, 5, width=8)]
STRAINS = [
    "*INITIAL_STRAIN_SHELL",
    *(line for n in (1, 2) for line in (
        card(n, 1, 2), card(0, 0, 0, 0, 0, 0, -1), card(0.01, 0, 0, 0, 0, 0, 1))),
]  # fmt: skip


def deck(*, parts=PARTS, shells=SHELLS, strains=STRAINS, more=()):
    """Two squares of 10 mm in parts 1 and 2."""
    corners = [(0, 0, 0), (10, 0, 0), (20, 0, 0), (0, 10, 0), (10, 10, 0), (20, 10, 0)]
    nodes = [card(n, width=8) + card(*xyz, width=16) for n, xyz in enumerate(corners, 1)]
    lines = ["*KEYWORD", *parts, *SECTION, "*NODE", *nodes, *shells, *more, *strains, "*END", ""]
    return "\n".join(lines)


def thickness(result):
    """Thickness of all shells [mm]."""
    return (result.read(0).thickness * 1e3).round(9).tolist()


ZERO = card(0, 0, 0)
AXES = card(0, 0, 0, 0, 1)


@pytest.mark.parametrize(
    "parts",
    [
        ["*PART", "cover", card(1, 5), "back", card(2, 5)],
        ["*PART_CONTACT", "cover", card(1, 5), card(0.2), "back", card(2, 5), card(0.3)],
        ["*PART_INERTIA", "cover", card(1, 5), ZERO, ZERO, ZERO, "back", card(2, 5), ZERO, ZERO,
         ZERO],
        ["*PART_INERTIA", "cover", card(1, 5), AXES, ZERO, ZERO, ZERO, "back", card(2, 5), ZERO,
         ZERO, ZERO],
        ["*PART_INERTIA_CONTACT", "cover", card(1, 5), ZERO, ZERO, ZERO, ZERO, "back", card(2, 5),
         ZERO, ZERO, ZERO, ZERO],
        ["*PART_ATTACHMENT_NODES", "cover", card(1, 5), card(7), "back", card(2, 5), card(7)],
        ["*PART_PRINT", "cover", card(1, 5), card(1), "back", card(2, 5), card(1)],
        ["*PART_REPOSITION", "cover", card(1, 5), ZERO, "back", card(2, 5), ZERO],
    ],
    ids=lambda parts: parts[0],
)  # fmt: skip
def test_several_parts_under_one_keyword(write, parts):
    result = read_keyword(write("d.k", deck(parts=parts)))
    assert result.shells.part_names == {1: "cover", 2: "back"}
    assert thickness(result) == [2, 2]


@pytest.mark.parametrize(
    ("keyword", "plies"),
    [
        ("*PART_COMPOSITE", [card(7, 0.5, 0, 0, 7, 0.25, 90)]),
        ("*PART_COMPOSITE", [card(7, 0.25, 0, 0, 7, 0.25), card(7, 0.25)]),
        ("*PART_COMPOSITE_LONG", [card(7, 0.5, 0, 0, 1), card(7, 0.25, 90, 0, 2)]),
        ("*PART_COMPOSITE_CONTACT", [card(0.3), card(7, 0.5, 0, 0, 7, 0.25)]),
    ],
)
def test_a_composite_part_is_as_thick_as_its_plies(write, keyword, plies):
    """The second field of its card is no section, even where a section has that number."""
    parts = [*PART, keyword, "back", card(2, 5), *plies]
    result = read_keyword(write("d.k", deck(parts=parts)))
    assert thickness(result) == [2, 0.75]
    assert result.shells.part_names[2] == "back"


@pytest.mark.parametrize(
    ("keyword", "plies"),
    [
        ("*ELEMENT_SHELL_COMPOSITE", [card(7, 0.5, 0, "", 7, 0.25, 90.0)]),
        ("*ELEMENT_SHELL_COMPOSITE", [card(777, 0.25, 0, "", 7, 0.25), card(777, "2.5-1")]),
        ("*ELEMENT_SHELL_COMPOSITE", ["7, 0.5, 0, , 7, 0.25"]),
        ("*ELEMENT_SHELL_COMPOSITE_LONG", [card(7, 0.5, 0, 1), card(7, 0.25, 90, 2)]),
    ],
)
def test_composite_shells_are_as_thick_as_their_plies(write, keyword, plies):
    shells = [keyword, SHELLS[1], *plies, SHELLS[2], card(7, 0.5)]
    assert thickness(read_keyword(write("d.k", deck(shells=shells)))) == [0.75, 0.5]


def strain_set(number=7):
    return ["*INITIAL_STRAIN_SHELL_SET", card(number, 1, 2), *STRAINS[2:4]]


SET_7 = card(7)


@pytest.mark.parametrize(
    ("lines", "members"),
    [
        (["*SET_SHELL_LIST", SET_7, card(1, 2)], [1, 2]),
        (["*SET_SHELL", SET_7, card(2)], [2]),
        (["*SET_SHELL_LIST_TITLE", "a title", SET_7, card(2)], [2]),
        (["*SET_SHELL_LIST_GENERATE", SET_7, card(1, 1, 2, 9)], [1, 2]),
        (["*SET_SHELL_COLUMN", SET_7, card(2, 0, 0, 0, 0), card(1, 0, 0, 0, 0)], [1, 2]),
        (["*SET_SHELL_GENERAL", SET_7, card("ALL")], [1, 2]),
        (["*SET_SHELL_GENERAL", SET_7, card("ALL"), card("DELEM", 1)], [2]),
        (["*SET_SHELL_GENERAL", SET_7, card("PART", 2), card("ELEM", 1)], [1, 2]),
        (["*SET_SHELL_GENERAL", SET_7, card("ALL"), card("DPART", 2)], [1]),
        (["*SET_SHELL_LIST_COLLECT", SET_7, card(1), "*SET_SHELL_LIST_COLLECT", SET_7, card(2)],
         [1, 2]),
    ],
)  # fmt: skip
def test_strains_of_a_set(write, lines, members):
    result = read_keyword(write("d.k", deck(more=lines, strains=strain_set())))
    strained = result.read(0).strain_outer[:, 0, 0] == 0.01
    assert result.shells.element_ids[strained].tolist() == members


@pytest.mark.parametrize(
    ("lines", "strains", "message"),
    [
        ([], strain_set(), "d.k:21: *INITIAL_STRAIN_SHELL_SET: got set 7, expected a *SET_SHELL"),
        (["*SET_SHELL_GENERAL", SET_7, card("BOX", 1)], strain_set(),
         "d.k:21: *SET_SHELL_GENERAL: got set 7, of a kind that is not read, expected LIST,"),
        (["*SET_SHELL_LIST", SET_7, card(1)], [*strain_set(), *STRAINS],
         "*INITIAL_STRAIN_SHELL: got shell 1 more than once"),
        ([], ["*INITIAL_STRAIN_SHELL_NASTRAN"],
         "d.k:21: *INITIAL_STRAIN_SHELL_NASTRAN: got a kind of strains that is not read"),
    ],
)  # fmt: skip
def test_strains_that_reach_no_shell_are_named(write, lines, strains, message):
    with pytest.raises(InputError) as caught:
        read_keyword(write("d.k", deck(more=lines, strains=strains)))
    assert message in str(caught.value)


@pytest.mark.parametrize("levels", [("", ""), (-1, 1), (1, -1), (-0.5, 0.5)])
@pytest.mark.parametrize("plane", ["", 0, 1])
def test_points_without_their_number_are_inner_and_outer(write, plane, levels):
    values = [0.004 - 0.006 * (level or sign) for level, sign in zip(levels, (-1, 1), strict=True)]
    strains = ["*INITIAL_STRAIN_SHELL", card(1, plane)]
    strains += [
        card(round(v, 6), 0, 0, 0, 0, 0, level) for v, level in zip(values, levels, strict=True)
    ]
    state = read_keyword(write("d.k", deck(strains=strains)), parts=[1]).read(0)
    assert state.strain_inner[0, 0, 0] == pytest.approx(0.010)
    assert state.strain_outer[0, 0, 0] == pytest.approx(-0.002)


@pytest.mark.parametrize("width", [16, 20])
@pytest.mark.parametrize("last", [0.003, ""])
def test_wide_strains_are_as_wide_as_their_cards(write, width, last):
    strains = ["*INITIAL_STRAIN_SHELL"]
    for n in (1, 2):
        strains.append(card(n, 1, 2, 1))
        for level in (-1, 1):
            first = card(0.01 * level, 0.001, -0.002, 0.0005, last, width=width).rstrip()
            strains += [first, card(0.004, level, width=width)]
    outer = read_keyword(write("d.k", deck(strains=strains))).read(0).strain_outer[1]
    assert np.diagonal(outer).tolist() == pytest.approx([0.01, 0.001, -0.002])
    assert [outer[0, 1], outer[1, 2], outer[0, 2]] == pytest.approx([0.0005, last or 0, 0.004])


def test_the_unit_of_the_deck_is_heeded(write, problems):
    path = write("d.k", deck(more=["*CONTROL_UNITS", card("cm", "s", "kg")]))
    assert problems(read_keyword, path) == [
        "d.k:21: *CONTROL_UNITS: got LENGTH CM, expected mm, as it is to be read (say the unit of "
        "length)"
    ]
    assert thickness(read_keyword(path, length_unit="cm")) == [20, 20]
    blank = write("d.k", deck(more=["*CONTROL_UNITS", card("", "s", "kg")]))
    assert len(read_keyword(blank).shells) == 2


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"shells": ["*ELEMENT_SHELL_COMPOSITE", SHELLS[1], SHELLS[2], card(7, 0.5)]},
         "d.k:19: *ELEMENT_SHELL_COMPOSITE: got shell 1 without plies, expected plies with a"),
        ({"shells": ["*ELEMENT_SHELL_COMPOSITE", card(7, 0.5), SHELLS[1]]},
         "d.k:19: *ELEMENT_SHELL_COMPOSITE: got plies without a shell, expected a shell's card"),
        ({"parts": ["*PART_COMPOSITE", "cover", card(1, 2)]},
         "d.k:2: *PART_COMPOSITE: got no plies, expected a title, a part and its plies"),
        ({"parts": ["*PART", "cover", card(1, 5), "one line too many", "back", card(2, 5)]},
         "*PART: got 'back', expected a number"),
        ({"more": ["*PART_MOVE", card(1, 1, 0, 0)]}, "*PART_MOVE: got a keyword that is not"),
        ({"more": ["*NODE_THICKNESS", card(1, 2)]}, "*NODE_THICKNESS: got a keyword that is not"),
    ],
)  # fmt: skip
def test_what_cannot_be_read_is_named(write, change, message):
    with pytest.raises(InputError) as caught:
        read_keyword(write("d.k", deck(**change)))
    assert message in str(caught.value)


def test_a_deck_in_metres_is_not_taken_as_millimetres(write, problems):
    """A car of 4.5 m is 4.5 mm wide then, which a small sample may be; no cover is 2 um thick."""
    path = write("d.k", deck().replace(SECTION[-1], card(*["2.0-3"] * 4)))
    assert problems(read_keyword, path) == [
        "d.k: thickness: got 0.002 mm in the middle, expected 0.02 mm or more (say the unit of "
        "length)"
    ]
    assert read_keyword(path, thickness=0.001).read(0).thickness.tolist() == [0.001, 0.001]
