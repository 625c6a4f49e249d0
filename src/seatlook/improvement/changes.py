"""Corrections in millimetres, made on the mesh of a cover and on its pattern alike."""

from __future__ import annotations

from collections.abc import Mapping
from copy import copy
from dataclasses import replace
from types import MappingProxyType
from typing import Self

import numpy as np

from seatlook import mesh
from seatlook.improvement.candidate import Candidate, outline_way
from seatlook.improvement.cutting.morph import Morph
from seatlook.improvement.cutting.outline import drawn_outlines, mesh_outlines
from seatlook.improvement.partners import Partners
from seatlook.mesh.closest import closest_places
from seatlook.model import Anchor, Cover, FloatArray, Foam, Hook, Panel, Pattern, Scene, Solution

Amounts = Mapping[Candidate, float]


class Changes:
    """What a solved cover and its pattern become when candidates are changed by amounts [m].

    Amounts add up: every change is one of the pattern as it was drawn.

    Parameters
    ----------
    solution : at rest, for the ways of hooks and foam
    pattern : that the cover was assembled from
    """

    def __init__(self, solution: Solution, pattern: Pattern) -> None:
        self.solution, self.drawn = solution, pattern
        self._cover = solution.cover
        self.outlines = mesh_outlines(self._cover, pattern)
        self._drawn = drawn_outlines(pattern)
        self.partners = Partners(pattern, self._drawn)
        self._morph = Morph(self._cover, pattern, self.outlines)
        self._ways: dict[Candidate, FloatArray] = {}
        self._made: Amounts = {}

    def beyond(self, made: Amounts) -> Self:
        """The same, where amounts come on top of what has been made."""
        other = copy(self)
        other._made = made
        return other

    def way(self, candidate: Candidate) -> FloatArray:
        """How material points move in the plane for an amount of 1, (n, 2) [1]."""
        if candidate not in self._ways:
            outline = self.outlines[candidate.panel]
            self._ways[candidate] = self._morph.spread(
                candidate.panel, outline_way(outline, candidate)
            )
        return self._ways[candidate]

    def cover(self, amounts: Amounts) -> Cover:
        """Return the cover on its mesh, changed.

        Raises
        ------
        InvertedElementError
            The mesh cannot follow.
        """
        way, amounts = np.zeros_like(self._cover.uv), added(self._made, amounts)
        for candidate, amount in amounts.items():
            if candidate.kind in ("offset", "length"):
                way += amount * self.way(candidate)
        changed = self._morph.moved(way)
        anchors = tuple(self._pulled(anchor, amounts) for anchor in changed.anchors)
        # It stands for no scene: a result of it is never taken for one.
        return replace(changed, anchors=anchors, foam=self._raised(amounts), scene_digest="")

    def lift(self, candidate: Candidate) -> FloatArray:
        """How much the foam below every vertex rises for an amount of 1, (n,) [1]."""
        share = np.zeros(len(self._cover.rest))
        own = self._cover.panel == candidate.panel
        area = np.bincount(
            self._cover.faces.ravel(), np.repeat(self._cover.rest_area, 3), len(share)
        )
        mine = np.bincount(
            self._cover.faces[own].ravel(), np.repeat(self._cover.rest_area[own], 3), len(share)
        )
        np.divide(mine, area, out=share, where=area > 0.0)
        return share

    def pattern(self, amounts: Amounts) -> Pattern:
        """Return the pattern with the same edges, notches and lines, changed.

        What partners differ by is exactly what the amounts mean to first order.
        """
        amounts = self.partners.exact(added(self._made, amounts))
        ways = {
            panel: np.zeros_like(self.drawn.panels[panel].outline)
            for panel in {c.panel for c in amounts if c.kind in ("offset", "length")}
        }
        inner = np.zeros_like(self._cover.uv)
        for candidate, amount in amounts.items():
            if candidate.kind in ("offset", "length"):
                ways[candidate.panel] += amount * outline_way(
                    self._drawn[candidate.panel], candidate
                )
                inner += amount * self.way(candidate)
        panels = [
            self._redrawn(number, panel, ways[number], inner) if number in ways else panel
            for number, panel in enumerate(self.drawn.panels)
        ]
        return replace(self.drawn, panels=tuple(panels))

    def scene(self, scene: Scene, amounts: Amounts) -> Scene:
        """Return a scene with the pattern, the hooks' wires and the foam changed, to be solved."""
        pattern, amounts = self.pattern(amounts), added(self._made, amounts)
        anchors = {anchor.name: anchor for anchor in self._cover.anchors}
        depth = {c.name: v for c, v in amounts.items() if c.kind == "hook" and v != 0.0}
        curves, hooks = dict(scene.foam.curves), list[Hook]()
        for hook in scene.hooks:
            if hook.name in depth:
                # A curve of its own: another hook of this wire stays where it is.
                name = f"{hook.wire}, {hook.name}"
                way = depth[hook.name] * self.inward(anchors[hook.name])
                curves[name] = scene.foam.curves[hook.wire] + way
                hook = replace(hook, wire=name)
            hooks.append(hook)
        raised = self._raised(amounts)
        vertices = scene.foam.vertices if raised is None else raised.vertices
        foam = replace(scene.foam, vertices=vertices, curves=MappingProxyType(curves))
        return replace(scene, pattern=pattern, hooks=tuple(hooks), foam=foam)

    def moves_any(self, candidate: Candidate, names: frozenset[str]) -> bool:
        """Whether a change of an edge moves an edge of these names too, as at their corner."""
        if candidate.kind not in ("offset", "length"):
            return False
        outline = self.outlines[candidate.panel]
        sides = [side.at for side in outline.sides if side.edge in names]
        return bool(sides) and bool(outline_way(outline, candidate)[np.concatenate(sides)].any())

    def _redrawn(self, number: int, panel: Panel, way: FloatArray, inner: FloatArray) -> Panel:
        """A panel whose outline moves by ``way``; allowance and notches follow the sew line."""
        ring = np.vstack([panel.outline, panel.outline[:1]])
        around, arc = np.vstack([way, way[:1]]), mesh.arc_length(ring)

        def beside(points: FloatArray) -> FloatArray:
            _, place = mesh.nearest_places(ring, points)
            way = np.column_stack([np.interp(place, arc, c) for c in around.T])
            return np.asarray(points + way)

        def inside(points: FloatArray) -> FloatArray:
            own = self._cover.panel == number
            flat = np.pad(self._cover.uv, ((0, 0), (0, 1)))
            faces = self._cover.faces[own]
            near = closest_places(np.pad(points, ((0, 0), (0, 1))), flat, faces, reach=np.inf)
            moved = np.einsum("kc,kcd->kd", near.weights, inner[faces[near.face]])
            return np.asarray(points + moved)

        outline = panel.outline + way
        same = np.array_equal(panel.outline, panel.cut_outline)
        return replace(
            panel,
            outline=outline,
            cut_outline=outline if same else beside(panel.cut_outline),
            notches=tuple(
                replace(notch, position=beside(notch.position[None])[0]) for notch in panel.notches
            ),
            internal_lines=MappingProxyType(
                {name: inside(line) for name, line in panel.internal_lines.items()}
            ),
            holes=tuple(inside(hole) for hole in panel.holes),
        )

    def _pulled(self, anchor: Anchor, amounts: Amounts) -> Anchor:
        depth = sum(v for c, v in amounts.items() if c.kind == "hook" and c.name == anchor.name)
        if anchor.kind != "hook" or depth == 0.0:
            return anchor
        way = depth * self.inward(anchor)
        wire = anchor.wire
        return replace(
            anchor,
            target=anchor.target + way,
            wire=None if wire is None else replace(wire, curve=wire.curve + way),
        )

    def inward(self, anchor: Anchor) -> FloatArray:
        """Unit vector (3,) into the foam along a hook: against the mean normal of the cover."""
        normal = mesh.vertex_normals(self.solution.positions, self._cover.faces)
        mean = anchor.points.at(normal).mean(axis=0)
        return np.asarray(-mean / np.linalg.norm(mean))

    def _raised(self, amounts: Amounts) -> Foam | None:
        """The foam, higher below some panels."""
        foam, heights = self._cover.foam, {c: v for c, v in amounts.items() if c.kind == "foam"}
        if foam is None or not any(heights.values()):
            return foam
        places = closest_places(
            foam.vertices, self.solution.positions, self._cover.faces, reach=0.05
        )
        found = np.flatnonzero(places.face >= 0)
        corners = self._cover.faces[places.face[found]]
        height = np.zeros(len(foam.vertices))
        for candidate, amount in heights.items():
            lift = self.lift(candidate)[corners]
            height[found] += amount * (places.weights[found] * lift).sum(axis=1)
        normal = mesh.vertex_normals(foam.vertices, foam.faces)
        return replace(foam, vertices=foam.vertices + height[:, None] * normal)


def added(*parts: Amounts) -> dict[Candidate, float]:
    """Sum amounts, candidate by candidate.

    Examples
    --------
    >>> front = Candidate(kind="length", name="INSERT.FRONT")
    >>> added({front: 0.002}, {front: 0.001})[front]
    0.003
    """
    total: dict[Candidate, float] = {}
    for part in parts:
        for candidate, amount in part.items():
            total[candidate] = total.get(candidate, 0.0) + amount
    return total
