"""A finite-element state as a solution: same indices, seen from the right side."""

import dataclasses
from pathlib import Path

import numpy as np
import pytest

from scenes import material
from seatlook import wrinkle
from seatlook.errors import InputError
from seatlook.io.shells import read_shells
from seatlook.mesh import face_normals
from seatlook.study.shell_cover import shell_solution

DATA = Path(__file__).parents[1] / "data"


@pytest.fixture(scope="module")
def strip():
    return read_shells(DATA / "bent_strip.d3plot")


@pytest.mark.parametrize("facing", [(0, 0, 1), (0, 0, -1)])
@pytest.mark.parametrize("mode", ["paper", "tensor"])
def test_the_solution_has_the_same_indices(strip, mode, facing):
    state = strip.read(2)
    found = wrinkle.shell_indices(strip.shells, state, curvature=mode, facing=facing)
    solution, element = shell_solution(strip.shells, state, found, material(thickness=0.0012))
    again = wrinkle.wrinkle_indices(
        *wrinkle.surface_strains(solution), solution.cover.thickness, 20.0, mode
    )
    np.testing.assert_allclose(again.c, found.indices.c[element], rtol=1e-6)
    seen = face_normals(solution.positions, solution.cover.faces) @ np.array(facing)
    assert (seen > 0).all()
    assert (solution.cover.rest_area > 0).all()
    assert np.ptp(solution.cover.rest, axis=0) == pytest.approx([0.1, 0.1], rel=1e-6)


def test_warp_strain_goes_to_the_warp(strip):
    """Stretch along the longer side of a part must come back as warp strain."""
    shells = dataclasses.replace(
        strip.shells, reference=strip.shells.reference @ np.diag([1.0, 3.0, 1.0])
    )
    x = shells.reference @ np.diag([1.0, 1.1, 1.0])
    state = dataclasses.replace(strip.read(0), positions=x, strain_inner=None, strain_outer=None)
    found = wrinkle.shell_indices(shells, state)
    solution, _ = shell_solution(shells, state, found, material())
    np.testing.assert_allclose(solution.strain_mid[:, 0, 0], 0.105, rtol=1e-6)
    np.testing.assert_allclose(solution.strain_mid[:, 1, 1], 0.0, atol=1e-6)


def test_parts_become_panels_with_their_own_vertices(strip):
    part = np.where(np.arange(800) < 400, 3, 8)
    shells = dataclasses.replace(strip.shells, part=part, part_names={3: "insert"})
    state = strip.read(1)
    found = wrinkle.shell_indices(shells, state)
    cloth = material(thickness=0.0012)
    solution, _ = shell_solution(shells, state, found, {3: cloth, 8: cloth})
    cover = solution.cover
    assert cover.panel_names == ("insert", "part 8")
    owners = [set(cover.faces[cover.panel == k].ravel()) for k in (0, 1)]
    assert not owners[0] & owners[1]
    assert {row.zone for row in wrinkle.zone_table(solution, wrinkle.wrinkle_indices(
        *wrinkle.surface_strains(solution), 0.0012, 20.0))} == {"insert", "part 8"}  # fmt: skip
    with pytest.raises(InputError, match=r"materials: got none for parts \[8\]"):
        shell_solution(shells, state, found, {3: cloth})


def test_what_is_no_pattern_is_refused(strip):
    state = strip.read(1)
    found = wrinkle.shell_indices(strip.shells, state)
    bent = dataclasses.replace(strip.shells, reference=state.positions)
    with pytest.raises(InputError, match="part 1: got 23 mm out of plane at the start"):
        shell_solution(bent, state, found, material())
    with pytest.raises(InputError, match="reference: got none"):
        shell_solution(dataclasses.replace(bent, reference=None), state, found, material())
