"""How visible the wrinkles of each variant are, in the looks and lights of the first."""

from __future__ import annotations

from dataclasses import dataclass
from types import MappingProxyType

from seatlook.chain.case import Case
from seatlook.comparison.compare import Comparison
from seatlook.errors import InputError
from seatlook.model.progress import Progress, silent
from seatlook.model.table import Table
from seatlook.visibility.grid import Grid, score_grid
from seatlook.visibility.scoring import null_gate
from seatlook.visibility.view import View


@dataclass(frozen=True, slots=True, kw_only=True)
class VariantScores:
    """VWI of every picture of a comparison.

    Parameters
    ----------
    variants : their names; the others are compared with the first
    vwi : (variant, texture, rig) -> VWI
    refused : variant -> why it has no score
    """

    variants: tuple[str, ...]
    vwi: MappingProxyType[tuple[str, str, str], float]
    refused: MappingProxyType[str, str]

    @property
    def widest(self) -> tuple[str, str, str] | None:
        """Picture (variant, texture, rig) that is farthest from the first variant's."""
        away = {
            cell: abs(value - self.vwi[self.variants[0], *cell[1:]])
            for cell, value in self.vwi.items()
            if cell[0] != self.variants[0] and (self.variants[0], *cell[1:]) in self.vwi
        }
        return max(away, key=lambda cell: away[cell]) if away else None

    def table(self) -> Table:
        """Textures and rigs by variants with differences, the largest first."""
        first, *others = self.variants
        rows: list[tuple[tuple[str, str], list[float | None], list[float | None]]] = []
        for cell in dict.fromkeys(cell[1:] for cell in self.vwi):
            scores = [self.vwi.get((name, *cell)) for name in self.variants]
            base = scores[0]
            away = [None if base is None or v is None else v - base for v in scores[1:]]
            rows.append((cell, scores, away))
        rows.sort(key=lambda row: -max((abs(v) for v in row[2] if v is not None), default=0.0))
        heads = ("texture", "rig", *self.variants, *(f"{name} - {first}" for name in others))
        return Table(heads=heads, rows=tuple((*c, *scores, *away) for c, scores, away in rows))

    def _repr_html_(self) -> str:
        return self.table()._repr_html_()


def score_variants(comparison: Comparison, progress: Progress = silent) -> VariantScores:
    """Score every picture of a comparison; a variant that cannot be scored says why.

    Raises
    ------
    RenderError
    """
    vwi: dict[tuple[str, str, str], float] = {}
    refused: dict[str, str] = {}
    # One limit for all: a finer mesh would be scored for waves that the others cannot have.
    coarsest = max(v.solution.cover.element_size for v in comparison.variants.values())
    for name, variant in comparison.variants.items():
        progress("score", variant=name)
        try:
            grid = _grid(comparison, variant, coarsest)
        except InputError as error:
            refused[name] = str(error)
            continue
        vwi |= {(name, *cell): sight.score.vwi for cell, sight in grid.sights.items()}
    return VariantScores(
        variants=tuple(comparison.variants),
        vwi=MappingProxyType(vwi),
        refused=MappingProxyType(refused),
    )


def _grid(comparison: Comparison, variant: Case, element_size: float) -> Grid:
    """Score one variant; what it takes to look at it, up to 2 GB, is given back before the next."""
    scene = comparison.first.scene
    view = View(variant.solution, comparison.camera, element_size=element_size)
    null_gate(view, scene)
    return score_grid(view, scene.textures, scene.rigs, indices=variant.assessment.indices)
