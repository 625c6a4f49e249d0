"""Decks in several files: where they are sought, and where their shells go."""

import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.io.lsdyna.deck.reader import read_keyword

QUARTER = np.pi / 2


def card(*fields, width=10):
    return "".join(str(field).rjust(width) for field in fields)


def body(part=1, *, local=0):
    """One square of 10 mm, 2 mm thick, strained along x at the outer surface."""
    corners = [(0, 0, 0), (10, 0, 0), (10, 10, 0), (0, 10, 0)]
    nodes = [card(n, width=8) + card(*xyz, width=16) for n, xyz in enumerate(corners, 1)]
    return "\n".join([
        "*KEYWORD", "*PART", "cover", card(part, 5), "*SECTION_SHELL", card(5, 2), card(2, 2, 2, 2),
        "*NODE", *nodes, "*ELEMENT_SHELL", card(1, part, 1, 2, 3, 4, width=8),
        "*INITIAL_STRAIN_SHELL", card(1, 1, 2, 0, 0, 0, 0, local),
        card(0, 0, 0, 0, 0, 0, -1), card(0.01, 0, 0, 0.002, 0, 0, 1), "*END", "",
    ])  # fmt: skip


def transform(name, offsets=(0,) * 7, other=0, length=1.0, number=0):
    return "\n".join([
        "*INCLUDE_TRANSFORM", name, card(*offsets), card(other), card(1, 1, length, 1), card(number)
    ])  # fmt: skip


def definition(number, *rows):
    return "\n".join(["*DEFINE_TRANSFORMATION", card(number), *(card(*row) for row in rows)])


def deck(*blocks):
    return "\n".join(["*KEYWORD", *blocks, "*END", ""])


@pytest.mark.parametrize(
    ("place", "lines"),
    [
        ("sub/body.k", "*INCLUDE\nsub\\body.k"),
        ("sub/body.k", "*INCLUDE\n.\\sub\\Body.K"),
        ("a long name/body.k", "*INCLUDE\na long +\n name/bo +\ndy.k"),
        ("a/b/body.k", "*INCLUDE_PATH_RELATIVE\na\\b\n*INCLUDE\nbody.k"),
        ("a/b/body.k", "*INCLUDE_PATH\nnowhere\na\n*INCLUDE\nb/body.k"),
        ("Bezüge/body.k", "*INCLUDE\nBezüge\\body.k"),
    ],
)
def test_an_included_file_is_found(write, tmp_path, place, lines):
    if "\n name" in lines:
        place = "a longname/body.k"
    (tmp_path / place).parent.mkdir(parents=True)
    write(place, body())
    assert len(read_keyword(write("main.k", deck(lines))).shells) == 1


def test_files_are_sought_beside_the_deck_that_names_them(write, tmp_path):
    (tmp_path / "sub").mkdir()
    write("sub/body.k", body())
    write("sub/inner.k", deck("*INCLUDE\nbody.k"))
    assert len(read_keyword(write("main.k", deck("*INCLUDE\nsub/inner.k"))).shells) == 1
    write("sub/inner.k", deck("*INCLUDE\nsub/body.k"))  # beside the first deck
    assert len(read_keyword(write("main.k", deck("*INCLUDE\nsub/inner.k"))).shells) == 1


def test_numbers_and_lengths_are_changed(write):
    """The same file twice, in centimetres the second time, within a file that adds too."""
    write("body.k", body())
    inner = transform("body.k", (100, 200, 300, 0, 0, 0, 0), 400, length=10.0)
    write("inner.k", deck(inner))
    outer = transform("inner.k", (1000, 2000, 3000, 0, 0, 0, 0), 4000)
    result = read_keyword(write("main.k", deck("*INCLUDE\nbody.k", outer)))
    assert result.shells.element_ids.tolist() == [1, 2201]
    assert result.shells.part.tolist() == [1, 3301]
    assert result.shells.part_names == {1: "cover", 3301: "cover"}
    state = result.read(0)
    np.testing.assert_allclose(state.thickness, [2e-3, 20e-3])
    np.testing.assert_allclose(np.ptp(state.positions[4:], axis=0), [0.1, 0.1, 0], atol=1e-15)
    assert result.notes == ()


ROTATE = ("ROTATE", 0, 0, 1, 0, 0, 0, 90)


