"""CPU time and memory of half a million shells: figures, and the command to maps and a picture."""

import resource
import subprocess
import sys

import numpy as np
import pytest

from support.d3plot_samples import d3plot

SIDE = 707  # quadrilaterals along each side
PITCH, THICKNESS = 1.0, 1.2  # [mm]


def waved_sheet(path, side=SIDE):
    """Write a sheet with 12 mm high waves of 240 mm and the surface strains that they make."""
    i, j = np.meshgrid(np.arange(side + 1), np.arange(side + 1), indexing="ij")
    flat = np.stack([PITCH * i, PITCH * j, 0.0 * i], axis=-1).reshape(-1, 3)
    a, b = np.meshgrid(np.arange(side), np.arange(side), indexing="ij")
    first = (a * (side + 1) + b).ravel() + 1
    shells = np.column_stack([first, first + side + 1, first + side + 2, first + 1])
    k = 2 * np.pi / 240.0
    x = flat + np.outer(12.0 * np.sin(k * flat[:, 0]), [0.0, 0.0, 1.0])
    middle = flat[shells - 1][:, :, 0].mean(axis=1)
    half = np.zeros((len(shells), 6))
    half[:, 0] = 0.5 * THICKNESS * 12.0 * k**2 * np.sin(k * middle)
    state = (0.0, x, np.full(len(shells), THICKNESS), -half, half)
    path.write_bytes(d3plot(flat, shells, [state]))


# The command, with what it has used when the four maps are written.
COMMAND = """
import resource, sys
from seatlook.__main__ import main
from seatlook.chain.shells import maps as shell_maps

next_step = shell_maps.write_elements

def maps_are_written(*args):
    own = resource.getrusage(resource.RUSAGE_SELF)
    sys.stderr.write(f"maps {own.ru_utime + own.ru_stime} {own.ru_maxrss}\\n")
    next_step(*args)

shell_maps.write_elements = maps_are_written
main()
"""


def used(words, cwd):
    """Run the command; name of the point reached -> CPU s and GB until then."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    run = subprocess.run(
        [sys.executable, "-c", COMMAND, *words], cwd=cwd, check=True, capture_output=True, text=True
    )
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    reached = {"end": (seconds, 1e-6 * after.ru_maxrss)}
    for line in run.stderr.splitlines():
        if line.startswith("maps "):
            reached["maps"] = float(line.split()[1]), 1e-6 * float(line.split()[2])
    return reached


@pytest.mark.bench
@pytest.mark.render
def test_half_a_million_shells(tmp_path, capsys):
    """Up to the maps; then to worst wrinkles, tables, checker and picture as well."""
    words = ["wrinkle", "d3plot", "--bending-radius-mm", "200", "--json"]
    # Compiled kernels are read from the cache by what is measured.
    waved_sheet(tmp_path / "d3plot", side=40)
    used([*words, "--out", "out"], tmp_path)
    waved_sheet(tmp_path / "d3plot")
    figures = used(words, tmp_path)["end"]
    drawn = used([*words, "--out", "out"], tmp_path)
    with capsys.disabled():
        for name, (seconds, gigabytes) in (
            ("figures", figures), ("maps", drawn["maps"]), ("all that is drawn", drawn["end"])
        ):  # fmt: skip
            print(f"\n500,000 shells to {name}: {seconds:.1f} CPU s, {gigabytes:.2f} GB")
    assert (tmp_path / "out/state-0/maps/w2.png").exists()
    assert drawn["maps"][1] < 3.0
    assert drawn["end"][1] < 3.0
