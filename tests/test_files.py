from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from seatlook.files import cache_folder, file_names


@pytest.mark.parametrize(
    ("named", "shared", "found"),
    [
        ("/own", "/shared", "/own"),
        ("", "/shared", "/shared/seatlook"),
        ("", "relative", "/home/me/.cache/seatlook"),
        ("", "", "/home/me/.cache/seatlook"),
    ],
)
def test_cache_folder_follows_the_environment(monkeypatch, named, shared, found):
    monkeypatch.setenv("SEATLOOK_CACHE_DIR", named)
    monkeypatch.setenv("XDG_CACHE_HOME", shared)
    monkeypatch.setenv("HOME", "/home/me")
    assert cache_folder() == Path(found)


def test_without_a_home_nothing_is_kept(monkeypatch):
    for name in ("SEATLOOK_CACHE_DIR", "XDG_CACHE_HOME"):
        monkeypatch.delenv(name, raising=False)

    def homeless():
        raise RuntimeError("no home")

    monkeypatch.setattr(Path, "home", homeless)
    assert cache_folder() is None


@given(st.lists(st.text(), unique=True, max_size=12))
def test_names_make_files_that_no_file_system_takes_for_each_other(names):
    files = file_names(names)
    assert list(files) == names
    assert len({file.casefold() for file in files.values()}) == len(names)
    for file in files.values():
        assert file.isascii()
        assert 0 < len(file) <= 160
        assert not set(file) & set('/\\:*?"<>| .')


@pytest.mark.parametrize(
    "names",
    [
        ["a b", "a-b", "A B"],
        ["¤", "§", "-"],
        ["x" * 300, "x" * 299 + "y"],
        ["größe", "grüße"],
        ["座席", "座面"],
    ],
)
def test_names_of_one_kind_are_told_apart(names):
    assert len(set(file_names(names).values())) == len(names)


def test_plain_names_stay_as_they_read():
    assert file_names(["Bulb left", "black-leather"]) == {
        "Bulb left": "bulb-left",
        "black-leather": "black-leather",
    }
