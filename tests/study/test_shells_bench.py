"""CPU time and memory of half a million shells: figures, and the command to maps and a picture."""

import resource
import subprocess
import sys

import numpy as np
import pytest

from d3plot_samples import d3plot

SIDE = 707  # quadrilaterals along each side
PITCH, THICKNESS = 1.0, 1.2  # [mm]


def waved_sheet(path):
    """Write a sheet with 12 mm high waves of 240 mm and the surface strains that they make."""
    i, j = np.meshgrid(np.arange(SIDE + 1), np.arange(SIDE + 1), indexing="ij")
    flat = np.stack([PITCH * i, PITCH * j, 0.0 * i], axis=-1).reshape(-1, 3)
    a, b = np.meshgrid(np.arange(SIDE), np.arange(SIDE), indexing="ij")
    first = (a * (SIDE + 1) + b).ravel() + 1
    shells = np.column_stack([first, first + SIDE + 1, first + SIDE + 2, first + 1])
    k = 2 * np.pi / 240.0
    x = flat + np.outer(12.0 * np.sin(k * flat[:, 0]), [0.0, 0.0, 1.0])
    middle = flat[shells - 1][:, :, 0].mean(axis=1)
    half = np.zeros((len(shells), 6))
    half[:, 0] = 0.5 * THICKNESS * 12.0 * k**2 * np.sin(k * middle)
    state = (0.0, x, np.full(len(shells), THICKNESS), -half, half)
    path.write_bytes(d3plot(flat, shells, [state]))


def used(words, cwd):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([sys.executable, "-m", "seatlook", *words], cwd=cwd, check=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    return seconds, after.ru_maxrss / 1e6


@pytest.mark.bench
@pytest.mark.render
def test_half_a_million_shells(tmp_path, capsys):
    waved_sheet(tmp_path / "d3plot")
    # Compiled kernels are read from the cache by what is measured.
    small = ["wrinkle", "d3plot", "--bending-radius-mm", "10", "--json"]
    for name, words in (("figures", small), ("maps", [*small, "--out", "out"])):
        seconds, gigabytes = used(words, tmp_path)
        with capsys.disabled():
            print(f"\n500,000 shells, {name}: {seconds:.1f} CPU s, {gigabytes:.2f} GB")
    assert (tmp_path / "out/state-0/maps/w2.png").exists()
