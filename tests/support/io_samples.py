"""Samples for readers: a small solved cover that uses every field of a result, a closed box."""

import dataclasses
from types import MappingProxyType

import numpy as np

from seatlook.io.material import read_foam_material, read_material
from seatlook.model import (
    Anchor,
    Cover,
    Field,
    Foam,
    Points,
    Solution,
    Stage,
    Stitching,
    WrinkleMap,
)
from seatlook.wrinkle import INDICES


def cover():
    rest = np.array([[0, 0], [0.1, 0], [0.1, 0.1], [0, 0.1], [0.2, 0], [0.3, 0], [0.3, 0.1]])
    points = Points(vertices=[[0, 1], [1, 2]], weights=[[0.25, 0.75], [1.0, 0.0]])
    corners = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]) * 0.5
    foam = Foam(
        vertices=corners,
        faces=[[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]],
        material=read_foam_material("foam-seat"),
        curves=MappingProxyType({"wire": np.array([[0.1, 0.2, 1 / 3], [0.4, 0.5, 0.6]])}),
    )
    return Cover(
        rest=rest,
        uv=rest + 0.01,
        positions=np.column_stack([rest, 0.01 * np.sin(40 * rest[:, 0])]),
        faces=[[0, 1, 2], [0, 2, 3], [4, 5, 6]],
        panel=[0, 0, 1],
        panel_names=("insert", "Wange links"),
        materials=(read_material("suede"), read_material("black-leather")),
        zone=[0, 0, 1],
        zone_names=("insert", "seam"),
        stitchings=(Stitching(name="s", a=points, b=points, length=[0.1, 0.2], stage="sew"),),
        anchors=(
            Anchor(name="h", kind="hook", points=points, target=np.ones((2, 3)) / 3,
                   length=[0.1, 0.1], stage="hook"),
        ),
        stages=(Stage(name="sew", start=0.0, end=0.1), Stage(name="hook", start=0.1, end=1 / 3)),
        foam=foam,
        element_size=0.1,
        seed=3,
        scene_digest="abc",
    )  # fmt: skip


def solution(status="converged"):
    shape = cover()
    random = np.random.default_rng(1)
    n, m = len(shape.rest), len(shape.faces)
    anchor = random.normal(size=(n, 3))
    anchor[2] = np.nan
    return Solution(
        cover=shape,
        positions=random.normal(size=(n, 3)) * 0.1,
        velocities=random.normal(size=(n, 3)) * 1e-300,
        strain_top=random.normal(size=(m, 2, 2)),
        strain_mid=random.normal(size=(m, 2, 2)),
        strain_bottom=random.normal(size=(m, 2, 2)),
        multipliers=MappingProxyType({"s": random.normal(size=(2, 3)), "h": np.zeros((2, 3))}),
        friction_anchor=anchor,
        stage="hook",
        status=status,
        reason="" if status == "converged" else "residual 3e-3",
        history=MappingProxyType(
            {"time": np.arange(3.0), "residual": np.array([1.0, np.inf, 0.1])}
        ),
        figures=MappingProxyType({"seam_gap_max": 0.1 + 0.2, "cpu_seconds": 12.5}),
        version="0.1.0",
    )


def wrinkles():
    c = np.array([3.0, -4.0, 0.0])
    w2 = np.maximum(-c / 20, 0.0)
    r = np.array([0.0, 0.25, 1.0])
    return WrinkleMap(
        c=c, w1=c / 20, w2=w2, r_stretch=r, w_stretch=w2 * r, w_compression=w2 * (1 - r)
    )


def box(width=0.5, depth=0.5, height=0.1):
    """Corners [m] and faces of a closed box that stands on z = 0."""
    corners = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (0, 1)])
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    faces = [f for a, b, c, d in quads for f in ((a, b, c), (a, c, d))]
    return corners * [width, depth, height], np.array(faces)


def as_placed(c):
    """A solution in which the cover lies as it was placed."""
    like = solution()
    n, m = len(c.rest), len(c.faces)
    return dataclasses.replace(
        like, cover=c, positions=c.positions, velocities=np.zeros((n, 3)),
        friction_anchor=np.zeros((n, 3)),
        **{name: np.zeros((m, 2, 2)) for name in ("strain_top", "strain_mid", "strain_bottom")},
    )  # fmt: skip


def fields_of(indices):
    """The paper's indices as the fields that exports carry."""
    return tuple(
        Field(
            name=index.export_name,
            unit=index.unit,
            meaning=index.meaning,
            values=index.scale * getattr(indices, index.name),
        )
        for index in INDICES.values()
        if hasattr(indices, index.name)
    )
