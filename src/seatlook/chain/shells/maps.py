"""Maps, pictures and files of one state of a finite-element result."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from seatlook import io, pbr
from seatlook.chain.assess import Assessment, assess
from seatlook.chain.draw import Canvas, Drawn, draw_distortion, draw_maps
from seatlook.chain.files import write_findings
from seatlook.chain.framing import fitted_view, side_light
from seatlook.chain.shells.states import ShellCriteria, ShellWrinkles
from seatlook.model import Camera, Criteria, Rig, Shells, Strains
from seatlook.model.progress import Progress
from seatlook.shells.cover import ShellCover

PICTURE, ELEMENTS = "picture.png", "elements.csv"
# From this many triangles the sky and the light between shells are left out of the picture: they
# are gathered at every vertex, and would take longer than all the rest.
_MANY = 200_000


@dataclass(frozen=True, slots=True, kw_only=True)
class DrawnState:
    """What was drawn of one state, for its page; paths are relative to ``folder``.

    Parameters
    ----------
    maps, distortion : no distortion without a flat undeformed state
    files : tables
    quality : tier of the picture
    """

    folder: Path
    cover: ShellCover
    assessment: Assessment
    camera: Camera
    rig: Rig
    maps: tuple[Drawn, ...]
    distortion: tuple[Drawn, ...]
    files: tuple[str, ...]
    quality: str


def assess_shells(
    cover: ShellCover, wrinkles: ShellWrinkles, criteria: ShellCriteria
) -> Assessment:
    """Assess a state on the faces of its cover, each with the strains of its shell."""
    of_shells, row = wrinkles.strains, cover.element
    strains = Strains(
        top=of_shells.top[row],
        mid=of_shells.mid[row],
        bottom=of_shells.bottom[row],
        thickness=of_shells.thickness[row],
        panel=of_shells.panel[row],
    )
    chosen = Criteria(curvature=criteria.curvature, thresholds=(criteria.threshold,))
    return assess(cover.solution, chosen, strains=strains)


def draw_state(
    shells: Shells,
    wrinkles: ShellWrinkles,
    cover: ShellCover,
    assessment: Assessment,
    out: Path,
    *,
    top: float,
    progress: Progress,
) -> DrawnState:
    """Draw maps and a picture of one state into a folder, with its worst wrinkles and tables.

    Leaves ``maps/``, ``picture.png``, ``worst.csv``, ``sections.csv``, and ``elements.csv`` with
    shell numbers and indices. Distortion is left out where a part has no flat undeformed state.

    Parameters
    ----------
    cover, assessment : of the same state, from ``shell_cover`` and ``assess_shells``
    top : upper end of the range of W2, the same for all states

    Raises
    ------
    NoOffscreenContext, RenderError
    """
    pbr.offscreen_backend()
    solution = cover.solution
    canvas = Canvas(solution=solution, camera=fitted_view(solution), out=out)
    maps = draw_maps(assessment, canvas, progress, top=top, whole_shape=False)
    write_elements(shells, wrinkles, out / ELEMENTS)
    files = write_findings(assessment, out, distortion=not cover.projected)
    distortion = () if cover.projected else draw_distortion(assessment, canvas, progress)
    progress("render")
    rig = side_light(solution)
    quality = "T3" if len(solution.cover.faces) < _MANY else "T2"
    pbr.render(solution, None, rig=rig, camera=canvas.camera, quality=quality).save(out / PICTURE)
    return DrawnState(
        folder=out, cover=cover, assessment=assessment, camera=canvas.camera, rig=rig, maps=maps,
        distortion=distortion, files=(ELEMENTS, *files), quality=quality,
    )  # fmt: skip


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
