"""A flat sheet of two panels that are sewn along x = 0."""

from __future__ import annotations

from dataclasses import replace
from types import MappingProxyType

import numpy as np

from seatlook.model import Anchor, Points, Stitching
from support.reference.lit_sheets import flat, sheet


def sewn(gap=0.0002, kind=None, *, size=0.1, steps=10, hooked=0.0, thickness=None):
    """Two panels, the one with x < 0 first, ``gap`` apart, sewn vertex to vertex.

    ``kind``: of the seam, whose side a is the first panel's; ``hooked``: share of its points that
    a hook pulls; ``thickness`` [m] of the cloth.
    """
    solution = sheet(flat, panels=2, steps=steps, size=size)
    x = np.array(solution.positions)
    right = np.arange(len(x)) >= len(x) // 2
    x[right, 0] += gap
    side = [
        np.flatnonzero(~right & (np.abs(x[:, 0]) < 1e-9)),
        np.flatnonzero(right & (np.abs(x[:, 0] - gap) < 1e-9)),
    ]
    a, b = (
        Points(vertices=np.column_stack([v, v]), weights=np.tile([1.0, 0.0], (len(v), 1)))
        for v in side
    )
    seam = Stitching(name="middle", a=a, b=b, length=np.full(len(a), 0.01), stage="sew")
    cover = replace(solution.cover, stitchings=(seam,))
    if kind is not None:
        cover = replace(cover, seam_kinds=MappingProxyType({"middle": kind}))
    if hooked:
        on = round(hooked * len(side[0]))
        loose = np.flatnonzero(~right & (x[:, 0] < -0.02))[: len(side[0]) - on]
        v = np.concatenate([side[0][:on], loose])
        points = Points(vertices=np.column_stack([v, v]), weights=np.tile([1.0, 0.0], (len(v), 1)))
        hook = Anchor(
            name="hook", kind="hook", points=points, target=x[v], length=np.full(len(v), 0.01),
            stage="hook",
        )  # fmt: skip
        cover = replace(cover, anchors=(hook,))
    if thickness is not None:
        cloth = [replace(m, fabric=replace(m.fabric, thickness=thickness)) for m in cover.materials]
        cover = replace(cover, materials=tuple(cloth))
    return replace(solution, positions=x, cover=cover)
