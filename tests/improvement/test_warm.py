"""Answers from the last balance."""

from dataclasses import replace

import numpy as np
import pytest

from seatlook.assembly import assemble
from seatlook.chain.assess import assess
from seatlook.chain.files import reusable
from seatlook.errors import InputError
from seatlook.improvement.warm import is_warm, solve_warm
from seatlook.model.scene import Freedom
from seatlook.solver import solve

MM = 1e-3


def moved(a, b):
    return np.linalg.norm(a.positions - b.positions, axis=1)


def net_means(solution):
    return {row.zone: row["w2_net_mean"] for row in assess(solution).zones}


@pytest.fixture(scope="module")
def eased(changes, candidates, solved):
    """One sewing line of the insert 4 mm longer."""
    line = next(c for c in candidates if c.kind == "length" and c.name == "INSERT.BOLSTER_L")
    return solve_warm(solved, changes.cover({line: 4 * MM}))


def test_an_unchanged_cover_stays_where_it_is(solved):
    again = solve_warm(solved, solved.cover)
    assert again.status == "converged"
    assert moved(again, solved).max() < 0.01 * MM


def test_ease_added_and_removed_leaves_no_wrinkle(eased, solved):
    assert eased.status == "converged"
    assert moved(eased, solved).max() > 0.5 * MM
    back = solve_warm(eased, solved.cover)
    assert back.status == "converged"
    assert moved(back, solved).max() < 0.5 * MM
    assert moved(back, solved).mean() < 0.05 * MM
    before, after = net_means(solved), net_means(back)
    for zone, mean in before.items():
        assert after[zone] == pytest.approx(mean, rel=0.03, abs=2e-3), zone


def test_a_warm_answer_never_stands_for_a_scene(eased, solved, scene):
    assert reusable(solved, scene)
    assert is_warm(eased)
    assert not is_warm(solved)
    assert not reusable(eased, scene)
    assert not reusable(solve_warm(solved, solved.cover), scene)


def test_foam_friction_and_hooks_change_warm_too(solved, changes, candidates):
    hook = next(c for c in candidates if c.kind == "hook")
    cover = changes.cover({hook: 2 * MM})
    foam = replace(cover.foam, material=replace(cover.foam.material, friction=0.1))
    result = solve_warm(solved, replace(cover, foam=foam))
    assert result.status == "converged"
    assert moved(result, solved).max() > 1 * MM


def test_another_mesh_and_an_open_start_are_refused(solved, scene):
    with pytest.raises(InputError, match="same triangles"):
        solve_warm(solved, assemble(scene, element_size=0.03))
    with pytest.raises(InputError, match="converged result at rest"):
        solve_warm(replace(solved, status="not converged", reason="made up"), solved.cover)


@pytest.mark.validate
def test_warm_agrees_with_cold_within_the_scatter_and_takes_a_part_of_its_time(
    scene, solved, changes, candidates
):
    """Zones against four seeds of the changed scene; bars of the issue."""
    rng, kept, bias, ratio = np.random.default_rng(4), [], [], []
    cut = [c for c in candidates if c.kind in ("offset", "length")]
    for _ in range(4):
        picked = rng.choice(len(cut), 3, replace=False)
        amounts = {cut[k]: float(rng.uniform(-4 * MM, 4 * MM)) for k in picked}
        warm = solve_warm(solved, changes.cover(amounts))
        changed = replace(scene, pattern=changes.pattern(amounts))
        cold = [solve(assemble(changed, seed=seed)) for seed in range(4)]
        seconds = np.median([one.figures["cpu_seconds"] for one in cold])
        ratio.append(warm.figures["cpu_seconds"] / seconds)
        rows = [{z.zone: z["w2_mean"] for z in assess(one).zones} for one in (warm, *cold)]
        for zone in rows[0]:
            values = np.array([row[zone] for row in rows[1:]])
            if values.mean() > 0.02:
                away = rows[0][zone] - values.mean()
                kept.append(abs(away) < max(2.0 * values.std(ddof=1), 0.02 * values.mean()))
                bias.append(away / values.mean())
    error = np.std(bias) / np.sqrt(len(bias))
    assert abs(np.mean(bias)) < 3.0 * error
    assert np.mean(kept) >= 0.9
    assert np.median(ratio) <= 0.5


def test_what_may_change_is_no_part_of_a_result(solved, scene):
    assert reusable(solved, replace(scene, improve=Freedom(edge=0.001, frozen=("INSERT.FRONT",))))
