"""Wires of the foam that hold nothing, and the seams that lie beside them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from seatlook import mesh
from seatlook.assembly.hooking import hooks_beside
from seatlook.model import FloatArray, Points, Scene, Solution

_REACH = 0.04  # m from a wire, in which a seam may be meant for it


@dataclass(frozen=True, slots=True, kw_only=True)
class Unhooked:
    """A wire without a hook, and the seam that could be pulled to it.

    Parameters
    ----------
    wire, seam : names
    points : of the seam, on its first panel
    inward : (s, 3) float64     unit vectors from these to the wire
    forces : (s, 2, 3) float64 [N]   on their vertices, of 1 N in all
    away : float [m]            mean distance
    """

    wire: str
    seam: str
    points: Points
    inward: FloatArray
    forces: FloatArray
    away: float


def unhooked_wires(scene: Scene, solution: Solution) -> tuple[Unhooked, ...]:
    """Find wires that neither a hook nor a frame uses, with a seam beside them."""
    used = {hook.wire for hook in scene.hooks} | {frame.curve for frame in scene.frames}
    wires = {name: curve for name, curve in scene.foam.curves.items() if name not in used}
    hooked = {line for hook in scene.hooks for line in hook.lines}
    stitchings = {s.name: s for s in solution.cover.stitchings if s.name not in hooked}
    lines = {name: s.a.at(solution.positions) for name, s in stitchings.items()}
    found = hooks_beside(lines, wires, reach=_REACH, stage="") if wires and lines else ()
    result = []
    for hook in found:
        for name in hook.lines:
            seam = stitchings[name]
            place = mesh.nearest_places(wires[hook.wire], lines[name])[1]
            way = mesh.points_at(wires[hook.wire], place) - lines[name]
            size = np.linalg.norm(way, axis=1)
            inward = way / np.maximum(size, 1e-9)[:, None]
            share = seam.length / seam.length.sum()
            forces = share[:, None, None] * seam.a.weights[:, :, None] * inward[:, None, :]
            result.append(
                Unhooked(
                    wire=hook.wire, seam=name, points=seam.a, inward=inward, forces=forces,
                    away=float(size.mean()),
                )
            )  # fmt: skip
    return tuple(result)
