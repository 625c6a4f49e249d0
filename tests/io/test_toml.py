import tomllib

import pytest
from hypothesis import given
from hypothesis import strategies as st

from seatlook.io.schema import (
    Array,
    Flag,
    Integer,
    Named,
    Number,
    Rows,
    Table,
    Text,
    Texts,
    read_table,
)
from seatlook.io.toml import index_lines, read_document

TEXT = '''# comment
schema = 1
"quoted.key" = "a [ b # c"

[pattern]   # with a comment
file = "a.dxf"
size.large = 3

[[rig]]
name = "one"
[[rig.light]]
kind = "sun"
[[rig.light]]
kind = "bulb"
position_mm = [
    1, # ]
    2,
    3,
]
after = 1
[[rig]]
text = """
[not_a_table]
x = 1
"""
last = { a = 1, b = [{ c = 2 }, { c = 3 }] }
[rig.sky]
lux = 5
'''


def test_index_names_the_line_of_every_key():
    lines = index_lines(TEXT)
    rows = TEXT.splitlines()
    for key, start in {
        ("schema",): "schema",
        ("quoted.key",): '"quoted.key"',
        ("pattern",): "[pattern]",
        ("pattern", "file"): "file",
        ("pattern", "size", "large"): "size.large",
        ("rig", 0): "[[rig]]",
        ("rig", 0, "name"): "name",
        ("rig", 0, "light", 1, "kind"): 'kind = "bulb"',
        ("rig", 0, "light", 1, "position_mm"): "position_mm",
        ("rig", 0, "light", 1, "after"): "after",
        ("rig", 1, "text"): "text",
        ("rig", 1, "last", "b", 1, "c"): "last",
        ("rig", 1, "sky", "lux"): "lux",
    }.items():
        assert rows[lines[key] - 1].startswith(start), key
    assert lines["rig", 1] == 21


@given(
    st.dictionaries(
        st.from_regex(r"[a-z_-]{1,6}", fullmatch=True),
        st.one_of(st.integers(-5, 5), st.text("ab[]{}#'=\n", max_size=6), st.booleans()),
        max_size=6,
    )
)
def test_index_finds_all_keys_whatever_the_strings_hold(values):
    def spell(v):
        if isinstance(v, bool):
            return str(v).lower()
        return str(v) if isinstance(v, int) else '"' + v.replace("\n", "\\n") + '"'

    text = "".join(f"{k} = {spell(v)}\n" for k, v in values.items())
    assert tomllib.loads(text) == values
    assert index_lines(text) == {(k,): i for i, k in enumerate(values, start=1)}


def test_long_array_is_indexed_in_linear_time():
    text = "points = [\n" + "  [1.0, 2.0],\n" * 20_000 + "]\nlast = 1\n"
    assert index_lines(text)["last",] == 20_003


def test_syntax_error_has_its_line(write, problems):
    path = write("a.toml", "a = 1\nb = = 2\n")
    assert problems(read_document, path) == [
        "a.toml:2: syntax: got invalid value, expected valid TOML"
    ]


def test_syntax_error_at_the_end_has_the_last_line(write, problems):
    (message,) = problems(read_document, write("a.toml", "a = 1\nb = [1,\n"))
    assert message.startswith("a.toml:3: syntax: got ")


def test_duplicate_key(write, problems):
    (message,) = problems(read_document, write("a.toml", "a = 1\na = 2\n"))
    assert message == "a.toml:2: syntax: got cannot overwrite a value, expected valid TOML"


def test_missing_file(tmp_path, problems):
    assert problems(read_document, tmp_path / "none.toml") == [
        "none.toml: file: got no such file, expected a file"
    ]


def test_folder_instead_of_file(tmp_path, problems):
    (message,) = problems(read_document, tmp_path)
    assert message.endswith("file: got a folder, expected a file")


def test_not_utf8(tmp_path, problems):
    path = tmp_path / "a.toml"
    path.write_bytes(b"a = 1\nb = '\xe9'\n")
    assert problems(read_document, path) == [
        "a.toml:2: encoding: got byte 0xe9, expected UTF-8 (save it as UTF-8)"
    ]


KEYS = {
    "count": Integer(low=1, high=9, required=True),
    "size_mm": Number(above=0, high=10, scale=1e-3, default=2.0),
    "on": Flag(default=True),
    "mode": Text(choices=("paper", "tensor"), default="tensor"),
    "names": Texts(or_one=True),
    "place": Array(shape=(2,)),
    "row": Rows(Table({"name": Text(required=True)})),
    "edge": Named(Table({"from_mm": Array(shape=(2,), required=True)})),
}


def read(path):
    document = read_document(path)
    row = read_table(document, KEYS)
    document.finish()
    return row


def test_values_are_converted_and_defaults_filled(write):
    row = read(write("a.toml", 'count = 3\nnames = "x"\nplace = [1, 2.5]\n[[row]]\nname = "r"\n'))
    assert row["count"] == 3
    assert row["size_mm"] == 0.002
    assert row["on"] is True
    assert row["names"] == ("x",)
    assert row["place"].tolist() == [1.0, 2.5]
    assert row["row"] == [{"name": "r"}]
    assert row["edge"] == {}


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("cuont = 2", "cuont: got unknown key, expected one of count, size_mm, on, mode, names, "
                      "place, row, edge (did you mean 'count'?)"),
        ("count = 2.5", "count: got 2.5, expected a whole number"),
        ("count = true", "count: got true, expected a whole number"),
        ("count = 12", "count: got 12, expected 1 to 9"),
        ('size_mm = "2"', "size_mm: got '2', expected a number"),
        ("size_mm = nan", "size_mm: got nan, expected a finite number"),
        ("size_mm = 0", "size_mm: got 0, expected a number above 0 and at most 10"),
        ("on = 1", "on: got 1, expected true or false"),
        ('mode = "papr"', "mode: got 'papr', expected one of paper, tensor "
                          "(did you mean 'paper'?)"),
        ("names = []", "names: got [], expected a text or a list of texts"),
        ("place = [1, 2, 3]", "place: got [1, 2, 3], expected an array of 2 numbers"),
        ("place = [1, true]", "place: got [1, True], expected an array of 2 numbers"),
        ("place = [1, inf]", "place: got [1, inf], expected finite numbers"),
        ("row = 3", "row: got 3, expected an array of tables, [[row]]"),
        ("edge = 3", "edge: got 3, expected tables with names"),
        ("[edge]\nE = 4", "edge.E: got 4, expected a table"),
        ("[[row]]\nname = 'a'\n[[row]]\nname = 'a'",
         "row[1].name: got 'a', expected a name not used before (line 3)"),
    ],
)  # fmt: skip
def test_each_kind_says_what_it_wants(write, problems, line, message):
    head = "" if line.startswith("count =") else "count = 1\n"
    path = write("a.toml", f"# head\n{head}{line}\n")
    assert [g.split(": ", 1)[1] for g in problems(read, path)] == [message]


def test_all_problems_are_reported_in_the_order_of_the_file(write, problems):
    path = write("a.toml", "on = 3\n\n[edge.left]\nfrom = [1, 2]\n[[row]]\n")
    assert problems(read, path) == [
        "a.toml: count: got nothing, expected a whole number",
        "a.toml:1: on: got 3, expected true or false",
        "a.toml:3: edge.left.from_mm: got nothing, expected an array of numbers",
        "a.toml:4: edge.left.from: got unknown key, expected one of from_mm "
        "(did you mean 'from_mm'?)",
        "a.toml:5: row[0].name: got nothing, expected a text",
    ]
