"""How far the frame curves that "init" lays from a pattern alone lie from those of the design.

Run it with: python gallery/borders.py [SHAPE ...]

Each shape of the family is written as "seatlook demo --shape" does. Then its pattern and foam are
given to "init", and the places where the edges of the border begin are compared.
"""

from __future__ import annotations

import sys
import tempfile
import warnings
from pathlib import Path

import numpy as np

import seatlook
from seatlook import io
from seatlook.mesh import arc_length
from seatlook.model import FloatArray, Scene
from seatlook.seats import SHAPES, write_demo


def beginnings(scene: Scene) -> tuple[float, dict[str, list[FloatArray]]]:
    """Length [m] of the only border, and per panel the places (3,) where its edges begin."""
    (frame,) = scene.frames
    curve = scene.foam.curves[frame.curve]
    arc = arc_length(curve)
    places: dict[str, list[FloatArray]] = {}
    for name, at in zip(frame.edges, frame.junctions, strict=False):
        place = np.array([np.interp(at, arc, column) for column in curve.T])
        places.setdefault(scene.pattern.edges[name].panel, []).append(place)
    return float(arc[-1]), places


def compare(shape: str, folder: Path) -> str:
    """One row: lengths of the border, and how far its edges begin from their places."""
    scene = write_demo(folder / "true", shape=shape)
    true = io.load_scene(scene)
    seatlook.init(scene.with_name("pattern.dxf"), scene.with_name("foam.obj"), folder / "guess")
    length, found = beginnings(io.load_scene(folder / "guess" / "scene.toml"))
    meant_length, meant = beginnings(true)
    off = max(
        min(float(np.linalg.norm(place - other)) for other in meant[panel])
        for panel, places in found.items()
        for place in places
    )
    return (
        f"{shape}: border {1e3 * length:.0f} mm, in the design {1e3 * meant_length:.0f} mm; "
        f"edges begin off by at most {1e3 * off:.0f} mm"
    )


def main(shapes: list[str]) -> None:
    """Print a row for each shape."""
    warnings.simplefilter("ignore")
    for shape in shapes or SHAPES:
        with tempfile.TemporaryDirectory() as folder:
            print(compare(shape, Path(folder)))


if __name__ == "__main__":
    main(sys.argv[1:])
