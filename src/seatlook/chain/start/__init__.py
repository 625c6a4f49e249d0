"""First scenes: of a design surface that is flattened, and of a pattern of one's own."""

from seatlook.chain.start.pattern import init
from seatlook.chain.start.surface import flatten_scene, scene_from

__all__ = ["flatten_scene", "init", "scene_from"]
