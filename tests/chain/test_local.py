"""Solving to a tolerance: where the mesh is fine, what its error is, and stages on it."""

import dataclasses
from types import MappingProxyType

import numpy as np
import pytest

from seatlook import io
from seatlook.assembly import with_mesh
from seatlook.assembly.digest import content_digest
from seatlook.chain.case import Case
from seatlook.chain.local import (
    BEFORE,
    SIZED,
    coarser,
    coarsest_size,
    finest_size,
    forecast,
    solve_scene,
    with_error,
    with_scatter,
)
from seatlook.chain.local import solve as local_solve
from seatlook.errors import InputError
from seatlook.results.resolution import ASKED, CURVATURE_ERROR, REACHED
from seatlook.solver import foam_wavelength
from support.scenes import material, two_panels


def asked(tolerance, *, bending=3e-5, **change):
    """Two panels of a fabric that wrinkles in waves of some 16 mm, one too long for its seam."""
    cloth = material(bending_warp=bending, bending_weft=bending, bending_twist=0.5 * bending)
    scene = two_panels(depth_b=0.104, **change)
    cloths = MappingProxyType({"LEFT": cloth, "RIGHT": cloth})
    return with_mesh(dataclasses.replace(scene, materials=cloths), tolerance=tolerance)


@pytest.fixture(scope="module")
def shown():
    """What the solve below shows of itself."""
    return []


@pytest.fixture(scope="module")
def solved(shown):
    case = Case(asked(0.4))
    case.solve(progress=lambda name, **figures: shown.append((name, figures)))
    return case


def test_sizes_follow_from_tolerance_and_wavelength():
    scene = asked(0.05)
    wave = foam_wavelength(scene.materials["LEFT"].fabric, scene.foam.material)
    assert CURVATURE_ERROR * (finest_size(scene) / wave) ** 2 == pytest.approx(0.05)
    assert coarsest_size(scene) >= 0.007
    # However loose, another mesh must be twice as coarse to tell the error.
    stiff = asked(0.5, bending=5e-2)
    assert finest_size(stiff) == pytest.approx(0.5 * coarsest_size(stiff))


def test_a_ladder_of_meshes_halves_the_elements_until_the_first():
    scene, tolerances = asked(0.05), []
    while scene.tolerance is not None:
        tolerances.append(scene.tolerance)
        scene = coarser(scene)
    assert tolerances == pytest.approx([0.05 * 4**k for k in range(len(tolerances))])
    assert scene.element_size >= 0.007
    # No mesh is asked for a tolerance that no scene may name, however short the waves are.
    assert coarser(asked(0.4)).tolerance is None


def test_a_size_and_a_tolerance_take_each_others_place():
    scene = asked(0.05)
    sized = with_mesh(scene, element_size=0.01)
    assert sized.tolerance is None
    assert content_digest(with_mesh(sized, tolerance=0.05)) == content_digest(scene)
    with pytest.raises(InputError, match="tolerance_percent: got element_size_mm as well"):
        with_mesh(scene, element_size=0.01, tolerance=0.05)
    with pytest.raises(InputError, match=r"tolerance_percent: got 0\.1, expected 1 to 50"):
        with_mesh(scene, tolerance=0.001)


def test_forecast_says_what_at_least_and_at_most_it_takes(solved):
    expected = forecast(solved.scene)
    fewest, most = expected.vertices
    assert 0.7 * fewest < len(solved.solution.cover.rest) < 1.3 * most
    assert forecast(with_mesh(solved.scene, tolerance=0.1)).vertices[1] > most
    assert f"{most:,} vertices" in expected.sentence


def test_the_mesh_is_fine_where_it_wrinkles(solved):
    cover = solved.solution.cover
    size = np.sqrt(cover.rest_area)
    bent = solved.assessment.values("w2")
    fine, coarse = size < np.quantile(size, 0.25), size > np.quantile(size, 0.75)
    assert bent[fine].mean() > 3.0 * bent[coarse].mean()


def test_the_result_carries_its_error_and_is_judged_by_it(solved):
    solution, found = solved.solution, solved.resolution
    assert solution.figures[ASKED] == 0.4
    assert found.error == solution.figures[REACHED]
    assert (found.status == "resolved") == (found.error <= 0.4 and not found.folds)
    assert all(row.w2_mesh_error is not None for row in solved.assessment.zones)
    stricter = dataclasses.replace(
        solution, figures=MappingProxyType({**solution.figures, ASKED: 0.5 * found.error})
    )
    judged = Case(solved.scene, solution=stricter).resolution
    assert judged.status == "converged, not resolved"
    assert "zone means of W2 err by" in judged.reason


