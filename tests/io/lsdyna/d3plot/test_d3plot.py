"""The d3plot reader: exact values behind every shift, and a name for everything it refuses."""

from pathlib import Path

import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.io.lsdyna.d3plot.reader import read_d3plot
from seatlook.io.lsdyna.shells import read_shells
from support.d3plot_samples import d3plot, quad_strip

DATA = Path(__file__).parents[3] / "data"
NODES, SHELLS = quad_strip()
E, N = len(SHELLS), len(NODES)


def states(count=2, seed=0):
    rng = np.random.default_rng(seed)
    return [
        (0.5 * k, NODES + rng.normal(0, 0.1, NODES.shape), rng.uniform(1, 2, E),
         rng.normal(0, 0.01, (E, 6)), rng.normal(0, 0.01, (E, 6)))
        for k in range(count)
    ]  # fmt: skip


@pytest.fixture
def save(tmp_path):
    def save(content, name="d3plot"):
        path = tmp_path / name
        path.write_bytes(content)
        return path

    return save


def assert_read(result, written, *, rows=slice(None), rtol=1e-6):
    """Thickness, positions and all 12 strain components arrive, in metres."""
    assert len(result) == len(written)
    for state, (time, positions, t, inner, outer) in zip(result, written, strict=True):
        assert state.time == pytest.approx(time)
        used = np.unique(SHELLS[rows]) - 1
        np.testing.assert_allclose(state.positions, positions[used] * 1e-3, rtol=rtol, atol=1e-8)
        np.testing.assert_allclose(state.thickness, t[rows] * 1e-3, rtol=rtol)
        for tensor, six in ((state.strain_inner, inner), (state.strain_outer, outer)):
            xx, yy, zz, xy, yz, zx = six[rows].T
            expected = np.array([[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]]).transpose(2, 0, 1)
            np.testing.assert_allclose(tensor, expected, rtol=rtol, atol=1e-9)


@pytest.mark.parametrize("word", ["<i4", ">i4", "<i8", ">i8"])
def test_word_sizes_and_byte_orders(save, word):
    written = states()
    result = read_d3plot(save(d3plot(NODES, SHELLS, written, word=word)))
    assert_read(result, written, rtol=1e-6 if word.endswith("4") else 1e-12)
    assert result.shells.element_ids.tolist() == list(range(101, 101 + E))
    assert set(result.shells.part) == {11}


@pytest.mark.parametrize(
    "change",
    [
        {"solids": 3},
        {"beams": 2},
        {"velocity": False},
        {"layers": 2},
        {"globals_": 0},
        {"names": {11: "insert", 12: "bolster"}},
        {"solids": 2, "beams": 3, "deletion": np.ones(E), "layers": 5},
    ],
    ids=lambda c: "-".join(c),
)
def test_what_lies_before_the_shells_does_not_shift_them(save, change):
    written = states()
    assert_read(read_d3plot(save(d3plot(NODES, SHELLS, written, **change))), written)


def test_states_in_followers_are_read_in_order(save):
    written = states(4)
    first = save(d3plot(NODES, SHELLS, written[:1]))
    whole = d3plot(NODES, SHELLS, written)
    geometry = len(d3plot(NODES, SHELLS, [])) - 4
    size = (len(whole) - geometry - 4) // 4
    for k, (low, high) in enumerate([(1, 3), (3, 4)], 1):
        body = whole[geometry + low * size : geometry + high * size]
        padding = np.float32(-999999).tobytes() + bytes(100)
        save(body + padding, f"d3plot{k:02d}")
    assert_read(read_d3plot(first), written)


def test_a_missing_follower_is_named(save, problems):
    first = save(d3plot(NODES, SHELLS, states(1)))
    save(b"", "d3plot02")
    assert problems(read_d3plot, first) == [
        "d3plot: followers: got no d3plot01, expected all up to d3plot02"
    ]


