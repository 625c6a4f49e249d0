"""The parts of a scene that tie named things together: stages, hooks, frames, zones, limits.

Where the pattern or the foam could not be read, names in it are not checked.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from seatlook.io.scene.checks import line_length
from seatlook.io.schema import known
from seatlook.io.toml import Document, Key
from seatlook.model import Foam, Frame, Hook, Limit, Pattern, Stage, ZoneBox, stage_units
from seatlook.model.scene import SCORE_MEASURES
from seatlook.model.zones import FREE_EDGE, zones

Row = dict[str, Any]


def make_stages(document: Document, rows: list[Row], pattern: Pattern | None) -> tuple[Stage, ...]:
    """Build the stages; every seam closes in one of them, groups are not torn apart."""
    stages: list[Stage] = []
    for number, row in enumerate(rows):
        key = ("stage", number)
        for seam in row["seams"] or ():
            if pattern is not None:
                known(document, (*key, "seams"), seam, [s.name for s in pattern.seams], "a seam")
            before = next((s.name for s in stages if seam in s.seams), None)
            if before is not None:
                expected = f"no seam of stage {before!r}"
                document.report((*key, "seams"), repr(seam), expected)
        if None in (row["name"], row["start_s"], row["end_s"], row["ramp"]):
            continue
        with document.blame(key):
            stage = Stage(
                name=row["name"],
                start=row["start_s"],
                end=row["end_s"],
                ramp=row["ramp"],
                group=row["group"],
                seams=tuple(row["seams"] or ()),
            )
            # One by one, so that the line is that of the stage that does not fit.
            stage_units([*stages, stage])
            stages.append(stage)
    return tuple(stages)


def make_hooks(
    document: Document, row: Row, pattern: Pattern | None, foam: Foam | None
) -> tuple[Hook, ...]:
    """Build the hooks: a seam or an internal line, and a wire of the foam."""
    lines: list[str] = []
    if pattern is not None:
        lines = [s.name for s in pattern.seams]
        lines += [f"{p.name}/{name}" for p in pattern.panels for name in p.internal_lines]
    for number, hook in enumerate(row["hook"]):
        key = ("hook", number)
        _check_stage(document, key, hook["stage"], row)
        if pattern is not None:
            known(document, (*key, "line"), hook["line"], lines, "a seam or PANEL/LINE")
        if foam is not None:
            known(document, (*key, "wire"), hook["wire"], foam.curves, "a curve of the foam")
        _check_part(document, key, hook, pattern)
    return tuple(
        Hook(
            name=hook["name"],
            line=hook["line"],
            wire=hook["wire"],
            stage=hook["stage"],
            pitch=hook["pitch_mm"],
            start=hook["from_mm"] or 0.0,
            end=hook["to_mm"],
            limit=hook["limit_n"],
        )
        for hook in row["hook"]
    )


def _check_part(document: Document, key: Key, hook: Row, pattern: Pattern | None) -> None:
    """Refuse a part of a line that is turned round or goes on beyond the line."""
    start, end = hook["from_mm"], hook["to_mm"]
    length = None if pattern is None else line_length(hook["line"], pattern)
    if end is not None and start is not None and not start < end:
        document.report((*key, "to_mm"), f"{1e3 * end:g}", f"above from_mm, {1e3 * start:g}")
    if length is None:
        return
    for name, value in (("from_mm", start), ("to_mm", end)):
        if value is not None and value > length + 5e-4:
            expected = f"at most the length of {hook['line']!r}, {1e3 * length:.1f}"
            document.report((*key, name), f"{1e3 * value:g}", expected)


def make_frames(
    document: Document, row: Row, pattern: Pattern | None, foam: Foam | None
) -> tuple[Frame, ...]:
    """Build the frames: free edges, and a curve below the foam."""
    for number, frame in enumerate(row["frame"]):
        key = ("frame", number)
        _check_stage(document, key, frame["stage"], row)
        if pattern is not None:
            for edge in frame["edges"] or ():
                what = "an edge of the seams file"
                known(document, (*key, "edges"), edge, pattern.edges, what)
        if foam is not None:
            known(document, (*key, "curve"), frame["curve"], foam.curves, "a curve of the foam")
    return tuple(Frame(**frame) for frame in row["frame"])


def _check_stage(document: Document, key: Key, name: str | None, row: Row) -> None:
    names = [s["name"] for s in row["stage"] if s["name"] is not None]
    known(document, (*key, "stage"), name, names, "a stage")


def make_boxes(document: Document, rows: list[Row], pattern: Pattern | None) -> tuple[ZoneBox, ...]:
    """Build the user's zones."""
    boxes = []
    for number, row in enumerate(rows):
        key = ("zones", "box", number)
        if pattern is not None:
            panels = [p.name for p in pattern.panels]
            known(document, (*key, "panel"), row["panel"], panels, "a panel of the pattern")
        if any(value is None for value in row.values()):
            continue
        low, high = row["low_mm"], row["high_mm"]
        if not (low < high).all():
            expected = f"above low_mm, {(1e3 * low).round(6).tolist()}"
            document.report((*key, "high_mm"), (1e3 * high).round(6).tolist(), expected)
        boxes.append(
            ZoneBox(
                name=row["name"], panel=row["panel"], low=low, high=high, visibility=row["class"]
            )
        )
    return tuple(boxes)


def make_limits(
    document: Document, rows: dict[str, Row], pattern: Pattern | None, boxes: tuple[ZoneBox, ...]
) -> tuple[Limit, ...]:
    """Build the limits of [accept]: of a zone, or of all boxes of a class."""
    if pattern is not None:
        none = np.zeros((0, 2)), np.zeros(0, dtype=np.int64)
        names = ["A", "B", "C", *zones(*none, pattern, boxes=boxes)[1]]
        for zone in rows:
            choices = [name for name in names if name != FREE_EDGE]
            known(document, ("accept", zone), zone, choices, "a zone or a class of boxes")
    for zone, row in rows.items():
        for measure in SCORE_MEASURES:
            if row[measure] is not None and zone.startswith("seam "):
                document.report(
                    ("accept", zone, measure),
                    "a seam band",
                    "an interior, a box or a class: a score leaves seams out",
                )
    return tuple(
        Limit(zone=zone, measure=measure, maximum=maximum)
        for zone, row in rows.items()
        for measure, maximum in row.items()
        if maximum is not None
    )
