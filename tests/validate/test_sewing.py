"""How a cover is sewn against what it looks like, on a small cover; values printed (``-s``)."""

import numpy as np
import pytest

from seatlook import model
from seatlook.assembly import assemble
from seatlook.chain.assess import assess
from seatlook.results.energy_balance import energy_balance
from seatlook.results.gap import gap
from seatlook.solver import solve
from support import patch

pytestmark = pytest.mark.validate
SEEDS = range(5)


@pytest.fixture
def report(capsys):
    def show(text):
        with capsys.disabled():
            print(f"\n    {text}", end="")

    return show


def solved(scene, seed=0):
    solution = solve(assemble(scene, seed=seed))
    assert solution.status == "converged", solution.reason
    return solution


def zone(scene, solution, name):
    rows = assess(solution).zones
    return next(row for row in rows if row.zone == name)


def differ(a, b):
    """Mean difference over its standard error, paired."""
    d = np.array(b) - np.array(a)
    return d.mean() / (d.std(ddof=1) / np.sqrt(len(d)))


def spearman(values):
    """Rank correlation with the order given."""
    rank = np.argsort(np.argsort(values))
    return float(np.corrcoef(np.arange(len(values)), rank)[0, 1])


def compare(first, other, report, what):
    rms = patch.shape_rms(first, other)
    gap = other.figures["seam_gap_max"]
    w2 = [patch.low_passed_w2(s) for s in (first, other)]
    change = w2[1] / w2[0] - 1
    report(f"{what}: gap {1e3 * gap:.4f} mm, shape rms {1e3 * rms:.3f} mm, W2 {change:+.1%}")
    assert gap < 1e-4
    assert rms < 0.5e-3
    assert abs(change) < 0.1


def test_pitch_on_one_mesh(report):
    """3, 5 and 10 mm; the mesh is the same, and fine enough for each to be another one."""
    scene = patch.scene(h=0.0035)
    covers = {p: assemble(patch.with_pitch(scene, p)) for p in (0.003, 0.005, 0.010)}
    counts = [len(c.stitchings[0].length) for c in covers.values()]
    assert counts == sorted(counts, reverse=True)
    assert len(set(counts)) == 3
    solutions = {p: solve(c) for p, c in covers.items()}
    first = solutions[0.005]
    for p, s in solutions.items():
        assert s.cover.rest.tobytes() == first.cover.rest.tobytes()
        assert s.status == "converged", s.reason
        compare(
            first, s, report, f"pitch {1e3 * p:g} mm, {len(s.cover.stitchings[0].length)} pairs"
        )


def test_element_sizes_across_one_seam(report):
    """Both panels at 6 mm, and the left one at 3 mm."""
    both = solved(patch.scene(h=0.006))
    mixed = solved(patch.scene(h=0.006, element_sizes={"LEFT": 0.003}))
    assert len(mixed.cover.rest) > 2 * len(both.cover.rest)
    compare(both, mixed, report, "3 mm against 6 mm")


@pytest.mark.parametrize("material", ["black-leather", "leather-laminate"])
def test_hem_changes_the_seam_and_hardly_the_shape(material, report):
    bands = {False: [], True: []}
    rms = []
    for seed in SEEDS:
        pair = {}
        for hem in bands:
            scene = patch.scene(material=material, hem=hem)
            pair[hem] = solved(scene, seed)
            bands[hem].append(zone(scene, pair[hem], "seam LEFT-RIGHT")["w2_mean"])
        rms.append(patch.shape_rms(pair[False], pair[True]))
    score = differ(bands[False], bands[True])
    report(
        f"{material}: shape rms {1e3 * max(rms):.3f} mm, W2 in the band "
        f"{np.mean(bands[False]):.4f} without, {np.mean(bands[True]):.4f} with, {score:.1f} sd"
    )
    assert max(rms) < 1.5e-3
    assert abs(score) > 2.8


