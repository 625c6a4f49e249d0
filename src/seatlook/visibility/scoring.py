"""How visible the wrinkles of a scene's result are: null gate, grid, heights, limits."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from seatlook import io
from seatlook.errors import InputError
from seatlook.model import Camera, Limit, Scene, Solution, WrinkleMap
from seatlook.model.progress import Progress, silent
from seatlook.model.scene import SCORE_MEASURES, Verdict
from seatlook.visibility.grid import Grid, score_grid
from seatlook.visibility.heights import Ladder, amplitude_ladder
from seatlook.visibility.reference import CUTOFF, Mode
from seatlook.visibility.view import View

BLACK = "black-leather"  # what equivalent heights are told on


@dataclass(frozen=True, slots=True, kw_only=True)
class SceneScore:
    """The score of one result.

    Parameters
    ----------
    null : VWI of the cover without wrinkles, the highest found; below the gate
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

    def zone_height(self, zone: str, texture: str, rig: str) -> float:
        """Equivalent height [m] of the wrinkles in a zone; inf above the ladder."""
        return self.ladder.zones[zone].equivalent(self.grid.sights[texture, rig].zones[zone])


def score_scene(
    scene: Scene,
    solution: Solution,
    indices: WrinkleMap,
    *,
    camera: Camera | None = None,
    mode: Mode = "view-ray",
    cutoff: float = CUTOFF,
    quality: str = "score",
    progress: Progress | None = None,
) -> SceneScore:
    """Score every texture of a scene under every rig, from one camera.

    Parameters
    ----------
    camera : None for the scene's first
    mode, cutoff, quality : see :class:`View`

    Raises
    ------
    ScoreRefusedError
        The cover without wrinkles scores 0.1 or more.
    InputError
        A limit on a zone that is not in view.
    """
    say = progress or silent
    say("score", what="reference")
    view = View(solution, camera or scene.cameras[0], mode=mode, cutoff=cutoff, quality=quality)
    scored = [limit for limit in scene.limits if limit.measure in SCORE_MEASURES]
    for limit in scored:
        _zones_of(limit, scene, view)
    say("score", what="null gate")
    null = null_gate(view, scene)
    say("score", what="grid")
    grid = score_grid(view, scene.textures, scene.rigs, indices=indices)
    say("score", what="amplitude ladder")
    ladder = amplitude_ladder(view, io.read_material(BLACK).appearance)
    grid = grid.on_ladder(ladder)
    verdicts = tuple(
        Verdict(limit=limit, value=_value(limit, _zones_of(limit, scene, view), grid, ladder))
        for limit in scored
    )
    return SceneScore(view=view, null=null, grid=grid, ladder=ladder, verdicts=verdicts)


def null_gate(view: View, scene: Scene) -> float:
    """Highest null score over cells that hold every texture and every rig at least once."""
    looks = list(scene.textures.values())
    return max(
        view.null_score(looks[k % len(looks)], scene.rigs[k % len(scene.rigs)])
        for k in range(max(len(looks), len(scene.rigs)))
    )


def _zones_of(limit: Limit, scene: Scene, view: View) -> tuple[str, ...]:
    """Zones in view that a limit names: one zone, or all boxes of a class."""
    names = view.solution.cover.zone_names
    shown = [names[k] for k in np.unique(view.region.zone[view.region.mask])]
    classes = {box.name: box.visibility for box in scene.boxes}
    found = tuple(name for name in shown if limit.zone in (name, classes.get(name)))
    if not found:
        raise InputError.single(
            f"accept.{limit.zone}.{limit.measure}",
            got=f"no pixel of it in view {view.camera.name}",
            expected=f"one of {', '.join(shown)}, or a view that shows it",
            file=scene.path,
        )
    return found


def _value(limit: Limit, zones: tuple[str, ...], grid: Grid, ladder: Ladder) -> float:
    """Worst value over the zones, all textures and all rigs."""
    cells: Mapping[tuple[str, str], MappingProxyType[str, float]] = {
        cell: sight.zones for cell, sight in grid.sights.items()
    }
    if limit.measure == "vwi":
        return max(found[zone] for found in cells.values() for zone in zones)
    return 1e3 * max(
        ladder.zones[zone].equivalent(found[zone]) for found in cells.values() for zone in zones
    )
