"""Previews of a shape: quick, under one light, for moving pictures and thumbnails."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from seatlook.errors import RenderError
from seatlook.model import Camera, FloatArray, Solution
from seatlook.model.colour import srgb_encode
from seatlook.pbr.kernels import surface as kernel
from seatlook.pbr.shading.eye import eye_of
from seatlook.pbr.shading.foam import FOAM, with_foam
from seatlook.pbr.shading.surface import vertex_normals

_FACTOR = 2  # samples per pixel and axis
_PAPER = 0.94  # linear
# Linear; neighbours in the list of panels differ, so that a seam shows where its panels lie flat.
_TINTS = np.array([[0.52, 0.30, 0.20], [0.62, 0.42, 0.30], [0.42, 0.22, 0.15]])
_SKY = 0.25  # share of the light that comes from everywhere
# The light, seen from the camera: to the right, up, and back along the view.
_LIGHT = np.array([-0.55, 0.60, 0.58])


def render_preview(solution: Solution, *, camera: Camera) -> npt.NDArray[np.uint8]:
    """Draw a cover on its foam, (h, w, 3) uint8: on the solver's own faces, without shadows.

    No light is traced and nothing refined, so that a picture takes a fraction of a second. The
    foam is pressed to below the cover, as in all pictures.

    Raises
    ------
    NoOffscreenContext, RenderError
    """
    from seatlook.pbr._vtk import face_window

    cover = solution.cover
    mesh, m = _drawn(solution), len(cover.faces)
    width, height = camera.size
    eye = eye_of(camera, _FACTOR)
    ids = face_window().faces(
        mesh.vertices, mesh.faces, camera, (width * _FACTOR, height * _FACTOR)
    )
    if not (ids >= 0).any():
        raise RenderError(f"camera {camera.name}: nothing is in the picture")
    lit = _lit(mesh.normals, camera)
    value = np.zeros(ids.shape)
    # Every corner of the foam has a vertex of its own, so its light need not be blended.
    kernel.paint(mesh, eye, ids, lit[mesh.faces], len(mesh.faces), value)
    tint = np.vstack([_TINTS[np.arange(len(cover.panel_names)) % len(_TINTS)], FOAM.albedo])
    panel = np.where(ids < m, mesh.panel[ids], len(tint) - 1)
    colour = tint[panel] * (_SKY + (1.0 - _SKY) * value)[..., None]
    colour[ids < 0] = _PAPER
    mean = colour.reshape(height, _FACTOR, width, _FACTOR, 3).mean(axis=(1, 3))
    return np.rint(255 * srgb_encode(np.clip(mean, 0.0, 1.0))).astype(np.uint8)


def _drawn(solution: Solution) -> kernel.Mesh:
    """The solver's faces with smooth normals, and the foam."""
    cover = solution.cover
    x, faces = np.array(solution.positions), np.array(cover.faces)
    mesh = kernel.Mesh(
        x,
        vertex_normals(x, faces),
        np.zeros((len(x), 3)),
        np.zeros((len(x), 2)),
        faces,
        np.array(cover.panel),
        np.full((len(x), 3), np.inf),
    )
    if cover.foam is None:
        return mesh
    return with_foam(mesh, cover.foam, len(cover.panel_names), cover=x)


def _lit(normals: FloatArray, camera: Camera) -> FloatArray:
    """Cosine (n,) to a light that stands beside the camera, 0 where it does not reach."""
    back = camera.position - camera.target
    back = back / np.linalg.norm(back)
    right = np.cross(camera.up, back)
    right = right / np.linalg.norm(right)
    frame = np.stack([right, np.cross(back, right), back])
    towards = _LIGHT / np.linalg.norm(_LIGHT) @ frame
    return np.asarray(np.maximum(normals @ towards, 0.0))
