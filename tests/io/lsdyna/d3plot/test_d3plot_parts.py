"""Titles of a d3plot reach their parts, and shells written as zeros are left out by name."""

import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.io.lsdyna.d3plot.reader import read_d3plot
from support.d3plot_samples import d3plot, quad_strip

NODES, SHELLS = quad_strip()
E = len(SHELLS)
PART = np.array([1, 1, 1, 2, 2, 2, 2])
UNKNOWN = (
    "titles of parts are left out: their numbers may be the user's or counted from 1, and release "
    "R11 does not say which; choose parts by number"
)


def state(time=0.0, *, thickness=1.2):
    return time, NODES, np.broadcast_to(thickness, E), np.zeros((E, 6)), np.zeros((E, 6))


def save(tmp_path, states=(), name="d3plot", **options):
    path = tmp_path / name
    path.write_bytes(d3plot(NODES, SHELLS, states or [state()], part=PART, **options))
    return path


@pytest.mark.parametrize(
    ("ids", "titles", "release", "expected", "note"),
    [
        ((11, 12), {11: "seat", 12: "foam"}, "", {11: "seat", 12: "foam"}, ""),
        ((11, 12), {1: "seat", 2: "foam"}, "", {11: "seat", 12: "foam"}, ""),
        ((1, 2), {1: "seat", 2: "foam"}, "", {1: "seat", 2: "foam"}, ""),
        ((1, 12), {1: "seat", 2: "foam"}, "", {1: "seat", 12: "foam"}, ""),
        ((2, 12), {2: "seat", 12: "foam"}, "", {2: "seat", 12: "foam"}, ""),
        # Both are possible: the release decides.
        ((2, 1), {1: "foam", 2: "seat"}, "R9", {1: "foam", 2: "seat"},
         "titles of parts are read by the user's numbers, as release R9 writes them"),
        ((2, 1), {1: "seat", 2: "foam"}, "R13", {2: "seat", 1: "foam"},
         "titles of parts are read in the file's order, as release R13 writes them"),
        ((2, 1), {1: "foam", 2: "seat"}, "R712", {1: "foam", 2: "seat"},
         "titles of parts are read by the user's numbers, as release R712 writes them"),
        ((2, 1), {1: "seat", 2: "foam"}, "14.1", {2: "seat", 1: "foam"},
         "titles of parts are read in the file's order, as release 14.1 writes them"),
        ((2, 1), {1: "seat", 2: "foam"}, "R11", {}, UNKNOWN),
        ((11, 12), {1: "seat", 7: "foam"}, "", {},
         "titles of parts are left out: their numbers (1, 7) are neither the user's nor counted "
         "from 1; choose parts by number"),
    ],
)  # fmt: skip
def test_titles_reach_their_parts(tmp_path, ids, titles, release, expected, note):
    result = read_d3plot(save(tmp_path, ids=ids, names=titles, release=release))
    assert dict(result.shells.part_names) == expected
    assert result.notes == ((note,) if note else ())
    for number, title in expected.items():
        chosen = read_d3plot(tmp_path / "d3plot", parts=[title.upper()])
        assert set(chosen.shells.part) == {number}


def test_a_title_of_two_parts_is_refused(tmp_path, problems):
    path = save(tmp_path, names={11: "seat", 12: "Seat"})
    assert problems(read_d3plot, path, parts=["seat"]) == [
        "d3plot: parts: got 'seat', the title of 2 parts, expected one of their numbers: 11, 12"
    ]


def test_titles_in_utf_8(tmp_path):
    result = read_d3plot(save(tmp_path, names={11: "Sitzbezug grün", 12: "座套"}))
    assert result.shells.part_names == {11: "Sitzbezug grün", 12: "座套"}


@pytest.mark.parametrize("given", [None, 0.001])
def test_shells_written_as_zeros_are_left_out(tmp_path, given):
    """Also under a thickness of the user, which would give rigid parts one."""
    states = [state(k, thickness=np.where(PART == 2, 0, 1.2)) for k in range(3)]
    result = read_d3plot(save(tmp_path, states, names={11: "seat", 12: "pan"}), thickness=given)
    assert result.shells.element_ids.tolist() == [101, 102, 103]
    assert result.notes == (
        "4 shells with thickness 0 in every state, as rigid parts are written, are left out: "
        "part 12 'pan'",
    )
    assert (result.read(2).thickness > 0).all()


def test_a_shell_with_a_thickness_in_some_state_stays(tmp_path):
    states = [state(0.0, thickness=np.where(PART == 2, 0, 1.2)), state(1.0)]
    result = read_d3plot(save(tmp_path, states))
    assert len(result.shells) == E
    assert result.notes == ()


def test_only_rigid_shells_are_refused(tmp_path, problems):
    path = save(tmp_path, [state(thickness=np.where(PART == 2, 0, 1.2))])
    assert problems(read_d3plot, path, parts=[12]) == [
        "d3plot: shells: got none with results, expected deformable shells"
    ]


def test_of_an_adaptive_run_the_last_mesh_is_read(tmp_path):
    first = save(tmp_path)
    save(tmp_path, [state(1.0)], "d3plotaa")
    last = save(tmp_path, [state(2.0), state(3.0)], "d3plotab")
    result = read_d3plot(first)
    assert result.times.tolist() == [2.0, 3.0]
    assert result.notes == ("the calculation remeshed: d3plotab is read, the last of 3 meshes",)
    assert read_d3plot(last).notes == ()
    last.write_bytes(b"")
    with pytest.raises(InputError, match="d3plotab: "):
        read_d3plot(first)


def test_a_d3plot_in_metres_is_not_taken_as_millimetres(tmp_path):
    result = read_d3plot(save(tmp_path, [state(thickness=0.0012)]))
    with pytest.raises(InputError, match=r"d3plot: thickness: got 0.0012 mm in the middle"):
        result.read(0)
