"""The keyword reader: one small deck in every format, and a line number for every fault."""

from pathlib import Path

import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.io.lsdyna.deck.reader import read_keyword

DATA = Path(__file__).parents[3] / "data"

# One quadrilateral 1-2-3-4 and one triangle 2-5-3, 10 mm wide; t = 1.2 mm.
NODES = [(1, 0, 0), (2, 10, 0), (3, 10, 10), (4, 0, 10), (5, 20, 0)]
POINTS = [(-1.0, -0.0015), (1.0, 0.0025)]  # level T, strain xx


def card(*fields, widths):
    return "".join(str(f).rjust(w) for f, w in zip(fields, widths, strict=True))


def deck(*, strains=None, thickness="section", long=False, header="*KEYWORD", end="*END\n"):
    """The deck in standard or LONG=Y format."""
    i, c, w = (20, 20, 20) if long else (8, 16, 10)
    lines = [f"{header} LONG=Y" if long else header, "*NODE", "$ a comment"]
    lines += [card(n, x, y, 0.5, widths=[i, c, c, c]) for n, x, y in NODES]
    shells = [(7, 3, 1, 2, 3, 4), (9, 3, 2, 5, 3, 3)]
    lines.append("*ELEMENT_SHELL" + ("_THICKNESS" if thickness == "own" else ""))
    for shell in shells:
        lines.append(card(*shell, widths=[i] * 6))
        if thickness == "own":
            lines.append(card(1.2, 1.1, 1.3, 1.2, widths=[c] * 4))
    if thickness == "section":
        lines += ["*PART", "Insert", card(3, 8, 1, widths=[w] * 3)]
        lines += ["*SECTION_SHELL", card(8, 2, 1.0, 3, widths=[w] * 4)]
        lines += [card(1.2, 1.2, 1.2, 1.2, widths=[w] * 4)]
    lines += strain_cards(w) if strains is None else strains
    return "\n".join(lines) + "\n" + end


def strain_cards(w=10):
    lines = ["*INITIAL_STRAIN_SHELL"]
    for element in (7, 9):
        lines.append(card(element, 1, 2, 0, "", "", "", 0, widths=[w] * 8))
        for level, xx in POINTS:
            lines.append(card(xx, 0.001, -0.0005, 0.0002, 0, 0, level, widths=[w] * 7))
    return lines


def assert_read(result, inner=-0.0015, outer=0.0025):
    assert result.shells.element_ids.tolist() == [7, 9]
    assert result.shells.part.tolist() == [3, 3]
    assert result.shells.corners.tolist() == [[0, 1, 2, 3], [1, 4, 2, 2]]
    state = result.read(0)
    expected = [[0, 0, 0.5], [10, 0, 0.5], [10, 10, 0.5], [0, 10, 0.5], [20, 0, 0.5]]
    np.testing.assert_allclose(state.positions, np.array(expected) * 1e-3)
    np.testing.assert_allclose(state.thickness, 0.0012)
    for strain, xx in ((state.strain_inner, inner), (state.strain_outer, outer)):
        tensor = [[xx, 0.0002, 0], [0.0002, 0.001, 0], [0, 0, -0.0005]]
        np.testing.assert_allclose(strain, [tensor, tensor], atol=1e-15)


@pytest.mark.parametrize("long", [False, True])
@pytest.mark.parametrize("thickness", ["section", "own"])
def test_standard_and_long_format(write, long, thickness):
    result = read_keyword(write("d.k", deck(long=long, thickness=thickness)))
    assert_read(result)
    assert result.shells.part_names.get(3, "Insert") == "Insert"


def test_free_format_and_short_exponents(write):
    text = deck(strains=[
        "*INITIAL_STRAIN_SHELL",
        "7,1,2,0", "-1.5-3,1.-3,-5.E-4,2d-4,0,0,-1", "2.5-3,1.0-3,-5-4,2.-4,,,1.",
        "9, 1, 2, 0", "-.15-2,1e-3,-5e-4,2.-4,0,0,-1", "+2.5-3,1.-3,-5e-4,2.-4,0,0,1",
    ])  # fmt: skip
    node = card(5, 20, 0, 0.5, widths=[8, 16, 16, 16])
    assert_read(read_keyword(write("d.k", text.replace(node, "5,20., 0,5.-1"))))


