"""Rendering: what is cached between pictures, and the order in which a picture is made."""

from __future__ import annotations

import functools
from collections import OrderedDict
from collections.abc import Hashable
from itertools import pairwise
from types import MappingProxyType

import numpy as np
import numpy.typing as npt

from seatlook.errors import InputError, RenderError
from seatlook.model import Camera, FloatArray, Light, Rig, Solution, Thread, surroundings_named
from seatlook.pbr.backend import offscreen_backend
from seatlook.pbr.cache import Cache
from seatlook.pbr.kernels import (
    area_shadow,
    bvh,
    coherent,
    rays,
    shade,
    shadow,
    stage,
    stitch,
    surface,
)
from seatlook.pbr.light.exposure import ev100
from seatlook.pbr.light.rig import lux_at_seat, pack_lights, white_card, white_of
from seatlook.pbr.light.windows import with_windows
from seatlook.pbr.picture import Image
from seatlook.pbr.quality import Quality, quality_named, quality_within
from seatlook.pbr.shading.allowance import sides_of
from seatlook.pbr.shading.backdrop import backdrop
from seatlook.pbr.shading.eye import eye_of
from seatlook.pbr.shading.indirect import IndirectLight, camera_key
from seatlook.pbr.shading.look import Looks, look_of
from seatlook.pbr.shading.seam import pack_thread
from seatlook.pbr.shading.surface import Surface, drawn_surface

# Foam in front of the cover by less than this [m] is a coarse foam face that cuts through it.
_COMPRESSED = 0.02


