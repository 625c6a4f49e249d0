"""*PARAMETER in decks: every field may hold a name instead of a number."""

import pytest

from seatlook.io.lsdyna.deck.reader import read_keyword

DECK = """*KEYWORD
{parameters}
*PART
cover
         1         1         1
*SECTION_SHELL
         1         2       1.0         2
{t}{t}{t}{t}
*NODE
       1             0.0             0.0             0.0
       2            {x:>4}             0.0             0.0
       3            {x:>4}            10.0             0.0
       4             0.0            10.0             0.0
*ELEMENT_SHELL
       1       1       1       2       3       4
*INITIAL_STRAIN_SHELL
         1         1         2         0
 {e:>9} 0.000E+00 0.000E+00 0.000E+00 0.000E+00 0.000E+00-1.000E+00
-5.000E-03 0.000E+00 0.000E+00 0.000E+00 0.000E+00 0.000E+00 1.000E+00
*END
"""


def deck(write, parameters, *, t="    &thick", x="10.0", e="5.000E-03"):
    return write("d.k", DECK.format(parameters=parameters, t=t, x=x, e=e))


@pytest.mark.parametrize(
    "parameters",
    [
        "*PARAMETER\nR   thick       1.5",
        "*PARAMETER\nRTHICK          1.5",
        "*PARAMETER\nR    THICK     1.5+0I   number         4",
        "*PARAMETER\nR thick,1.5",
        "*PARAMETER\nI      one         1R    thick       1.5\nR   other       9.0",
        "*PARAMETER\nR   thick       1.5\n*PARAMETER\nR   thick       9.0",
        "*PARAMETER_LOCAL\nR   thick       1.5",
    ],
)
def test_a_name_stands_for_its_value(write, parameters):
    state = read_keyword(deck(write, parameters)).read(0)
    assert state.thickness.tolist() == pytest.approx([0.0015])


@pytest.mark.parametrize(("field", "value"), [("&e", "-4.0E-3"), ("-&e", "4.0E-3")])
def test_in_any_field_and_with_a_sign(write, field, value):
    parameters = f"*PARAMETER\nR        e{value:>10}R        x      12.0"
    state = read_keyword(deck(write, parameters, t="       1.0", x="&x", e=field)).read(0)
    assert state.strain_inner[0, 0, 0] == pytest.approx(-0.004)
    assert state.positions[:, 0].max() == pytest.approx(0.012)


@pytest.mark.parametrize(
    ("parameters", "message"),
    [
        ("*PARAMETER\nR   other       1.5", "got '&thick', expected a number (*PARAMETER does not"),
        ("*PARAMETER_EXPRESSION\nR   thick 2.0*1.5", "expressions are not read: write the number"),
        ("*PARAMETER\nX   thick       1.5", "expected R, I or C, a name, and its value"),
        ("*PARAMETER\nR   thick", "expected R, I or C, a name, and its value"),
        ("*PARAMETER\nR   thick      soft", "*SECTION_SHELL: got '&thick', expected a number"),
    ],
)
def test_what_stands_for_no_number_is_named(write, problems, parameters, message):
    (said,) = problems(read_keyword, deck(write, parameters))
    assert message in said
