"""The solved cover as a table, one row per face."""

from __future__ import annotations

import csv
import io
from pathlib import Path

from seatlook.files import write_text
from seatlook.io.export.vtp import voigt
from seatlook.model import FloatArray, Solution, WrinkleMap


def write_csv(solution: Solution, indices: WrinkleMap, path: Path) -> None:
    """Write place, panel, zone, indices and strains of each face; the unit is in each head.

    ``u_mm, v_mm`` is the face's centre in its panel, ``x_mm, y_mm, z_mm`` in the world.
    """
    cover = solution.cover
    where = 1e3 * solution.positions[cover.faces].mean(axis=1)
    uv = 1e3 * cover.uv[cover.faces].mean(axis=1)
    columns: dict[str, FloatArray] = {
        **{f"{c}_mm": uv[:, i] for i, c in enumerate("uv")},
        **{f"{c}_mm": where[:, i] for i, c in enumerate("xyz")},
        "rest_area_mm2": 1e6 * cover.rest_area,
        "thickness_mm": 1e3 * cover.thickness,
        "c_per_mm": 1e-3 * indices.c,
        "w1": indices.w1,
        "w2": indices.w2,
        "r_stretch": indices.r_stretch,
        "w_stretch": indices.w_stretch,
        "w_compression": indices.w_compression,
    }
    for side in ("top", "mid", "bottom"):
        strain = voigt(getattr(solution, f"strain_{side}"))
        columns |= {f"e{ij}_{side}": strain[:, i] for i, ij in enumerate(("11", "22", "12"))}
    buffer = io.StringIO()
    writer = csv.writer(buffer, lineterminator="\n")
    writer.writerow(["face", "panel", "zone", *columns])
    values = zip(*(column.tolist() for column in columns.values()), strict=True)
    for face, row in enumerate(values):
        panel = cover.panel_names[cover.panel[face]]
        writer.writerow([face, panel, cover.zone_names[cover.zone[face]], *row])
    write_text(path, buffer.getvalue())
