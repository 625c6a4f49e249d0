from pathlib import Path

import pytest

from seatlook.files import cache_folder


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
