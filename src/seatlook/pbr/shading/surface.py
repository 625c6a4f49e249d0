"""The surface that is drawn: the solved panels refined and smooth, and the foam below them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy import sparse

from seatlook.errors import InputError, RenderError
from seatlook.model import Cover, FloatArray, IntArray, Solution, Surroundings
from seatlook.pbr.kernels.surface import Mesh
from seatlook.pbr.shading import seam
from seatlook.pbr.shading.allowance import heights, sides_of
from seatlook.pbr.shading.foam import with_foam
from seatlook.pbr.shading.ground import Ground, ground_of
from seatlook.pbr.shading.subdivision import Refined, boundary_edges, sharp_corners, subdivide

# Refinement stops below this edge length [m], about a pixel of the named views, or at this size.
_FINE = 0.0012
_MOST_FACES = 500_000


@dataclass(frozen=True, slots=True)
class Surface:
    """What is drawn.

    Parameters
    ----------
    mesh : Mesh           cover first, then foam; the foam's ``panel`` is one past the last panel
    refined : Refined     how the cover's vertices come from the solved ones
    vertices, faces : int how many of the mesh's are the refined panels
    opaque : int          how many faces stop light: of the cover, of what is around it, and of the
        allowance turned in
    ground : Ground       what is around the seat, after the panels; or None
    lift : (n,) float64 or None   [m] by which allowances below the seams lift the cover
    coarse_faces : (m, 3) the solver's faces
    element_size : float  [m] of the solver's faces
    """

    mesh: Mesh
    refined: Refined
    vertices: int
    faces: int
    opaque: int
    coarse_faces: IntArray
    element_size: float
    ground: Ground | None = None
    lift: FloatArray | None = None

    @property
    def gathering(self) -> int:
        """How many vertices gather light: those of the panels, then those around the seat."""
        return self.vertices + (len(self.ground.vertices) if self.ground else 0)

    @property
    def fronts(self) -> int:
        """How many faces shine: those of the panels, then those around the seat."""
        return self.faces + (len(self.ground.faces) if self.ground else 0)

    def faces_of_level(self, level: int) -> IntArray:
        """Faces (m, 3) of the panels refined ``level`` times: each keeps a corner in each child."""
        finer = len(self.refined.parents) - level
        first = np.arange(len(self.coarse_faces) * 4**level) * 4**finer
        step = (4**finer - 1) // 3
        corners = [self.mesh.faces[first + k * step, k] for k in range(3)]
        return np.column_stack(corners)

    @property
    def solved(self) -> int:
        """How many of the vertices are the solver's; they come first."""
        return len(self.refined.points) - sum(map(len, self.refined.parents))

    def shaded_as(self, other: Surface) -> Surface:
        """The surface with the normals of another shape of the same cover.

        Raises
        ------
        InputError
            It is of another cover.
        """
        if not np.array_equal(self.mesh.faces, other.mesh.faces):
            raise InputError.single(
                "shading", got="another cover", expected="another shape of the same cover"
            )
        return replace(self, mesh=self.mesh._replace(normals=other.mesh.normals))

    @property
    def cover_mesh(self) -> Mesh:
        """Only the cover; foam that it compresses is not in the way of light."""
        m = self.mesh
        return m._replace(faces=m.faces[: self.opaque], panel=m.panel[: self.opaque])


def drawn_surface(
    solution: Solution,
    surroundings: Surroundings | None = None,
    *,
    like: Surface | None = None,
    built: bool = True,
) -> Surface:
    """Refine the solved cover until its elements do not show, add what is around it and the foam.

    Parameters
    ----------
    like : of the same cover in another shape; the foam is as that has pressed it, and what does
        not depend on the shape is shared, and so is what is around the seat
    built : whether seams are drawn as they are built: with allowances, by their kinds

    Raises
    ------
    RenderError
        The cover has no faces, or a face without area.
    """
    cover = solution.cover
    if len(cover.faces) == 0:
        raise RenderError("the cover has no faces to draw")
    levels = _levels(cover.element_size, len(cover.faces))
    refined = subdivide(
        np.hstack([solution.positions, cover.rest]),
        cover.faces,
        levels=levels,
        corners=sharp_corners(cover.rest, cover.faces) if levels else np.zeros(0, dtype=np.int64),
    )
    uv = np.ascontiguousarray(refined.points[:, 3:])
    edges = seam.sewn_edges(cover, refined, uv)
    x = seam.close(refined.points[:, :3], edges)
    if like is not None:
        return _moved(like, x, edges)
    mesh, lift = _sewn_mesh(cover, refined, x, edges, built=built)
    n, m, ground = len(x), len(refined.faces), None
    if surroundings is not None:
        ground = _ground(mesh, edges, cover)
        mesh = _with_ground(mesh, ground, len(cover.panel_names) + 1)
    if len(edges):
        mesh = _with_allowance(mesh, edges)
    k = len(mesh.faces)
    if cover.foam is not None:
        mesh = with_foam(mesh, cover.foam, len(cover.panel_names), cover=x)
    coarse = np.array(cover.faces)
    return Surface(mesh, refined, n, m, k, coarse, cover.element_size, ground, lift)


