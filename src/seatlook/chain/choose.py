"""Textures, rigs and views of a scene, by their names or as objects."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import replace
from types import MappingProxyType
from typing import TypeVar

from seatlook import io
from seatlook.errors import InputError, did_you_mean
from seatlook.model import VIEWS, Appearance, Camera, Material, Rig, Scene, framed_view

_Named = TypeVar("_Named")
Look = str | Appearance | Material | None


def look_of(scene: Scene, texture: Look) -> Appearance | None:
    """Appearance of a texture of the scene, of a supplied material or of an object.

    Raises
    ------
    InputError
        A name that is neither, with the nearest one.
    """
    if isinstance(texture, Material):
        return texture.appearance
    if texture is None or isinstance(texture, Appearance):
        return texture
    if texture in scene.textures:
        return scene.textures[texture]
    supplied = io.list_materials()
    if texture in supplied:
        return io.read_material(texture).appearance
    raise _unknown("texture", texture, (*scene.textures, *supplied))


def rig_of(scene: Scene, rig: str | Rig | None) -> Rig:
    """A rig of the scene by its name, or the first, or the object itself.

    Raises
    ------
    InputError
        A name that the scene does not have, with the nearest one.
    """
    if isinstance(rig, Rig):
        return rig
    return _chosen("rig", rig, {r.name: r for r in scene.rigs})


def camera_of(scene: Scene, camera: str | Camera | None) -> Camera:
    """A view of the scene or a named view of its foam, or the first, or the object itself.

    Raises
    ------
    InputError
        A name that is neither, with the nearest one.
    """
    if isinstance(camera, Camera):
        return camera
    own = {c.name: c for c in scene.cameras}
    if camera in own or camera is None:
        return _chosen("view", camera, own)
    if camera in VIEWS:
        return framed_view(camera, scene.foam.vertices)
    raise _unknown("view", camera, (*own, *VIEWS))


def narrowed(scene: Scene, textures: Iterable[str] = (), rigs: Iterable[str] = ()) -> Scene:
    """The scene with some of its textures and rigs; all where none is named.

    Raises
    ------
    InputError
        A name that the scene does not have, with the nearest one.
    """
    looks = _several("texture", tuple(textures), scene.textures)
    lights = _several("rig", tuple(rigs), {rig.name: rig for rig in scene.rigs})
    return replace(scene, rigs=tuple(lights.values()), textures=MappingProxyType(looks))


def _chosen(what: str, name: str | None, known: Mapping[str, _Named]) -> _Named:
    """Return what has a name; the first where none is given."""
    chosen = next(iter(known), None) if name is None else name
    if chosen is None or chosen not in known:
        raise _unknown(what, name, known)
    return known[chosen]


def _several(what: str, names: tuple[str, ...], known: Mapping[str, _Named]) -> dict[str, _Named]:
    """Return what has these names; all where none is given."""
    for name in names:
        if name not in known:
            raise _unknown(what, name, known)
    return {name: known[name] for name in names or known}


def _unknown(what: str, name: str | None, known: Iterable[str]) -> InputError:
    names = tuple(known)
    return InputError.single(
        what,
        got="none" if name is None else repr(name),
        expected=f"one of {', '.join(names)}" if names else "one in the scene",
        hint=did_you_mean(name or "", names),
    )