def test_compression_in_the_band_grows_with_the_ease(report):
    eases = (0.0, 0.005, 0.01, 0.02, 0.04)
    means = []
    for ease in eases:
        scene = patch.scene(valley=0.0, tension=0.0, ease=ease)
        values = [
            zone(scene, solved(scene, k), "seam LEFT-RIGHT").w_compression_mean for k in SEEDS
        ]
        means.append(np.mean(values))
        report(f"ease {ease:.1%}: W_compression {means[-1]:.5f}, sd {np.std(values, ddof=1):.5f}")
    report(f"Spearman {spearman(means):.2f}")
    assert spearman(means) >= 0.9


def stretched_share(scene, solution):
    """W_stretch / W2 of the right panel, over elements with W2 > 0.1 and a strain above 1e-3."""
    w, cover = assess(solution).indices, solution.cover
    strain = np.abs(np.linalg.eigvalsh(solution.strain_mid)).max(axis=1)
    inner = np.array([name != "free edge" for name in cover.zone_names])[cover.zone]
    chosen = inner & (cover.panel == 1) & (w.w2 > 0.1) & (strain > 1e-3)
    assert chosen.sum() > 5
    area = cover.rest_area[chosen]
    return float((area @ w.w_stretch[chosen]) / (area @ w.w2[chosen]))


def test_a_short_panel_has_a_larger_share_of_stretch(report):
    """Not the larger the shorter it is.

    Pulled harder, the panel contracts across the pull, and eq. 4 calls that more balanced.
    """
    share = {}
    for short in (0.0, 0.01, 0.02, 0.03, 0.04):
        scene = patch.scene(short=short)
        share[short] = [stretched_share(scene, solved(scene, seed)) for seed in SEEDS]
        mean, sd = np.mean(share[short]), np.std(share[short], ddof=1)
        report(f"short {short:.0%}: {mean:.3f}, sd {sd:.3f}")
        if short:
            assert differ(share[0.0], share[short]) > 2.8
    report(f"Spearman {spearman([np.mean(v) for v in share.values()]):.2f}")


def test_work_and_forces_balance(report):
    """With friction, hem and a hooked seam."""
    scene = patch.scene(hem=True)
    hook = model.Hook(name="wire", line="LEFT-RIGHT", wire="wire", stage="cover", pitch=0.03)
    for hooks in ((), (hook,)):
        solution = solved(patch.dataclasses.replace(scene, hooks=hooks))
        balance = energy_balance(solution)
        report(
            f"work {balance.work_in:.4f} J, stored {balance.stored:.4f}, friction "
            f"{balance.friction:.4f}, damping {balance.damping:.4f}: {balance.share:.2%} left"
        )
        assert balance.share <= 0.05
        figures = solution.figures
        parts = [
            np.array([figures[f"{name}_{axis}"] for axis in "xyz"])
            for name in ("weight", "ties", "contact", "friction")
        ]
        total = np.linalg.norm(sum(parts)) / sum(np.linalg.norm(p) for p in parts)
        report(f"resultant {total:.2e} of the sum of the magnitudes")
        assert total <= 0.01


def test_balanced_hooking_improves_map_and_zones(report):
    """A seam hooked at one end only, and along its whole length."""
    scene = patch.scene(tension=0.0)
    row = {}
    for name, end in (("before", 0.05), ("after", None)):
        hook = model.Hook(
            name="wire", line="LEFT-RIGHT", wire="wire", stage="cover", pitch=0.03, end=end
        )
        mine = patch.dataclasses.replace(scene, hooks=(hook,))
        solution = solved(mine)
        gaps = gap(solution)
        known = np.isfinite(gaps)
        area = solution.cover.rest_area[known]
        rms = np.sqrt(np.average(gaps[known] ** 2, weights=area))
        found = zone(mine, solution, "seam LEFT-RIGHT")
        row[name] = rms, found["w2_mean"]
        report(f"{name}: gap rms {1e3 * rms:.3f} mm, W2 in the band {found['w2_mean']:.4f}")
    assert row["after"][0] < row["before"][0]
