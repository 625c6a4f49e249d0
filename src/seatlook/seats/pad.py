"""A pad: one smooth map from a flat plane onto top, rolled edge and walls."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import shapely

from seatlook.model import FloatArray
from seatlook.seats.drawing import Drawing

QUARTERS = ("left", "rear", "right", "front")  # counter-clockwise seen from above, from +x
QUARTER = 1000  # points of the perimeter in each


@dataclass(frozen=True, slots=True, kw_only=True)
class Pad(ABC):
    """A pad with a rounded rectangle as plan, an edge that is rolled, and walls.

    All lengths in m, angles in rad. The plane point p maps to the plan view where the top is
    flat; beyond the start of the edge roll the way from there, measured along the plan outline's
    normal, is arc length over the roll and down the wall.

    Parameters
    ----------
    width, depth, corner_radius : plan outline, a rounded rectangle centred on the origin
    front_bow : how far the middle of the front stands forward of its corners
    height : top of the middle
    roll, roll_front : radius at sides, corners and rear; in the middle of the front
    roll_angle : angle turned by the roll; beyond 90 degrees the wall leans inward
    seam_angle : where on the roll the top is sewn to the walls
    slot : extra depth of the foam right under a tie-down, room for the wire
    frame_height : level at which the cover ends; the foam's bottom is at 0
    """

    width: float
    depth: float
    corner_radius: float
    front_bow: float
    height: float
    roll: float
    roll_front: float
    roll_angle: float
    seam_angle: float
    slot: float
    frame_height: float

    @abstractmethod
    def top(self, x: FloatArray, y: FloatArray) -> FloatArray:
        """Height of the top over the plan, before the edge roll takes it down."""

    @property
    def half(self) -> FloatArray:
        """Half width and half depth of the plan outline, (2,)."""
        return np.array([self.width, self.depth]) / 2

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

    def perimeter(self, count: int = QUARTER) -> tuple[FloatArray, FloatArray]:
        """Sample the plan outline from the middle of the front left corner, counter-clockwise.

        Every quarter (left, rear, right, front) has ``count`` points and starts in the middle of a
        corner.
        """
        core = self.half - self.corner_radius
        feet, normals = [], []
        for k in range(4):
            turn = np.array([[0, -1], [1, 0]])
            across = np.linalg.matrix_power(turn, k) @ np.array([1, 0])
            along = np.linalg.matrix_power(turn, k) @ np.array([0, 1])
            half = abs(core @ along)
            arc = self.corner_radius * np.pi / 4
            s = np.linspace(-half - arc, half + arc, count, endpoint=False)
            bend = np.sign(s) * np.maximum(np.abs(s) - half, 0) / self.corner_radius
            theta = k * np.pi / 2 + bend
            normal = np.column_stack([np.cos(theta), np.sin(theta)])
            middle = abs(core @ across) * across + np.clip(s, -half, half)[:, None] * along
            feet.append(middle + self.corner_radius * normal)
            normals.append(normal)
        return np.concatenate(feet), np.concatenate(normals)

    def room(self, p: FloatArray) -> FloatArray:
        """Extra depth (k,) [m] of the foam below a tie-down at plane points (k, 2)."""
        return np.full(len(p), self.slot)

    def walled(self, walls: Mapping[str, tuple[int, str]]) -> Drawing:
        """Draw the seam round the top, frame and rim, and lines down the walls.

        Parameters
        ----------
        walls : name of a line -> (point of ``perimeter`` where it lies, panel that follows it)
        """
        feet, normals = self.perimeter()
        levels = {"seam": None, "frame": self.frame_height, "rim": 0.0}
        loops = {name: self.ring(feet, normals, level=level) for name, level in levels.items()}
        lines = {name: np.concatenate([loop, loop[:1]]) for name, loop in loops.items()}
        middle = (loops["seam"] + loops["frame"]) / 2
        starts = [start for start, _ in walls.values()]
        panels: dict[str, list[FloatArray]] = {}
        for name, (start, panel) in walls.items():
            down = [loop[start] for loop in loops.values()]
            lines |= {name: np.array(down[:2]), f"below {name}": np.array(down[1:])}
            way = min((k - start) % len(feet) for k in starts if k != start)
            panels.setdefault(panel, []).append(middle[(start + way // 2) % len(feet)])
        return Drawing(lines=lines, panels={name: np.array(at) for name, at in panels.items()})

    def on_top(self, line: FloatArray) -> FloatArray:
        """Return the part (k, 2) of a line within the seam between top and walls."""
        area = shapely.Polygon(self.ring(*self.perimeter(), level=None))
        return np.asarray(shapely.get_coordinates(shapely.LineString(line).intersection(area)))


def swell(share: FloatArray) -> FloatArray:
    """Rise from 0 at 0 to 1 at 1 along a parabola that ends level, and stay there."""
    return np.asarray(1 - (1 - np.clip(share, 0, 1)) ** 2)


def fading(way: FloatArray, reach: float, tail: float) -> FloatArray:
    """Fall from 1 at 0 to 0 at ``reach``: two parabolas with one tangent, the last over ``tail``.

    So what fades along a seat leaves no crease where it ends.
    """
    middle = 1 - way**2 / (reach * (reach - tail))
    end = np.maximum(reach - way, 0) ** 2 / (reach * tail)
    return np.asarray(np.where(way < reach - tail, middle, end))


def quarters(*panels: str) -> dict[str, tuple[int, str]]:
    """Walls that meet in the four corners, for ``Pad.walled``: left, rear, right, front."""
    return {f"corner {k}": (k * QUARTER, panel) for k, panel in enumerate(panels)}
