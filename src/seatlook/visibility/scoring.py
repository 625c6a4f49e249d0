"""How visible the wrinkles of a scene's result are: null gate, grid, heights, limits."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from seatlook import io
from seatlook.errors import InputError
from seatlook.model import Limit, Scene, WrinkleMap
from seatlook.model.progress import Progress, silent
from seatlook.model.scene import SCORE_MEASURES, Verdict
from seatlook.results.resolution import resolution
from seatlook.visibility.concentration import Concentration
from seatlook.visibility.grid import Grid, score_grid
from seatlook.visibility.heights import Ladder, amplitude_ladder
from seatlook.visibility.view import View

BLACK = "black-leather"  # the material of equivalent heights


@dataclass(frozen=True, slots=True, kw_only=True)
class SceneScore:
    """The score of one result.

    Parameters
    ----------
    null : largest VWI of the cover without wrinkles; below the gate
    grid : textures by rigs
    ladder : of black leather under the reference rig
    verdicts : of those limits of [accept] that are on the score
    """

    view: View
    null: float
    grid: Grid
    ladder: Ladder
    verdicts: tuple[Verdict, ...]

    @property
    def accepted(self) -> bool:
        """Whether every limit on the score is kept."""
        return all(v.kept for v in self.verdicts)

    @property
    def peak(self) -> Concentration:
        """Where most of the score of a cell lies in the fewest pixels."""
        return max((sight.peak for sight in self.grid.sights.values()), key=lambda p: p.share)

    def zone_height(self, zone: str, texture: str, rig: str) -> float | None:
        """Equivalent height [m] of the wrinkles in a zone; inf above the ladder.

        None for a zone that moving shadows leave no pixel of, here or under the reference rig.
        """
        vwi = self.grid.sights[texture, rig].zones.get(zone)
        ladder = self.ladder.zones.get(zone)
        return None if vwi is None or ladder is None else ladder.equivalent(vwi)


def score_scene(
    scene: Scene, view: View, indices: WrinkleMap, *, progress: Progress = silent
) -> SceneScore:
    """Score every texture of a scene under every rig, from one camera.

    Parameters
    ----------
    view : of the scene's solution beside its reference
    indices : of that solution, to split the score by cause

    Raises
    ------
    ScoreRefusedError
        The cover without wrinkles scores ``observer.NULL_LIMIT`` or more.
    InputError
        A limit on a zone that is not in view.
    """
    scored = [limit for limit in scene.limits if limit.measure in SCORE_MEASURES]
    for limit in scored:
        _zones_of(limit, scene, view)
    progress("score", what="null gate")
    null = null_gate(view, scene)
    # Before the grid, whose cells stay in memory.
    progress("score", what="amplitude ladder")
    ladder = amplitude_ladder(view, io.read_material(BLACK).appearance)
    progress("score", what="grid")
    grid = score_grid(view, scene.textures, scene.rigs, indices=indices).on_ladder(ladder)
    resolved = bool(scored) and resolution(view.solution).resolved
    verdicts = tuple(
        Verdict(
            limit=limit,
            value=_value(limit, _zones_of(limit, scene, view), grid, ladder),
            resolved=resolved,
        )
        for limit in scored
    )
    return SceneScore(view=view, null=null, grid=grid, ladder=ladder, verdicts=verdicts)


def null_gate(view: View, scene: Scene) -> float:
    """Highest null score over cells that hold every texture and every rig at least once."""
    looks, null = list(scene.textures.values()), view.without_wrinkles()
    return max(
        view.null_score(looks[k % len(looks)], scene.rigs[k % len(scene.rigs)], null=null)
        for k in range(max(len(looks), len(scene.rigs)))
    )


def _zones_of(limit: Limit, scene: Scene, view: View) -> tuple[str, ...]:
    """Zones in view that a limit names: one zone, or all boxes of a class."""
    names = view.solution.cover.zone_names
    shown = [names[k] for k in np.unique(view.region.zone[view.region.mask])]
    named = scene.limited_zones(limit, shown)
    if not named:
        raise InputError.single(
            f"accept.{limit.zone}.{limit.measure}",
            got=f"no pixel of it in view {view.camera.name}",
            expected=f"one of {', '.join(shown)}, or a view that shows it",
            file=scene.path,
        )
    return named


def _value(limit: Limit, zones: tuple[str, ...], grid: Grid, ladder: Ladder) -> float:
    """Worst value over the zones, all textures and all rigs; inf where none can be told."""
    values = [
        (zone, sight.zones[zone])
        for sight in grid.sights.values()
        for zone in zones
        if zone in sight.zones and (limit.measure == "vwi" or zone in ladder.zones)
    ]
    if limit.measure == "vwi":
        return max((vwi for _, vwi in values), default=np.inf)
    heights = (ladder.zones[zone].equivalent(vwi) for zone, vwi in values)
    return 1e3 * max(heights, default=np.inf)
