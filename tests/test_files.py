import os
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from seatlook.errors import InputError
from seatlook.files import (
    cache_folder,
    file_names,
    kept,
    opened,
    read_file,
    read_text,
    reader,
    silenced,
)


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


def refusal(read, *args, **kwargs):
    with pytest.raises(InputError) as caught:
        read(*args, **kwargs)
    (problem,) = caught.value.problems
    return problem.got


@pytest.mark.parametrize(
    ("name", "got"),
    [
        ("none", "no such file"),
        ("folder", "a folder"),
        ("pipe", "a pipe"),
        ("round", "Too many levels of symbolic links"),
        ("n\0ne", "embedded null byte"),
        ("n" * 300, "File name too long"),
    ],
)
def test_what_is_no_file_is_refused_without_waiting(tmp_path, name, got):
    (tmp_path / "folder").mkdir()
    os.mkfifo(tmp_path / "pipe")
    (tmp_path / "round").symlink_to(tmp_path / "round")
    assert refusal(read_file, tmp_path / name) == got


def test_devices_and_large_files_are_refused(tmp_path):
    assert refusal(read_file, Path("/dev/zero")) == "a device"
    with (tmp_path / "large").open("wb") as file:
        file.truncate(3 << 30)
    assert refusal(read_file, tmp_path / "large") == "3,072 MiB"


def test_a_link_to_a_file_is_that_file(tmp_path):
    (tmp_path / "a").write_bytes(b"seat")
    (tmp_path / "b").symlink_to("a")
    assert read_file(tmp_path / "b") == b"seat"


def test_a_file_that_changes_while_it_is_read(tmp_path):
    path = tmp_path / "a"
    path.write_bytes(b"first")

    def read():
        with opened(path) as stream:
            stream.read()
            path.write_bytes(b"second, longer")

    assert refusal(read) == "a file that changes while it is read"


def test_a_mark_of_byte_order_is_no_fault(tmp_path):
    (tmp_path / "a").write_bytes("n\u00e4ht".encode("utf-8-sig"))
    assert read_text(tmp_path / "a") == "n\u00e4ht"
    (tmp_path / "a").write_bytes("n\u00e4ht".encode("utf-16"))
    assert refusal(read_text, tmp_path / "a") == "UTF-16"


@pytest.mark.parametrize(
    ("error", "got"),
    [
        (RecursionError(), "things in things in things, too deep to follow"),
        (MemoryError(), "more than there is memory for"),
        (OSError(5, "Input/output error"), "Input/output error"),
        (KeyError("x"), "KeyError: 'x'"),
    ],
)
def test_whatever_a_reader_stumbles_over_is_named_with_the_file(error, got):
    @reader("a seat")
    def read(path):
        raise error

    assert refusal(read, Path("a.toml")) == got
    with pytest.raises(InputError, match=r"^a\.toml: file: got "):
        read(Path("a.toml"))


def test_what_was_read_is_kept_until_the_file_is_another(tmp_path):
    path, calls = tmp_path / "a", []

    @kept
    def read(path, unit="mm"):
        calls.append(unit)
        return path.read_bytes()

    for content in (b"one", b"one", b"two"):
        path.write_bytes(content)
        assert read(path) == content
    assert read(path, unit="m") == b"two"
    assert calls == ["mm", "mm", "m"]


def test_libraries_are_silenced_and_heard_again(capfd):
    """Past Python, as a C library writes; also where the library fails, and one within another."""

    def fail():
        with silenced(), silenced():
            os.write(2, b"lost\n")
            raise InputError.single("a", got="b", expected="c")

    with pytest.raises(InputError):
        fail()
    os.write(2, b"heard\n")
    assert capfd.readouterr().err == "heard\n"
