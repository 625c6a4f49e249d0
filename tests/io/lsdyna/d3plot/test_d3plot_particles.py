"""Particles elsewhere in the model do not shift the shells, whatever is written of them."""

import numpy as np
import pytest

from seatlook.io.lsdyna.d3plot.reader import read_d3plot
from support.d3plot_samples import d3plot, quad_strip

NODES, SHELLS = quad_strip()
E = len(SHELLS)
ALL = (11, 1, 1, 6, 1, 1, 1, 1, 6, 1, 3)


def states():
    rng = np.random.default_rng(5)
    return [
        (0.5 * k, NODES + k, rng.uniform(1, 2, E), *rng.normal(0, 0.01, (2, E, 6)))
        for k in range(3)
    ]


@pytest.mark.parametrize(
    "options",
    [
        {"sph": 7, "sph_flags": ALL},
        {"sph": 7, "sph_flags": (11, 1, 0, 6, 0, 1, 0, 0, -6, 1, 0)},
        {"sph": 40, "sph_flags": (11, 1, 1, 6, 1, 1, 1, 1, 12, 1, 0)},
        {"sph": 7, "sph_flags": (10, 1, 1, 6, 1, 1, 1, 1, 6, 1, 99)},
        {"airbags": (3, 2, 4, 14, 30, 2)},
        {"airbags": (4, 1, 5, 15, 11, 3)},
        {"airbags": (4, 3, 5, 15, 50, 3), "sph": 5, "sph_flags": ALL, "solids": 2, "beams": 3},
    ],
    ids=["sph", "true-strains", "rates", "ten-flags", "bags", "chambers", "both"],
)
@pytest.mark.parametrize("word", ["<i4", ">i8"])
@pytest.mark.parametrize("deleted", [False, True])
def test_particles_do_not_shift_the_shells(tmp_path, options, word, deleted):
    path = tmp_path / "d3plot"
    written = states()
    deletion = np.arange(1.0, E + 1) > 1 if deleted else None
    path.write_bytes(d3plot(NODES, SHELLS, written, word=word, deletion=deletion, **options))
    read = list(read_d3plot(path))
    assert len(read) == 3
    for state, (time, _, thickness, inner, outer) in zip(read, written, strict=True):
        assert state.time == pytest.approx(time)
        kept = slice(int(deleted), None)  # a deleted shell has no strains
        assert state.strain_inner[kept, 0, 0] == pytest.approx(inner[kept, 0], rel=1e-6)
        assert state.strain_outer[kept, 0, 1] == pytest.approx(outer[kept, 3], rel=1e-6)
        assert state.thickness[kept] == pytest.approx(1e-3 * thickness[kept], rel=1e-6)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"sph": 3, "sph_flags": (12, *ALL[1:], 0)}, "ISPHFG: got 12 flags, expected 10 or 11"),
        ({"sph": 3, "sph_flags": (11, 1, 1, -6, *ALL[4:])}, "ISPHFG: got"),
        ({"airbags": (3, 1, 4, 10**8, 3, 2)}, "airbag particles: got"),
    ],
)
def test_counts_that_cannot_be_are_named(tmp_path, problems, options, message):
    path = tmp_path / "d3plot"
    size = {"airbags": (3, 1, 4, 14, 3, 2)} if "airbags" in options else options
    content = bytearray(d3plot(NODES, SHELLS, states(), **size))
    if "airbags" in options:
        content[4 * 65 : 4 * 66] = np.array([10**8], "<i4").tobytes()
    path.write_bytes(content)
    (said,) = problems(read_d3plot, path)
    assert said.startswith(f"d3plot: {message}")
