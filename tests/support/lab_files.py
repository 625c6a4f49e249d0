"""A small file of tests and its curves, as a laboratory would send them."""

from __future__ import annotations

from pathlib import Path

import numpy as np

TESTS = """base = "woven"
laboratory = "Laboratory A"
date = "2026-11-30"

[sheet]
thickness_mm = 0.9
density_kg_per_m2 = 0.32

[[test]]
kind = "tensile"
direction = "warp"
sides = "held"
files = ["strip.csv"]
strain = { column = "strain", unit = "%" }
force = { column = "force", unit = "N/m" } # force
width_mm = 50

[[test]]
kind = "shear"
files = ["shear.csv"]
angle = { column = 1, unit = "deg" }
force = { column = 2, unit = "gf/cm" }
pretension_n_per_m = 9.8

[[test]]
kind = "cantilever"
direction = "weft"
overhang_mm = [61.0, 63.5]
angle_deg = [41.5]

[[test]]
kind = "numbers"
direction = "weft"
sides = "held"
lt = 0.7
wt_gf_cm_per_cm2 = 9.0
rt_percent = 60.0
peak_gf_per_cm = 500.0
g_gf_per_cm_deg = 0.8
full_2hg_gf_per_cm = 1.2
full_2hg5_gf_per_cm = 2.4
g_between_deg = [0.5, 2.5]
b_gf_cm2_per_cm = 0.9
full_2hb_gf_cm_per_cm = 0.4
hb_at_per_cm = 1.0
"""
_STRAIN = np.arange(0.0, 13.0)
_FORCE = (0, 70, 150, 240, 340, 450, 570, 700, 830, 960, 1200, 1340, 1480)
STRIP = "strain,force\n" + "".join(
    f"{e:.1f},{F:.1f}\n" for e, F in zip(_STRAIN, _FORCE, strict=True)
)
# The same strip of 50 mm, as a testing machine reads it.
IN_NEWTON = "".join(f"{e:.1f},{0.05 * F:.2f}\n" for e, F in zip(_STRAIN, _FORCE, strict=True))


def write_tests(folder: Path) -> Path:
    """Write the file of tests and its curves, and return the path of the first."""
    (folder / "strip.csv").write_text(STRIP)
    angle = np.concatenate([np.linspace(0, 8, 9), np.linspace(7, -8, 16), np.linspace(-7, 0, 8)])
    way = np.sign(np.diff(angle, prepend=-1.0))
    force = 0.8 * angle + 0.5 * way
    rows = (f"{a:.1f};{F:.3f}\n" for a, F in zip(angle, force, strict=True))
    (folder / "shear.csv").write_text("angle (deg);force\n" + "".join(rows))
    path = folder / "tests.toml"
    path.write_text(TESTS)
    return path
