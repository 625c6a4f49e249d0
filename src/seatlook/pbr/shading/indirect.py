"""Light of the sky and of the cover itself, gathered at vertices: more of them where it changes."""

from __future__ import annotations

import functools
from collections.abc import Hashable

import numpy as np
import numpy.typing as npt

from seatlook.model import Camera, FloatArray, IntArray, Rig
from seatlook.pbr.cache import Cache
from seatlook.pbr.kernels import bvh, light, rays, specular_bounce
from seatlook.pbr.kernels.light import Lights
from seatlook.pbr.kernels.parts import in_parts
from seatlook.pbr.kernels.specular_bounce import Reflection, Sources, Vertices
from seatlook.pbr.kernels.stage import Look
from seatlook.pbr.kernels.surface import mark_faces
from seatlook.pbr.light.rig import pack_lights, patched, sky_colour, sky_levels, sky_unhidden
from seatlook.pbr.quality import Quality
from seatlook.pbr.shading.looking import Hits, Lookout, Memory
from seatlook.pbr.shading.sharing import Neighbours, neighbours
from seatlook.pbr.shading.subdivision import boundary_edges
from seatlook.pbr.shading.surface import Surface

# Share of the sky seen by what lies below the cover; judgement.
_HIDDEN_SKY = 0.3
# How often vertices share what they gathered over the half-space.
_TIMES = 24
# Vertices that are worth a thread.
_LEAST = 512


