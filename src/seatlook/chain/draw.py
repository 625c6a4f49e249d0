"""Pictures and maps of one result, written below a folder."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from types import MappingProxyType

import numpy as np

from seatlook import pbr
from seatlook.chain.assess import Assessment
from seatlook.chain.files import picture_paths
from seatlook.model import Camera, FloatArray, Scene, Solution
from seatlook.model.progress import Progress
from seatlook.pbr import Picture
from seatlook.wrinkle import DISTORTIONS, INDICES, Index

CHECKER = 0.010  # [m] side of the squares
OWN = 0.992  # share of the faces whose value lies in the range of a map of its own
_HIGHEST = 100.0  # end of a range
_SHOWN = 0.99  # share of the faces whose value lies inside the range
_DISTANCE_MM = 5.0  # end of the range of distances, the same on every page, so that pages compare


@dataclass(frozen=True, slots=True, kw_only=True)
class Drawn:
    """A map that was drawn.

    Parameters
    ----------
    name : as it is written, such as "W2"; path : below the folder; unit, meaning : for readers
    alone : path of the same map in a range of its own, which ends at ``alone_high``; or None
    """

    name: str
    path: str
    picture: Picture
    unit: str
    meaning: str
    alone: str | None = None
    alone_high: float = 1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Canvas:
    """Where pictures of one result go: its folder, the camera, and the run that they belong to."""

    solution: Solution
    camera: Camera
    out: Path
    run: str = ""

    def draw(
        self, path: str, values: FloatArray, title: str, *, unit: str, ends: tuple[float, float]
    ) -> Picture:
        """Draw values (m,) and save the map."""
        picture = pbr.render_map(
            self.solution, values, camera=self.camera, title=title, unit=unit, value_range=ends
        )
        picture.save(self.out / path, run=self.run)
        return picture


@dataclass(frozen=True, slots=True, kw_only=True)
class Exposures:
    """How pictures are shown: quality, tone curve, and whether the radiance is kept (npy, exr).

    ``white``: ``exposure``, or ``card``: a white card facing the light is white, for a review of
    colours; ``adaptation``: to the colour of the light, 0 to 1.
    """

    quality: str = "standard"
    tone: str = "clamp"
    white: str = "exposure"
    adaptation: float = 1.0
    radiance: str | None = None


def draw_pictures(
    scene: Scene,
    canvas: Canvas,
    progress: Progress,
    *,
    exposures: Exposures | None = None,
    paths: Mapping[tuple[str, str], str] | None = None,
) -> MappingProxyType[tuple[str, str], str]:
    """Render every texture under every rig; return (texture, rig) -> path below the folder.

    Parameters
    ----------
    paths : names of the pictures, where the scene is a part of a larger one
    """
    chosen = exposures or Exposures()
    names = picture_paths(scene) if paths is None else paths
    pictures: dict[tuple[str, str], str] = {}
    steps = len(scene.rigs) * len(scene.textures)
    for rig in scene.rigs:
        for texture, appearance in scene.textures.items():
            progress("render", rig=rig.name, texture=texture, step=len(pictures), steps=steps)
            path = canvas.out / names[texture, rig.name]
            image = pbr.render(
                canvas.solution,
                appearance,
                rig=rig,
                camera=canvas.camera,
                quality=chosen.quality,
                surroundings=scene.surroundings,
            )
            shown = replace(
                image,
                tone=chosen.tone,
                review=chosen.white == "card",
                adaptation=chosen.adaptation,
            )
            shown.save(path, run=canvas.run)
            if chosen.radiance is not None:
                image.save(path.with_suffix(f".{chosen.radiance}"))
            pictures[texture, rig.name] = names[texture, rig.name]
    return MappingProxyType(pictures)


def draw_maps(
    assessment: Assessment,
    canvas: Canvas,
    progress: Progress,
    *,
    top: float | None = None,
    whole_shape: bool = True,
) -> tuple[Drawn, ...]:
    """Draw every index of the registry.

    Parameters
    ----------
    top : upper end of the range of W2, to be given where several covers are to share it
    whole_shape : whether indices that need the shape that was meant are drawn as well
    """
    end = top or assessment.top
    maps = []
    for index in INDICES.values():
        if index.whole_shape and not whole_shape:
            continue
        progress("map", name=index.name)
        maps.append(_draw_index(index, assessment.values(index.name), canvas, end))
    return tuple(maps)


def _draw_index(index: Index, values: FloatArray, canvas: Canvas, top: float) -> Drawn:
    path = f"maps/{index.name}.png"
    picture = canvas.draw(
        path,
        values,
        f"{index.symbol}: {index.meaning}",
        unit=index.unit,
        ends=map_ends(index, values, top),
    )
    alone, high = None, 1.0
    if index.own_range:
        alone, high = f"maps/{index.name}-own.png", max(float(np.quantile(values, OWN)), 1e-6)
        title = f"{index.symbol}, range of its own"
        canvas.draw(alone, values, title, unit=index.unit, ends=(0.0, high))
    return Drawn(
        name=index.symbol,
        path=path,
        picture=picture,
        unit=index.unit,
        meaning=index.meaning,
        alone=alone,
        alone_high=high,
    )


def map_ends(index: Index, values: FloatArray, top: float) -> tuple[float, float]:
    """Values at both ends of the colours of an index; ``top`` is the end for W2."""
    if index.ends == "w2":
        return 0.0, top
    if index.ends == "w1":
        return -top, top
    if index.ends == "values":
        end = round_end(values, least=1e-3)
        return (0.0 if index.limits[0] >= 0 else -end), end
    return index.ends


def draw_distance(name: str, values: FloatArray, canvas: Canvas, meaning: str) -> Drawn:
    """Draw distances (m,) [m] in mm about 0; faces where they are not known stay grey."""
    path, symbol = f"maps/{name}.png", name.capitalize()
    ends = (-_DISTANCE_MM, _DISTANCE_MM)
    picture = canvas.draw(path, 1e3 * values, f"{symbol}: {meaning}", unit="mm", ends=ends)
    return Drawn(name=symbol, path=path, picture=picture, unit="mm", meaning=meaning)


def draw_distortion(
    assessment: Assessment, canvas: Canvas, progress: Progress
) -> tuple[Drawn, ...]:
    """Draw the maps of distortion and a checker of 10 mm."""
    maps = []
    for name, (label, unit, factor, meaning) in DISTORTION_MAPS.items():
        progress("map", name=name)
        values = factor * DISTORTIONS[name](assessment.distortion)
        end = round_end(values)
        path = f"maps/{name.removesuffix('_deg')}.png"
        picture = canvas.draw(path, values, meaning, unit=unit, ends=(-end, end))
        maps.append(Drawn(name=label, path=path, picture=picture, unit=unit, meaning=meaning))
    checker = pbr.render_checker(canvas.solution, camera=canvas.camera, size=CHECKER)
    checker.save(canvas.out / "maps/checker.png", run=canvas.run)
    maps.append(
        Drawn(
            name="Checker",
            path="maps/checker.png",
            picture=checker,
            unit="mm",
            meaning=f"squares that are {1e3 * CHECKER:g} mm wide on the flat pattern",
        )
    )
    return tuple(maps)


# name -> as it is written, unit, factor to it, meaning
DISTORTION_MAPS: Mapping[str, tuple[str, str, float, str]] = MappingProxyType(
    {
        "stretch_along": (
            "Stretch along the grain", "%", 100.0, "stretch of the texture along the warp"
        ),
        "stretch_across": (
            "Stretch across the grain", "%", 100.0, "stretch of the texture across the warp"
        ),
        "shear_deg": ("Shear", "deg", 1.0, "how far warp and weft are from a right angle"),
        "grain_drift_deg": (
            "Grain drift", "deg", 1.0, "turn of the grain against its panel's mean direction"
        ),
    }
)  # fmt: skip


def round_end(values: FloatArray, *, least: float = 1.0) -> float:
    """Return the first of 1, 2, 5, 10, ... 100 that 99 % of the values stay within, either sign.

    ``least`` is a power of ten from which to begin.

    Examples
    --------
    >>> round_end(np.array([0.3, -4.0, np.nan])), round_end(np.array([0.013]), least=1e-3)
    (5.0, 0.02)
    """
    known = np.abs(values[np.isfinite(values)])
    most = float(np.quantile(known, _SHOWN)) if len(known) else 0.0
    decade = least
    while decade < _HIGHEST:
        for step in (1.0, 2.0, 5.0):
            if most <= step * decade:
                return step * decade
        decade *= 10.0
    return _HIGHEST