def test_parts_are_selected_by_number_or_title(save, problems):
    part = np.array([1, 1, 1, 2, 2, 2, 2])
    written = states()
    path = save(d3plot(NODES, SHELLS, written, part=part, names={11: "Insert", 12: "Bolster"}))
    rows = slice(3, None)
    for parts in ([12], ["12"], ["bolster"]):
        result = read_d3plot(path, parts=parts)
        assert len(result.shells) == 4
        assert_read(result, written, rows=rows)
    assert problems(read_d3plot, path, parts=["rear", 13]) == [
        "d3plot: parts: got 'rear', expected a part with shells: 11 'Insert', 12 'Bolster'",
        "d3plot: parts: got 13, expected a part with shells: 11 'Insert', 12 'Bolster'",
    ]


def test_rigid_shells_have_no_rows_and_are_left_out(save):
    part = np.array([1, 1, 2, 2, 1, 1, 1])
    written = states()
    result = read_d3plot(save(d3plot(NODES, SHELLS, written, part=part, rigid_part=2)))
    keep = part == 1
    for state, (_, _, t, _, _) in zip(result, written, strict=True):
        np.testing.assert_allclose(state.thickness, t[keep] * 1e-3, rtol=1e-6)
    assert result.notes == ("2 shells of rigid parts are left out: part 12",)


def test_deleted_shells_are_marked(save):
    alive = np.array([1.0, 1, 0, 1, 1, 1, 0])
    written = states(1)
    written[0][3][2] = np.nan  # the calculation leaves anything in a deleted row
    (state,) = read_d3plot(save(d3plot(NODES, SHELLS, written, deletion=alive)))
    assert state.alive.tolist() == (alive > 0).tolist()


def test_missing_strains_are_told(save):
    result = read_d3plot(save(d3plot(NODES, SHELLS, states(), strains=False)))
    assert result.read(0).strain_inner is None
    assert result.notes == (
        "the file has no strains (STRFLG=0): curvature is taken from the geometry",
    )


def test_missing_thickness_is_named_or_given(save, problems):
    path = save(d3plot(NODES, SHELLS, states(), thickness=False))
    assert problems(read_d3plot, path) == [
        "d3plot: thickness: got none in the file, expected ENGFLG=1 in *DATABASE_EXTENT_BINARY "
        "(or say the thickness)"
    ]
    assert (read_d3plot(path, thickness=0.001).read(0).thickness == 0.001).all()


def test_the_sample_of_a_bent_strip():
    result = read_d3plot(DATA / "bent_strip.d3plot")
    assert len(result.shells) == 800
    assert result.times.tolist() == [0.0, 1.0, 2.0]
    assert result.read(1).strain_outer.max() == pytest.approx(0.012, rel=1e-3)
    assert result.read(1).thickness == pytest.approx(np.full(800, 0.0012), rel=1e-6)


GOOD = d3plot(NODES, SHELLS, states())
STATE_0 = len(d3plot(NODES, SHELLS, [])) - 4


def patched(at, value, dtype="<i4"):
    changed = bytearray(GOOD)
    changed[4 * at : 4 * at + 4] = np.array([value], dtype=dtype).tobytes()
    return bytes(changed)


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"", "file: got no file type 1 or 5 in word 11, expected a d3plot or d3part file"),
        (b"not a d3plot at all" * 40, "file: got no file type 1 or 5 in word 11"),
        (patched(11, 4), "file: got an intfor file, expected a d3plot or d3part file"),
        (GOOD[:200], "control words: got 50 words, expected at least 64 (the file is truncated)"),
        (GOOD[:300], "shells: got 75 words"),
        (GOOD[:1000], "(the file is truncated)"),
        (GOOD[:STATE_0], "states: got none, only the geometry of 7 shells, expected at least one "
         "state in the file or its followers (is d3plot01 missing?)"),
        (GOOD[: STATE_0 + 400], "state 0: got 100 words"),
        (GOOD[:-200], "state 1: got"),
        (patched(31, 0), "shells: got none, expected a result with shell elements"),
        (patched(16, 0), "nodes: got none, expected a result with nodes"),
        (patched(16, -5), "NUMNP: got -5, expected 0 or more"),
        (patched(20, 0), "IU: got no node positions in the states"),
        (patched(33, 44), "NV2D: got 44, expected 33 or 45 words per shell"),
        (patched(37, 7), "ISPHFG: got"),
        (patched(51, 2**31 - 1), "NMMAT: got 2147483647, expected at most"),
        (patched(51, 76893465), "file: got a femzip archive"),
        (patched(15, 7), "NDIM: got 7, expected 3, 4, 5 or 8"),
        (patched(64 + 3 * N, 999), "shell nodes: got 2..999, expected 1..14"),
        (patched(64 + 3 * N + 4, 9), "shell parts: got 1..9, expected 1..1"),
        (patched(18, 9), "state 1: got 408 words, expected 409 (the file is truncated)"),
        (d3plot(NODES, SHELLS, states()[::-1]), "state 1: time: got 0, expected rising times"),
        (patched(64, np.nan, "<f4"), "nodes: got nan or inf, expected finite positions"),
    ],
)  # fmt: skip
def test_bad_files_are_named(save, content, message):
    with pytest.raises(InputError) as caught:
        list(read_d3plot(save(content)))
    assert message in str(caught.value)


