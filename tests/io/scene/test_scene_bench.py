"""CPU time of reading the demo's scene, and of reading it again in the same process."""

import time

import pytest

from seatlook import io
from seatlook.cli import run


@pytest.mark.bench
@pytest.mark.filterwarnings("ignore::seatlook.errors.InputWarning")
def test_the_demo_is_read_twice(tmp_path, capsys):
    assert run(["demo", "--files-only", "--quiet", "--out", str(tmp_path)]) == 0
    io.load_scene(tmp_path / "scene.toml")  # imports what reading takes
    scene = tmp_path / "again.toml"
    scene.write_bytes((tmp_path / "scene.toml").read_bytes())
    seconds = []
    for _ in range(5):
        began = time.process_time()
        io.load_scene(scene)
        seconds.append(time.process_time() - began)
    with capsys.disabled():
        shown = ", ".join(f"{s:.2f}" for s in seconds)
        print(f"\nthe demo's scene, imports excluded, read again and again: {shown} CPU s")
