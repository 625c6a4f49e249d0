"""Fit the model observer to published thresholds, and show what it misses on those not fitted.

Run it with: python gallery/observer.py FOLDER

The folder holds the published tables that docs/measurements/score.md names; they are not part of
this project. Sensitivity is fitted on four sets and judged on a fifth, masking on every second
point of each set and judged on the others; for matches nothing is fitted. The misses [dB], not the
thresholds, are kept in docs/charts/observer.csv.
"""

from __future__ import annotations

import csv
import functools
import itertools
import sys
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
from scipy.optimize import minimize_scalar

from seatlook.model import FloatArray
from seatlook.visibility.observer import OBSERVER, Observer, contrast_sensitivity
from seatlook.visibility.vwi import score

ROOT = Path(__file__).parents[1]
CHARTS = ROOT / "docs" / "charts"
sys.path.insert(0, str(ROOT / "tests"))

import matplotlib  # noqa: E402

matplotlib.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402

from support.seen.published import (  # noqa: E402
    FITTED,
    HELD_OUT,
    Detected,
    Masked,
    Matched,
    detected,
    masked,
    matched,
)
from support.seen.stimuli import axes, grating  # noqa: E402

# Two places of a pattern between the octaves of the pyramid: on one, and midway.
PIXELS_PER_CYCLE = (4.56, 6.45)
LEAST = 2.0  # sensitivity below which a pattern of full contrast was hardly seen: not fitted
OUTLIER = 6.0  # [dB] from which a miss counts by its size, not its square
GAINS, NEIGHBOURS = (0.3, 0.4, 0.5, 0.6), (0.0, 1.0, 2.0, 3.0)
CONSTANTS = ("area_deg2", "gain", "masking_gain", "masking_neighbours", "pooling")
CONTRASTS = np.geomspace(2e-3, 0.98, 22)

Formula = Callable[[FloatArray, float, float], FloatArray]
Miss = tuple[str, str, float, float]  # panel, set, where on its axis, dB


def main(folder: Path) -> None:
    """Fit, print, keep and draw."""
    rows = detected(folder)
    fit_sensitivity(rows)
    sets = masked(folder)
    fit_masking(sets)
    misses = [*misses_of_detection(rows), *misses_of_masking(sets), *misses_of_matches(folder)]
    with (CHARTS / "observer.csv").open("w", newline="", encoding="utf-8") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(("panel", "set", "at", "miss_db"))
        writer.writerows(
            ("observer", name, f"{getattr(OBSERVER, name):g}", "") for name in CONSTANTS
        )
        writer.writerows((p, s, f"{at:.4g}", f"{miss:.2f}") for p, s, at, miss in misses)
    for name in dict.fromkeys(miss[1] for miss in misses):
        mine = np.array([miss[3] for miss in misses if miss[1] == name])
        print(f"| {name} | {len(mine)} | {rms(mine):.2f} | {mine.mean():+.2f} |", flush=True)
    draw(misses)


def fit_sensitivity(rows: list[Detected]) -> None:
    """Fit two formulas, and print what each misses of the set that is held out.

    The size of the field by the shape within every fitted set, the gain by the mean of what the
    sets miss.
    """
    octaves = [octaves_of(row, step) for row in rows for step in PIXELS_PER_CYCLE]
    twice = [row for row in rows for _ in PIXELS_PER_CYCLE]
    groups = [
        [k for k, row in enumerate(twice) if row.source == name and row.sensitivity >= LEAST]
        for name in FITTED
    ]
    held_out = [k for k, row in enumerate(twice) if row.source == HELD_OUT]

    def missed(formula: Formula, log_area: float) -> FloatArray:
        area = float(np.exp(log_area))
        seen = (
            np.sum((formula(f, row.luminance, area) * amount) ** OBSERVER.pooling)
            for (f, amount), row in zip(octaves, twice, strict=True)
        )
        published = np.array([row.sensitivity for row in twice])
        return 20 * np.log10(np.array(list(seen)) ** (1 / OBSERVER.pooling) / published)

    def badness(log_area: float, formula: Formula) -> float:
        miss = missed(formula, log_area)
        off = (miss[group] - miss[group].mean() for group in groups)
        return float(np.mean([np.mean(np.sqrt(1 + (x / OUTLIER) ** 2)) for x in off]))

    print("| formula | area [deg2] | gain | badness | held out: rms [dB] |")
    for formula in (castle, barten):
        best = minimize_scalar(badness, args=(formula,), bounds=(-3.0, 4.0), method="bounded")
        miss = missed(formula, best.x)
        off = np.mean([miss[group].mean() for group in groups])
        print(
            f"| {formula.__name__} | {np.exp(best.x):.3g} | {10 ** (-off / 20):.3g} "
            f"| {best.fun:.3f} | {rms(miss[held_out] - off):.2f} |",
            flush=True,
        )


