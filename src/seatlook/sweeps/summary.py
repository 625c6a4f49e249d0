"""What a sweep found: one table of all cells, and the inputs that matter most."""

from __future__ import annotations

import json
from collections import defaultdict
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from seatlook.errors import InputError
from seatlook.model.zones import FREE_EDGE
from seatlook.sweeps.cell import Cell, finished
from seatlook.sweeps.irregularity import rank_correlation
from seatlook.wrinkle import figure_names

FEWEST = 4  # converged covers from which ranks mean something
OUTPUT = "w2_mean"  # over the whole cover; the share above 1 is often 0 in every cell


@dataclass(frozen=True, slots=True, kw_only=True)
class Cause:
    """How an input goes with the mean of W2.

    Parameters
    ----------
    correlation : Spearman's with the input, in [-1, 1]: more of it, more wrinkles
    of_size : Spearman's with the input's size: any departure makes wrinkles, either way
    noise : the size that 95 of 100 correlations without influence stay below
    """

    input: str
    correlation: float
    of_size: float
    noise: float

    @property
    def strength(self) -> float:
        """The larger of the two in size; 0 where W2 never changes."""
        return max(abs(float(np.nan_to_num(v))) for v in (self.correlation, self.of_size))

    @property
    def matters(self) -> bool:
        """Whether one of the correlations is above the noise."""
        return self.strength > self.noise

    @property
    def sentence(self) -> str:
        """How strong it is, for the first of several causes."""
        rank = "matters most" if self.matters else "is strongest, but not above the noise"
        return (
            f"{self.input} {rank} "
            f"(rank correlation {self.strength:.2f} in size, noise {self.noise:.2f})"
        )


def groups(cells: Sequence[Cell]) -> dict[str, list[Cell]]:
    """Cells with irregular inputs, by what else they are of."""
    grouped = defaultdict(list)
    for cell in cells:
        if cell.settings["values"] is not None:
            grouped[cell.group].append(cell)
    return dict(grouped)


def rows(cells: Sequence[Cell], folder: Path) -> list[dict[str, Any]]:
    """One row per finished cell: its settings, its status, and each measure over the cover."""
    table = []
    for cell in cells:
        if not finished(cell, folder):
            continue
        result = json.loads((folder / f"{cell.name}.json").read_text(encoding="utf-8"))
        row = {"cell": cell.name, "variant": result["variant"]}
        row |= {"status": result["status"], "reason": result.get("reason", "")}
        for word in result["set"]:
            key, _, value = word.partition("=")
            row[key] = value
        for tolerance, value in zip(result["inputs"], result["values"] or (), strict=False):
            row[tolerance["name"]] = value
        row["criterion"] = "; ".join(dict.fromkeys(map(_criterion, result["zones"])))
        table.append(row | overall(result["zones"]))
    return table


def _criterion(zone: dict[str, Any]) -> str:
    """Mode and threshold of a zone's W2; cells of older versions do not state them."""
    return str(zone.get("criterion", "not stated"))


def at_rest(row: dict[str, Any]) -> bool:
    """Whether the cover of a row has come to rest, be it resolved by its mesh or not."""
    return str(row["status"]) != "not converged"


def overall(zones: Sequence[dict[str, Any]]) -> dict[str, float]:
    """Means over the zones, weighted by area, without free edges, which are clamped or trimmed."""
    inner = [z for z in zones if z["zone"] != FREE_EDGE]
    area = np.array([z["area_cm2"] for z in inner])
    figures = [name for name in figure_names() if name in inner[0]]
    return {m: float(area @ [z[m] for z in inner] / area.sum()) for m in figures}


def causes(cells: Sequence[Cell], folder: Path) -> tuple[Cause, ...]:
    """Rank correlation of every irregular input, the strongest first.

    Only cells that converged count, resolved or not.

    Raises
    ------
    InputError
        Fewer than ``FEWEST`` of them.
    """
    good = [r for r in rows(cells, folder) if at_rest(r)]
    names = [i["name"] for i in json.loads(cells[0].spec)["inputs"]]
    if len(good) < FEWEST:
        raise InputError.single(
            "irregularity", got=f"{len(good)} converged", expected=f"{FEWEST} or more"
        )
    drawn = np.array([[row[name] for name in names] for row in good])
    output = np.array([row[OUTPUT] for row in good])
    correlations, noise = rank_correlation(drawn, output)
    sizes, _ = rank_correlation(np.abs(drawn), output)
    listed = [
        Cause(input=name, correlation=float(value), of_size=float(size), noise=noise)
        for name, value, size in zip(names, correlations, sizes, strict=True)
    ]
    return tuple(sorted(listed, key=lambda c: -c.strength))
