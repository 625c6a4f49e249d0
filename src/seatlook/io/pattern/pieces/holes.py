"""Cut-outs of a piece: closed lines inside its outline; millimetres."""

from __future__ import annotations

from collections.abc import Sequence

import shapely

from seatlook.errors import InputError
from seatlook.io.pattern.drawing.layers import BOUNDARY, CUT_OUT
from seatlook.io.pattern.pieces.join import GAP_MM, Chain
from seatlook.io.pattern.pieces.outline import closed_outline
from seatlook.io.pattern.pieces.sewline import parallel_inside
from seatlook.model import FloatArray


def cut_outs(
    name: str,
    outline: FloatArray,
    inner: Sequence[Chain],
    drawn: Sequence[Chain],
    smallest: float,
    notes: list[str],
) -> list[FloatArray]:
    """Return the cut-outs (k, 2) of a piece, counter-clockwise.

    Parameters
    ----------
    outline : (n, 2)         what the piece is sewn along
    inner : closed lines of the boundary layer inside the outline
    drawn : lines of the layer of cut-outs
    smallest : across; what is narrower is closed, as a notch is

    Raises
    ------
    InputError
        A cut-out that is open, or crosses itself, the outline or another one.
    """
    holes: list[FloatArray] = []
    small = 0
    for layer, chains in ((BOUNDARY, inner), (CUT_OUT, drawn)):
        for chain in chains:
            hole = closed_outline([chain], key=f"piece {name}, layer {layer}").points
            area = shapely.Polygon(hole)
            if any(_same(area, shapely.Polygon(other)) for other in holes):
                continue
            if 2.0 * shapely.maximum_inscribed_circle(area).length < smallest:
                small += 1
            else:
                holes.append(hole)
    if small:
        notes.append(f"piece {name}: {small} cut-outs narrower than {smallest:g} mm are closed")
    whole = shapely.Polygon(outline, holes)
    if holes and not whole.is_valid:
        reason = shapely.is_valid_reason(whole)
        raise InputError.single(
            f"piece {name}, layer {CUT_OUT}",
            got=f"a cut-out that crosses an outline: {reason} mm",
            expected="cut-outs inside the sew line and apart from each other",
        )
    return holes


def take_sew_lines(
    outline: FloatArray | None, groups: Sequence[list[Chain]], sew: Sequence[Chain]
) -> list[Chain]:
    """Put in the place of cut-outs the sew lines that run round them; return the other sew lines.

    Parameters
    ----------
    outline : (n, 2) of the boundary, where it is one line
    groups : cut-outs as drawn; one may be in several groups
    """
    rest = []
    for line in sew:
        count = 0
        for group in groups:
            for k, chain in enumerate(group):
                if _runs_round(line, chain, outline):
                    group[k] = line
                    count += 1
        if not count:
            rest.append(line)
    return rest


def _runs_round(line: Chain, cut_out: Chain, outline: FloatArray | None) -> bool:
    """Whether a line is parallel to a cut-out round it, and closer to it than to the outline."""
    if not line.closed or parallel_inside(line.points, [cut_out]) is None:
        return False
    ring = shapely.LinearRing(line.points)
    inner = ring.hausdorff_distance(shapely.LinearRing(cut_out.points))
    return outline is None or bool(inner < ring.hausdorff_distance(shapely.LinearRing(outline)))


def _same(one: shapely.Polygon, other: shapely.Polygon) -> bool:
    """Whether two outlines are one, drawn on two layers."""
    return bool(one.exterior.hausdorff_distance(other.exterior) < GAP_MM)
