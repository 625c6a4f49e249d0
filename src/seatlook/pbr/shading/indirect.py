"""Light of the sky and of the cover itself, gathered at vertices: more of them where it changes."""

from __future__ import annotations

import functools
from collections.abc import Callable, Hashable

import numpy as np
import numpy.typing as npt

from seatlook.model import Camera, FloatArray, IntArray, Rig
from seatlook.pbr.cache import Cache
from seatlook.pbr.kernels import bvh, light, rays, specular_bounce
from seatlook.pbr.kernels.light import Lights
from seatlook.pbr.kernels.specular_bounce import Reflection, Sources, Vertices
from seatlook.pbr.kernels.stage import Look
from seatlook.pbr.light.rig import pack_lights, sky_colour, sky_levels, sky_unhidden
from seatlook.pbr.quality import Quality
from seatlook.pbr.shading.subdivision import boundary_edges
from seatlook.pbr.shading.surface import Surface

# Share of the sky seen by what lies below the cover; judgement.
_HIDDEN_SKY = 0.3
# Between neighbours whose open share differs by more, the vertex between them looks itself.
_CONTRAST = 0.2


class IndirectLight:
    """Light of the sky and of other faces at every vertex of a drawn surface.

    What a vertex sees lies in the ``cache``: over the half-space once, along reflections per
    camera. Lights and materials cost only what these faces send.
    """

    def __init__(self, surface: Surface, tree: bvh.Bvh, cache: Cache) -> None:
        self.surface, self.tree, self.cache = surface, tree, cache
        self.few = surface.solved

    @functools.cached_property
    def _points(self) -> FloatArray:
        """Where light is gathered: the refined vertices, those on an edge a little inside."""
        mesh, m = self.surface.mesh, self.surface.faces
        edge = boundary_edges(mesh.faces[:m])
        corner = np.isin(mesh.faces[:m], np.unique(edge))
        face = np.full(self.surface.vertices, -1)
        face[mesh.faces[:m][corner]] = np.nonzero(corner)[0]
        out = np.empty((len(face), 3))
        rays.inset(mesh, face, out)
        return out

    def light(
        self, rig: Rig, look: Look, level: Quality, camera: Camera, ids: np.ndarray
    ) -> light.Indirect:
        """Indirect light under a rig; see ``light.Indirect``."""
        mesh, k = self.surface.mesh, self.surface.vertices
        n = len(mesh.vertices)
        look = look._replace(materials=from_afar(look))
        even, panorama = rig.ambient * sky_colour(rig), sky_levels(rig)
        diffuse, mirrored, open_ = np.zeros((n, 3)), np.zeros((n, 3)), np.ones(n)
        seen, strata = self._half_space(level), level.strata or 8
        sky = (seen.hits == rays.OPEN).mean(axis=1)[:, None] * even
        if len(panorama):
            key = ("sky", panorama.tobytes(), len(seen.which))
            whole = self.cache(key, lambda: sky_unhidden(rig, mesh.normals[seen.which]))
            rays.sky_seen(mesh.normals, seen.which, seen.hits, strata, panorama, whole, sky)
        diffuse[:k] = self._spread(seen.which, sky)
        # Of the sky below a seam, and where the foam is in sight, little is seen.
        diffuse[k:] = _HIDDEN_SKY * diffuse[: self.few].mean(axis=0)
        if level.bounces:
            lights = pack_lights(rig)
            sources = Sources(mesh, look, lights, self._lit(lights), diffuse)
            sent = np.empty((len(seen.which), 3))
            specular_bounce.first_bounce(sources, seen, strata, sent)
            diffuse[:k] += self._again(seen, sent, look.materials, level.bounces - 1)
            self._mirror(camera, ids, level, sources, open_, mirrored)
        if level.strata:
            open_[k:] = _HIDDEN_SKY
        return light.Indirect(diffuse, mirrored, open_, even, panorama)

    def _lit(self, lights: Lights) -> FloatArray:
        """Share of each light that reaches each vertex, (lights, n)."""
        mesh = self.surface.mesh
        few = np.empty((len(lights.near), self.few))
        rays.lit(self.tree, self._points, mesh.normals, lights, few)
        lit = np.zeros((len(few), len(mesh.vertices)))
        lit[:, : self.surface.vertices] = self.surface.refined.spread(few.T).T
        return lit

    def _again(
        self, seen: Vertices, sent: FloatArray, materials: np.ndarray, times: int
    ) -> FloatArray:
        """First bounce and those after it, at all refined vertices."""
        total = every = self._spread(seen.which, sent)
        albedo = np.ascontiguousarray(materials["albedo"])
        for _ in range(times):
            padded = np.zeros(self.surface.mesh.vertices.shape)
            padded[: len(every)] = every
            rays.bounce(self.surface.mesh, seen.hits, albedo, padded, sent)
            every = self._spread(seen.which, sent)
            total = total + every
        return total

    def _mirror(
        self,
        camera: Camera,
        ids: np.ndarray,
        level: Quality,
        sources: Sources,
        open_: FloatArray,
        mirrored: FloatArray,
    ) -> None:
        """What reflections towards the camera see, into ``open_`` (n,) and ``mirrored`` (n, 3)."""
        k = self.surface.vertices
        key = ("lobes", camera_key(camera), level.factor, level.strata)
        reflection = Reflection(np.array(camera.position), self._points, 3 * level.strata // 4)
        seen = self.cache(key, lambda: self._lobes(reflection, ids))
        share, sent = np.empty(len(seen.which)), np.empty((len(seen.which), 3))
        specular_bounce.reflected(sources, seen, reflection, self._panel, share, sent)
        both = self._spread(seen.which, np.column_stack([share, sent]))
        open_[:k], mirrored[:k] = both[:, 0], both[:, 1:]

    @functools.cached_property
    def _panel(self) -> IntArray:
        """Panel of every vertex."""
        mesh = self.surface.mesh
        panel = np.zeros(len(mesh.vertices), dtype=np.int64)
        panel[mesh.faces] = mesh.panel[:, None]
        return panel

    def _half_space(self, level: Quality) -> Vertices:
        if not level.strata:
            return Vertices(np.arange(self.few), np.full((self.few, 64), rays.OPEN, dtype=np.int32))
        strata, mesh = level.strata, self.surface.mesh

        def look(which: IntArray) -> npt.NDArray[np.int32]:
            hits = np.empty((len(which), strata * strata), dtype=np.int32)
            rays.gather(
                self.tree, self.surface.faces, self._points, mesh.normals, which, strata, hits
            )
            return hits

        wanted = np.ones(self.surface.vertices, dtype=bool)
        seen: Vertices = self.cache(("hits", strata), lambda: self._where_it_changes(look, wanted))
        return seen

    def _lobes(self, reflection: Reflection, ids: np.ndarray) -> Vertices:
        m, mesh = self.surface.faces, self.surface.mesh

        def look(which: IntArray) -> npt.NDArray[np.int32]:
            hits = np.empty((len(which), 2 * reflection.strata**2), dtype=np.int32)
            specular_bounce.look_along_lobes(self.tree, m, reflection, mesh.normals, which, hits)
            return hits

        # All refined vertices of the solver's faces that are in the picture.
        seen = np.zeros(len(mesh.faces), dtype=bool)
        seen[ids[ids >= 0]] = True
        children = m // len(self.surface.coarse_faces)
        seen = seen[:m].reshape(-1, children).any(axis=1).repeat(children)
        wanted = np.zeros(self.surface.vertices, dtype=bool)
        wanted[mesh.faces[:m][seen]] = True
        return self._where_it_changes(look, wanted)

    def _where_it_changes(
        self, look: Callable[[IntArray], npt.NDArray[np.int32]], wanted: np.ndarray
    ) -> Vertices:
        """Look from the solver's vertices, then from refined ones whose parents differ."""
        which = [np.flatnonzero(wanted[: self.few])]
        hits = [look(which[0])]
        share = np.ones(self.few)
        share[which[0]] = _open(hits[0])
        for ends in self.surface.refined.parents:
            a, b = share[ends[:, 0]], share[ends[:, 1]]
            middle = 0.5 * (a + b)
            here = wanted[len(share) : len(share) + len(ends)]
            differ = np.flatnonzero((np.abs(a - b) > _CONTRAST) & here)
            which.append(len(share) + differ)
            hits.append(look(which[-1]))
            middle[differ] = _open(hits[-1])
            share = np.concatenate([share, middle])
        return Vertices(np.concatenate(which), np.concatenate(hits))

    def _spread(self, which: IntArray, values: FloatArray) -> FloatArray:
        """Values (m, d) of the vertices ``which`` carried to all refined ones."""
        out = np.zeros((self.few, values.shape[1]))
        first = int(np.searchsorted(which, self.few))
        out[which[:first]] = values[:first]
        for ends in self.surface.refined.parents:
            middle = 0.5 * (out[ends[:, 0]] + out[ends[:, 1]])
            stop = int(np.searchsorted(which, len(out) + len(ends)))
            middle[which[first:stop] - len(out)] = values[first:stop]
            out, first = np.concatenate([out, middle]), stop
        return out


def camera_key(camera: Camera) -> Hashable:
    """What makes one camera differ from another, whatever they are called."""
    vectors = np.concatenate([camera.position, camera.target, camera.up]).tobytes()
    return (vectors, camera.vertical_fov_deg, camera.size)


def from_afar(look: Look) -> np.ndarray:
    """Materials (p,) whose relief and maps are one roughness and one metalness."""
    out = look.materials.copy()
    for material in out:
        squared, variance = material["roughness"] ** 4, 0.0
        if material["maps"] >= 0:
            mean = look.maps.texels[look.maps.levels[material["maps"], -1, 0]]
            squared, variance = squared * mean[3], mean[7]
            material["metalness"] *= mean[4]
        if material["texture"] >= 0:
            mean = look.textures.texels[material["texture"], look.textures.start[-1]]
            variance += (material["texture_depth"] / material["texture_scale"]) ** 2 * mean[2]
        material["roughness"] = min(1.0, (squared + 2 * variance) ** 0.25)
    return out


def _open(hits: npt.NDArray[np.int32]) -> FloatArray:
    return np.asarray((hits == rays.OPEN).mean(axis=1))
