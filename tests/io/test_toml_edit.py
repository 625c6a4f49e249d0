"""Changes of a TOML text leave all else as it was, and say what was wanted."""

from __future__ import annotations

import tomllib

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from seatlook.io.toml_edit import add_row, add_table, drop, put, spelled_value

TEXT = """# The seat of the "left" side.
schema = 1   # never another
name = "a # b = c"

[pattern]
file = 'x.dxf'
layers = { "1" = "CUT", "2" = "SEW" }  # as drawn

# probability 0.97
[[seam]]
name = "one"
b = [
  "p", # first
  "q",
]

# probability 0.91
[[seam]]
name = "two"   # keep

[[rig]]
name = "sun"

[[rig.light]]
kind = "sun"

[edge."A.left side"]
from_mm = [1.0, 2.0]
"""
VALUES = st.recursive(
    st.booleans()
    | st.integers(-(2**40), 2**40)
    | st.floats(allow_nan=False, allow_infinity=False)
    | st.text(st.characters(exclude_categories=["Cs"]), max_size=12),
    lambda inner: st.lists(inner, max_size=3),
    max_leaves=6,
)
KEYS = st.sampled_from(
    [
        ("schema",),
        ("name",),
        ("new",),
        ("pattern", "file"),
        ("pattern", "layers", "1"),
        ("pattern", "new key"),
        ("seam", 0, "b"),
        ("seam", 1, "name"),
        ("seam", 1, "new"),
        ("rig", 0, "light", 0, "kind"),
        ("rig", 0, "lux"),
        ("edge", "A.left side", "from_mm"),
        ("edge", "new one", "panel"),
        ("fresh", "deep", "key"),
    ]
)


def with_value(data, key, value):
    node = data
    for part in key[:-1]:
        node = node.setdefault(part, {}) if isinstance(node, dict) else node[part]
    node[key[-1]] = value
    return data


@settings(max_examples=200, deadline=None)
@given(changes=st.lists(st.tuples(KEYS, VALUES), min_size=1, max_size=6), crlf=st.booleans())
def test_values_are_set_and_every_other_line_stays(changes, crlf):
    text = TEXT.replace("\n", "\r\n") if crlf else TEXT
    wanted, touched = tomllib.loads(text), set()
    for key, value in changes:
        text = put(text, key, value)
        wanted = with_value(wanted, key, value)
        touched.add(key[:-1] if key == ("pattern", "layers", "1") else key)
    assert tomllib.loads(text) == wanted
    lines = iter(text.splitlines())
    marks = {
        "schema = 1": ("schema",),
        'name = "a #': ("name",),
        "file =": ("pattern", "file"),
        "layers": ("pattern", "layers"),
        'name = "two"': ("seam", 1, "name"),
        "kind": ("rig", 0, "light", 0, "kind"),
        "from_mm": ("edge", "A.left side", "from_mm"),
    }
    # What was not touched is there, in its order; of the seam's list all three lines may go.
    for line in TEXT.splitlines():
        if line.strip() in ("b = [", '"p", # first', '"q",', "]") and ("seam", 0, "b") in touched:
            continue
        if not any(line.startswith(m) and key in touched for m, key in marks.items()):
            assert line in lines, line
    assert ("\r\n" in text) == crlf
    assert not crlf or "\n" not in text.replace("\r\n", "")


def test_a_comment_beside_a_value_stays():
    assert put(TEXT, ("schema",), 2) == TEXT.replace("schema = 1 ", "schema = 2 ")
    assert put(TEXT, ("seam", 1, "name"), "2") == TEXT.replace('"two"', '"2"')


@settings(max_examples=60, deadline=None)
@given(
    order=st.sampled_from([[0, 0, 0], [0, 1, 0], [1, 1, 0], [2, 0, 0], [2, 1, 0]]),
    crlf=st.booleans(),
)
def test_rows_come_and_go_with_their_comments(order, crlf):
    text = TEXT.replace("\n", "\r\n") if crlf else TEXT
    added = add_row(text, "seam", {"name": "three", "b": ["p"]}, "probability 0.95\nby hand")
    assert [row["name"] for row in tomllib.loads(added)["seam"]] == ["one", "two", "three"]
    assert drop(added, ("seam", 2)) == text
    names = ["one", "two", "three"]
    for number in order:
        added = drop(added, ("seam", number))
        del names[number]
        left = tomllib.loads(added).get("seam", [])
        assert [row["name"] for row in left] == names
        notes = {"one": "0.97", "two": "0.91", "three": "0.95"}
        assert {name for name, note in notes.items() if note in added} == {*names}
    rest = [line for line in TEXT.splitlines() if "[" in line and "seam" not in line]
    assert all(line in added for line in rest if line != "b = [")


def test_a_table_goes_with_what_is_below_it():
    assert tomllib.loads(drop(TEXT, ("rig", 0))).keys() == tomllib.loads(TEXT).keys() - {"rig"}
    assert "kind" not in drop(TEXT, ("rig", 0))


def test_a_table_is_added_beside_its_kin():
    added = add_table(TEXT, ("edge", "B"), {"panel": "x"})
    assert added == TEXT + '\n[edge.B]\npanel = "x"\n'
    with pytest.raises(KeyError):
        add_table(added, ("edge", "B"), {})


@pytest.mark.parametrize("key", [("seam", 7, "name"), ("name", "x"), ("seam", "name")])
def test_what_is_not_there_is_not_changed(key):
    with pytest.raises((KeyError, IndexError, TypeError)):
        put(TEXT, key, 1)
    with pytest.raises((KeyError, IndexError, TypeError)):
        drop(TEXT, key)


@pytest.mark.parametrize("value", [None, {1, 2}, object()])
def test_what_toml_has_nothing_for_is_refused(value):
    with pytest.raises(TypeError):
        spelled_value(value)
