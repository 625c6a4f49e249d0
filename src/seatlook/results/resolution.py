"""Whether a mesh is fine enough for the wrinkles of its fabrics on their foam."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from seatlook.model import Cover
from seatlook.solver import foam_wavelength

Level = Literal["not resolved", "shape only", "resolved"]
SHAPE, INDICES = 8.0, 12.0  # elements per wave from which the shape, and the indices, are resolved


@dataclass(frozen=True, slots=True, kw_only=True)
class Resolution:
    """One material of a cover: its shortest wrinkle and the elements.

    Parameters
    ----------
    wavelength, element_size : float [m]
    """

    material: str
    wavelength: float
    element_size: float

    @property
    def per_wave(self) -> float:
        """Elements per wave, lambda / h."""
        return self.wavelength / self.element_size

    @property
    def level(self) -> Level:
        """What the mesh resolves of this wave."""
        if self.per_wave < SHAPE:
            return "not resolved"
        return "shape only" if self.per_wave < INDICES else "resolved"


def resolutions(cover: Cover) -> tuple[Resolution, ...]:
    """One for each material of a cover on foam; none without foam."""
    if cover.foam is None:
        return ()
    waves = {m.name: foam_wavelength(m.fabric, cover.foam.material) for m in cover.materials}
    return tuple(
        Resolution(material=name, wavelength=wave, element_size=cover.element_size)
        for name, wave in waves.items()
    )
