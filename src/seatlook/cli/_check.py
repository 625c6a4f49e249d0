"""The command that tries all that can be tried before the solve."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from seatlook.cli._options import (
    Changes,
    ElementSize,
    SceneFile,
    Seed,
    TolerancePercent,
    note_coarse,
    seat_of,
)
from seatlook.cli._output import Json, note, say, table
from seatlook.errors import InputError, RenderError

if TYPE_CHECKING:
    from collections.abc import Sequence

    from seatlook.assembly.ease import SeamEase
    from seatlook.assembly.start_lines import StartLine
    from seatlook.model import Cover
    from seatlook.results.resolution import Waves
    from seatlook.seat import Seat


def check(
    scene: SceneFile,
    /,
    *,
    seed: Seed = None,
    element_size_mm: ElementSize = None,
    tolerance_percent: TolerancePercent = None,
    changes: Changes = (),
    json: Json = False,
) -> None:
    """Read a scene with all its files, mesh it, and say what would be solved; solve nothing.

    Also says what is read of the pattern file, and what is not, with the reason.

    Draws the cover as it starts into check/assembly.png beside the scene: panels over foam, seams
    by number with their gaps, hooks and frames, and whatever is refused. Says which material will
    not be resolved, because its wrinkles are shorter than eight elements.

    Example: seatlook check seat.toml
    """
    from seatlook.assembly.ease import seam_ease
    from seatlook.assembly.start_lines import start_lines
    from seatlook.results.resolution import expected_waves

    seat = seat_of(scene, seed, element_size_mm, changes, tolerance_percent)
    drawing = _drawing(seat, scene.parent / "check" / "assembly.png")
    cover, pattern = seat.check(), seat.scene.pattern
    read = _pattern_lines(scene, changes)
    waves = expected_waves(cover)
    lines = start_lines(seat.scene, cover)
    sewn = {line.name: line for line in lines if line.kind == "seam"}
    eases = [seam_ease(pattern, seam) for seam in pattern.seams]
    eases.sort(key=lambda ease: -abs(ease.share))
    seams = [_seam_row(ease, sewn[ease.name]) for ease in eases]
    held = [_line_row(line) for line in lines if line.kind != "seam"]
    table(
        ("what", "value"),
        [
            ("scene", seat.scene.name),
            *_mesh_figures(cover, waves, seat),
            ("drawing", None if drawing is None else str(drawing)),
            *([("ease", seams), ("held", held), ("pattern", read)] if json else ()),
            *([("waves", list(map(_wave_row, waves)))] if json else ()),
        ],
        json=json,
    )
    for rows in (seams, held):
        if rows and not json:
            table(tuple(rows[0]), [tuple(map(_short, row.values())) for row in rows], json=False)
    note_coarse(seat)
    note(f"nothing wrong; to solve and draw it: seatlook evaluate {scene} --out FOLDER")


def _mesh_figures(cover: Cover, waves: Sequence[Waves], seat: Seat) -> list[tuple[str, Any]]:
    """What there is to solve, and whether its mesh will carry it."""
    from seatlook.chain.local import forecast

    asked: list[tuple[str, Any]] = []
    if seat.scene.tolerance is not None:
        expected = forecast(seat.scene)
        asked = [
            ("tolerance_percent", 100 * expected.tolerance),
            ("finest_element_mm", 1e3 * expected.finest),
            ("coarsest_element_mm", 1e3 * expected.coarsest),
            ("vertices_at_most", expected.vertices[1]),
            ("cpu_seconds_at_most", expected.cpu_seconds[1]),
        ]
    finest = min(waves, key=lambda wave: wave.wavelength)
    resolved = bool(asked) or all(wave.resolved for wave in waves)
    return [
        ("panels", len(cover.panel_names)),
        ("seams", len(cover.stitchings)),
        ("hooks_and_frames", len(cover.anchors)),
        ("vertices", len(cover.rest)),
        ("triangles", len(cover.faces)),
        ("criterion", seat.criteria.words()),
        ("element_size_mm", 1e3 * cover.element_size),
        ("wavelength_mm", 1e3 * finest.wavelength),
        ("wavelength_over_element_size", finest.wavelength / cover.element_size),
        ("expected_status", "resolved" if resolved else "converged, not resolved"),
        *asked,
    ]


def _pattern_lines(scene: Path, changes: tuple[str, ...]) -> list[str]:
    """Say what is read of the pattern file, and what is not."""
    from seatlook import io

    report = io.report_pattern(scene, changes=changes)
    lines = [] if report is None else report.lines()
    note(*lines)
    return lines


def _wave_row(wave: Waves) -> dict[str, Any]:
    """Figures of the elements of one material."""
    return {
        "material": wave.material,
        "panels": list(wave.panels),
        "wavelength_mm": 1e3 * wave.wavelength,
        "element_size_mm": 1e3 * wave.element_size,
        "wavelength_over_element_size": wave.per_wave,
        "resolved": wave.resolved,
    }


def _drawing(seat: Seat, path: Path) -> Path | None:
    """Draw the cover as it starts and say where; nothing else depends on it."""
    _ = seat.cover  # what cannot be meshed is the scene's fault, not the drawing's
    try:
        seat.draw_assembly(path)
    except (InputError, RenderError) as error:
        say(f"not drawn: {str(error).splitlines()[0]}")
        return None
    note(f"drawing of the start: {path}")
    return path


def _short(value: Any) -> Any:
    """A figure of a seam for a reader: to a hundredth of a millimetre or percent."""
    return f"{round(value, 2) + 0.0:.2f}" if isinstance(value, float) else value


def _seam_row(ease: SeamEase, line: StartLine) -> dict[str, Any]:
    """Figures of one seam; "matched" is whether both sides have as many notches."""
    return {
        "number": line.number,
        "seam": ease.name,
        "gap_mm": 1e3 * line.gap,
        "length_a_mm": 1e3 * ease.length_a,
        "length_b_mm": 1e3 * ease.length_b,
        "ease_mm": 1e3 * ease.ease,
        "ease_percent": 100 * ease.share,
        "most_between_notches_percent": 100 * ease.extreme,
        "notches_a": len(ease.notches_a),
        "notches_b": len(ease.notches_b),
        "matched": ease.matched,
    }


def _line_row(line: StartLine) -> dict[str, Any]:
    """Figures of a hook or frame as it starts."""
    return {
        "number": line.number,
        "kind": line.kind,
        "name": line.name,
        "pulled_to": line.target,
        "gap_mm": 1e3 * line.gap,
        "largest_gap_mm": 1e3 * float(line.gaps.max()),
    }
