"""Where irregular covers wrinkle and how likely, and what those left out could change."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from seatlook import io, pbr
from seatlook.chain.case import Case
from seatlook.errors import InputError
from seatlook.model import Cover, Criteria, FloatArray
from seatlook.sweeps.cell import Cell, failed
from seatlook.sweeps.summary import at_rest, rows


@dataclass(frozen=True, slots=True, kw_only=True)
class Chance:
    """Share of irregular covers whose W2 is above 1.

    Covers that did not converge, or whose cell failed, have no W2 to count, and they are often
    the most wrinkled: the share of all lies between the bounds and nothing narrower is known.

    Parameters
    ----------
    share : (m,) face by face, of those that converged; nan where none did
    converged, left_out : how many covers; those not run yet are in neither
    """

    share: FloatArray
    converged: int
    left_out: int

    @property
    def covers(self) -> int:
        """All covers that were run."""
        return self.converged + self.left_out

    @property
    def low(self) -> FloatArray:
        """The share (m,) of all covers if none of those left out were above 1."""
        return np.nan_to_num(self.share) * self.converged / self.covers

    @property
    def high(self) -> FloatArray:
        """The share (m,) of all covers if all of those left out were above 1."""
        return np.asarray(self.low + self.left_out / self.covers)


def chance(cells: Sequence[Cell], folder: Path) -> Chance:
    """Count the covers of some cells, on the faces of the cover as drawn.

    Raises
    ------
    InputError
        None of them converged.
    """
    table = rows(cells, folder)
    good = {row["cell"] for row in table if at_rest(row)}
    left_out = len(table) - len(good) + sum(failed(cell, folder) for cell in cells)
    above = [np.load(folder / f"{c.name}.npy") > 1 for c in cells if c.name in good]
    if not above:
        raise InputError.single(
            "irregularity", got=f"none of {left_out} covers converged", expected="one or more"
        )
    return Chance(share=np.mean(above, axis=0), converged=len(above), left_out=left_out)


def zone_chances(
    probability: Chance, cover: Cover, criteria: Criteria
) -> list[dict[str, str | int | float]]:
    """One row per zone of the cover as drawn: means by area, and where it is largest.

    Parameters
    ----------
    criteria : by which W2 of the covers was evaluated
    """
    area, listed = cover.rest_area, []
    columns = {
        "": probability.share,
        "_if_left_out_below": probability.low,
        "_if_left_out_above": probability.high,
    }
    for number, zone in enumerate(cover.zone_names):
        inside = cover.zone == number
        if not inside.any():
            continue
        row: dict[str, str | int | float] = {
            "zone": zone, "criterion": criteria.words(cover.panel[inside]),
            "converged": probability.converged, "left_out": probability.left_out,
        }  # fmt: skip
        for end, share in columns.items():
            row[f"probability{end}"] = float(share[inside] @ area[inside] / area[inside].sum())
            row[f"largest{end}"] = float(share[inside].max())
        listed.append(row)
    return listed


def draw_chance(
    cells: Sequence[Cell], probability: Chance, path: Path
) -> list[dict[str, str | int | float]]:
    """Draw the probability that W2 is above 1 on the cover as drawn; return its zones."""
    spec = json.loads(cells[0].spec)
    scene = io.load_scene(spec["scene"], changes=spec["set"])
    case = Case(scene)
    solution = case.solution
    pbr.render_map(
        solution,
        probability.share,
        camera=scene.cameras[0],
        title=_title(probability),
        unit="1",
        value_range=(0.0, 1.0),
        colormap="cividis",
    ).save(path)
    return zone_chances(probability, solution.cover, case.criteria)


def _title(probability: Chance) -> str:
    title = (
        f"Probability that W2 is above 1: {probability.converged} of {probability.covers} covers"
    )
    if not probability.left_out:
        return f"{title}, all that were made"
    most = probability.left_out / probability.covers
    return f"{title} that converged; the others could change it by up to {most:.2f}"
