"""Coherent pixels: their four samples see the same, so that fewer are enough."""

from __future__ import annotations

from numba import njit

from seatlook.pbr.kernels import leaf
from seatlook.pbr.kernels.surface import blend, dot, meet, ray_through, row, unit

# What a sample of such a pixel stands for; a number from 0 on is that of a sample in its pixel.
FIRST_HALF, SECOND_HALF, WHOLE = -1, -2, -3
# Cosine between normals of neighbouring samples that count as one: 2 degrees.
_UNBENT = 0.9994


@leaf()
def _normal(mesh, eye, f, i, j):
    """Normal of face f at the sample in column i, row j."""
    b1, b2, _, _ = meet(mesh, eye, f, ray_through(eye, i, j))
    return unit(blend(mesh.normals, mesh.faces, f, b1, b2))


@leaf()
def _unbent(mesh, eye, ids, x, y, i, j):
    """Whether the normal changes little from sample (x, y) to (i, j), both on the surface."""
    f, g = ids[y, x], ids[j, i]
    # Corners lie further apart than samples: where theirs agree there is no need to look closer.
    corners = dot(row(mesh.normals, mesh.faces[f, 0]), row(mesh.normals, mesh.faces[g, 0]))
    return corners >= _UNBENT or (
        dot(_normal(mesh, eye, f, x, y), _normal(mesh, eye, g, i, j)) >= _UNBENT
    )


@leaf()
def _is_coherent(mesh, eye, ids, visibility, reach, x, y):
    """Whether the 2 x 2 samples from (x, y) see one panel, unbent, equally lit, no seam."""
    f = ids[y, x]
    if f < 0:
        return False
    i, j, k = mesh.faces[f, 0], mesh.faces[f, 1], mesh.faces[f, 2]
    if min(mesh.seam[i, 0], mesh.seam[j, 0], mesh.seam[k, 0]) < reach:
        return False
    for q in range(1, 4):
        i, j = x + q % 2, y + q // 2
        g = ids[j, i]
        for light in range(len(visibility)):
            if visibility[light, j, i] != visibility[light, y, x]:
                return False
        if g == f:
            continue
        if g < 0 or mesh.panel[g] != mesh.panel[f] or not _unbent(mesh, eye, ids, x, y, i, j):
            return False
    return True


@njit(cache=True)
def find_coherent(mesh, eye, ids, visibility, reach, out):
    """Whether a pixel is coherent, into ``out`` (h, w).

    ``ids`` (2 h, 2 w) and ``visibility`` (k, 2 h, 2 w) as for ``shade``; ``reach`` [m]: how far
    from a seam something of it is to be seen.
    """
    for y in range(out.shape[0]):
        for x in range(out.shape[1]):
            out[y, x] = _is_coherent(mesh, eye, ids, visibility, reach, 2 * x, 2 * y)
