"""Wrinkles of a stretched clamped sheet against its thickness and stretch, with their exponents.

Run it with: python gallery/stretched_sheet.py

A sheet of 250 x 100 mm, Poisson's ratio 0.5, on unstructured meshes of equally many edges to the
wave that a thin long sheet would have, 2 sqrt(pi) (B / T)^(1/4) sqrt(L) (Cerda and Mahadevan 2003),
which goes by thickness^(1/2) and stretch^(-1/4). Rows in docs/charts/stretched_sheet.csv are kept,
not run again; delete one to repeat it.
"""

from __future__ import annotations

import csv
import sys
import time
from pathlib import Path

import numpy as np

ROOT = Path(__file__).parents[1]
CHARTS = ROOT / "docs" / "charts"
TABLE = CHARTS / "stretched_sheet.csv"
sys.path.insert(0, str(ROOT / "tests"))

import matplotlib  # noqa: E402

matplotlib.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402

from support.reference.stretched import LENGTH, POISSON, stretched, wave_and_amplitude  # noqa: E402

MEASURED = {"wave_mm": "wave length [mm]", "amplitude_t": "amplitude / thickness"}
LABELS = {"thickness_mm": "thickness [mm] (10 % stretch)", "stretch": "stretch (0.1 mm thick)"}
COLUMNS = ("thickness_mm", "stretch", "seed", "h_mm", "vertices", "wave_mm", "amplitude_t",
           "cpu_seconds")  # fmt: skip
# Thickness [mm], stretch, seed; h is 2.5 mm at 0.1 mm and 10 %.
CASES = (
    *((0.1, 0.10, seed) for seed in range(5)),
    (0.1, 0.05, 0), (0.1, 0.15, 0), (0.1, 0.20, 0), (0.05, 0.10, 0), (0.07, 0.10, 0),
)  # fmt: skip


def theory(thickness: float, stretch: float) -> float:
    """Wave length [m] of a thin long sheet of this thickness [m] under this stretch."""
    bending_over_tension = thickness**2 / (12.0 * (1.0 - POISSON**2) * stretch)
    return float(2.0 * np.sqrt(np.pi) * bending_over_tension**0.25 * np.sqrt(LENGTH))


def run(thickness_mm: float, stretch: float, seed: int) -> tuple[float | int, ...]:
    """Solve one case."""
    thickness = 1e-3 * thickness_mm
    h = 2.5e-3 * theory(thickness, stretch) / theory(1e-4, 0.1)
    clock = time.process_time()
    X, x = stretched("uns", h, seed=seed, thickness=thickness, stretch=stretch)
    wave, amplitude = wave_and_amplitude(X, x, thickness)
    return (thickness_mm, stretch, seed, round(1e3 * h, 3), len(X), round(1e3 * wave, 3),
            round(amplitude, 3), round(time.process_time() - clock, 1))  # fmt: skip


def rows() -> list[dict[str, float]]:
    """Return the table, with what it lacked."""
    if not TABLE.exists():
        TABLE.write_text(",".join(COLUMNS) + "\n", encoding="utf-8")
    done = read()
    for case in CASES:
        if case not in {(r["thickness_mm"], r["stretch"], int(r["seed"])) for r in done}:
            row = run(*case)
            print(*row, flush=True)
            with TABLE.open("a", newline="", encoding="utf-8") as file:
                csv.writer(file, lineterminator="\n").writerow(row)
    return read()


def read() -> list[dict[str, float]]:
    """Read the table."""
    with TABLE.open(encoding="utf-8") as file:
        return [{k: float(v) for k, v in row.items()} for row in csv.DictReader(file)]


def main() -> None:
    """Draw wave length and amplitude over thickness and stretch, fit the wave's exponents."""
    found = rows()
    figure, axes = plt.subplots(2, 2, figsize=(9, 7), layout="constrained", sharey="row")
    for column, key in enumerate(LABELS):
        other = next(name for name in LABELS if name != key)
        mine = sorted((r for r in found if r[other] == 0.1), key=lambda r: r[key])
        x, wave, amplitude = (np.array([r[name] for r in mine]) for name in (key, *MEASURED))
        waves(axes[0, column], key, x, wave)
        axes[1, column].plot(x, amplitude, "o", mfc="none")
        axes[1, column].set(xscale="log", ylim=(0, None), ylabel=MEASURED["amplitude_t"])
        for axis in axes[:, column]:
            axis.set_xticks(np.unique(x), [f"{v:g}" for v in np.unique(x)])
            axis.minorticks_off()
            axis.set_xlabel(LABELS[key])
            axis.grid(alpha=0.3)
    axes[0, 0].set_yticks([10, 12, 14, 16, 18, 20], ["10", "12", "14", "16", "18", "20"])
    seeds = np.array([[r["wave_mm"], r["amplitude_t"]] for r in found
                      if (r["thickness_mm"], r["stretch"]) == (0.1, 0.1)])  # fmt: skip
    mean, spread = seeds.mean(axis=0), seeds.std(axis=0, ddof=1)
    print(f"{len(seeds)} seeds: {mean[0]:.2f} mm (sd {spread[0]:.2f}), "
          f"{mean[1]:.2f} t (sd {spread[1]:.2f})")  # fmt: skip
    figure.suptitle("Stretched clamped sheet, 250 x 100 mm, Poisson's ratio 0.5")
    figure.savefig(CHARTS / "stretched_sheet.svg")


def waves(axis: plt.Axes, key: str, x: np.ndarray, wave: np.ndarray) -> None:
    """Wave lengths, their power law, and that of a thin long sheet; flat sheets have none."""
    there = np.isfinite(wave)
    slope, level = np.polyfit(np.log(x[there]), np.log(wave[there]), 1)
    print(f"wave length over {key}: exponent {slope:+.3f}")
    t, e = (x, 0.1) if key == "thickness_mm" else (0.1, x)
    thin = [1e3 * theory(1e-3 * a, b) for a, b in np.broadcast(t, e)]
    exponent = 0.5 if key == "thickness_mm" else -0.25
    axis.plot(x, wave, "o", mfc="none", label="solved, seeds 0 to 4 where five")
    axis.plot(x[there], np.exp(level) * x[there] ** slope, label=f"fit, exponent {slope:+.2f}")
    axis.plot(x, thin, "--", label=f"thin long sheet, {exponent:+.2f}")
    axis.set(xscale="log", yscale="log", ylabel=MEASURED["wave_mm"])
    axis.legend(fontsize=8)


if __name__ == "__main__":
    main()
