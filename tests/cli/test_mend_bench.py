"""CPU time and memory of ``seatlook mend``: a raw scan, and a whole seat of two bodies."""

import resource
import subprocess
import sys

import pytest
import trimesh

from support.rough_surfaces import scan, whole_seat


@pytest.mark.bench
@pytest.mark.parametrize(
    ("name", "surface", "words"),
    [
        ("a raw scan", scan, ["--close", "--smooth-mm", "15"]),
        ("a whole seat of two bodies", whole_seat, ["--unite"]),
    ],
)
def test_from_a_file_to_a_foam(tmp_path, capsys, name, surface, words):
    vertices, faces = surface()
    trimesh.Trimesh(1e3 * vertices, faces, process=False).export(tmp_path / "a.stl")
    command = [sys.executable, "-m", "seatlook", "mend", "a.stl", "--out", "foam.obj", *words]
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run(command, cwd=tmp_path, check=True, capture_output=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    gigabytes = 1e-6 * after.ru_maxrss
    with capsys.disabled():
        print(f"\n{name}, {len(faces)} faces, to foam: {seconds:.1f} CPU s, {gigabytes:.2f} GB")
    assert gigabytes < 2
