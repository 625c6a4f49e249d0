"""The gallery page of one state of a finite-element result."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any

from seatlook._version import __version__
from seatlook.chain.shells.maps import PICTURE, DrawnState
from seatlook.model.table import Table
from seatlook.report.page.data import PageData
from seatlook.report.page.types import CloseUp, WrinkleSection
from seatlook.report.page.write import write_page
from seatlook.report.sections.in_short import state_lines
from seatlook.report.sections.maps import map_view
from seatlook.report.sections.rigs import rig_head
from seatlook.report.sections.wrinkles import section_of

# key of a part's figures -> head of its column
_COLUMNS: MappingProxyType[str, str] = MappingProxyType(
    {
        "c": "C mean [1/mm]",
        "w1": "W1 mean",
        "w2": "W2 mean",
        "w2_p95": "W2 95 %",
        "w2_area_share": "W2 above 1 [share of area]",
        "w_stretch": "W_stretch mean",
        "w_compression": "W_compression mean",
        "area_mm2": "area [mm2]",
        "h_mm": "h [mm]",
    }
)


def write_shell_page(
    drawn: DrawnState,
    figures: dict[str, Any],
    *,
    title: str,
    asked: dict[str, str],
    notes: Sequence[str] = (),
) -> Path:
    """Write ``index.html`` beside the pictures of a state and return its path.

    Parameters
    ----------
    figures : of the state, from ``seatlook.chain.shells.states.state_figures``
    asked : what was asked for -> its value, such as curvature mode and threshold
    notes : what the reader of the file said
    """
    look = drawn.cover.solution.cover.materials[0].name
    rig = rig_head(drawn.rig)
    heads = ("key", "value", "source")
    parameters = Table(heads=heads, rows=tuple((k, v, None) for k, v in asked.items()))
    wrinkles = section_of(
        drawn.assessment,
        drawn.camera,
        maps=tuple(map(map_view, drawn.distortion)),
        files=drawn.files,
        distortion=not drawn.cover.projected,
    )
    data = PageData(
        title=title,
        summary=state_lines(drawn.assessment, asked, str(figures["source"])),
        close_up=_close_up(wrinkles),
        spots=wrinkles.spots,
        camera=drawn.camera.name,
        size=drawn.camera.size,
        pixels_per_degree=drawn.camera.pixels_per_degree,
        textures=(look,),
        rigs=(rig,),
        pictures=MappingProxyType({(look, rig.name): PICTURE}),
        maps=tuple(map(map_view, drawn.maps)),
        zones=_parts(figures),
        wrinkles=wrinkles,
        parameters=MappingProxyType({"evaluation": parameters}),
        provenance=_provenance(drawn, figures),
        status="the shape is that of another calculation",
        verdict="another program",
        warnings=(*notes, *_projected(drawn)),
        files=drawn.files,
    )
    return write_page(data, drawn.folder)


def _provenance(drawn: DrawnState, figures: dict[str, Any]) -> MappingProxyType[str, str]:
    return MappingProxyType(
        {
            "seatlook": __version__,
            "time": f"{figures['time']:g}",
            "curvature from": figures["source"],
            "shells turned over": str(figures["shells_turned"]),
            "shells deleted": str(figures["shells_deleted"]),
            "tier of the picture": drawn.quality,
        }
    )


def _close_up(wrinkles: WrinkleSection) -> CloseUp:
    """The worst wrinkle in view, or the whole picture."""
    for spot in wrinkles.spots[:1]:
        return CloseUp(image=PICTURE, caption=spot.label, at=(spot.x, spot.y))
    return CloseUp(image=PICTURE, caption="the shells")


def _parts(figures: dict[str, Any]) -> Table:
    """One row per part of a state."""
    return Table(
        heads=("part", *_COLUMNS.values()),
        rows=tuple(
            (f"{p['part']} {p['name']}".strip(), *(p[key] for key in _COLUMNS))
            for p in figures["parts"]
        ),
    )


def _projected(drawn: DrawnState) -> Iterator[str]:
    if drawn.cover.projected:
        yield (
            f"No flat undeformed state: {', '.join(drawn.cover.projected)}. Textures are laid on "
            "along the world's axes, and the distortion of the texture is not known."
        )
