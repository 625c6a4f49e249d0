"""Maps, pictures and files of one state of a finite-element result."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING

from seatlook import io, pbr
from seatlook.chain.evaluation import draw_maps
from seatlook.chain.findings import Findings, draw_findings, find, write_findings
from seatlook.chain.framing import fitted_view, side_light
from seatlook.model import Camera, Rig, Shells, WrinkleMap
from seatlook.model.progress import Progress
from seatlook.shells.cover import ShellCover
from seatlook.shells.strains import ShellWrinkles

if TYPE_CHECKING:
    from seatlook.pbr import Picture

PICTURE = "picture.png"
# From this many triangles the sky and the light between shells are left out of the picture: they
# are gathered at every vertex, and would take longer than all the rest.
_MANY = 200_000


@dataclass(frozen=True, slots=True, kw_only=True)
class DrawnState:
    """What was drawn of one state, for its page; paths are relative to ``folder``.

    Parameters
    ----------
    maps, distortion : name -> path and picture; no distortion without a flat undeformed state
    files : tables
    quality : tier of the picture
    """

    folder: Path
    cover: ShellCover
    findings: Findings
    camera: Camera
    rig: Rig
    maps: MappingProxyType[str, tuple[str, Picture]]
    distortion: MappingProxyType[str, tuple[str, Picture]] = field(
        default_factory=lambda: MappingProxyType({})
    )
    files: tuple[str, ...]
    quality: str


def draw_state(
    shells: Shells,
    wrinkles: ShellWrinkles,
    cover: ShellCover,
    out: Path,
    *,
    top: float,
    say: Progress,
    size: tuple[int, int] = (1280, 720),
) -> DrawnState:
    """Draw maps and a picture of one state into a folder, with its worst wrinkles and tables.

    Leaves ``maps/``, ``picture.png``, ``worst.csv``, ``sections.csv``, and ``elements.csv`` with
    shell numbers and indices. Distortion is left out where a part has no flat undeformed state.

    Parameters
    ----------
    cover : of the same state, from ``shell_cover``
    top : upper end of the range of W2, the same for all states

    Raises
    ------
    NoOffscreenContext, RenderError
    """
    pbr.offscreen_backend()
    solution = cover.solution
    indices = on_faces(wrinkles.indices, cover)
    camera = fitted_view(solution, size=size)
    maps = draw_maps(solution, indices, camera, out, say, top=top)
    write_elements(shells, wrinkles, out / "elements.csv")
    found = find(solution, indices)
    files = write_findings(found, out, distortion=not cover.projected)
    shown: MappingProxyType[str, tuple[str, Picture]] = MappingProxyType({})
    if not cover.projected:
        shown = draw_findings(found, solution, camera, out, say)
    say("render")
    rig = side_light(solution)
    quality = "T3" if len(solution.cover.faces) < _MANY else "T2"
    pbr.render(solution, None, rig=rig, camera=camera, quality=quality).save(out / PICTURE)
    return DrawnState(
        folder=out, cover=cover, findings=found, camera=camera, rig=rig, maps=maps,
        distortion=shown, files=("elements.csv", *files), quality=quality,
    )  # fmt: skip


def on_faces(indices: WrinkleMap, cover: ShellCover) -> WrinkleMap:
    """Give each triangle the indices of its shell."""
    return WrinkleMap(**{f.name: getattr(indices, f.name)[cover.element] for f in fields(indices)})


def write_elements(shells: Shells, wrinkles: ShellWrinkles, path: Path) -> None:
    """Write the indices of every shell under the number that its file gives it."""
    w, k = wrinkles.indices, wrinkles.element
    columns = (
        shells.element_ids[k], shells.part[k], 1e6 * wrinkles.area, 1e-3 * w.c, w.w1, w.w2,
        w.r_stretch, w.w_stretch, w.w_compression,
    )  # fmt: skip
    heads = (
        "shell", "part", "area_mm2", "c_per_mm", "w1", "w2", "r_stretch", "w_stretch",
        "w_compression",
    )  # fmt: skip
    io.write_numbers(path, heads, columns)
