"""Where methods fail, and that it is said: time steps, iterations, unstable and snapping states."""

import numpy as np
import pytest

from seatlook import model
from seatlook.solver import (
    Explicit,
    Load,
    Sheet,
    SheetError,
    SheetSettings,
    SolverSettings,
    Support,
    UnstableStepError,
    solve,
    solve_sheet,
)
from seatlook.solver.element.elastic import ElasticSheet
from seatlook.solver.methods.newton import Potential, newton
from support import fabrics, meshes
from support.covers import cover, flat_foam, sheet
from support.reference.counter_examples import position_based
from support.reference.hanging import explicit_limit, hanging

pytestmark = pytest.mark.failure


@pytest.mark.parametrize("thickness", [1e-1, 1e-3])
def test_explicit_above_its_time_step(thickness):
    limit = explicit_limit(thickness=thickness)
    with pytest.raises(SheetError, match=r"grew without bound .* the mesh allows .* s: shorten"):
        hanging(thickness=thickness, method=Explicit(time_step=1.3 * limit), max_iterations=400)
    below = Explicit(time_step=0.9 * limit)
    _, solved = hanging(thickness=thickness, method=below, max_iterations=4)
    assert solved.reason.startswith("residual")


def test_explicit_cover_above_its_time_step():
    X, T, x = sheet(0.12, 0.12, 0.04, z=0.002, at=(-0.06, -0.06))
    drop = model.Stage(name="drop", start=0.0, end=0.1)
    c = cover([(X, T, x)], foam=flat_foam(), stages=[drop], h=0.04)
    with pytest.raises(UnstableStepError, match="the mesh allows"):
        solve(c, settings=SolverSettings(method=Explicit(time_step=1e-2)))


@pytest.mark.parametrize("thickness", [1e-1, 1e-2, 1e-3, 1e-4])
def test_thickness(thickness):
    """Newton converges over three decades; where L-BFGS does not, it says so."""
    _, best = hanging(thickness=thickness, method="newton")
    assert best.converged
    _, other = hanging(thickness=thickness, method="lbfgs", max_iterations=1500)
    if other.converged:
        gap = np.linalg.norm(other.positions - best.positions, axis=1).max()
        assert gap < 5e-3
    else:
        assert "residual" in other.reason
        assert thickness <= 1e-3


@pytest.mark.parametrize("ratio", [1.0, 1e2, 1e5])
def test_stiffness_ratio(ratio):
    """Warp up to 1e5 times as stiff as weft."""
    _, solved = hanging(stiffness_ratio=ratio, stretch=3e4, method="newton")
    assert solved.converged, solved.reason
    tip = solved.positions[:, 2].min()
    assert tip == pytest.approx(-0.1235, abs=2e-3)


@pytest.mark.parametrize("sweeps", [(20, 200)])
def test_position_based_dynamics_depends_on_its_iterations(sweeps):
    """Ten times the sweeps change the stretch of a hanging strip by more than its own size."""
    X, T = meshes.rectangle("right", 1.0, 0.2, 0.05)
    fabric = fabrics.isotropic(1e4, 1e-2, density=0.3)
    x = np.pad(X, ((0, 0), (0, 1)))
    true = 0.5 * 0.3 * 9.81 / 1e4
    stretch = []
    for iterations in sweeps:
        moved = position_based(
            X, T, fabric, x, X[:, 0] < 1e-9, (9.81, 0, 0), dt=1.0, iterations=iterations
        )
        stretch.append((moved[X[:, 0] > 1 - 1e-9, 0].mean() - 1.0) / true)
    assert abs(stretch[0] - stretch[1]) > 1.0
    assert abs(stretch[0] - 1.0) > 1.0


def arch_states(method):
    """Shallow arch between hinges, pressed at its crown until it has to snap."""
    X, T = meshes.rectangle("right", 1.0, 0.1, 0.1)
    fabric = fabrics.isotropic(1e4, 1e-2, thickness=0.01)
    ends = (X[:, 0] < 1e-9) | (X[:, 0] > 1 - 1e-9)
    pushed = np.pad(X * [0.99, 1.0], ((0, 0), (0, 1)))
    pushed[:, 2] = 0.05 * np.sin(np.pi * X[:, 0])
    body = Sheet(X, T, fabric)
    options = {"support": Support(fixed=ends), "settings": SheetSettings(method=method)}
    arch = solve_sheet(body, start=pushed, strict=True, **options)
    crown = np.abs(X[:, 0] - 0.5) < 0.01
    loads = np.zeros((len(X), 3))
    loads[crown, 2] = -6.0 / crown.sum()
    down = solve_sheet(body, start=arch, load=Load(forces=loads), **options)
    return arch.positions[crown, 2].mean(), down.positions[crown, 2].mean(), down


@pytest.mark.parametrize("method", ["newton", "lbfgs"])
def test_snap_through(method):
    before, after, solved = arch_states(method)
    assert before > 0.05
    assert after < -0.05
    assert solved.converged, solved.reason
    assert (np.diff(solved.energy) <= 1e-9 * abs(solved.energy[0])).all() or solved.kicks


def test_flat_sheet_past_its_buckling_load_is_unstable_and_leaves():
    X, T = meshes.rectangle("right", 1.0, 0.1, 0.1)
    fabric = fabrics.isotropic(1e4, 1e-2)
    body = ElasticSheet(X, T, np.zeros(len(T), dtype=np.int64), [fabric])
    ends = (X[:, 0] < 1e-9) | (X[:, 0] > 1 - 1e-9)
    flat = np.pad(X * [0.99, 1.0], ((0, 0), (0, 1)))
    free = np.repeat(~ends[:, None], 3, axis=1)
    stayed = newton(Potential(body.energies, (), free), flat, tolerance=1e-8)
    assert stayed.downhill > 0
    for method in ("newton", "lbfgs", "explicit"):
        buckled = solve_sheet(
            Sheet(X, T, fabric),
            start=flat,
            support=Support(fixed=ends),
            settings=SheetSettings(method=method),
            strict=True,
        )
        assert buckled.kicks >= 1
        assert abs(buckled.positions[:, 2]).max() > 0.05
