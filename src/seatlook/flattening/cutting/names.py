"""Names for panels, by a point inside each."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from seatlook.errors import InputError, Problem
from seatlook.flattening.surface import DesignSurface
from seatlook.mesh.closest import closest_places
from seatlook.model import FloatArray

_REACH = 0.010  # m from a point to the surface


def named(surface: DesignSurface, points: Mapping[str, FloatArray]) -> DesignSurface:
    """Name panels by a point (3,) [m] of each, at most 10 mm off the surface; others keep theirs.

    Raises
    ------
    InputError
        A point off the surface, two in one panel, a name that another panel has.
    """
    if not points:
        return surface
    places = np.array(list(points.values()))
    closest = closest_places(places, surface.vertices, surface.faces, reach=_REACH)
    names, problems = list(surface.panel_names), []
    given: dict[int, str] = {}
    for name, face in zip(points, closest.face.tolist(), strict=True):
        key = f"panel.{name}.point_mm"
        panel = -1 if face < 0 else int(surface.panel[face])
        if panel < 0:
            expected = f"a point at most {1e3 * _REACH:g} mm off the surface"
            problems.append(Problem(key=key, got="one farther away", expected=expected))
        elif panel in given:
            got = f"a point in the same panel as {given[panel]}"
            problems.append(Problem(key=key, got=got, expected="one name for a panel"))
        else:
            given[panel] = names[panel] = name
    twice = sorted({name for name in names if names.count(name) > 1})
    problems += [
        Problem(key=f"panel.{name}", got="a name that two panels have", expected="another one")
        for name in twice
    ]
    if problems:
        raise InputError(problems)
    return replace(surface, panel_names=tuple(names))
