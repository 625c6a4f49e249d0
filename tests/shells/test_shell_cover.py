"""A finite-element state as a solution: same indices, seen from the right side."""

import dataclasses
from pathlib import Path

import numpy as np
import pytest

from seatlook import wrinkle
from seatlook.chain.assess import assess
from seatlook.chain.shells.states import ShellCriteria, shell_indices
from seatlook.errors import InputError
from seatlook.io.lsdyna.shells import read_shells
from seatlook.mesh import face_normals
from seatlook.shells.cover import shell_cover
from support.scenes import material

DATA = Path(__file__).parents[1] / "data"


@pytest.fixture(scope="module")
def strip():
    return read_shells(DATA / "bent_strip.d3plot")


@pytest.mark.parametrize("facing", [(0, 0, 1), (0, 0, -1)])
@pytest.mark.parametrize("mode", ["paper", "tensor"])
def test_the_solution_has_the_same_indices(strip, mode, facing):
    state = strip.read(2)
    found = shell_indices(strip.shells, state, ShellCriteria(curvature=mode, facing=facing))
    made = shell_cover(strip.shells, state, found, material(thickness=0.003))
    solution, element = made.solution, made.element
    assert made.projected == ()
    # The shells' own thickness, not the material's.
    np.testing.assert_allclose(solution.cover.thickness, 0.0012, rtol=1e-6)
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
    found = shell_indices(shells, state)
    solution = shell_cover(shells, state, found, material()).solution
    np.testing.assert_allclose(solution.strain_mid[:, 0, 0], 0.105, rtol=1e-6)
    np.testing.assert_allclose(solution.strain_mid[:, 1, 1], 0.0, atol=1e-6)


def test_parts_become_panels_with_their_own_vertices(strip):
    part = np.where(np.arange(800) < 400, 3, 8)
    shells = dataclasses.replace(strip.shells, part=part, part_names={3: "insert"})
    state = strip.read(1)
    found = shell_indices(shells, state)
    cloth = material(thickness=0.0012)
    solution = shell_cover(shells, state, found, {3: cloth, 8: cloth}).solution
    cover = solution.cover
    assert cover.panel_names == ("insert", "part 8")
    owners = [set(cover.faces[cover.panel == k].ravel()) for k in (0, 1)]
    assert not owners[0] & owners[1]
    assert {row.zone for row in assess(solution).zones} == {"insert", "part 8"}
    with pytest.raises(InputError, match=r"materials: got none for parts \[8\]"):
        shell_cover(shells, state, found, {3: cloth})


@pytest.mark.parametrize("reference", ["bent", "none"])
def test_a_part_without_a_flat_state_is_laid_out_along_the_axes(strip, reference):
    """An arch of 115 degrees looks up and to two sides: three panels, one zone, same indices."""
    state = strip.read(1)
    shape = state.positions if reference == "bent" else None
    shells = dataclasses.replace(strip.shells, reference=shape)
    found = shell_indices(shells, state, ShellCriteria(curvature="tensor", facing=(0, 0, 1)))
    made = shell_cover(shells, state, found, material())
    cover = made.solution.cover
    assert made.projected == ("part 1",)
    assert cover.zone_names == ("part 1",)
    assert set(cover.panel_names) == {"part 1 +x", "part 1 -x", "part 1 +z"}
    assert (cover.rest_area > 0).all()
    assert (face_normals(made.solution.positions, cover.faces)[:, 2] > 0).all()
    again = wrinkle.wrinkle_indices(
        *wrinkle.surface_strains(made.solution), cover.thickness, 20.0, "tensor"
    )
    np.testing.assert_allclose(again.c, found.indices.c[made.element], rtol=1e-6)


def test_strains_of_a_turned_shell_keep_their_shear(strip):
    """Shear in warp and weft axes must not change its sign with the order of the corners."""
    shells = strip.shells
    x = shells.reference.copy()
    x[:, 0] += 0.02 * x[:, 1]
    state = dataclasses.replace(strip.read(0), positions=x, strain_inner=None, strain_outer=None)
    corners = np.array(shells.corners)
    corners[::3] = corners[::3][:, [1, 0, 2, 2]]
    turned = dataclasses.replace(shells, corners=corners)
    for one in (shells, turned):
        found = shell_indices(one, state, ShellCriteria(facing=(0, 0, 1)))
        solution = shell_cover(one, state, found, material()).solution
        np.testing.assert_allclose(solution.strain_mid[:, 0, 1], 0.01, rtol=1e-6)
