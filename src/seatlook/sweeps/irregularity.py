"""Covers as they are made, not as they are drawn: seams off their line, hooks off their depth."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType

import numpy as np
from scipy import stats

from seatlook.errors import InputError, did_you_mean
from seatlook.io.sweep import Tolerance
from seatlook.mesh import arc_length, vertex_normals
from seatlook.model import FloatArray, IntArray, Panel, Scene

_EASE_REACH = 0.15  # m from an eased line over which its panel's stretch fades out
_CUT = 3.0  # standard deviations at which a normal distribution is cut


def draw(inputs: Sequence[Tolerance], count: int, seed: int) -> FloatArray:
    """Draw ``count`` irregular covers: (count, inputs), in the units of the inputs' kinds.

    Latin hypercube (McKay, Beckman and Conover 1979): every input goes through its distribution
    evenly, in an order that has nothing to do with the others'.

    Examples
    --------
    >>> a = Tolerance(name="a", kind="foam_mm", of=None, distribution="uniform", spread=2.0)
    >>> np.sort(np.floor(draw([a], 4, 0)[:, 0])).tolist()
    [-2.0, -1.0, 0.0, 1.0]
    """
    share = stats.qmc.LatinHypercube(len(inputs), rng=np.random.default_rng(seed)).random(count)
    columns = [
        tolerance.spread
        * (
            2 * share[:, k] - 1
            if tolerance.distribution == "uniform"
            else stats.truncnorm.ppf(share[:, k], -_CUT, _CUT)
        )
        for k, tolerance in enumerate(inputs)
    ]
    return np.column_stack(columns)


def irregular(scene: Scene, inputs: Sequence[Tolerance], values: Sequence[float]) -> Scene:
    """Return the scene with each input at its value.

    ``seam_offset_mm`` sews the near side that far inside its line (outside below 0), fading out
    at its ends; ``ease_percent`` makes the near side longer; ``hook_depth_mm`` lowers a wire;
    ``foam_mm`` lets the foam grow along its normals.

    Raises
    ------
    InputError
        A seam or a curve that the scene does not have.
    """
    for tolerance, value in zip(inputs, values, strict=True):
        scene = APPLY[tolerance.kind](scene, tolerance, float(value))
    return scene


def rank_correlation(inputs: FloatArray, output: FloatArray) -> tuple[FloatArray, float]:
    """Spearman's rank correlation of each input (n, k) with an output (n,), and its noise.

    Returns
    -------
    (k,) in [-1, 1]; nan for an output that never changes
    the size that 95 of 100 inputs without any influence stay below, 1.96 / sqrt(n - 1)
    """
    ranks = stats.rankdata(inputs, axis=0)
    out = stats.rankdata(output)
    if np.ptp(out) == 0:
        return np.full(inputs.shape[1], np.nan), float(1.96 / np.sqrt(len(out) - 1))
    correlation = [np.corrcoef(ranks[:, k], out)[0, 1] for k in range(inputs.shape[1])]
    return np.array(correlation), float(1.96 / np.sqrt(len(out) - 1))


def _seam_offset(scene: Scene, tolerance: Tolerance, value: float) -> Scene:
    def move(outline: FloatArray, at: IntArray) -> FloatArray:
        points, moved = outline[at], np.array(outline)
        tangent = np.gradient(points, axis=0)
        inward = np.column_stack([-tangent[:, 1], tangent[:, 0]])
        inward /= np.linalg.norm(inward, axis=1)[:, None]
        share = arc_length(points) / arc_length(points)[-1]
        # Corners belong to other seams as well: they stay.
        moved[at] = points + 1e-3 * value * np.sin(np.pi * share)[:, None] * inward
        return moved

    return _with_panel(scene, tolerance, move)


def _ease(scene: Scene, tolerance: Tolerance, value: float) -> Scene:
    def move(outline: FloatArray, at: IntArray) -> FloatArray:
        start, end = outline[at[0]], outline[at[-1]]
        along = (end - start) / np.linalg.norm(end - start)
        away = outline - (start + end) / 2
        depth = np.abs(away @ np.array([-along[1], along[0]]))
        fade = np.clip(1 - depth / _EASE_REACH, 0.0, 1.0)
        return np.asarray(outline + value / 100 * (fade * (away @ along))[:, None] * along)

    return _with_panel(scene, tolerance, move)


def _with_panel(
    scene: Scene, tolerance: Tolerance, move: Callable[[FloatArray, IntArray], FloatArray]
) -> Scene:
    """Redraw the panel of the near side of a seam; ``move`` gets that side's indices."""
    seams = {seam.name: seam for seam in scene.pattern.seams}
    if tolerance.of not in seams:
        raise _unknown(tolerance, "seam", tuple(seams))
    edge = scene.pattern.edges[seams[tolerance.of].a]
    panel = scene.pattern.panel(edge.panel)
    n = len(panel.outline)
    at = (edge.start + np.arange(((edge.end - edge.start) % n or n) + 1)) % n
    redrawn = _redrawn(panel, move(panel.outline, at))
    panels = tuple(redrawn if p is panel else p for p in scene.pattern.panels)
    return replace(scene, pattern=replace(scene.pattern, panels=panels))


def _redrawn(panel: Panel, outline: FloatArray) -> Panel:
    """The panel with another outline; its notches go along with the nearest point of it."""
    notches = []
    for notch in panel.notches:
        near = int(np.linalg.norm(panel.outline - notch.position, axis=1).argmin())
        shift = outline[near] - panel.outline[near]
        notches.append(replace(notch, position=notch.position + shift))
    return replace(panel, outline=outline, notches=tuple(notches))


def _hook_depth(scene: Scene, tolerance: Tolerance, value: float) -> Scene:
    curves = dict(scene.foam.curves)
    if tolerance.of not in curves:
        raise _unknown(tolerance, "curve of the foam", tuple(curves))
    curves[tolerance.of] = curves[tolerance.of] - [0.0, 0.0, 1e-3 * value]
    return replace(scene, foam=replace(scene.foam, curves=MappingProxyType(curves)))


def _foam(scene: Scene, tolerance: Tolerance, value: float) -> Scene:
    foam = scene.foam
    normals = vertex_normals(foam.vertices, foam.faces)
    return replace(scene, foam=replace(foam, vertices=foam.vertices + 1e-3 * value * normals))


def _unknown(tolerance: Tolerance, what: str, names: tuple[str, ...]) -> InputError:
    return InputError.single(
        f"irregularity.input {tolerance.name}",
        got=repr(tolerance.of),
        expected=f"a {what}: {', '.join(names) or 'there is none'}",
        hint=did_you_mean(tolerance.of or "", names),
    )


APPLY: Mapping[str, Callable[[Scene, Tolerance, float], Scene]] = {
    "seam_offset_mm": _seam_offset,
    "ease_percent": _ease,
    "hook_depth_mm": _hook_depth,
    "foam_mm": _foam,
}
