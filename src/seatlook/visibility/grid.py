"""Textures by rigs: which cell shows wrinkles most, and which texture hides them best."""

from __future__ import annotations

import itertools
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

from seatlook.errors import InputError
from seatlook.model import FloatArray, Rig, WrinkleMap
from seatlook.visibility.cross_check import Verdict, more_visible
from seatlook.visibility.heights import Ladder
from seatlook.visibility.view import Looks, Sight, View


@dataclass(frozen=True, slots=True, kw_only=True)
class Grid:
    """Scores of one view, a row per texture and a column per rig.

    Parameters
    ----------
    sights : (texture, rig) -> Sight, every cell
    height : (texture, rig) -> equivalent height [m] on black leather, inf above the ladder; empty
        without one
    """

    textures: tuple[str, ...]
    rigs: tuple[str, ...]
    sights: MappingProxyType[tuple[str, str], Sight]
    height: MappingProxyType[tuple[str, str], float]

    @property
    def vwi(self) -> FloatArray:
        """VWI, (textures, rigs)."""
        return np.array(
            [
                [self.sights[texture, rig].score.vwi for rig in self.rigs]
                for texture in self.textures
            ]
        )

    def on_ladder(self, ladder: Ladder) -> Grid:
        """Return the same grid with equivalent heights."""
        height = {cell: ladder.equivalent(s.score.vwi) for cell, s in self.sights.items()}
        return replace(self, height=MappingProxyType(height))

    def worst_texture(self, rig: str) -> str:
        """Texture that shows wrinkles most under a rig."""
        return self.textures[int(self.vwi[:, self.rigs.index(rig)].argmax())]

    def worst_rig(self, texture: str) -> str:
        """Rig under which a texture shows wrinkles most."""
        return self.rigs[int(self.vwi[self.textures.index(texture)].argmax())]

    @property
    def least_visible(self) -> str | None:
        """Texture whose worst cell is lowest, the safest choice for these rigs.

        None where it cannot be told from the worst cell of another.
        """
        worst = {name: self.sights[name, self.worst_rig(name)].measures for name in self.textures}
        lowest = min(self.textures, key=lambda name: worst[name].vwi)
        others = (worst[name] for name in self.textures if name != lowest)
        told = all(more_visible(other, worst[lowest]) == "first" for other in others)
        return lowest if told else None

    def compare(self, first: str, second: str, rig: str) -> Verdict:
        """Say which of two textures shows more under a rig, if all measures agree."""
        return more_visible(self.sights[first, rig].measures, self.sights[second, rig].measures)

    def not_separable(self) -> tuple[tuple[str, str, str], ...]:
        """Pairs of textures (first, second, rig) that the measures order differently."""
        return tuple(
            (first, second, rig)
            for rig in self.rigs
            for first, second in itertools.combinations(self.textures, 2)
            if self.compare(first, second, rig) == "not separable"
        )


def score_grid(
    view: View,
    textures: Mapping[str, Looks],
    rigs: Sequence[Rig],
    *,
    indices: WrinkleMap | None = None,
) -> Grid:
    """Score every texture under every rig.

    Raises
    ------
    InputError
        No texture or no rig, two rigs of one name.
    """
    names = tuple(rig.name for rig in rigs)
    if not textures or not rigs or len(set(names)) < len(names):
        raise InputError.single(
            "grid",
            got=f"{len(textures)} textures, rigs {', '.join(names) or 'none'}",
            expected="a texture and a rig or more, rigs by different names",
        )
    sights = {
        (name, rig.name): view.sight(looks, rig, indices=indices)
        for rig in rigs
        for name, looks in textures.items()
    }
    return Grid(
        textures=tuple(textures),
        rigs=names,
        sights=MappingProxyType(sights),
        height=MappingProxyType({}),
    )