def test_large_format_and_points_inside_the_thickness(write):
    """Gauss points at 0.5 and at four places of the plane: the line runs on to the surfaces."""
    lines = ["*INITIAL_STRAIN_SHELL"]
    for element in (7, 9):
        lines.append(card(element, 2, 2, 1, widths=[10] * 4))
        for shift in (-1e-4, 1e-4):
            for level in (-0.5, 0.5):
                xx = round(0.0005 + 0.002 * level + shift, 6)
                lines.append(card(xx, 0.001, -0.0005, 0.0002, 0, widths=[16] * 5))
                lines.append(card(0, level, widths=[16] * 2))
    assert_read(read_keyword(write("d.k", deck(strains=lines))))


@pytest.mark.parametrize("ending", ["+", " +"])
def test_one_keyword_in_long_format(write, ending):
    text = deck(thickness="own").replace("*ELEMENT_SHELL_THICKNESS", f"*ELEMENT_SHELL{ending}")
    rows = [card(*s, widths=[20] * 6) for s in ((7, 3, 1, 2, 3, 4), (9, 3, 2, 5, 3, 3))]
    head, _, tail = text.partition(f"*ELEMENT_SHELL{ending}\n")
    tail = tail[tail.index("*INITIAL") :]
    path = write("d.k", head + f"*ELEMENT_SHELL{ending}\n" + "\n".join(rows) + "\n" + tail)
    assert_read(read_keyword(path, thickness=0.0012))


def test_ten_wide_numbers(write):
    text = deck().replace("*KEYWORD", "*KEYWORD I10=Y")
    for n, x, y in NODES:
        old = card(n, x, y, 0.5, widths=[8, 16, 16, 16])
        text = text.replace(old, card(n, x, y, 0.5, widths=[10, 16, 16, 16]))
    for shell in ((7, 3, 1, 2, 3, 4), (9, 3, 2, 5, 3, 3)):
        text = text.replace(card(*shell, widths=[8] * 6), card(*shell, widths=[10] * 6))
    assert_read(read_keyword(write("d.k", text)))


def test_includes_are_followed_and_loops_are_named(write, problems):
    text = deck()
    nodes = text[text.index("*NODE") : text.index("*ELEMENT")]
    write("nodes.k", nodes)
    main = write("d.k", text.replace(nodes, "*INCLUDE\nnodes.k\n"))
    assert_read(read_keyword(main))
    write("nodes.k", "*INCLUDE\nd.k\n")
    assert problems(read_keyword, main) == [
        "nodes.k:2: *INCLUDE: got 'd.k' again, expected each file once"
    ]
    main.write_text("*KEYWORD\n*INCLUDE\nabsent.k\n")
    assert problems(read_keyword, main) == [
        "d.k:3: *INCLUDE: got 'absent.k', expected a readable file (sought beside the decks and "
        "in *INCLUDE_PATH)"
    ]


def test_the_dynain_sample(problems):
    path = DATA / "bent_strip_dynain.k"
    result = read_keyword(path, thickness=0.0012)
    assert len(result.shells) == 800
    assert np.linalg.norm(result.read(0).strain_outer, axis=(1, 2)) == pytest.approx(
        np.full(800, 0.012 * np.sqrt(2)), rel=2e-3
    )
    assert problems(read_keyword, path) == [
        "bent_strip_dynain.k: thickness: got none for 800 shells of part 1, first 1, expected "
        "*SECTION_SHELL, *PART_COMPOSITE or *ELEMENT_SHELL_THICKNESS of this part (or say the "
        "thickness)"
    ]


def test_a_shell_without_an_entry_is_unstrained_and_told(write):
    result = read_keyword(write("d.k", deck(strains=strain_cards()[:4])))
    assert (result.read(0).strain_outer[1] == 0).all()
    assert result.notes == (
        "1 shells have no strains in the deck and count as unstrained: part 3 'Insert'",
    )


