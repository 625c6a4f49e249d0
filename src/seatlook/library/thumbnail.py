"""Small drawings by which an entry is known at a glance: outlines, forms, colours."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt

from seatlook import io
from seatlook.io.scene.read import load_scene
from seatlook.io.toml import read_document
from seatlook.model.colour import srgb_encode

FloatArray = npt.NDArray[np.float64]
IntArray = npt.NDArray[np.int64]

SIZE = 160  # px
_CELLS = 22  # along the longest side, to which vertices are drawn together
_HEAD = (
    f'<svg xmlns="http://www.w3.org/2000/svg" width="{SIZE}" height="{SIZE}" '
    f'viewBox="0 0 {SIZE} {SIZE}">'
)
# Seen from the front, from above and a little from the left; z is up, -y to the front.
_RIGHT = np.array([0.866, 0.5, 0.0])
_UP = np.array([-0.25, 0.433, 0.866])


def thumbnail(kind: str, main: Path) -> str | None:
    """A drawing as SVG of what an entry is, None of what has no look: rigs and limits."""
    if kind == "pattern":
        return outlines([panel.outline for panel in io.read_panels(main)])
    if kind == "foam":
        surface = io.read_foam_surface(main)
        return form(surface.vertices, surface.faces)
    if kind == "seat":
        foam = load_scene(main).foam
        return form(foam.vertices, foam.faces)
    if kind == "result":
        solution = io.read_result(main)
        return form(solution.positions, solution.cover.faces)
    if kind == "material" and "fabric" in read_document(main).data:
        return swatch(io.read_material(main).appearance.albedo)
    return None


def outlines(panels: Sequence[FloatArray]) -> str:
    """Draw panels as they lie in the pattern.

    Parameters
    ----------
    panels : outlines, (n, 2) each, in any unit
    """
    points = _fitted(np.concatenate(panels))
    parts = np.split(points, np.cumsum([len(one) for one in panels])[:-1])
    drawn = [f'<path d="{_path(one)}"/>' for one in parts]
    return _svg('<g fill="#d9dee6" stroke="#3b4656" stroke-linejoin="round">', drawn)


def form(vertices: FloatArray, faces: IntArray) -> str:
    """Draw a surface as a solid in light from above, its small triangles drawn together.

    Parameters
    ----------
    vertices : (n, 3), z up; faces : (m, 3) int64, outward
    """
    low, extent = vertices.min(axis=0), float(np.ptp(vertices, axis=0).max())
    cells = np.floor((vertices - low) / max(extent, 1e-12) * _CELLS).astype(np.int64)
    _, of = np.unique(cells, axis=0, return_inverse=True)
    of = of.ravel()
    count = np.bincount(of)
    places = np.stack([np.bincount(of, vertices[:, k]) / count for k in range(3)], axis=1)
    corners = of[faces]
    whole = (corners != np.roll(corners, 1, axis=1)).all(axis=1)
    corners = np.unique(np.sort(corners[whole], axis=1), axis=0, return_index=True)[1]
    triangles = places[of[faces][whole][corners]]
    normals = np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0])
    normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-12)
    towards = np.cross(_RIGHT, _UP)
    order = np.argsort(triangles.mean(axis=1) @ towards)
    order = order[normals[order] @ towards > 0]
    light = 0.45 + 0.55 * np.clip(normals @ np.array([-0.35, -0.35, 0.87]), 0, 1)
    flat = triangles @ np.stack([_RIGHT, _UP], axis=1)
    flat = _fitted(flat.reshape(-1, 2)).reshape(-1, 3, 2)
    drawn = []
    for number in order:
        grey = round(225 * float(light[number]))
        colour = f"#{grey:02x}{grey:02x}{min(grey + 8, 255):02x}"
        drawn.append(f'<path color="{colour}" d="{_path(flat[number])}"/>')
    return _svg('<g fill="currentColor" stroke="currentColor" stroke-width=".5">', drawn)


def swatch(albedo: FloatArray) -> str:
    """Draw a colour as a disc.

    Parameters
    ----------
    albedo : (3,) linear
    """
    colour = "".join(f"{round(255 * v):02x}" for v in np.clip(srgb_encode(albedo), 0, 1))
    middle, radius = SIZE // 2, SIZE // 2 - 12
    disc = f'<circle cx="{middle}" cy="{middle}" r="{radius}" fill="#{colour}"/>'
    return _svg('<g stroke="#8a94a3">', [disc])


def _fitted(points: FloatArray) -> FloatArray:
    """Points in the middle of the picture, y down."""
    low, high = points.min(axis=0), points.max(axis=0)
    scale = (SIZE - 16) / max(float((high - low).max()), 1e-12)
    fitted: FloatArray = (points - (low + high) / 2) * scale * [1.0, -1.0] + SIZE / 2
    return fitted


def _path(points: FloatArray) -> str:
    return "M" + "L".join(f"{x:.1f} {y:.1f}" for x, y in points) + "Z"


def _svg(group: str, drawn: Sequence[str]) -> str:
    return "\n".join([_HEAD, group, *drawn, "</g>", "</svg>", ""])
