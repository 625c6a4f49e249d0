"""A shell's row in a d3plot: every layout is read back exactly, or refused by name."""

from itertools import product

import numpy as np
import pytest

from seatlook.io.lsdyna.d3plot.reader import read_d3plot
from seatlook.io.lsdyna.d3plot.row import shell_row
from support.d3plot_samples import d3plot, quad_strip

NODES, SHELLS = quad_strip()
E = len(SHELLS)
LAYERS = range(1, 11)


def states(count):
    rng = np.random.default_rng(3)
    return [
        (0.5 * k, NODES, rng.uniform(1, 2, E), *rng.normal(0, 0.01, (2, E, 6)))
        for k in range(count)
    ]


@pytest.mark.parametrize("history", [0, 19])
@pytest.mark.parametrize("layers", LAYERS)
def test_every_row_is_read_exactly(tmp_path, layers, history):
    """MAXINT 1 to 10 with STRFLG 0, 1, 10, 11, thermal tensors and four points in the plane."""
    path = tmp_path / "d3plot"
    (written,) = states(1)
    _, _, t, inner, outer = written
    for plastic, thermal, strains, thickness, four in product([False, True], repeat=5):
        for digit in {False, strains}:
            path.write_bytes(
                d3plot(
                    NODES, SHELLS, [written], layers=layers, history=history, plastic=plastic,
                    thermal=thermal, strains=strains, thickness=thickness, strain_digit=digit,
                    in_plane=4 if four else 1,
                )
            )  # fmt: skip
            (state,) = read_d3plot(path, thickness=None if thickness else 0.001)
            assert (state.strain_inner is not None) == strains
            if thickness:
                np.testing.assert_allclose(state.thickness, 1e-3 * t, rtol=1e-6)
            if strains:
                diagonal = np.diagonal(state.strain_inner, axis1=1, axis2=2)
                np.testing.assert_allclose(diagonal, inner[:, :3], rtol=1e-6)
                np.testing.assert_allclose(state.strain_outer[:, 0, 1], outer[:, 3], rtol=1e-6)


@pytest.mark.parametrize(
    ("words", "layers", "neips", "ioshl2", "idtdt", "expected"),
    [
        (260, 10, 16, 1000, 100, (238, -1)),  # release 14
        (51, 3, 0, 1000, 100, (29, -1)),
        (63, 3, 0, 1000, 10100, (29, 32)),
        (102, 3, 19, 1000, 0, (86, 89)),  # release 7
    ],
)
def test_rows_seen_outside(tmp_path, words, layers, neips, ioshl2, idtdt, expected):
    control = {
        "nv2d": words, "maxint": layers, "neips": neips, "idtdt": idtdt, "numds": 1,
        "ioshl1": 1000, "ioshl2": ioshl2, "ioshl3": 1000, "ioshl4": 1000,
    }  # fmt: skip
    assert shell_row(tmp_path, control) == expected


def test_a_row_of_two_readings_is_refused(tmp_path, problems):
    """One layer of four words: four points in the plane are as long as one point with strains."""
    control = {
        "nv2d": 16, "maxint": 1, "neips": 4, "idtdt": 0, "numds": -1,
        "ioshl1": 0, "ioshl2": 0, "ioshl3": 0, "ioshl4": 0,
    }  # fmt: skip
    assert problems(shell_row, tmp_path / "d3plot", control) == [
        "d3plot: NV2D: got 16 words per shell, with or without strains, expected one reading of a "
        "shell's row (set STRFLG=1 and MAXINT=3 in *DATABASE_EXTENT_BINARY)"
    ]
