"""Maps, pictures and files of one state of a finite-element result."""

from __future__ import annotations

from dataclasses import fields
from pathlib import Path

from seatlook import io, pbr
from seatlook.evaluation import Progress, draw_maps
from seatlook.model import Shells, WrinkleMap
from seatlook.study.findings import Findings, draw_findings, find, write_findings
from seatlook.study.framing import fitted_view, side_light
from seatlook.study.shell_cover import ShellCover
from seatlook.wrinkle.shells import ShellWrinkles


def draw_state(
    shells: Shells,
    wrinkles: ShellWrinkles,
    cover: ShellCover,
    out: Path,
    *,
    top: float,
    say: Progress,
    size: tuple[int, int] = (1280, 720),
) -> Findings:
    """Draw maps and a picture of one state into a folder, with its worst wrinkles and tables.

    Leaves ``maps/``, ``picture.png``, ``worst.csv``, ``sections.csv``, ``elements.csv`` (shell
    numbers and indices) and ``result.npz``, which "seatlook render" and "score" take. Distortion
    is left out where a part has no flat undeformed state.

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
    io.write_result(solution, out / "result.npz")
    write_elements(shells, wrinkles, out / "elements.csv")
    draw_maps(solution, indices, camera, out, say, top=top)
    found = find(solution, indices)
    write_findings(found, out, distortion=not cover.projected)
    if not cover.projected:
        draw_findings(found, solution, camera, out, say)
    say("render")
    picture = pbr.render(solution, None, rig=side_light(solution), camera=camera)
    picture.save(out / "picture.png")
    return found


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
    io.write_table(path, heads, zip(*(column.tolist() for column in columns), strict=True))
