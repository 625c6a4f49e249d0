"""What the hooks pull with, ring by ring."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from seatlook import mesh
from seatlook.model import Solution


@dataclass(frozen=True, slots=True, kw_only=True)
class RingPull:
    """Pull of one hog ring, or of one vertex of a line that is pulled all along.

    Parameters
    ----------
    ring : int                  number along the hook's line, from 1
    at : float [m]              along the line
    x, y, z : float [m]         where it sits on the cover
    gap : float [m]             what it is short of its wire
    pull : float [N]
    per_length : float [N/m]    pull over the length of line that the ring holds
    limit : float [N] or None   largest pull allowed
    """

    hook: str
    ring: int
    at: float
    x: float
    y: float
    z: float
    gap: float
    pull: float
    per_length: float
    limit: float | None

    @property
    def kept(self) -> bool:
        """Whether the pull is at most the limit."""
        return self.limit is None or self.pull <= self.limit


def ring_pulls(solution: Solution) -> tuple[RingPull, ...]:
    """List the rings of all hooks, in the order of the scene and of the line."""
    return tuple(_rings(solution))


def overpulled(solution: Solution) -> tuple[str, ...]:
    """Say for each hook with a limit that is not kept which ring pulls hardest."""
    messages = []
    rings = ring_pulls(solution)
    for name in dict.fromkeys(ring.hook for ring in rings):
        over = [ring for ring in rings if ring.hook == name and not ring.kept]
        if over:
            worst = max(over, key=lambda ring: ring.pull)
            messages.append(
                f"hook {name}: ring {worst.ring}, {1e3 * worst.at:.0f} mm along its line, pulls "
                f"{worst.pull:.1f} N; {len(over)} above the limit of {worst.limit:g} N"
            )
    return tuple(messages)


def _rings(solution: Solution) -> Iterator[RingPull]:
    for anchor in solution.cover.anchors:
        force = solution.forces.get(anchor.name)
        if anchor.kind != "hook" or force is None or anchor.at is None:
            continue
        points = anchor.points.at(solution.positions)
        target, wire = anchor.target, anchor.wire
        if wire is not None:
            target = mesh.points_at(wire.curve, wire.nearest(points))
        gap = np.linalg.norm(points - target, axis=1)
        pull = np.linalg.norm(force, axis=1)
        for k, (x, y, z) in enumerate(points.tolist()):
            yield RingPull(
                hook=anchor.name,
                ring=k + 1,
                at=float(anchor.at[k]),
                x=x,
                y=y,
                z=z,
                gap=float(gap[k]),
                pull=float(pull[k]),
                per_length=float(pull[k] / anchor.length[k]),
                limit=anchor.limit,
            )