def castle(frequency: FloatArray, luminance: float, area: float) -> FloatArray:
    """The formula of the project."""
    return contrast_sensitivity(frequency, luminance, area_deg2=area)


def barten(frequency: FloatArray, luminance: float, area: float) -> FloatArray:
    """Barten's closed formula (Proc. SPIE 5294, 2003) for a square field."""
    f2 = np.square(frequency)
    optics = np.exp(-0.0016 * f2 * (1 + 100 / luminance) ** 0.08)
    summation = 1 + 144 / area + 0.64 * f2
    noise = 63 / luminance**0.83 - 1 / np.expm1(-0.02 * f2)
    return np.asarray(5200 * optics / np.sqrt(summation * noise))


def octaves_of(row: Detected, pixels_per_cycle: float) -> tuple[FloatArray, FloatArray]:
    """Frequencies of the octaves, and what they hold of a pattern of contrast 1."""
    small = 1e-3  # contrast, so that the pattern does not change its own ground
    pattern, ppd = row.pattern(pixels_per_cycle)
    flat = np.full(pattern.shape, row.luminance)
    bands = score(flat * (1 + small * pattern), flat, pixels_per_degree=ppd).bands
    frequency = np.array([band.frequency for band in bands])
    S = contrast_sensitivity(frequency, row.luminance, area_deg2=OBSERVER.area_deg2)
    return frequency, np.array([band.vwi for band in bands]) / (small * OBSERVER.gain * S)


def fit_masking(sets: dict[str, list[Masked]]) -> None:
    """Print what every pair of constants misses: fitted points, and those held out."""
    print("| k | w | fitted: rms [dB] | held out |")
    for gain, neighbours in itertools.product(GAINS, NEIGHBOURS):
        observer = replace(OBSERVER, masking_gain=gain, masking_neighbours=neighbours)
        parts = [missed_masks(points, observer) for points in sets.values()]
        halves = [rms(np.concatenate([part[k::2] for part in parts])) for k in (1, 0)]
        print(f"| {gain:g} | {neighbours:g} | {halves[0]:.2f} | {halves[1]:.2f} |", flush=True)


def missed_masks(points: list[Masked], observer: Observer) -> FloatArray:
    """Miss [dB] of all points but the first, which sets how well these observers saw."""
    first = points[0]
    for _ in range(3):
        off = first.predicted_db(observer) - first.threshold_db
        observer = replace(observer, gain=observer.gain * 10 ** (off / 20))
    return np.array([point.predicted_db(observer) - point.threshold_db for point in points[1:]])


def misses_of_detection(rows: list[Detected]) -> list[Miss]:
    """Predicted over published sensitivity [dB], mean of two places between the octaves."""
    found = []
    for row in rows:
        seen = []
        for step in PIXELS_PER_CYCLE:
            pattern, ppd = row.pattern(step)
            flat, contrast = np.full(pattern.shape, row.luminance), min(0.2 / row.sensitivity, 0.1)
            d = score(flat * (1 + contrast * pattern), flat, pixels_per_degree=ppd).vwi
            seen.append(decibel(d / contrast / row.sensitivity))
        name = f"{row.source}, held out" if row.source == HELD_OUT else row.source
        found.append(("detection", name, row.frequency, float(np.mean(seen))))
    return found


