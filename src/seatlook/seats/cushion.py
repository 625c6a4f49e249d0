"""The demo cushion's shape: one smooth map from a flat plane onto top, rolls and walls."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from seatlook.model import FloatArray


@dataclass(frozen=True, slots=True, kw_only=True)
class Cushion:
    """A car-seat cushion: crowned insert, two bolsters, waterfall front, walls that tuck under.

    All lengths in m, angles in rad. The plane point p maps to the plan view where the top is
    flat; beyond the start of the edge roll the way from there, measured along the plan outline's
    normal, is arc length over the roll and down the wall.

    Parameters
    ----------
    width, depth, corner_radius : plan outline, a rounded rectangle centred on the origin
    front_bow : how far the middle of the front stands forward of its corners
    height, tilt : top of the middle; rise towards the front per length
    crown_x, crown_y : fall of the bolsters' level at the outline's sides and ends
    trench, trench_taper : half width of the insert at y = 0; widening per length to the front
    trench_depth : from the bolsters' level to the tie-down trench, deepest at y = 0
    bolster_width : from the trench to where the bolster reaches its level
    pillow : rise of the insert's middle above the trenches
    fade, fade_tail : trench and insert come up to the bolsters' level at this distance from the
        middle, along a parabola and over the tail softly, so that no crease is left where front
        and rear panels are sewn on. With ``crown_y`` the insert stays convex along the seat too:
        a cover under tension would lift off a dish
    roll, roll_front : radius at sides, corners and rear; in the middle of the front
    roll_angle : angle turned by the roll; beyond 90 degrees the wall leans inward
    seam_angle : where on the roll the top is sewn to the walls
    slot : extra depth of the foam right under a trench, room for the wire; fades like the trench
    frame_height : level at which the cover ends; the foam's bottom is at 0
    """

    width: float = 0.50
    depth: float = 0.55
    corner_radius: float = 0.075
    front_bow: float = 0.012
    height: float = 0.125
    tilt: float = 0.04
    crown_x: float = 0.006
    crown_y: float = 0.026
    trench: float = 0.135
    trench_taper: float = 0.03
    trench_depth: float = 0.034
    bolster_width: float = 0.070
    pillow: float = 0.021
    fade: float = 0.263
    fade_tail: float = 0.015
    roll: float = 0.046
    roll_front: float = 0.060
    roll_angle: float = np.deg2rad(90.0)
    seam_angle: float = np.deg2rad(48.0)
    slot: float = 0.003
    frame_height: float = 0.025

    @property
    def half(self) -> FloatArray:
        """Half width and half depth of the plan outline, (2,)."""
        return np.array([self.width, self.depth]) / 2

    def trench_x(self, y: FloatArray) -> FloatArray:
        """Distance of the trenches from the middle plane at ``y``."""
        return np.asarray(self.trench - self.trench_taper * y)

    def top(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Height of the top over the plan, before the edge roll takes it down."""
        a, b = self.half
        level = self.height - self.tilt * y - self.crown_x * (x / a) ** 2
        level = level - self.crown_y * (y / b) ** 2
        trench = self.trench_x(y)
        out = np.clip(1 - (np.abs(x) - trench) / self.bolster_width, 0, 1)
        u = np.clip(np.abs(x) / trench, 0, 1)
        # Sixth power: round shoulders, so the insert swells like a pillow between its seams.
        inner = self.trench_depth - self.pillow * (1 - 0.35 * u**2 - 0.65 * u**6)
        carved = np.where(np.abs(x) < trench, inner, self.trench_depth * out**2)
        return np.asarray(level - carved * self.depth_share(y))

    def depth_share(self, y: FloatArray) -> FloatArray:
        """Share of the trench's depth that is left at ``y``: two parabolas with one tangent."""
        reach, tail = self.fade, self.fade_tail
        middle = 1 - y**2 / (reach * (reach - tail))
        end = np.maximum(reach - np.abs(y), 0) ** 2 / (reach * tail)
        return np.asarray(np.where(np.abs(y) < reach - tail, middle, end))

    def outline(self, p: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Project p (k, 2) onto the plan outline: foot (k, 2), outward normal, signed distance."""
        core = self.half - self.corner_radius
        nearest = np.clip(p, -core, core)
        away = p - nearest
        reach = np.linalg.norm(away, axis=1)
        inside = reach == 0
        across = np.abs(p) - self.half
        axis = across.argmax(axis=1)
        unit = np.eye(2)[axis] * np.where(np.take_along_axis(p, axis[:, None], 1) < 0, -1, 1)
        normal = np.where(inside[:, None], unit, away / np.where(inside, 1, reach)[:, None])
        distance = np.where(inside, across.max(axis=1), reach - self.corner_radius)
        return p - distance[:, None] * normal, normal, distance

    def roll_radius(self, foot: FloatArray, normal: FloatArray) -> FloatArray:
        """Roll radius (k,) at points of the plan outline."""
        core = self.half[0] - self.corner_radius
        bump = np.clip(1 - (foot[:, 0] / core) ** 2, 0, 1) ** 2
        front = bump * (normal[:, 1] < -0.99)
        return np.asarray(self.roll + front * (self.roll_front - self.roll))

    def position(self, p: FloatArray) -> FloatArray:
        """Map plane points p (k, 2) onto the surface, (k, 3)."""
        foot, normal, distance = self.outline(p)
        radius = self.roll_radius(foot, normal)
        way = np.maximum(distance + radius, 0)
        turned = np.minimum(way / radius, self.roll_angle)
        wall = way - turned * radius
        rolled = foot - (radius * (1 - np.sin(turned)))[:, None] * normal
        plan = np.where((way > 0)[:, None], rolled, p)
        z = self.top(*plan.T) - radius * (1 - np.cos(turned)) - np.sin(self.roll_angle) * wall
        x, y = (plan + (np.cos(self.roll_angle) * wall)[:, None] * normal).T
        a, b = self.half
        y = y - self.front_bow * (1 - (x / a) ** 2) * (np.maximum(-y, 0) / b) ** 2
        return np.column_stack([x, y, z])

    def ring(self, feet: FloatArray, normals: FloatArray, *, level: float | None) -> FloatArray:
        """Plane points (k, 2) of a closed line round the cushion.

        The seam between top and walls where ``level`` is None, else the line at that height.
        """
        radius = self.roll_radius(feet, normals)
        if level is None:
            way = radius * self.seam_angle
        else:
            plan = feet - (radius * (1 - np.sin(self.roll_angle)))[:, None] * normals
            fall = self.top(*plan.T) - radius * (1 - np.cos(self.roll_angle)) - level
            way = radius * self.roll_angle + fall / np.sin(self.roll_angle)
        return np.asarray(feet + (way - radius)[:, None] * normals)