class Studio:
    """One solved cover ready to be drawn, with everything that pictures share.

    Faces seen are cached per camera, shadows per camera and light, open sky per mesh: another
    material costs only its shading, another light only its shadows. With ``shading`` the normals
    are those of another shape of the same cover; outlines and shadows stay. With ``like``, the
    studio of another shape of the same cover, what does not depend on the shape is taken from that;
    with ``seen``, one whose vertices lie on the same rays of the only camera that is used, so are
    faces seen. ``surroundings``: name of what is around the seat. ``built``: whether seams are
    drawn as they are built, or all as grooves with one row of stitches, as for a score.

    Raises
    ------
    NoOffscreenContext, RenderError
    InputError
        ``shading``, ``like`` or ``seen`` is of another cover.
    """

    def __init__(
        self,
        solution: Solution,
        *,
        shading: Solution | None = None,
        thread: Thread | None = None,
        like: Studio | None = None,
        seen: Studio | None = None,
        surroundings: str = "plain",
        built: bool = True,
    ) -> None:
        around = surroundings_named(surroundings)
        offscreen_backend()
        self.solution = solution
        rows = int(sides_of(solution.cover).rows.max(initial=0))
        self.thread = pack_thread(thread or solution.cover.thread, built=built, rows=rows)
        self.surroundings, self._around = surroundings, around
        self._seen, self._like = seen, seen or like
        if self._like and self._like.solution.cover is not solution.cover:
            raise InputError.single(
                "like", got="another cover", expected="the same in another shape"
            )
        if self._like and self._like.surroundings != surroundings:
            raise InputError.single("surroundings", got=surroundings, expected="those of like")
        first = self._like.surface if self._like else None
        self.surface: Surface = drawn_surface(solution, around, like=first, built=built)
        if shading is not None:
            other = drawn_surface(shading, around, built=built)
            self.surface = self.surface.shaded_as(other)
        self._cache = Cache()

    # Maps need neither: they are made for the first picture.
    @functools.cached_property
    def _bvh(self) -> bvh.Bvh:
        vertices, faces = self.surface.mesh.vertices, self.surface.cover_mesh.faces
        if self._like:
            return bvh.moved(self._like._bvh, vertices, faces)
        return bvh.build(vertices, faces)

    @functools.cached_property
    def _indirect(self) -> IndirectLight:
        return IndirectLight(self.surface, self._bvh, self._cache)

    def render(
        self,
        appearance: Looks = None,
        *,
        rig: Rig,
        camera: Camera,
        quality: str | Quality = "standard",
        target_error: float | None = None,
    ) -> Image:
        """Draw the cover; see :func:`render`."""
        level = quality if isinstance(quality, Quality) else quality_named(quality)
        if target_error is not None:
            level = quality_within(target_error)
        look = look_of(self.solution.cover, appearance, self.thread, self._around)
        ids = self.faces(camera, level.factor)
        ev, white, card, lux = ev100(rig), white_of(rig), white_card(rig), lux_at_seat(rig)
        own, rig = len(rig.lights), with_windows(rig)
        visibility = self._visibility(rig, own, camera, level, ids)
        same = self._coherent(rig, camera, level, ids, visibility)
        radiance = np.empty((*camera.size[::-1], 3), dtype=np.float32)
        indirect = self._indirect.light(rig, look, level, camera, ids)
        brightest = shade.shade(
            stage.Stage(
                self.surface.mesh,
                eye_of(camera, level.factor),
                look,
                pack_lights(rig, level.factor),
                indirect,
            ),
            shade.Raster(ids, visibility, same, level.factor, level.relief),
            backdrop(self.surface, self._around, rig, ev, indirect),
            radiance,
        )
        _check(radiance, brightest, ids, visibility, camera)
        return Image(
            radiance=radiance,
            ev100=ev,
            lux=MappingProxyType(lux),
            white=white,
            card=card,
            camera=camera,
            cover=self._cover(camera, level.factor),
            alpha=self._alpha(ids, level.factor),
            surroundings=self.surroundings,
        )

    def _alpha(self, ids: npt.NDArray[np.int32], factor: int) -> npt.NDArray[np.float32] | None:
        """Share of each pixel that is not transparent, (h, w); None where all of it is."""
        if self._around is None or self._around.shown:
            return None
        share = np.empty((len(ids) // factor, ids.shape[1] // factor), dtype=np.float32)
        surface.covered(ids, len(self.surface.mesh.faces), (0, 0), factor, share)
        return share

    def _cover(self, camera: Camera, factor: int) -> npt.NDArray[np.float32]:
        """Share of each pixel that shows the cover, (h, w)."""

        def make() -> npt.NDArray[np.float32]:
            share = np.empty(camera.size[::-1], dtype=np.float32)
            around = (self.surface.faces, self.surface.fronts)
            surface.covered(self.faces(camera, factor), self.surface.opaque, around, factor, share)
            share.flags.writeable = False
            return share

        return np.asarray(self._cache(("cover", camera_key(camera), factor), make))

    def faces(self, camera: Camera, factor: int = 1) -> npt.NDArray[np.int32]:
        """Face of the drawn mesh seen by each sample, (h factor, w factor), -1 for none.

        Raises
        ------
        RenderError
            Nothing is in the picture.
        """
        if self._seen is not None:
            return self._seen.faces(camera, factor)
        key = ("faces", camera_key(camera), factor)
        return np.asarray(self._cache(key, lambda: self._draw(camera, factor)))

    def facing(self, camera: Camera, factor: int = 1) -> npt.NDArray[np.float32]:
        """Cosine of the normal to the view at each sample of :meth:`faces`; 1 where is none."""
        key = ("facing", camera_key(camera), factor)
        return np.asarray(self._cache(key, lambda: self._facing(camera, factor)))

    def _facing(self, camera: Camera, factor: int) -> npt.NDArray[np.float32]:
        ids = self.faces(camera, factor)
        cosine = np.ones(ids.shape, dtype=np.float32)
        surface.facing(self.surface.mesh, eye_of(camera, factor), ids, cosine)
        return cosine

    def _draw(self, camera: Camera, factor: int) -> npt.NDArray[np.int32]:
        """Draw the cover, then the foam where it sticks out, each part after part."""
        from seatlook.pbr._vtk import face_window, parts_of

        mesh, m, window = self.surface.mesh, self.surface.opaque, face_window()
        size = (camera.size[0] * factor, camera.size[1] * factor)
        ids = np.empty(size[::-1], dtype=np.int32)
        for part in parts_of(size):
            cover = window.faces(mesh.vertices, mesh.faces[:m], camera, size, part)
            ids[part.lines, part.columns] = cover
        for part in parts_of(size) if len(mesh.faces) > m else ():
            foam = window.faces(mesh.vertices, mesh.faces[m:], camera, size, part)
            eye = eye_of(camera, factor).part(*part[:2])
            self._stick_out(foam, ids[part.lines, part.columns], eye)
        seen = ids >= 0
        if self._around is not None and self.surface.ground is not None:
            first, floor = self.surface.faces, self.surface.ground.floor
            on_floor = (ids >= first) & (ids < first + floor)
            if not self._around.shown:
                ids[on_floor] = -1
            seen = seen & ~on_floor
        if not seen.any():
            raise RenderError(f"camera {camera.name}: nothing is in the picture")
        return ids

    def _stick_out(
        self, foam: npt.NDArray[np.int32], ids: npt.NDArray[np.int32], eye: surface.Eye
    ) -> None:
        """Let foam into ``ids`` where it lies before the cover."""
        foam = np.where(foam >= 0, foam + np.int32(self.surface.opaque), foam)
        cover_far, foam_far = np.empty(ids.shape), np.empty(ids.shape)
        front = surface.distances(self.surface.mesh, eye, ids, cover_far)
        surface.distances(self.surface.mesh, eye, foam, foam_far)
        pressed = np.where(front, _COMPRESSED, 0.0)
        np.copyto(ids, foam, where=foam_far < cover_far - pressed)

    def sky_share(self, quality: str = "standard") -> FloatArray:
        """Share (n,) of an even sky that reaches each vertex of the drawn surface."""
        return self._indirect.sky_share(quality_named(quality))

    def seen_from(
        self, points: FloatArray, normals: FloatArray, directions: FloatArray
    ) -> npt.NDArray[np.bool_]:
        """Whether points (k, 3) can be seen past the cover from one of ``directions`` (d, 3).

        A point is not seen from behind, by its normal (k, 3).
        """
        far = [Light(name="far", intensity=1.0, vector=d, near=False) for d in directions]
        out = np.empty((len(directions), len(points)))
        rays.lit(self._bvh, points, normals, pack_lights(Rig(name="far", lights=tuple(far))), out)
        return np.asarray(out.any(axis=0))

    def shadows(self, rig: Rig, camera: Camera, quality: str) -> npt.NDArray[np.uint8]:
        """Share of each light [1/255] seen by each sample of :meth:`faces`, (lights, h, w).

        Windows that a panorama's bright regions are taken for come after the rig's own lights.
        """
        level = quality_named(quality)
        ids = self.faces(camera, level.factor)
        return self._visibility(with_windows(rig), len(rig.lights), camera, level, ids)

    def _visibility(
        self, rig: Rig, own: int, camera: Camera, level: Quality, ids: npt.NDArray[np.int32]
    ) -> npt.NDArray[np.uint8]:
        """Share of each light [1/255] seen by each sample, of a rectangle its cells as bits.

        (lights, h, w). The first ``own`` are cached one by one, the windows of a panorama together.
        """

        def seen(first: int, last: int) -> npt.NDArray[np.uint8]:
            out = np.full((last - first, *ids.shape), 255, dtype=np.uint8)
            for k in range(first, last):
                self._shadow(rig, k, camera, level, ids, out[k - first])
            return out

        ends = [*range(own + 1), len(rig.lights)]
        stacks = [np.empty((0, *ids.shape), dtype=np.uint8)]
        for first, last in pairwise(ends):
            lights = tuple(_light_key(one) for one in rig.lights[first:last])
            key = ("shadow", camera_key(camera), level.factor, level.rays, lights)
            if lights:
                stacks.append(self._cache(key, functools.partial(seen, first, last)))
        return stacks[1] if len(stacks) == 2 else np.concatenate(stacks)

    def _coherent(
        self,
        rig: Rig,
        camera: Camera,
        level: Quality,
        ids: npt.NDArray[np.int32],
        visibility: npt.NDArray[np.uint8],
    ) -> npt.NDArray[np.bool_]:
        """Pixels whose 2 x 2 samples see the same, (h, w)."""

        def make() -> npt.NDArray[np.bool_]:
            same = np.zeros(camera.size[::-1], dtype=np.bool_)
            if level.factor == 2:
                eye, far = eye_of(camera, 2), stitch.reach(self.thread)
                coherent.find_coherent(self.surface.mesh, eye, ids, visibility, far, same)
            return same

        lights = tuple(_light_key(one) for one in rig.lights)
        key = ("coherent", camera_key(camera), level.factor, level.rays, lights)
        return np.asarray(self._cache(key, make))

    def _shadow(
        self,
        rig: Rig,
        k: int,
        camera: Camera,
        level: Quality,
        ids: npt.NDArray[np.int32],
        share: npt.NDArray[np.uint8],
    ) -> None:
        if level.rays == 0:
            return
        eye = eye_of(camera, level.factor)
        seen = (self._bvh, self.surface.mesh, eye, ids, pack_lights(rig), k, level.factor)
        if rig.lights[k].is_rectangle:
            area_shadow.cells_seen(*seen, share)
        else:
            shadow.shadows(*seen, level.rays, share)


def render(
    solution: Solution,
    appearance: Looks = None,
    *,
    rig: Rig,
    camera: Camera,
    quality: str | Quality = "standard",
    target_error: float | None = None,
    surroundings: str = "plain",
) -> Image:
    """Draw a solved cover under a rig.

    Parameters
    ----------
    appearance : None for the panels' own materials, one Appearance for all panels, or a mapping
        from panel name to Appearance; panels not named keep their own
    quality : ``draft`` (hard shadows, no smoothing), ``standard`` (2 x 2 samples, soft shadows,
        covered sky, one bounce) or ``high`` (4 x 4, three bounces); also ``T0`` to ``T4``, of
        which these are T1, T3 and T4, or a :class:`~seatlook.pbr.quality.Quality`
    target_error : instead of ``quality``: the cheapest tier whose charted FLIP against path
        tracing is at most this
    surroundings : around the seat: ``plain`` (nothing), ``sweep`` (a bright floor, a valance over
        the hem), ``cabin`` (the same, dark) or ``transparent`` (a floor that is not seen)

    Returns
    -------
    Image
        Radiance [cd/m2] and the rig's exposure, which does not depend on anything drawn.

    Raises
    ------
    NoOffscreenContext, RenderError, InputError

    Notes
    -----
    The studios of the two solutions drawn last are cached; make your own :class:`Studio` to decide.
    """
    return studio(solution, surroundings).render(
        appearance, rig=rig, camera=camera, quality=quality, target_error=target_error
    )


_studios: OrderedDict[tuple[int, str, bool], Studio] = OrderedDict()


def studio(solution: Solution, surroundings: str = "plain", *, built: bool = True) -> Studio:
    """Return the studio of a solution, making it where it is not among the last two."""
    key = (id(solution), surroundings, built)
    if key not in _studios:
        _studios[key] = Studio(solution, surroundings=surroundings, built=built)
        if len(_studios) > 2:
            _studios.popitem(last=False)
    _studios.move_to_end(key)
    return _studios[key]


def _check(
    radiance: np.ndarray,
    brightest: float,
    ids: np.ndarray,
    visibility: np.ndarray,
    camera: Camera,
) -> None:
    if not np.isfinite(brightest):
        raise RenderError(f"camera {camera.name}: the picture holds values that are not finite")
    if radiance.min() < 0:
        raise RenderError(f"camera {camera.name}: the picture holds values below 0")
    if brightest <= 0 and (visibility[:, ids >= 0] > 0).any():
        raise RenderError(f"camera {camera.name}: the picture is black though a light reaches it")


def _light_key(light: Light) -> Hashable:
    place = (light.near, light.vector.tobytes(), light.size)
    return (*place, light.sides.tobytes(), light.two_sided)
