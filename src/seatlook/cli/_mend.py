"""The command that makes a foam or a design surface of a file from another program or scanner."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import Parameter

from seatlook.cli._output import Json, note, table
from seatlook.io.surface.axes import Unit, Up

if TYPE_CHECKING:
    from seatlook.mesh.mending.mend import Mending


@Parameter(name="*")
@dataclass(frozen=True, kw_only=True)
class MendingOptions:
    """What is done to the surface of a foam on request.

    Parameters
    ----------
    close
        Fill the holes: small ones smoothly, wide openings flat.
    thicken_mm
        Give an open shell this thickness, below it.
    unite
        Make one foam of several bodies.
    body
        Keep one of several bodies, by its number; the largest is 1.
    smooth_mm
        Take waves shorter than this out of the surface, as the noise of a scan.
    """

    close: Annotated[bool, Parameter(negative=())] = False
    thicken_mm: float = 0.0
    unite: Annotated[bool, Parameter(negative=())] = False
    body: int | None = None
    smooth_mm: float = 0.0

    def choices(self) -> Mending:
        """Return them as the reader takes them."""
        from seatlook.mesh.mending.mend import Mending

        return Mending(
            close=self.close,
            thicken=self.thicken_mm / 1e3,
            unite=self.unite,
            body=self.body,
            smooth=self.smooth_mm / 1e3,
        )


def mend(
    surface: Annotated[Path, Parameter(help="Surface: OBJ, STL, PLY or glTF.")],
    /,
    *,
    out: Annotated[Path, Parameter(help="OBJ file to write, in mm with z up.")],
    unit: Unit | None = None,
    up: Up | None = None,
    mending: MendingOptions | None = None,
    sheet: Annotated[bool, Parameter(negative=())] = False,
    json: Json = False,
) -> None:
    """Make the closed surface of a foam of a file from any program or scanner, and report how.

    Always mended: faces drawn twice, slivers, cracks up to 0.3 mm, edges of more than two faces,
    loose specks, faces turned over. Holes and several bodies are mended on request.

    Example: seatlook mend scan.ply --out foam.obj --close --smooth-mm 15

    Example: seatlook mend shell.glb --out foam.obj --thicken-mm 40

    Parameters
    ----------
    unit
        Unit of the file; by its format and size if not given.
    up
        Vertical axis of the file; y in glTF, else z, if not given.
    sheet
        Make a design surface: its longest border stays open, its panels keep their names.
    """
    from seatlook import io

    choices = (mending or MendingOptions()).choices()
    mended = io.mend_file(surface, out, unit=unit, up=up, mending=choices, sheet=sheet)
    axes = mended.axes
    table(
        ("number", "what", "place"),
        [(row.number, row.what, axes.place(row.place)) for row in mended.mended],
        json=json,
    )
    kind = "design surface" if sheet else "foam"
    apart = any(row.what.endswith("parts that do not touch") for row in mended.mended)
    note(
        *(() if mended.mended else ("nothing to mend",)),
        f"read in {axes.unit} with {axes.up} up: {axes.size(mended.vertices)}",
        f"{kind} of {len(mended.faces)} triangles: {out}",
        *(["say unite = true in [foam] as well: its parts do not touch"] if apart else ()),
    )
