"""The command that tries all that can be tried before the solve."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from seatlook.cli._options import Changes, ElementSize, SceneFile, Seed, seat_of
from seatlook.cli._output import Json, note, table

if TYPE_CHECKING:
    from seatlook.assembly.ease import SeamEase


def check(
    scene: SceneFile,
    /,
    *,
    seed: Seed = None,
    element_size_mm: ElementSize = None,
    changes: Changes = (),
    json: Json = False,
) -> None:
    """Read a scene with all its files, mesh it, and say what would be solved; solve nothing.

    Example: seatlook check seat.toml
    """
    from seatlook.assembly.ease import seam_ease
    from seatlook.results.resolution import resolutions

    seat = seat_of(scene, seed, element_size_mm, changes)
    cover, pattern = seat.check(), seat.scene.pattern
    finest = min(resolutions(cover), key=lambda mesh: mesh.wavelength)
    eases = [seam_ease(pattern, seam) for seam in pattern.seams]
    seams = [_seam_row(ease) for ease in sorted(eases, key=lambda ease: -abs(ease.share))]
    table(
        ("what", "value"),
        [
            ("scene", seat.scene.name),
            ("panels", len(cover.panel_names)),
            ("seams", len(cover.stitchings)),
            ("hooks_and_frames", len(cover.anchors)),
            ("vertices", len(cover.rest)),
            ("triangles", len(cover.faces)),
            ("element_size_mm", 1e3 * cover.element_size),
            ("wavelength_mm", 1e3 * finest.wavelength),
            ("wavelength_over_element_size", finest.per_wave),
            *([("ease", seams)] if json else ()),
        ],
        json=json,
    )
    if seams and not json:
        table(tuple(seams[0]), [tuple(map(_short, row.values())) for row in seams], json=False)
    note(f"nothing wrong; to solve and draw it: seatlook evaluate {scene} --out FOLDER")


def _short(value: Any) -> Any:
    """A figure of a seam for a reader: to a hundredth of a millimetre or percent."""
    return f"{round(value, 2) + 0.0:.2f}" if isinstance(value, float) else value


def _seam_row(ease: SeamEase) -> dict[str, Any]:
    """Figures of one seam; "matched" is whether both sides have as many notches."""
    return {
        "seam": ease.name,
        "length_a_mm": 1e3 * ease.length_a,
        "length_b_mm": 1e3 * ease.length_b,
        "ease_mm": 1e3 * ease.ease,
        "ease_percent": 100 * ease.share,
        "most_between_notches_percent": 100 * ease.extreme,
        "notches_a": len(ease.notches_a),
        "notches_b": len(ease.notches_b),
        "matched": ease.matched,
    }
