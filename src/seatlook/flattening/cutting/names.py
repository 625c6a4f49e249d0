"""Panels by a point inside each: what they are called, and which are none."""

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
    names = list(surface.panel_names)
    for name, panel in _panels_at(surface, points).items():
        names[panel] = name
    twice = sorted({name for name in names if names.count(name) > 1})
    if twice:
        raise InputError(
            Problem(key=f"panel.{name}", got="a name that two panels have", expected="another one")
            for name in twice
        )
    return replace(surface, panel_names=tuple(names))


def first_named(
    surface: DesignSurface, points: Mapping[str, FloatArray]
) -> tuple[DesignSurface, bool]:
    """Name panels that may yet be cut: each by the first point in it, and whether there are more.

    So both halves of a ring have its name. Points for each half count only when it is cut.

    Raises
    ------
    InputError
        A point off the surface.
    """
    first = {panel: name for name, panel in reversed(_panel_of(surface, points).items())}
    one_each = {name: points[name] for name in points if name in first.values()}
    return named(surface, one_each), len(one_each) < len(points)


def without(surface: DesignSurface, points: Mapping[str, FloatArray]) -> DesignSurface:
    """Leave out the panels in which points (3,) [m] lie; their borders become free.

    Raises
    ------
    InputError
        A point off the surface, two in one panel, no panel that is left.
    """
    if not points:
        return surface
    left_out = list(_panels_at(surface, points).values())
    rest = np.setdiff1d(np.arange(len(surface.panel_names)), left_out)
    if not len(rest):
        names = ", ".join(points)
        raise InputError.single("panel", got=f"only bare ones: {names}", expected="one to cover")
    covered = np.isin(surface.panel, rest)
    return replace(
        surface,
        faces=surface.faces[covered],
        panel=np.searchsorted(rest, surface.panel[covered]),
        panel_names=tuple(surface.panel_names[k] for k in rest),
    )


def _panels_at(surface: DesignSurface, points: Mapping[str, FloatArray]) -> dict[str, int]:
    """Name -> index of the panel in which the point of that name lies, each another one."""
    given: dict[int, str] = {}
    problems = []
    panels = _panel_of(surface, points)
    for name, panel in panels.items():
        if panel in given:
            got = f"a point in the same panel as {given[panel]}"
            key = f"panel.{name}.point_mm"
            problems.append(Problem(key=key, got=got, expected="one name for a panel"))
        given.setdefault(panel, name)
    if problems:
        raise InputError(problems)
    return panels


def _panel_of(surface: DesignSurface, points: Mapping[str, FloatArray]) -> dict[str, int]:
    """Name -> index of the panel in which the point of that name lies."""
    if not points:
        return {}
    places = np.array(list(points.values()))
    closest = closest_places(places, surface.vertices, surface.faces, reach=_REACH)
    problems = [
        Problem(
            key=f"panel.{name}.point_mm",
            got="one farther away",
            expected=f"a point at most {1e3 * _REACH:g} mm off the surface",
        )
        for name, face in zip(points, closest.face.tolist(), strict=True)
        if face < 0
    ]
    if problems:
        raise InputError(problems)
    return dict(zip(points, surface.panel[closest.face].tolist(), strict=True))
