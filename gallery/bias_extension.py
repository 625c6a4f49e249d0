"""Two ways to read a strip at 45 degrees, over how stiff it is in shear against tension.

Run it with: python gallery/bias_extension.py

A clamped strip (H/W = 2.5) of a fabric of known shear stiffness G and tension Ea is pulled by a
little in the solver. Its force is read by the energy of turning yarns, which do not stretch, and as
a sheet that stretches evenly; docs/charts/bias_extension.svg and .csv. The curves cross where
``seatlook.identify.bias.SWITCH`` stands.
"""

from __future__ import annotations

import csv
from pathlib import Path

import matplotlib
import numpy as np

matplotlib.use("Agg")
from matplotlib import pyplot as plt

from seatlook.identify.bias import SWITCH, Frame, shear_modulus
from seatlook.model import Curve, Fabric
from seatlook.solver import Sheet, SheetSettings, Support, solve_sheet

CHARTS = Path(__file__).parents[1] / "docs" / "charts"
WIDTH, LENGTH, TENSION = 0.04, 0.10, 8000.0
RATIOS = (0.003, 0.006, 0.0125, 0.025, 0.05, 0.1, 0.2, 0.4)


def strip(shear: float, displacement: float, across: int = 16) -> float:
    """Force [N] of the jaws of a strip at 45 degrees, at a displacement [m]."""
    along = round(across * LENGTH / WIDTH)
    x, y = np.meshgrid(np.linspace(0, LENGTH, along + 1), np.linspace(0, WIDTH, across + 1),
                       indexing="ij")  # fmt: skip
    number = np.arange(x.size).reshape(x.shape)
    a, b, c, d = number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]
    # Four triangles to a square, so that edges lie along warp and weft.
    middle = x.size + np.arange(a.size).reshape(a.shape)
    X = np.column_stack([x.ravel(), y.ravel()])
    X = np.vstack([X, X[np.stack([a, b, c, d], axis=2).reshape(-1, 4)].mean(axis=1)])
    faces = np.concatenate(
        [
            np.stack([p, q, middle], axis=2).reshape(-1, 3)
            for p, q in ((a, b), (b, c), (c, d), (d, a))
        ]
    )
    turn = np.sqrt(0.5) * np.array([[1.0, 1.0], [-1.0, 1.0]])
    fabric = Fabric(
        thickness=1e-3, density=0.3, warp=Curve.linear(TENSION), weft=Curve.linear(TENSION),
        shear=Curve.linear(shear), poisson=0.0, bending_warp=1e-4, bending_weft=1e-4,
        bending_twist=5e-5,
    )  # fmt: skip
    ends = (X[:, 0] < 1e-9) | (X[:, 0] > LENGTH - 1e-9)
    fixed = np.stack([ends, ends, np.ones_like(ends)], axis=1)
    pull = np.where(X[:, 0] > LENGTH - 1e-9, displacement, 0.0)
    target = np.pad((X + np.column_stack([pull, 0 * pull])) @ turn.T, ((0, 0), (0, 1)))
    solved = solve_sheet(Sheet(X @ turn.T, faces, fabric), strict=True,
                         support=Support(fixed=fixed, prescribed=target),
                         settings=SheetSettings(tolerance=1e-6))  # fmt: skip
    axis = np.append(turn @ [1.0, 0.0], 0.0)
    return float((solved.reactions[X[:, 0] > LENGTH - 1e-9] @ axis).sum())


def main() -> None:
    """Pull, read both ways, draw."""
    frame, moved = Frame(LENGTH, WIDTH), 1e-4
    angle = frame.angle(np.array([moved]))
    unit = frame.force(angle, np.sin(angle), np.sin(0.5 * angle))[0]
    rows = []
    for ratio in RATIOS:
        G = ratio * TENSION
        force = strip(G, moved)
        by_turning = force / unit
        slope = force / WIDTH / (moved / LENGTH)
        by_stretching = shear_modulus(slope, TENSION, TENSION, 0.0)
        rows.append((ratio, by_turning / G - 1.0, by_stretching / G - 1.0))
        print(f"G/Ea {ratio:.4g}: turning {100 * rows[-1][1]:+.1f} %, "
              f"stretching {100 * rows[-1][2]:+.1f} %", flush=True)  # fmt: skip
    with (CHARTS / "bias_extension.csv").open("w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(("shear_over_tension", "error_turning", "error_stretching"))
        table.writerows([f"{v:.4g}" for v in row] for row in rows)
    ratio, turning, stretching = np.array(rows).T
    gap = np.log(np.abs(turning / stretching))
    print(f"they are as wrong as each other at {np.exp(np.interp(0.0, gap, np.log(ratio))):.3g}")
    figure, axis = plt.subplots(figsize=(6, 4), layout="constrained")
    axis.loglog(ratio, 100 * np.abs(turning), "o-", label="yarns turn (energy of the jaws)")
    axis.loglog(ratio, 100 * np.abs(stretching), "s-", label="sheet stretches (45-degree formula)")
    axis.axvline(SWITCH, color="grey", linestyle=":", label="switch")
    axis.set(xlabel="G / Ea", ylabel="error of G [%]")
    axis.legend()
    figure.savefig(CHARTS / "bias_extension.svg")


if __name__ == "__main__":
    main()
