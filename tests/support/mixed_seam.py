"""One seam of three fabrics: a panel sewn to two others, no two alike in anything."""

import dataclasses
from types import MappingProxyType

import numpy as np

from seatlook import model
from seatlook.flattening.pattern import cut_outline
from support import scenes

LENGTH, PART = 0.1, 0.036  # of the seam, and of its lower part [m]
WIDTH = MappingProxyType({"LEFT": 0.1, "LOWER": 0.07, "UPPER": 0.08})
DEPTH = MappingProxyType({"LEFT": LENGTH, "LOWER": PART, "UPPER": LENGTH - PART})
GRAIN = MappingProxyType({"LEFT": 30.0, "LOWER": 75.0, "UPPER": -20.0})  # [deg]
ALLOWANCE = MappingProxyType({"LEFT": 0.012, "LOWER": 0.006, "UPPER": 0.009})  # [m]
SIZE = MappingProxyType({"LEFT": 0.008, "LOWER": 0.003, "UPPER": 0.005})  # of elements [m]
FABRIC = MappingProxyType(
    {
        "LEFT": scenes.fabric(),
        "LOWER": scenes.fabric(
            thickness=0.0025, density=1.4, warp=model.Curve.linear(2200.0),
            weft=model.Curve.linear(900.0), bending_warp=5e-3, bending_weft=6e-4,
            bending_twist=9e-4,
        ),
        "UPPER": scenes.fabric(
            thickness=0.0006, density=0.25, warp=model.Curve.linear(14e3),
            weft=model.Curve.linear(21e3), bending_warp=1e-4, bending_weft=7e-4,
            bending_twist=1e-4, bending_poisson=0.2,
        ),
    }
)  # fmt: skip


def scene(*, hem=True, pitch=0.005, gap=0.0):
    """LEFT's right edge, sewn upwards to those of LOWER and UPPER on its right."""
    panels = []
    for name in WIDTH:
        panel = scenes.rectangle(name, WIDTH[name], DEPTH[name], angle=GRAIN[name])
        outline = cut_outline(panel.outline, ALLOWANCE[name])
        panels.append(dataclasses.replace(panel, cut_outline=outline))
    edges = [
        scenes.edge("LEFT.seam", "LEFT", 1, 2),
        scenes.edge("UPPER.seam", "UPPER", 3, 0),
        scenes.edge("LOWER.seam", "LOWER", 3, 0),
        scenes.edge("LEFT.rim", "LEFT", 3, 0),
    ]
    seam = model.Seam(name="middle", a="LEFT.seam", b=("LOWER.seam", "UPPER.seam"), pitch=pitch)
    at = {"LEFT": (0.0, 0.0), "LOWER": (0.1 + gap, 0.0), "UPPER": (0.1 + gap, PART)}
    return dataclasses.replace(
        scenes.two_panels(),
        pattern=model.Pattern(
            panels=tuple(panels), edges=MappingProxyType(dict(edges)), seams=(seam,)
        ),
        materials=MappingProxyType(
            {
                name: dataclasses.replace(scenes.material(name.lower()), fabric=FABRIC[name])
                for name in WIDTH
            }
        ),
        placement=MappingProxyType(
            {
                name: model.Pose(rotation=np.eye(3), translation=np.array([x, y, 0.005]))
                for name, (x, y) in at.items()
            }
        ),
        element_size=0.005,
        element_sizes=SIZE,
        hem=hem,
    )


def in_grain(vector, name):
    """Pattern vector (2,) in the warp/weft axes of a panel."""
    turn = np.radians(GRAIN[name])
    warp = np.array([np.cos(turn), np.sin(turn)])
    return np.array([vector @ warp, vector @ [-warp[1], warp[0]]])