def test_nan_strains_are_named_with_state_and_shell(save):
    written = states()
    written[1][4][3, 2] = np.nan
    result = read_d3plot(save(d3plot(NODES, SHELLS, written)))
    result.read(0)
    with pytest.raises(InputError, match="state 1: strains: got nan or inf in 1 rows, first 104"):
        result.read(1)


def test_a_wrong_unit_is_noticed(save, problems):
    path = save(GOOD)
    assert "say the unit of length" in problems(read_d3plot, path, length_unit="m")[0]
    assert problems(read_d3plot, path, length_unit="ft") == [
        "length_unit: got 'ft', expected one of mm, cm, m, inch"
    ]


def test_missing_file(tmp_path, problems):
    assert problems(read_d3plot, tmp_path / "x") == ["x: file: got no such file, expected a file"]
    (message,) = problems(read_shells, tmp_path / "x")
    assert message == "x: file: got no such file, expected a d3plot or a keyword deck"


def test_the_format_is_told_by_the_content(save, problems):
    path = save(GOOD, "anything.k")
    assert len(read_shells(path).shells) == E
    assert problems(read_shells, path, reference=path)[0].startswith("anything.k: reference: got")


@pytest.mark.validate
def test_ten_thousand_damaged_files_give_an_input_error_or_a_result(save):
    """Bytes and words changed, runs cut out, files cut short: nothing but InputError comes out."""
    rng = np.random.default_rng(1)
    refused = 0
    for _ in range(10_000):
        content = bytearray(GOOD)
        for _ in range(rng.integers(1, 4)):
            kind, at = rng.integers(4), int(rng.integers(len(content)))
            if kind == 0:
                content[at] = rng.integers(256)
            elif kind == 1:
                word = 4 * int(rng.integers(64))
                value = rng.choice([0, 1, -1, 5, 1000, 2**31 - 1, -(2**31), int(rng.integers(99))])
                content[word : word + 4] = int(value).to_bytes(4, "little", signed=True)
            elif kind == 2:
                del content[at : at + int(rng.integers(1, 40))]
            else:
                del content[at:]
            if len(content) < 2:
                break
        try:
            for state in read_d3plot(save(bytes(content))):
                assert np.isfinite(state.positions).all()
        except InputError:
            refused += 1
    assert refused > 3000


@pytest.mark.validate
def test_a_real_result_with_shells():
    """A tension specimen of the lasso project's tests, read where it is at hand."""
    path = Path(__file__).parents[5] / "shared/data/fetched/lasso_simple_d3plot/d3plot"
    if not path.exists():
        pytest.skip("third-party sample absent")
    result = read_d3plot(path)
    assert len(result.shells) == 4696
    assert result.shells.part_names[1] == "Zugprobe"
    assert result.read(0).thickness == pytest.approx(np.full(4696, 0.00293), rel=1e-5)