def _sewn_mesh(
    cover: Cover, refined: Refined, x: FloatArray, edges: seam.SewnEdges, *, built: bool
) -> tuple[Mesh, FloatArray | None]:
    """Mesh of the panels with its vertices at x (n, 3), lifted by allowances if ``built``."""
    uv = np.ascontiguousarray(refined.points[:, 3:])
    panel = np.repeat(cover.panel, len(refined.faces) // len(cover.faces))
    panel_of = _panel_of_vertices(refined.faces, panel, len(x))
    rows = sides_of(cover).rows if built else np.ones(2 * len(cover.stitchings))
    beside, lift = seam.coordinates(uv, panel_of, edges, rows), None
    if built and len(edges):
        lift = heights(cover, uv, panel_of, beside[:, 0], edges)
        x = _lifted(x, refined.faces, lift)
    normals, warp = vertex_normals(x, refined.faces), _warp(x, uv, refined.faces)
    return Mesh(x, normals, warp, uv, refined.faces, panel, beside), lift


def _moved(like: Surface, x: FloatArray, edges: seam.SewnEdges) -> Surface:
    """The surface of the same cover with its refined vertices at ``x`` (n, 3)."""
    old, faces = like.mesh, like.refined.faces
    if like.lift is not None:
        x = _lifted(x, faces, like.lift)
    around = slice(len(x), like.gathering)
    points, normals = [x, old.vertices[around]], [vertex_normals(x, faces), old.normals[around]]
    warp = [_warp(x, old.uv[: len(x)], faces), old.warp[around]]
    if len(edges):
        below, _, origin = seam.turned_in(x, normals[0], edges)
        points.append(below)
        normals.append(normals[0][origin])
        warp.append(warp[0][origin])
    rest = slice(sum(map(len, points)), None)
    mesh = old._replace(
        vertices=np.vstack([*points, old.vertices[rest]]),
        normals=np.vstack([*normals, old.normals[rest]]),
        warp=np.vstack([*warp, old.warp[rest]]),
    )
    return replace(like, mesh=mesh)


def _lifted(x: FloatArray, faces: np.ndarray, lift: FloatArray) -> FloatArray:
    return x + lift[:, None] * vertex_normals(x, faces)


def vertex_normals(x: FloatArray, faces: np.ndarray) -> FloatArray:
    """Area-weighted unit normals (n, 3); vertices without a face get z.

    Panels share no vertices, so their seams stay creases.
    """
    a, b, c = (x.take(corner, axis=0) for corner in faces.T)
    n = _sum_to_vertices(np.cross(b - a, c - a), faces, len(x))
    length = np.linalg.norm(n, axis=1, keepdims=True)
    lost = length[:, 0] == 0
    n[lost] = (0.0, 0.0, 1.0)
    length[lost] = 1.0
    return np.ascontiguousarray(n / length)


def _levels(element_size: float, faces: int) -> int:
    levels = 0
    while element_size / 2**levels > _FINE and faces * 4 ** (levels + 1) <= _MOST_FACES:
        levels += 1
    return levels


def _warp(x: FloatArray, uv: FloatArray, faces: np.ndarray) -> FloatArray:
    """Unit direction (n, 3) of the first pattern coordinate at the vertices."""
    a, b, c = (x.take(corner, axis=0) for corner in faces.T)
    p, q, r = (uv.take(corner, axis=0) for corner in faces.T)
    # det times dx/du: as a sum over faces this weights each with its area.
    along = (b - a) * (r - p)[:, 1:] - (c - a) * (q - p)[:, 1:]
    warp = _sum_to_vertices(along, faces, len(x))
    length = np.linalg.norm(warp, axis=1, keepdims=True)
    return np.ascontiguousarray(warp / np.where(length > 0, length, 1.0))


def _sum_to_vertices(values: FloatArray, faces: np.ndarray, n: int) -> FloatArray:
    """Sum (n, d) at each vertex of the values (m, d) of its faces."""
    m = len(faces)
    corners = (np.ones(3 * m), faces.ravel(), np.arange(0, 3 * m + 1, 3))
    return np.asarray(sparse.csc_array(corners, shape=(n, m)) @ values)


def _ground(mesh: Mesh, edges: seam.SewnEdges, cover: Cover) -> Ground:
    """Floor and valance of a drawn cover."""
    free = boundary_edges(mesh.faces)
    sewn = np.isin(free @ [len(mesh.vertices), 1], edges.start * len(mesh.vertices) + edges.end)
    foam = np.zeros((0, 3)) if cover.foam is None else np.array(cover.foam.vertices)
    return ground_of(mesh.vertices, mesh.normals, free[~sewn], foam)


def _with_ground(mesh: Mesh, ground: Ground, panel: int) -> Mesh:
    """Mesh with a floor, whose panel is the one given, and a valance, whose panel is the next."""
    g = len(ground.vertices)
    own = panel + (np.arange(len(ground.faces)) >= ground.floor)
    return Mesh(
        np.vstack([mesh.vertices, ground.vertices]),
        np.vstack([mesh.normals, ground.normals]),
        np.vstack([mesh.warp, np.zeros((g, 3))]),
        np.vstack([mesh.uv, np.zeros((g, 2))]),
        np.vstack([mesh.faces, len(mesh.vertices) + ground.faces]),
        np.concatenate([mesh.panel, own]),
        np.vstack([mesh.seam, np.full((g, 3), np.inf)]),
    )


def _with_allowance(mesh: Mesh, edges: seam.SewnEdges) -> Mesh:
    points, faces, origin = seam.turned_in(mesh.vertices, mesh.normals, edges)
    owner = np.concatenate([edges.panel, edges.panel])
    return Mesh(
        np.vstack([mesh.vertices, points]),
        np.vstack([mesh.normals, mesh.normals[origin]]),
        np.vstack([mesh.warp, mesh.warp[origin]]),
        np.vstack([mesh.uv, mesh.uv[origin]]),
        np.vstack([mesh.faces, faces]),
        np.concatenate([mesh.panel, owner]),
        np.vstack([mesh.seam, np.column_stack([np.zeros(len(points)), mesh.seam[origin, 1:]])]),
    )


def _panel_of_vertices(faces: IntArray, panel: IntArray, n: int) -> IntArray:
    out = np.zeros(n, dtype=np.int64)
    out[faces] = panel[:, None]
    return out
