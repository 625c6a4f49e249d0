"""Measured pictures of a surface, laid over pattern coordinates."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from seatlook.errors import InputError
from seatlook.model._check import positive

Pixels = npt.NDArray[np.uint8]

_CHANNELS = {"albedo": 3, "roughness": 1, "metalness": 1, "normal": 3}


# Compared by identity: two sets are told apart without looking at millions of pixels.
@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class TextureMaps:
    """Eight-bit maps of one piece of a surface, repeated over a panel; None where there is no map.

    First row at the top (large v), first column at the left (small u). Sizes may differ.

    Parameters
    ----------
    folder : str                     where they come from, as the material file has it
    width, height : float [m]        size of the piece on the panel as cut
    albedo : (h, w, 3) uint8         sRGB
    roughness, metalness : (h, w) uint8   from 0 to 255 as 0 to 1
    normal : (h, w, 3) uint8         (n + 1) / 2 with x along u, y along v, z towards the viewer
    """

    folder: str
    width: float
    height: float
    albedo: Pixels | None = None
    roughness: Pixels | None = None
    metalness: Pixels | None = None
    normal: Pixels | None = None

    def __post_init__(self) -> None:
        positive(self, "width", "height")
        if not self.given:
            raise InputError.single("TextureMaps", got="no map", expected="at least one")
        for name in self.given:
            pixels, channels = np.array(getattr(self, name)), _CHANNELS[name]
            shape = pixels.shape[:2] if channels == 1 else (*pixels.shape[:2], channels)
            if pixels.dtype != np.uint8 or pixels.shape != shape or 0 in shape or len(shape) < 2:
                expected = "(h, w)" if channels == 1 else f"(h, w, {channels})"
                raise InputError.single(
                    f"TextureMaps.{name}",
                    got=f"{pixels.dtype} {pixels.shape}",
                    expected=f"uint8 {expected}",
                )
            pixels.setflags(write=False)
            object.__setattr__(self, name, pixels)

    @property
    def given(self) -> tuple[str, ...]:
        """Names of the maps that there are."""
        return tuple(name for name in _CHANNELS if getattr(self, name) is not None)