def test_no_strains_need_a_reference(write, problems):
    path = write("d.k", deck(strains=[]))
    assert problems(read_keyword, path) == [
        "d.k: *INITIAL_STRAIN_SHELL: got none for these shells, expected strains on at least two "
        "levels of the thickness, or a reference deck"
    ]
    result = read_keyword(path, reference=write("flat.k", deck()))
    assert result.read(0).strain_inner is None
    assert result.notes == ("the deck has no strains: curvature is taken from the geometry",)
    short = write("short.k", deck().replace(card(5, 20, 0, 0.5, widths=[8, 16, 16, 16]), ""))
    short.write_text(short.read_text().replace("\n\n", "\n"))
    assert problems(read_keyword, path, reference=short) == [
        "short.k: *NODE: got 1 nodes missing, first 5, expected the nodes of the deformed deck"
    ]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (("*KEYWORD", "KEYWORD"), "d.k: file: got no keyword on the first line"),
        (("*NODE", "*NODES"), "d.k: *NODE: got none, expected nodes"),
        (("*ELEMENT_SHELL", "*ELEMENT_SOLID"), "d.k: *ELEMENT_SHELL: got none, expected shells"),
        (("*ELEMENT_SHELL", "*ELEMENT_SHELL_DOF"),
         "d.k:9: *ELEMENT_SHELL_DOF: got option DOF, expected THICKNESS, BETA, MCID, OFFSET or"),
        (("              10               0", "              1O               0"),
         "d.k:5: *NODE: got '1O', expected a number"),
        (("              10               0", "             nan               0"),
         "d.k:5: *NODE: got nan or inf, expected numbers"),
        (("       5              20", "       4              20"),
         "d.k: *NODE: got number 4 more than once"),
        (("       9       3       2       5", "       9       3       2      77"),
         "d.k: *ELEMENT_SHELL: got 1 shells on unknown nodes, first 9"),
        (("       9       3       2", "       7       3       2"),
         "d.k: *ELEMENT_SHELL: got number 7 more than once"),
        (("       9       3       2", "     9.5       3       2"),
         "d.k:11: *ELEMENT_SHELL: got '9.5', expected a whole number"),
        (("       1.2       1.2       1.2       1.2", "         0"),
         "d.k: thickness: got none for 2 shells of part 3 'Insert', first 7"),
        (("       1.2       1.2       1.2       1.2", "    &thick"),
         "d.k:17: *SECTION_SHELL: got '&thick', expected a number (*PARAMETER does not define"),
        (("         7         1         2", "         7         1         1"),
         "d.k:21: *INITIAL_STRAIN_SHELL: got '0.0025', expected a whole number"),
        (("         7         1         2", "         7       100         2"),
         "d.k:19: *INITIAL_STRAIN_SHELL: got number 7, NPLANE 100, NTHICK 2, LARGE 0, expected a"),
        (("         7         1         2", "                   1         2"),
         "d.k:19: *INITIAL_STRAIN_SHELL: got number 0, NPLANE 1, NTHICK 2, LARGE 0, expected a"),
        (("         9         1         2", "         7         1         2"),
         "d.k: *INITIAL_STRAIN_SHELL: got shell 7 more than once, expected one entry for each"),
        (("*NODE", "*NODE_TRANSFORM\n*NODE"),
         "d.k:2: *NODE_TRANSFORM: got a keyword that is not followed, expected no nodes that"),
        (("*NODE", "*INCLUDE_NASTRAN\na.nas\n*NODE"),
         "d.k:2: *INCLUDE_NASTRAN: got a kind of include that is not read, expected *INCLUDE,"),
        (("         7         1         2", "         7         1         9"),
         "d.k:19: *INITIAL_STRAIN_SHELL: got too few cards, expected 9 cards of strains"),
        (("         0         0       1.0", "         0         0        -1"),
         "d.k:18: *INITIAL_STRAIN_SHELL: got one level of thickness for shell 7"),
    ],
)  # fmt: skip
def test_faults_are_named_with_their_line(write, change, message):
    text = deck()
    assert change[0] in text
    path = write("d.k", text.replace(*change, 1))
    with pytest.raises(InputError) as caught:
        read_keyword(path)
    assert message in str(caught.value).replace(str(path.parent) + "/", "")


def test_binary_data_is_no_deck(tmp_path, problems):
    path = tmp_path / "d.k"
    path.write_bytes(b"*KEYWORD\n*NODE\n\0\0")
    assert problems(read_keyword, path) == [
        "d.k: file: got binary data, expected a keyword deck in text"
    ]


@pytest.mark.validate
def test_ten_thousand_damaged_decks_give_an_input_error_or_a_result(tmp_path):
    rng = np.random.default_rng(2)
    good = [deck().encode(), deck(long=True, thickness="own").encode()]
    path = tmp_path / "d.k"
    refused = 0
    for k in range(10_000):
        content = bytearray(good[k % 2])
        for _ in range(rng.integers(1, 4)):
            kind, at = rng.integers(5), int(rng.integers(len(content)))
            if kind == 0:
                content[at] = rng.integers(256)
            elif kind == 1:
                content[at : at + 1] = rng.choice([b"1e999", b"-", b",", b"*", b"\n", b"nan", b"&"])
            elif kind == 2:
                del content[at : at + int(rng.integers(1, 60))]
            elif kind == 3:
                content[at:at] = content[at : at + int(rng.integers(1, 200))]
            else:
                del content[at:]
            if len(content) < 2:
                break
        path.write_bytes(content)
        try:
            state = read_keyword(path).read(0)
            assert np.isfinite(state.strain_inner).all()
        except InputError:
            refused += 1
    assert refused > 3000
