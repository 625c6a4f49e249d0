"""Poses for the panels of a scene that gives none."""

from __future__ import annotations

from dataclasses import replace
from types import MappingProxyType

from seatlook.assembly.unfolding import lay_out
from seatlook.model import Scene


def with_poses(scene: Scene) -> Scene:
    """Return the scene with a pose for every panel; those it states stay as they are.

    The others are laid out over the foam as ``seatlook init`` does: the largest panel on top, each
    next one turned about a seam and folded down until it nears the foam.

    Raises
    ------
    InputError
        A panel without a pose is sewn to no other.
    """
    missing = [p.name for p in scene.pattern.panels if p.name not in scene.placement]
    if not missing:
        return scene
    poses = lay_out(scene.pattern, scene.foam).poses
    own = {name: poses[name] for name in missing}
    return replace(scene, placement=MappingProxyType({**scene.placement, **own}))
