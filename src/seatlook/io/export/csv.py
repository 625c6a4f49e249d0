"""The solved cover as a table, one row per face."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from seatlook.io.export.vtp import voigt
from seatlook.io.table import write_table
from seatlook.model import Field, FloatArray, Solution


def write_csv(solution: Solution, fields: Sequence[Field], path: Path) -> None:
    """Write place, panel, zone, fields and strains of each face; the unit is in each head.

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
        **{field.name: field.values for field in fields},
    }
    for side in ("top", "mid", "bottom"):
        strain = voigt(getattr(solution, f"strain_{side}"))
        columns |= {f"e{ij}_{side}": strain[:, i] for i, ij in enumerate(("11", "22", "12"))}
    values = zip(*(column.tolist() for column in columns.values()), strict=True)
    rows = (
        (face, cover.panel_names[cover.panel[face]], cover.zone_names[cover.zone[face]], *row)
        for face, row in enumerate(values)
    )
    write_table(path, ("face", "panel", "zone", *columns), rows)
