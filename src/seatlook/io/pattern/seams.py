"""The seams file: which stretches of which panels are edges, and which edges are sewn together.

A pattern file says nothing about sewing. This one names edges by their end points, so that it
stays true when a CAD system numbers its points anew.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import Any, Unpack

import numpy as np

from seatlook.errors import InputError
from seatlook.files import reader, write_text
from seatlook.io.pattern.allowance import only_cut, with_edge_allowances
from seatlook.io.pattern.dxf import Reading, read_dxf
from seatlook.io.schema import (
    FAR_MM,
    MM,
    Array,
    Flag,
    Integer,
    Kind,
    Named,
    Number,
    Rows,
    Table,
    Text,
    Texts,
    read_table,
    shown,
)
from seatlook.io.toml import Document, quoted, read_document
from seatlook.model import Edge, FloatArray, Panel, Pattern, Seam

# A new pattern format is one reader here: path, size, units, smallest notch in, panels out.
READERS: dict[str, Callable[..., tuple[Panel, ...]]] = {".dxf": read_dxf}

SNAP_MM = 2.0
LENGTH_TOLERANCE_MM = 0.5
# Sides differ by some percent of ease; more means that an edge runs the wrong way round.
LARGEST_RATIO = 1.10

_KEYS: dict[str, Kind] = {
    "schema": Integer(low=1, high=1, default=1),
    "edge": Named(
        Table(
            {
                "panel": Text(required=True),
                "from_mm": Array(shape=(2,), low=-FAR_MM, high=FAR_MM, required=True),
                "to_mm": Array(shape=(2,), low=-FAR_MM, high=FAR_MM, required=True),
                "allowance_mm": Number(low=0, high=100, scale=MM),
            }
        ),
        required=True,
    ),
    "seam": Rows(
        Table(
            {
                "name": Text(required=True),
                "a": Text(required=True),
                "b": Texts(or_one=True, required=True),
                "reverse": Flag(default=True),
                "pitch_mm": Number(low=0.1, high=50, scale=MM, default=5.0),
                "length_mm": Number(above=0),
                "length_b_mm": Number(above=0),
            }
        )
    ),
}


@reader("a pattern")
def read_panels(path: Path, **reading: Unpack[Reading]) -> tuple[Panel, ...]:
    """Read the panels of a pattern file of any format in ``READERS``."""
    reader = READERS.get(path.suffix.lower())
    if reader is None:
        expected = f"one of {', '.join(READERS)}"
        raise InputError.single("file", got=shown(path.suffix), expected=expected, file=path)
    return reader(path, **reading)


@reader("a pattern")
def read_pattern(path: Path, seams: Path, **reading: Unpack[Reading]) -> Pattern:
    """Read a pattern and how it is sewn.

    Parameters
    ----------
    path : pattern file (AAMA DXF)
    seams : seams file; see docs/reference/scene.md
    reading : as in ``read_dxf``

    Raises
    ------
    InputError
        As ``read_dxf``; for an edge of an unknown panel or one that does not end within 2 mm of a
        corner, a seam of an unknown edge, a length that is not the one stated. All problems of the
        seams file are reported together.
    """
    return read_seams(seams, read_panels(path, **reading), reading.get("allowance") or 0.0)


@reader("a seams file")
def read_seams(path: Path, panels: tuple[Panel, ...], allowance: float = 0.0) -> Pattern:
    """Read the seams file of ``panels``, whose sew lines lie ``allowance`` [m] inside."""
    document = read_document(path)
    row = read_table(document, _KEYS)
    by_name = {p.name: p for p in panels}
    edges = {
        name: edge
        for name, values in row["edge"].items()
        if (edge := _edge(document, name, values, by_name)) is not None
    }
    for number, values in enumerate(row["seam"]):
        _check_names(document, number, values, tuple(row["edge"]))
    document.finish()
    pattern = Pattern(
        panels=_with_own_allowances(document, row["edge"], edges, panels, allowance),
        edges=MappingProxyType(edges),
        seams=tuple(
            Seam(name=s["name"], a=s["a"], b=s["b"], reverse=s["reverse"], pitch=s["pitch_mm"])
            for s in row["seam"]
        ),
    )
    for number, values in enumerate(row["seam"]):
        _check_lengths(document, number, values, pattern)
    document.finish()
    return pattern


def _with_own_allowances(
    document: Document,
    rows: dict[str, dict[str, Any]],
    edges: dict[str, Edge],
    panels: tuple[Panel, ...],
    allowance: float,
) -> tuple[Panel, ...]:
    """Move the sew lines of edges that have an allowance of their own."""
    moved = []
    for panel in panels:
        own = {name: edge for name, edge in edges.items() if edge.panel == panel.name}
        widths = {n: w for n in own if (w := rows[n]["allowance_mm"]) is not None}
        if widths and not (only_cut(panel) or allowance):
            first = next(iter(widths))
            document.report(
                ("edge", first, "allowance_mm"), f"{1e3 * widths[first]:g}",
                f"none, as the sew line of {panel.name} is drawn",
            )  # fmt: skip
        elif widths:
            with document.blame(("edge", next(iter(widths)))):
                panel = with_edge_allowances(panel, own, widths, allowance)
        moved.append(panel)
    document.finish()
    return tuple(moved)


def _edge(
    document: Document, name: str, values: dict[str, Any], panels: dict[str, Panel]
) -> Edge | None:
    key = ("edge", name)
    if values["panel"] is None:
        return None
    panel = panels.get(values["panel"])
    if panel is None:
        hint = document.hint(values["panel"], panels)
        document.report(
            (*key, "panel"), shown(values["panel"]), f"one of {', '.join(panels)}", hint
        )
        return None
    ends = [_corner(document, (*key, end), values[end], panel) for end in ("from_mm", "to_mm")]
    if ends[0] is None or ends[1] is None:
        return None
    return Edge(name=name, panel=panel.name, start=ends[0], end=ends[1])


def _corner(
    document: Document, key: tuple[str, ...], point: FloatArray | None, panel: Panel
) -> int | None:
    """Return the corner of the panel next to a point [mm]."""
    if point is None:
        return None
    places = 1e3 * panel.outline[panel.corners]
    distance = np.hypot(*(places - point).T)
    if not len(places) or distance.min() > SNAP_MM:
        nearest = "no corner" if not len(places) else places[distance.argmin()].round(2).tolist()
        away = f", which is {distance.min():.1f} mm away" if len(places) else ""
        document.report(
            key,
            point.tolist(),
            f"a point within {SNAP_MM:g} mm of a corner or turn point of {panel.name}",
            f"the nearest is {nearest}{away}",
        )
        return None
    return int(panel.corners[distance.argmin()])


def _check_names(
    document: Document, number: int, values: dict[str, Any], edges: tuple[str, ...]
) -> None:
    sides = {"a": (values["a"],), "b": values["b"]}
    for side, names in sides.items():
        for name in names or ():
            if name is not None and name not in edges:
                expected = "an edge of this file"
                document.report(
                    ("seam", number, side), shown(name), expected, document.hint(name, edges)
                )
    if values["b"] and values["a"] in values["b"]:
        document.report(("seam", number, "b"), shown(values["a"]), "another edge than a")


def _check_lengths(
    document: Document, number: int, values: dict[str, Any], pattern: Pattern
) -> None:
    lengths = {
        "length_mm": 1e3 * pattern.edge_length(values["a"]),
        "length_b_mm": 1e3 * sum(pattern.edge_length(b) for b in values["b"]),
    }
    for key, length in lengths.items():
        stated = values[key]
        if stated is not None and abs(stated - length) > LENGTH_TOLERANCE_MM:
            document.report(
                ("seam", number, key), stated, f"{length:.3f}, the length in the pattern"
            )
    ratio = max(lengths.values()) / min(lengths.values())
    if ratio > LARGEST_RATIO:
        document.report(
            ("seam", number),
            f"{values['name']!r} with sides of {lengths['length_mm']:.1f} and "
            f"{lengths['length_b_mm']:.1f} mm",
            f"sides that differ by at most {LARGEST_RATIO - 1:.0%}",
            "from_mm to to_mm runs counter-clockwise round the panel",
        )


def write_seams(
    pattern: Pattern,
    path: Path,
    *,
    notes: Mapping[str, str] | None = None,
    remarks: Sequence[str] = (),
) -> None:
    """Write the seams file of a pattern, with both lengths of each seam as checks.

    Parameters
    ----------
    notes : comments on seams and edges, by name
    remarks : comments at the end of the file
    """
    notes = notes or {}
    blocks = ["schema = 1"]
    for edge in pattern.edges.values():
        points = 1e3 * pattern.edge_points(edge.name)
        blocks.append(
            f"{_comment(notes.get(edge.name))}[edge.{quoted(edge.name)}]\n"
            f"panel = {quoted(edge.panel)}\n"
            f"from_mm = {points[0].round(6).tolist()}\n"
            f"to_mm = {points[-1].round(6).tolist()}"
        )
    for seam in pattern.seams:
        length_b = sum(pattern.edge_length(b) for b in seam.b)
        blocks.append(
            f"{_comment(notes.get(seam.name))}[[seam]]\n"
            f"name = {quoted(seam.name)}\n"
            f"a = {quoted(seam.a)}\n"
            f"b = [{', '.join(map(quoted, seam.b))}]\n"
            f"reverse = {str(seam.reverse).lower()}\n"
            f"pitch_mm = {1e3 * seam.pitch:.9g}\n"
            f"length_mm = {1e3 * pattern.edge_length(seam.a):.3f}\n"
            f"length_b_mm = {1e3 * length_b:.3f}"
        )
    blocks += [_comment(remark).rstrip() for remark in remarks]
    write_text(path, "\n\n".join(blocks) + "\n")


def _comment(text: str | None) -> str:
    return "".join(f"# {line}\n" for line in text.splitlines()) if text else ""
