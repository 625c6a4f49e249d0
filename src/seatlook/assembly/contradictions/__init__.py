"""Contradictions of a scene that show before it is solved: places that cannot be reached together.

Each has a name, by which ``[check] allow`` of the scene lets it pass.
"""

from seatlook.assembly.contradictions.contradiction import Contradiction
from seatlook.assembly.contradictions.find import contradictions, out_of_scale, refuse

__all__ = ["Contradiction", "contradictions", "out_of_scale", "refuse"]
