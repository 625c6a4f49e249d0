"""Element sizes that a tolerance asks for, and what it takes."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import shapely

from seatlook.assembly import with_mesh
from seatlook.chain.companions import APART
from seatlook.errors import InputError
from seatlook.model import Scene
from seatlook.model.scene import FIRST_SIZE, TOLERANCES
from seatlook.results.resolution import CURVATURE_ERROR
from seatlook.solver import foam_wavelength

_TWICE = 2.0  # as large are the elements of the mesh before
_COARSEST = 0.014  # m; the shape of a seat needs no finer
_SECONDS, _MANY = 1e-3, 4000.0  # CPU seconds for a vertex on meshes of so many, and
_SLOWER = 0.3  # the power of their number by which it takes longer: docs/charts/tolerance.csv


def finest_size(scene: Scene) -> float:
    """Element size [m] where a cover wrinkles that is to keep the scene's tolerance.

    Never so large that no coarser mesh could tell its error.
    """
    return _wavelength(scene) * math.sqrt(sizing(scene) / CURVATURE_ERROR)


def coarsest_size(scene: Scene) -> float:
    """Element size [m] where nothing wrinkles, and of the first mesh."""
    return float(np.clip(_TWICE * finest_size(scene), FIRST_SIZE, _COARSEST))


@dataclass(frozen=True, slots=True, kw_only=True)
class Forecast:
    """What a tolerance takes, before it is known how much of the cover wrinkles.

    Parameters
    ----------
    tolerance : float [1]
    finest, coarsest : float [m]     element size where it wrinkles, and where it does not
    vertices : of the last mesh if nothing wrinkles, and if everything does
    cpu_seconds : likewise, of all meshes, as an estimate
    """

    tolerance: float
    finest: float
    coarsest: float
    vertices: tuple[int, int]
    cpu_seconds: tuple[float, float]

    @property
    def sentence(self) -> str:
        """What is to be expected, in words."""
        fewest, most = self.vertices
        least, longest = self.cpu_seconds
        return (
            f"for {100 * self.tolerance:g} %: elements of {1e3 * self.finest:.2g} mm where it "
            f"wrinkles, {1e3 * self.coarsest:.2g} mm elsewhere; {fewest:,} to {most:,} vertices, "
            f"about {least:.0f} to {longest:.0f} CPU seconds, as much of it wrinkles"
        )


def forecast(scene: Scene) -> Forecast:
    """Say what a scene's tolerance takes, from its area and wavelength alone.

    Raises
    ------
    InputError   the scene names no tolerance
    """
    area = sum(shapely.Polygon(panel.outline).area for panel in scene.pattern.panels)
    finest, coarsest = finest_size(scene), coarsest_size(scene)
    sizes = coarsest, min(finest, coarsest)
    fewest, most = (round(area / (size**2 * math.sqrt(0.75))) for size in sizes)
    first, all_fine = (n * _SECONDS * (n / _MANY) ** _SLOWER for n in (fewest, most))
    return Forecast(
        tolerance=asked(scene),
        finest=sizes[1],
        coarsest=coarsest,
        vertices=(fewest, most),
        cpu_seconds=(first + 0.5 * first, first + all_fine),
    )


def coarser(scene: Scene) -> Scene:
    """The scene of the mesh before: of one size, or of four times the tolerance."""
    first, looser = coarsest_size(scene), _TWICE**2 * asked(scene)
    if _TWICE * APART * finest_size(scene) < first and looser <= TOLERANCES[1]:
        return with_mesh(scene, tolerance=looser)
    return with_mesh(scene, element_size=first)


def _wavelength(scene: Scene) -> float:
    return min(foam_wavelength(m.fabric, scene.foam.material) for m in scene.materials.values())


def sizing(scene: Scene) -> float:
    """Tolerance that sizes a mesh: the scene's, or that of half the coarsest elements."""
    coarse = CURVATURE_ERROR * (_COARSEST / _TWICE / _wavelength(scene)) ** 2
    return min(asked(scene), coarse)


def asked(scene: Scene) -> float:
    """Tolerance [1] of a scene.

    Raises
    ------
    InputError   it names none
    """
    if scene.tolerance is None:
        raise InputError.single(
            "tolerance", got="nothing", expected="a share of the zone means", file=scene.path
        )
    return scene.tolerance
