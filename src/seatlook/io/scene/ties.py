"""The parts of a scene that tie named things together: stages, hooks, frames, zones, limits.

Where the pattern or the foam could not be read, names in it are not checked.
"""

from __future__ import annotations

from itertools import pairwise
from typing import Any

import numpy as np

from seatlook.io.scene.checks import chain_length
from seatlook.io.schema import known
from seatlook.io.toml import Document, Key
from seatlook.mesh import is_closed, length
from seatlook.model import (
    FloatArray,
    Foam,
    Frame,
    Hook,
    Limit,
    Pattern,
    Stage,
    ZoneBox,
    stage_units,
)
from seatlook.model.scene import SCORE_MEASURES, Freedom
from seatlook.model.zones import FREE_EDGE, built_in_zones, zones

Row = dict[str, Any]

_ON_CURVE = 5e-4  # m by which a place given in a file may lie beyond the end of its line


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
    """Build the hooks: seams or internal lines, and a wire of the foam."""
    hooks = []
    for number, hook in enumerate(row["hook"]):
        key = ("hook", number)
        _check_stage(document, key, hook["stage"], row)
        lines = _hooked_lines(document, key, hook, pattern)
        if foam is not None:
            known(document, (*key, "wire"), hook["wire"], foam.curves, "a curve of the foam")
        _check_part(document, key, hook, lines, pattern)
        hooks.append(
            Hook(
                name=hook["name"],
                line=hook["line"] or "",
                chain=hook["chain"] or (),
                wire=hook["wire"],
                stage=hook["stage"],
                junctions=_junctions(document, key, hook, len(lines), _curve(foam, hook["wire"])),
                pitch=hook["pitch_mm"],
                start=hook["from_mm"] or 0.0,
                end=hook["to_mm"],
                limit=hook["limit_n"],
                slides=hook["slides"],
            )
        )
    return tuple(hooks)


def _hooked_lines(
    document: Document, key: Key, hook: Row, pattern: Pattern | None
) -> tuple[str, ...]:
    """The lines of a hook; reports names that do not exist or come twice, and none or both keys."""
    lines = (hook["line"],) if hook["line"] else hook["chain"] or ()
    if (hook["line"] is None) == (hook["chain"] is None):
        got = "neither" if hook["line"] is None else "both"
        document.report((*key, "line"), got, "one of line and chain")
    if pattern is not None:
        names = [seam.name for seam in pattern.seams]
        names += [f"{p.name}/{name}" for p in pattern.panels for name in p.internal_lines]
        for name in lines:
            at = "line" if hook["line"] else "chain"
            known(document, (*key, at), name, names, "a seam or PANEL/LINE")
    for name in sorted({name for name in lines if lines.count(name) > 1}):
        document.report((*key, "chain"), f"{name!r} twice", "each line once")
    return tuple(lines)


def _curve(foam: Foam | None, curve: str | None) -> FloatArray | None:
    """Points (k, 3) [m] of a curve of the foam, if it is there."""
    return None if foam is None or curve is None else foam.curves.get(curve)


def _junctions(
    document: Document, key: Key, row: Row, lines: int, curve: FloatArray | None
) -> tuple[float, ...]:
    """Places along a curve [m] of a chain's lines: one more than lines, rising, on the curve.

    On a closed curve they may go on past its end, not more than once round.
    """
    values = row["junctions_mm"]
    if values is None:
        return ()
    places = tuple(values.tolist())
    shown = [round(1e3 * place, 3) for place in places]
    if len(places) != lines + 1:
        expected = f"{lines + 1} places, where the lines begin and the last one ends"
        document.report((*key, "junctions_mm"), shown, expected)
    elif not all(a < b for a, b in pairwise(places)):
        document.report((*key, "junctions_mm"), shown, "places that rise along the curve")
    elif curve is not None:
        long, closed = length(curve), is_closed(curve)
        last = min(places[0], long) + long if closed else long
        if places[-1] > last + _ON_CURVE:
            expected = f"places on the curve, which is {1e3 * long:.1f} mm long"
            expected += ", once round at most" if closed else ""
            document.report((*key, "junctions_mm"), shown, expected)
    return places


def _check_part(
    document: Document, key: Key, hook: Row, lines: tuple[str, ...], pattern: Pattern | None
) -> None:
    """Refuse a part of a chain that is turned round or goes on beyond it."""
    start, end = hook["from_mm"], hook["to_mm"]
    long = chain_length(lines, pattern)
    if end is not None and start is not None and not start < end:
        document.report((*key, "to_mm"), f"{1e3 * end:g}", f"above from_mm, {1e3 * start:g}")
    if long is None:
        return
    for name, value in (("from_mm", start), ("to_mm", end)):
        if value is not None and value > long + _ON_CURVE:
            whole = " + ".join(map(repr, lines))
            expected = f"at most the length of {whole}, {1e3 * long:.1f}"
            document.report((*key, name), f"{1e3 * value:g}", expected)


def make_frames(
    document: Document, row: Row, pattern: Pattern | None, foam: Foam | None
) -> tuple[Frame, ...]:
    """Build the frames: free edges, and a curve below the foam."""
    frames = []
    for number, frame in enumerate(row["frame"]):
        key = ("frame", number)
        _check_stage(document, key, frame["stage"], row)
        if pattern is not None:
            for edge in frame["edges"] or ():
                what = "an edge of the seams file"
                known(document, (*key, "edges"), edge, pattern.edges, what)
        if foam is not None:
            known(document, (*key, "curve"), frame["curve"], foam.curves, "a curve of the foam")
        edges, curve = frame["edges"] or (), _curve(foam, frame["curve"])
        places = _junctions(document, key, frame, len(edges), curve)
        values = {name: value for name, value in frame.items() if name != "junctions_mm"}
        frames.append(Frame(**values, junctions=places))
    return tuple(frames)


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
        if pattern is not None and row["name"] in built_in_zones(pattern):
            expected = "a name of its own: a zone or class is called so already"
            document.report((*key, "name"), repr(row["name"]), expected)
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


def make_freedom(
    document: Document, row: Row, pattern: Pattern | None, foam: Foam | None
) -> Freedom:
    """Build [improve]: what a correction may change."""
    own = row["improve"]
    if pattern is not None and foam is not None:
        names = [
            *pattern.edges,
            *(seam.name for seam in pattern.seams),
            *(panel.name for panel in pattern.panels),
            *foam.curves,
            *(hook["name"] for hook in row["hook"]),
        ]
        for name in own["frozen"]:
            known(
                document, ("improve", "frozen"), name, names, "an edge, seam, hook, wire or panel"
            )
    return Freedom(
        frozen=tuple(own["frozen"]),
        edge=own["edge_mm"],
        length=own["length_mm"],
        hook=own["hook_mm"],
        foam=own["foam_mm"],
        symmetric=own["symmetric"],
        corrections=own["corrections"],
    )