@pytest.mark.parametrize(
    ("rows", "corner", "strain"),
    [
        ([("TRANSL", 1, 2, 3)], (11, 2, 3), (0.01, 0, 0.002)),
        ([("ROTATE", 0, 0, 1, 10, 0, 0, 90)], (10, 0, 0), (0, 0.01, -0.002)),
        ([("TRANSL", 1, 2, 3), ROTATE], (-2, 11, 3), (0, 0.01, -0.002)),
        ([ROTATE, ("TRANSL", 1, 2, 3)], (1, 12, 3), (0, 0.01, -0.002)),
        ([("SCALE", 2, 2, 2)], (20, 0, 0), (0.01, 0, 0.002)),
        ([("POINT", 1, 0, 0, 0), ("POINT", 2, 0, 0, 5), ("ROTATE", 1, 2, 90)], (0, 10, 0),
         (0, 0.01, -0.002)),
        ([("POINT", 1, 0, 0, 0), ("POINT", 2, 1, 0, 0), ("POINT", 3, 0, 1, 0),
          ("POINT", 4, 5, 0, 0), ("POINT", 5, 5, 3, 0), ("POINT", 6, 4, 0, 0),
          ("POS6P", 1, 2, 3, 4, 5, 6)], (5, 10, 0), (0, 0.01, -0.002)),
    ],
)  # fmt: skip
@pytest.mark.parametrize("before", [True, False])
def test_a_transformation_moves_places_and_turns_strains(write, rows, corner, strain, before):
    """Its definition may stand before or behind the file that it moves."""
    write("body.k", body())
    blocks = [definition(9, *rows), transform("body.k", number=9)]
    result = read_keyword(write("main.k", deck(*(blocks if before else blocks[::-1]))))
    state = result.read(0)
    np.testing.assert_allclose(state.positions[1] * 1e3, corner, atol=1e-12)
    xx, yy, xy = strain
    expected = [[[xx, xy, 0], [xy, yy, 0], [0, 0, 0]]]
    np.testing.assert_allclose(state.strain_outer, expected, atol=1e-15)
    assert state.thickness.tolist() == [2e-3]
    names = ", ".join(row[0] for row in rows if row[0] != "POINT")
    assert result.notes == (
        f"a file of *INCLUDE_TRANSFORM is moved by *DEFINE_TRANSFORMATION 9: {names}, in this "
        "order; strains in global axes are turned with it, and the thickness stays",
    )


def test_strains_in_axes_of_the_shell_are_not_turned(write):
    write("body.k", body(local=1))
    main = write("main.k", deck(definition(9, ROTATE), transform("body.k", number=9)))
    assert read_keyword(main).read(0).strain_outer[0, 0, 0] == 0.01


def test_random_chains_of_transformations(write):
    """Lengths of sides and invariants of strain stay; nested files move as one matrix says."""
    rng = np.random.default_rng(4)
    write("body.k", body())
    for _ in range(30):
        shift, axis = rng.integers(-9, 9, 3), rng.integers(1, 9, 3)
        rows = [("ROTATE", *axis, *shift, int(rng.integers(1, 360))), ("TRANSL", *shift)]
        write("inner.k", deck(transform("body.k", number=9)))
        outer = transform("inner.k", (0, 0, 0, 0, 0, 0, 0), number=9)
        main = write("main.k", deck(outer, definition(9, *rows)))
        state = read_keyword(main).read(0)
        side = np.linalg.norm(np.diff(state.positions, axis=0), axis=1)
        np.testing.assert_allclose(side, 0.01, rtol=1e-12)
        strain = state.strain_outer[0]
        assert np.trace(strain) == pytest.approx(0.01)
        assert np.linalg.norm(strain) == pytest.approx(np.hypot(0.01, np.sqrt(2) * 0.002))
        along = state.positions[1] - state.positions[0]
        assert along @ strain @ along == pytest.approx(0.01 * along @ along)


@pytest.mark.parametrize(
    ("blocks", "message"),
    [
        ([transform("body.k", number=8)],
         "main.k:2: *INCLUDE_TRANSFORM: got TRANID 8, expected a *DEFINE_TRANSFORMATION"),
        ([transform("body.k", number=9), definition(9, ("MIRROR", 0, 0, 0, 1, 0, 0, 0))],
         "main.k:10: *DEFINE_TRANSFORMATION: got MIRROR, expected SCALE, ROTATE, TRANSL,"),
        ([transform("body.k", number=9), definition(9, ("SCALE", 1, 2, 1))],
         "main.k:2: *INCLUDE_TRANSFORM: got a mirror or unequal scales, expected rotations,"),
        ([transform("body.k", number=9), definition(9, ("SCALE", -1, 1, 1))],
         "main.k:2: *INCLUDE_TRANSFORM: got a mirror or unequal scales, expected rotations,"),
        ([transform("body.k", number=9), definition(9, ("ROTATE", 1, 2, 90))],
         "main.k:10: *DEFINE_TRANSFORMATION: got ROTATE with point 1, expected a point of"),
        ([transform("body.k", number=9), definition(9, ("ROTATE", 0, 0, 0, 1, 0, 0, 90))],
         "main.k:10: *DEFINE_TRANSFORMATION: got ROTATE: no direction, expected a direction"),
        (["*INCLUDE\nbody.k", "*INCLUDE\nbody.k"],
         "main.k:5: *INCLUDE: got 'body.k' again, expected each file once"),
        ([transform("main.k")], "*INCLUDE_TRANSFORM: got 'main.k' again, expected each file once"),
        ([transform("body.k") + "\nbody.k"],
         "main.k:8: *INCLUDE_TRANSFORM: got more than five cards, expected one file, offsets,"),
        (["*INCLUDE\nC:\\users\\x\\body.k"],
         "main.k:3: *INCLUDE: got 'C:/users/x/body.k', expected a readable file (sought beside"),
    ],
)  # fmt: skip
def test_what_is_not_followed_is_named(write, blocks, message):
    write("body.k", body())
    with pytest.raises(InputError) as caught:
        read_keyword(write("main.k", deck(*blocks)))
    assert message in str(caught.value)