def misses_of_masking(sets: dict[str, list[Masked]]) -> list[Miss]:
    """Predicted over published threshold [dB]."""
    found = []
    for points in sets.values():
        misses = missed_masks(points, OBSERVER)
        for k, (point, miss) in enumerate(zip(points[1:], misses, strict=True)):
            half = "held out" if k % 2 == 0 else "fitted"
            found.append(("masking", f"{point.source}, {half}", point.at_db, float(miss)))
    return found


def misses_of_matches(folder: Path) -> list[Miss]:
    """Predicted over published match [dB]; the same of plain contrast."""
    found: list[Miss] = []
    for match in matched(folder):
        published = match.match[2]
        found += [
            ("matches", match.source, match.at, decibel(matching(match) / published)),
            ("plain contrast", f"{match.source}, plain", match.at,
             decibel(match.shown[2] / published)),
        ]  # fmt: skip
    return found


def matching(match: Matched) -> float:
    """Least contrast that looks at least as strong as what was shown."""
    strong = np.interp(match.shown[2], CONTRASTS, strength(*match.shown[:2]))
    seen = strength(*match.match[:2])
    above = max(int((seen <= 0).sum()) - 1, 0)
    return float(np.interp(strong, seen[above:], CONTRASTS[above:]))


@functools.cache
def strength(frequency: float, luminance: float) -> FloatArray:
    """Apparent contrast [%] of a grating over its contrast, in a field with soft edges."""
    size = max(3.0, 2 / frequency) if frequency < 8 else 1.8
    ppd = max(6 * frequency, 8.0)
    x, y = axes(1.6 * size, ppd)
    beyond = np.clip((np.hypot(x, y) / (size / 2) - 1) / 0.4, 0, 1)
    bars = grating(x, y, frequency) * (0.5 + 0.5 * np.cos(np.pi * beyond))
    flat = np.full(x.shape, luminance)
    return np.array(
        [
            score(flat * (1 + c * bars), flat, pixels_per_degree=ppd, mask=beyond == 0)
            .apparent_contrast
            for c in CONTRASTS
        ]
    )  # fmt: skip


def draw(misses: list[Miss]) -> None:
    """Chart every point by panel and set."""
    panels = {
        "detection": ("frequency [cycles/deg]", "log"),
        "masking": ("contrast of the mask [dB]", "linear"),
        "matches": ("frequency [cycles/deg], or luminance [cd/m2]", "log"),
    }
    figure, axs = plt.subplots(1, 3, figsize=(13, 4.6), layout="constrained", sharey=True)
    for axis, (panel, (label, scale)) in zip(axs, panels.items(), strict=True):
        points = [miss for miss in misses if miss[0] == panel]
        names = list(dict.fromkeys(miss[1] for miss in points))
        for k, name in enumerate(names):
            xy = np.array([miss[2:] for miss in points if miss[1] == name])
            marker = "o" if "held out" in name or panel == "matches" else "x"
            axis.plot(*xy.T, marker, ms=4, mfc="none", color=f"C{k % 10}",
                      label=f"{name}: {rms(xy[:, 1]):.1f} dB")  # fmt: skip
        axis.axhline(0, color="grey", lw=0.8)
        axis.set(title=panel, xlabel=label, xscale=scale)
        axis.grid(alpha=0.3)
        axis.legend(fontsize=7)
    axs[0].set_ylim(-17, 19)
    axs[0].set_ylabel("predicted over published [dB]")
    figure.savefig(CHARTS / "observer.svg")


def rms(values: FloatArray) -> float:
    """Root mean square."""
    return float(np.sqrt(np.mean(np.square(values))))


def decibel(ratio: float) -> float:
    """Ratio of contrasts in dB."""
    return float(20 * np.log10(ratio))


if __name__ == "__main__":
    main(Path(sys.argv[1]))
