"""The demo cover sewn, hooked and covered with its allowances folded; values printed (``-s``)."""

import dataclasses

import numpy as np
import pytest

from seatlook import io, mesh
from seatlook.assembly import assemble
from seatlook.results.energy_balance import energy_balance
from seatlook.seats import write_demo
from seatlook.solver import solve

pytestmark = pytest.mark.validate


@pytest.fixture(scope="module")
def covers(tmp_path_factory):
    """Without and with hem, on one mesh of 10k vertices."""
    folder = tmp_path_factory.mktemp("demo")
    write_demo(
        folder,
        ease={},
        short={},
        material="leather-laminate",
        insert="leather-laminate",
        element_size_mm=7.0,
        seed=0,
    )
    scene = io.load_scene(folder / "scene.toml")
    return [solve(assemble(dataclasses.replace(scene, hem=hem))) for hem in (False, True)]


def test_finished_cover_with_hem(covers, capsys):
    _, solution = covers
    figures, balance = solution.figures, energy_balance(solution)
    parts = [
        np.array([figures[f"{name}_{axis}"] for axis in "xyz"])
        for name in ("weight", "ties", "contact", "friction")
    ]
    resultant = np.linalg.norm(sum(parts)) / sum(np.linalg.norm(p) for p in parts)
    seconds = [s.figures["cpu_seconds"] for s in covers]
    with capsys.disabled():
        print(
            f"\n    {len(solution.positions)} vertices, {seconds[1]:.1f} CPU s, without hem "
            f"{seconds[0]:.1f}; seams {1e3 * figures['seam_gap_max']:.4f} mm, wires "
            f"{1e3 * figures['hook_gap_max']:.4f} mm, resultant {resultant:.1e}, work "
            f"{balance.work_in:.2f} J, damping {balance.damping:.2f} J, left {balance.share:.2%}"
        )
    assert solution.status == "converged", solution.reason
    assert figures["seam_gap_max"] < 1e-4
    assert figures["hook_gap_max"] < 5e-4
    assert figures["intersecting_pairs"] == 0
    assert figures["hem_crossing_pairs"] == 0
    assert resultant <= 0.01
    assert balance.share <= 0.05


def test_shape_with_and_without_hem(covers, capsys):
    """Along the normal, over all of the cover."""
    plain, hemmed = covers
    cover = plain.cover
    assert cover.rest.tobytes() == hemmed.cover.rest.tobytes()
    normal = mesh.vertex_normals(plain.positions, cover.faces)
    off = ((hemmed.positions - plain.positions) * normal).sum(axis=1)
    rms = float(np.sqrt(np.mean(off**2)))
    with capsys.disabled():
        print(f"\n    with and without hem {1e3 * rms:.3f} mm rms")
    assert rms < 1.5e-3