class IndirectLight:
    """Light of the sky and of other faces at every vertex of a drawn surface.

    What a vertex sees lies in the ``cache``: over the half-space once, along reflections per
    camera. Lights and materials cost only what these faces send.
    """

    def __init__(self, surface: Surface, tree: bvh.Bvh, cache: Cache) -> None:
        self.surface, self.tree, self.cache = surface, tree, cache
        self.lookout = Lookout(surface)
        self.first = self.lookout.first

    @property
    def _on_cover(self) -> IntArray:
        """Vertices that look first, but those around the seat."""
        return self.first[self.first < self.surface.vertices]

    @functools.cached_property
    def _points(self) -> FloatArray:
        """Where light is gathered: the refined vertices, those on an edge a little inside."""
        mesh, m = self.surface.mesh, self.surface.faces
        edge = boundary_edges(mesh.faces[:m])
        corner = np.isin(mesh.faces[:m], np.unique(edge))
        face = np.full(self.surface.gathering, -1)
        face[mesh.faces[:m][corner]] = np.nonzero(corner)[0]
        out = np.empty((len(face), 3))
        rays.inset(mesh, face, out)
        return out

    def light(
        self, rig: Rig, look: Look, level: Quality, camera: Camera, ids: np.ndarray
    ) -> light.Indirect:
        """Indirect light under a rig; see ``light.Indirect``."""
        mesh, k = self.surface.mesh, self.surface.gathering
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
        diffuse[:k] = self.lookout.spread(seen.which, self._shared(seen, sky, _TIMES))
        # Of the sky below a seam, and where the foam is in sight, little is seen.
        diffuse[k:] = _HIDDEN_SKY * diffuse[self._on_cover].mean(axis=0)
        if level.bounces:
            lights = pack_lights(patched(rig))
            sources = Sources(mesh, look, lights, self._lit(lights), diffuse)
            sent = self._first_bounce(sources, seen, level)
            diffuse[:k] += self._again(seen, sent, look.materials, level.bounces - 1)
            self._mirror(camera, ids, level, sources, open_, mirrored)
        if level.strata:
            open_[k:] = _HIDDEN_SKY
        return light.Indirect(diffuse, mirrored, open_, even, panorama)

    def sky_share(self, level: Quality) -> FloatArray:
        """Share (n,) of an even sky that reaches each vertex of the drawn surface."""
        out, k = np.empty(len(self.surface.mesh.vertices)), self.surface.gathering
        seen = self._half_space(level)
        share = (seen.hits == rays.OPEN).mean(axis=1)[:, None]
        out[:k] = self.lookout.spread(seen.which, self._shared(seen, share, _TIMES))[:, 0]
        out[k:] = _HIDDEN_SKY * out[self._on_cover].mean()
        return out

    def _first_bounce(self, sources: Sources, seen: Vertices, level: Quality) -> FloatArray:
        """Luminance (m, 3) that the vertices which look get of the faces they see."""
        sent = np.empty((len(seen.which), 3))

        def gather(a: int, b: int) -> None:
            part = Vertices(seen.which[a:b], seen.hits[a:b])
            specular_bounce.first_bounce(sources, part, level.strata, sent[a:b])

        in_parts(len(sent), gather, least=_LEAST)
        return self._shared(seen, sent, _TIMES)

    def _shared(self, seen: Vertices, values: FloatArray, times: int) -> FloatArray:
        """Values (m, d) of vertices that look, held between those beside them, and shared."""
        if (seen.hits == rays.OPEN).all():
            return values
        beside = self._neighbours(seen)
        return beside.shared(beside.trimmed(values), times=times)

    def _neighbours(self, seen: Vertices) -> Neighbours:
        """Vertices that look, side by side, and how much the same they see."""

        def make() -> tuple[Vertices, Neighbours]:
            mesh, (which, hits) = self.surface.mesh, seen
            points, around = self._points[which], np.empty(len(which))
            rays.around(mesh, points, hits, around)
            pairs = self.lookout.pairs(which)
            return seen, neighbours(points, mesh.normals[which], pairs, around)

        # What was seen is kept with it: as long as it lives no other has its number.
        kept: tuple[Vertices, Neighbours] = self.cache(("neighbours", id(seen)), make)
        return kept[1]

    def _lit(self, lights: Lights) -> FloatArray:
        """Share of each light that reaches each vertex, (lights, n)."""

        def make() -> FloatArray:
            mesh = self.surface.mesh
            few = np.empty((len(lights.near), len(self.first)))
            normals = mesh.normals[self.first]
            rays.lit(self.tree, self._points[self.first], normals, lights, few)
            lit = np.zeros((len(few), len(mesh.vertices)))
            lit[:, : self.surface.gathering] = self.lookout.spread(self.first, few.T).T
            return lit

        return np.asarray(self.cache(("lit", *_places(lights)), make))

    def _again(
        self, seen: Vertices, sent: FloatArray, materials: np.ndarray, times: int
    ) -> FloatArray:
        """First bounce and those after it, at all refined vertices."""
        total = every = self.lookout.spread(seen.which, sent)
        albedo = np.ascontiguousarray(materials["albedo"])
        for _ in range(times):
            padded = np.zeros(self.surface.mesh.vertices.shape)
            padded[: len(every)] = every
            rays.bounce(self.surface.mesh, seen.hits, albedo, padded, sent)
            every = self.lookout.spread(seen.which, sent)
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
        k = self.surface.gathering
        reflection = Reflection(np.array(camera.position), self._points, 3 * level.strata // 4)
        seen = self._lobes(reflection, camera, ids, level, sources)
        share, sent = np.empty(len(seen.which)), np.empty((len(seen.which), 3))

        def gather(a: int, b: int) -> None:
            part = Vertices(seen.which[a:b], seen.hits[a:b])
            specular_bounce.reflected(sources, part, reflection, self._panel, share[a:b], sent[a:b])

        in_parts(len(sent), gather, least=_LEAST)
        both = self._shared(seen, np.column_stack([share, sent]), 0)
        both = self.lookout.spread(seen.which, both)
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
            return Vertices(self.first, np.full((len(self.first), 64), rays.OPEN, dtype=np.int32))
        strata, mesh = level.strata, self.surface.mesh

        def look(which: IntArray) -> npt.NDArray[np.int32]:
            hits = np.empty((len(which), strata * strata), dtype=np.int32)
            start = (self.tree, self.surface.fronts, self._points, mesh.normals)
            in_parts(
                len(which),
                lambda a, b: rays.gather(*start, which[a:b], strata, hits[a:b]),
                least=_LEAST,
            )
            return hits

        wanted = np.ones(self.surface.gathering, dtype=bool)
        seen: Vertices = self.cache(
            ("hits", strata), lambda: self.lookout.where_it_changes(look, _open, wanted)
        )
        return seen

    def _lobes(
        self,
        reflection: Reflection,
        camera: Camera,
        ids: np.ndarray,
        level: Quality,
        sources: Sources,
    ) -> Vertices:
        """What vertices in the picture see along reflections, by more where lit shares differ."""
        m, mesh, lights = self.surface.fronts, self.surface.mesh, sources.lights

        def look(which: IntArray) -> npt.NDArray[np.int32]:
            hits = np.empty((len(which), 2 * reflection.strata**2), dtype=np.int32)
            start = (self.tree, m, reflection, mesh.normals)
            in_parts(
                len(which),
                lambda a, b: specular_bounce.look_along_lobes(*start, which[a:b], hits[a:b]),
                least=_LEAST,
            )
            return hits

        lit = sources.lit[:, mesh.faces].mean(axis=2)

        def shares(hits: Hits) -> FloatArray:
            light = np.where(hits >= 0, lit[:, np.maximum(hits, 0)], 0.0).mean(axis=2)
            return np.column_stack([_open(hits), light.T])

        key = ("lobes", camera_key(camera), level.factor, level.strata)
        memory = self.cache(key, lambda: Memory(self.surface.gathering))
        seen: Vertices = self.cache(
            (*key, *_places(lights)),
            lambda: self.lookout.where_it_changes(
                functools.partial(memory, look), shares, self._in_picture(ids)
            ),
        )
        return seen

    def _in_picture(self, ids: np.ndarray) -> npt.NDArray[np.bool_]:
        """All refined vertices of the solver's faces that are in the picture."""
        m, mesh = self.surface.faces, self.surface.mesh
        seen = np.zeros(len(mesh.faces), dtype=bool)
        mark_faces(ids, seen)
        children = m // len(self.surface.coarse_faces)
        seen = seen[:m].reshape(-1, children).any(axis=1).repeat(children)
        wanted = np.zeros(self.surface.gathering, dtype=bool)
        wanted[mesh.faces[:m][seen]] = True
        return wanted


def _places(lights: Lights) -> tuple[bytes, ...]:
    """Where lights are, whatever they send."""
    return tuple(x.tobytes() for x in (lights.near, lights.vector, lights.size, lights.sides))


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


def _open(hits: Hits) -> FloatArray:
    return np.asarray((hits == rays.OPEN).mean(axis=1)[:, None])
