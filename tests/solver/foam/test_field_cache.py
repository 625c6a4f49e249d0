"""Distance fields kept between runs: found again, refused when damaged, forgotten in turn."""

import os

import numpy as np
import pytest

from seatlook.assembly import assemble
from seatlook.results.gap import gap
from seatlook.solver import solve
from seatlook.solver.foam import distance, field_cache
from support import scenes
from support.covers import sphere

SURFACE = sphere(0.05, 2)


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """An empty cache on disk and none in memory."""
    monkeypatch.setenv("SEATLOOK_CACHE_DIR", str(tmp_path))
    monkeypatch.setattr(distance, "_fields", type(distance._fields)())
    return tmp_path / "fields"


@pytest.fixture
def built(monkeypatch):
    """Counts what is made anew."""
    made, build = [], distance._built
    monkeypatch.setattr(distance, "_built", lambda *args: (made.append(1), build(*args))[1])
    return made


def again(**options):
    """Ask as another run would, with nothing in memory."""
    distance._fields.clear()
    return distance.distance_field(*SURFACE, spacing=0.01, **options)


def assert_same_bits(a, b):
    assert a.coefficients.tobytes() == b.coefficients.tobytes()
    assert a.grid.tobytes() == b.grid.tobytes()
    assert a.least_extent == b.least_extent


def test_another_run_finds_the_field(folder, built):
    first = again()
    assert_same_bits(again(), first)
    assert len(built) == 1
    again(margin=0.03)
    assert len(built) == 2
    assert len(list(folder.glob("*.field"))) == 2
    points = np.array([[0.0, 0.01, 0.052]])
    assert again().at(points)[0] == first.at(points)[0]


@pytest.mark.parametrize("spoil", ["cut", "flip", "empty"])
def test_damaged_file_is_made_again_with_a_warning(folder, built, spoil):
    first = again()
    (path,) = folder.glob("*.field")
    whole = path.read_bytes()
    middle = len(whole) // 2
    flipped = whole[:middle] + bytes([whole[middle] ^ 1]) + whole[middle + 1 :]
    path.write_bytes({"cut": whole[:-9], "flip": flipped, "empty": b""}[spoil])
    with pytest.warns(RuntimeWarning, match=rf"{path.name} is damaged; made again"):
        assert_same_bits(again(), first)
    assert len(built) == 2
    assert path.read_bytes() == whole


def test_file_that_cannot_be_read_is_made_again(folder, built, monkeypatch):
    first = again()

    def refuse(path):
        raise PermissionError(f"not yours: {path.name}")

    monkeypatch.setattr("pathlib.Path.read_bytes", refuse)
    with pytest.warns(RuntimeWarning, match="cannot be read"):
        assert_same_bits(again(), first)
    assert len(built) == 2


def test_solving_and_judging_make_one_field(folder, built):
    solution = solve(assemble(scenes.two_panels(gap=0.004, element_size=0.03)))
    assert np.isfinite(gap(solution)).any()
    assert len(built) == 1


def test_folder_that_refuses_costs_only_time(tmp_path, monkeypatch, built):
    (tmp_path / "fields").write_text("in the way")
    monkeypatch.setenv("SEATLOOK_CACHE_DIR", str(tmp_path))
    assert_same_bits(again(), again())
    assert len(built) == 2


def test_changed_code_does_not_find_what_it_made_before(folder, built, monkeypatch):
    again()
    monkeypatch.setattr(field_cache, "_code", lambda: "another")
    again()
    assert len(built) == 2


def test_what_was_not_used_for_longest_is_forgotten(folder, monkeypatch):
    monkeypatch.setattr(field_cache, "_MAX_FILES", 2)
    for number, key in enumerate("abc"):
        field_cache.write(key, x=np.zeros(3))
        for path in folder.glob("*.field"):
            if path.stat().st_mtime > 1e6:
                os.utime(path, (number, number))
        if key == "b":
            field_cache.read("a")
    assert field_cache.read("b") is None
    assert field_cache.read("a") is not None
    assert field_cache.read("c") is not None