def test_cost_and_history_are_those_of_all_meshes(solved):
    solution = solved.solution
    assert (np.diff(solution.history["cpu_seconds"]) >= 0.0).all()
    assert solution.history["iterations"].sum() == solution.figures["iterations"]
    assert len(solution.history["iterations"]) == solution.figures["steps"]


def test_a_result_stands_for_its_scene_alone(solved, tmp_path):
    path = tmp_path / "r.npz"
    io.write_result(solved.solution, path)
    assert Case(solved.scene).reuse(path)
    assert not Case(with_mesh(solved.scene, tolerance=0.3)).reuse(path)
    assert not Case(coarser(solved.scene)).reuse(path)
    assert io.read_result(path).figures[ASKED] == 0.4


def test_scatter_is_that_of_seeds_on_the_first_mesh(solved):
    scattered = with_scatter(solved.scene, solved.solution, seeds=2)
    rows = Case(solved.scene, solution=scattered).assessment.zones
    assert all(row.w2_scatter is not None and row.w2_scatter >= 0.0 for row in rows)
    before = {row.zone: row.w2_mesh_error for row in solved.assessment.zones}
    assert {row.zone: row.w2_mesh_error for row in rows} == before
    with pytest.raises(InputError, match="seeds: got 1, expected 2 or more"):
        with_scatter(solved.scene, solved.solution, seeds=1)


def test_stages_are_kept_on_the_last_mesh_and_resumed_to_the_same_bits(solved, tmp_path):
    whole = Case(solved.scene)
    whole.solve_in_stages(tmp_path)
    assert len(whole.solution.cover.rest) == len(solved.solution.cover.rest)
    stages = sorted(path.name for path in tmp_path.glob("*.npz"))
    assert stages[0] == BEFORE
    again = Case(solved.scene)
    again.solve_in_stages(tmp_path, resume=True)
    np.testing.assert_array_equal(again.solution.positions, whole.solution.positions)
    assert again.resolution.error == whole.resolution.error


def test_progress_goes_from_the_first_mesh_to_the_last(solved, shown):
    done = [figures["step"] for name, figures in shown if name == "solve"]
    assert done == sorted(done)
    assert 0.0 < done[0] < 5.0
    assert done[-1] <= 100.0
    meshes = [figures["mesh"] for name, figures in shown if name == "solve"]
    assert len(set(meshes)) >= 2
    assert meshes[-1] == f"{len(solved.solution.cover.rest)} vertices:"


@pytest.fixture(scope="module")
def missed():
    """A scene that is stiff and smooth, whose first fine mesh misses the tolerance."""
    return asked(0.05, bending=3e-3)


def test_a_mesh_that_misses_its_tolerance_is_left_for_a_finer_one(missed, monkeypatch):
    tried = []

    def watched(scene, fine, coarse):
        result = with_error(scene, fine, coarse)
        tried.append((len(fine.cover.rest), result.figures[REACHED]))
        return result

    monkeypatch.setattr(local_solve, "with_error", watched)
    solution = solve_scene(missed)
    vertices, errors = zip(*tried, strict=True)
    assert len(tried) >= 2
    assert list(vertices) == sorted(set(vertices))
    assert all(error > 0.05 for error in errors[:-1])
    assert errors[-1] == solution.figures[REACHED] <= 0.05
    # However badly it is missed, the last mesh is the answer and says so.
    monkeypatch.setattr(local_solve, "_MESHES", 1)
    assert solve_scene(missed).figures[REACHED] > 0.05


def test_stages_on_a_finer_mesh_are_resumed_there(missed, tmp_path):
    whole = Case(missed)
    whole.solve_in_stages(tmp_path)
    assert whole.resolution.error <= 0.05
    assert io.read_result(tmp_path / BEFORE).figures[SIZED] < 1.0
    again = Case(missed)
    again.solve_in_stages(tmp_path, resume=True)
    np.testing.assert_array_equal(again.solution.positions, whole.solution.positions)


def test_a_mean_that_falls_errs_by_no_more_than_itself(solved):
    """W2 is nowhere below zero, so a mean has no further to fall than to there."""
    fine, coarse = solved.solution, solve_scene(coarser(solved.scene))
    mid = fine.strain_mid
    flat = dataclasses.replace(fine, strain_top=mid, strain_bottom=mid)
    rows = Case(solved.scene, solution=with_error(solved.scene, flat, coarse)).assessment.zones
    assert all(row.w2_mesh_error <= row["w2_mean"] < 1e-9 for row in rows)
