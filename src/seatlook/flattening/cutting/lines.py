"""A design surface cut into panels along seam lines that are drawn onto it."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType

from seatlook.flattening.cutting.names import first_named, named, without
from seatlook.flattening.cutting.opening import opened
from seatlook.flattening.cutting.parts import parted
from seatlook.flattening.surface import DesignSurface
from seatlook.mesh.imprint import imprint
from seatlook.mesh.line_ends import lay_on
from seatlook.model import FloatArray

LINE_TOLERANCE = 0.002  # [m] between a seam line and the surface, the border, another line


def cut_along(
    surface: DesignSurface,
    lines: Mapping[str, FloatArray],
    *,
    bare: Mapping[str, FloatArray] = MappingProxyType({}),
    names: Mapping[str, FloatArray] = MappingProxyType({}),
) -> DesignSurface:
    """Cut a surface into panels along lines; where its panels met before does not matter.

    A panel is called after the panel of the surface given that most of it was; several of one name
    are numbered from front to rear, then from the occupant's right to the left. A line that ends
    inside a panel is a dart. Panels that are rings are opened; see ``opened``.

    Parameters
    ----------
    surface : DesignSurface
    lines : name -> (k, 3) [m]   closer than ``LINE_TOLERANCE`` to the surface; each ends on the
                                 border, on another line, or as a dart, or is closed
    bare : name -> point (3,) [m] inside a panel that is left out
    names : name -> point (3,) [m] inside the panel that is called so; a ring that is opened into
        two panels gives its name to both, numbered, unless each has a point of its own

    Returns
    -------
    DesignSurface
        Its seams have the names of the lines.

    Raises
    ------
    InputError
        A line lies off the surface, leaves it, or lies inside a panel with both ends; a panel has
        less than 1 cm2; a point for a name lies off the surface, or in a panel that has one.
    """
    laid = lay_on(surface.vertices, surface.faces, lines, tolerance=LINE_TOLERANCE)
    drawing = imprint(surface.vertices, surface.faces, laid)
    drawn = DesignSurface(
        vertices=drawing.vertices,
        faces=drawing.faces,
        panel=surface.panel[drawing.source],
        panel_names=surface.panel_names,
        seam_lines=MappingProxyType(drawing.edges),
    )
    covered, more = first_named(without(parted(drawn, rejoined=True), bare), names)
    cut = opened(covered)
    cut.patches()  # refuses panels that are no disk
    return named(cut, names) if more else cut
