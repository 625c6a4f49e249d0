"""The design surface: a file that names the panel of each face."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import pairwise
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

import numpy as np

from seatlook.errors import InputError
from seatlook.files import kept, read_file, reader, write_text
from seatlook.io.schema import shown
from seatlook.io.surface.axes import Axes, Unit, Up, file_axes
from seatlook.io.surface.formats import joined, read_parts
from seatlook.model import FloatArray, IntArray

_SAME_M = 1e-6


class GroupedMesh(NamedTuple):
    """A surface whose faces carry the name of a panel.

    Parameters
    ----------
    vertices : (n, 3) [m]; faces : (m, 3) int64
    panel : (m,) int64, index into ``panel_names``
    seam_lines : edge, smaller vertex first -> name of the line that is drawn along it
    """

    vertices: FloatArray
    faces: IntArray
    panel: IntArray
    panel_names: tuple[str, ...]
    seam_lines: Mapping[tuple[int, int], str] = MappingProxyType({})


@reader("a design surface")
def read_surface(
    path: Path, *, unit: Unit | None = None, up: Up | None = None, ungrouped: str | None = None
) -> GroupedMesh:
    """Read a design surface whose file names the panel of each face.

    In OBJ that is ``g NAME``, or ``o NAME`` in a file without ``g``; in glTF the name of the node.
    Lines of an OBJ (``l``) that run along edges of its faces are seam lines, called after their
    group; others count for nothing.
    STL and PLY know no names. Polygons are cut into fans. The surface need not be closed. Panels
    that were written with corners of their own share them again where they agree within 1 um.

    Parameters
    ----------
    path : OBJ, STL, PLY or glTF
    unit, up : of the file; by its format and size if not given (``file_axes``)
    ungrouped : panel of the faces without a name; where none is given, they are refused

    Raises
    ------
    InputError
        For a face without a name, outside the vertices or of fewer than three, for a number that
        is none, and for a size not within 0.05 to 3 m; with the line of an OBJ, all together.
    """
    return read_surface_axes(path, unit=unit, up=up, ungrouped=ungrouped)[0]


@reader("a design surface")
def read_surface_axes(
    path: Path, *, unit: Unit | None = None, up: Up | None = None, ungrouped: str | None = None
) -> tuple[GroupedMesh, Axes]:
    """Read a design surface (``read_surface``), and the axes of its file."""
    drawn = _read_obj(path, ungrouped) if path.suffix.lower() == ".obj" else _named(path, ungrouped)
    axes = file_axes(path, drawn.vertices[np.unique(drawn.faces)], unit, up)
    vertices, corner = _welded(axes.world(drawn.vertices))
    faces = corner[drawn.faces]
    drawn_lines = {_ends(*corner[list(ends)].tolist()): n for ends, n in drawn.seam_lines.items()}
    return drawn._replace(vertices=vertices, faces=faces, seam_lines=drawn_lines), axes


def _named(path: Path, ungrouped: str | None) -> GroupedMesh:
    """Read the objects of a file as panels."""
    parts = read_parts(path)
    names = [part.name or ungrouped for part in parts]
    if None in names:
        raise InputError.single(
            "panels",
            got=f"a {path.suffix} file, which knows no names",
            expected="an OBJ with a group per panel, or a glTF with a node per panel",
            file=path,
            hint="seatlook flatten cuts it along --seam-lines",
        )
    panel_names = tuple(dict.fromkeys(str(name) for name in names))
    numbers = [panel_names.index(str(name)) for name in names]
    vertices, faces = joined(parts)
    return GroupedMesh(
        vertices=vertices,
        faces=faces,
        panel=np.repeat(numbers, [len(part.faces) for part in parts]).astype(np.int64),
        panel_names=panel_names,
    )


@kept
def _read_obj(path: Path, ungrouped: str | None) -> GroupedMesh:
    text = read_file(path).decode("utf-8-sig", errors="replace")
    # Other ends of lines than these may be in names.
    lines = text.replace("\r\n", "\n").replace("\r", "\n").split("\n")
    has_groups = any(line.split(None, 1)[:1] == ["g"] for line in lines)
    reader = _ObjReader(path, "g" if has_groups else "o")
    if ungrouped is not None:
        reader.open_group(ungrouped)
    words: list[str] = []
    for number, line in enumerate(lines, start=1):
        words += line.split("#", 1)[0].removesuffix("\\").split()
        if not line.endswith("\\"):  # a backslash continues the line
            reader.read(number, words)
            words = []
    return reader.result()


class _ObjReader:
    """The lines of an OBJ file, one after the other."""

    def __init__(self, path: Path, group_word: str) -> None:
        self.path = path
        self.group_word = group_word
        self.vertices: list[list[float]] = []
        self.faces: list[list[int]] = []
        self.panel: list[int] = []
        self.lines: dict[tuple[int, int], str] = {}
        self.names: list[str] = []
        self.errors: list[InputError] = []
        self.group: int | None = None

    def read(self, number: int, words: list[str]) -> None:
        if not words or words[0] not in ("v", "f", "l", self.group_word):
            return
        kind, values = words[0], words[1:]
        try:
            if kind == "v":
                self._vertex(values)
            elif kind == self.group_word:
                self.open_group(" ".join(values))
            elif kind == "l":
                self._line(values)
            else:
                self._face(values)
        except ValueError as error:
            self.errors.append(
                InputError.single(kind, got=shown(" ".join(values)), expected=str(error),
                                  file=self.path, line=number)
            )  # fmt: skip

    def _vertex(self, values: list[str]) -> None:
        # A line that is refused still counts, or every later index would be off by one.
        self.vertices.append([0.0, 0.0, 0.0])
        expected = "three finite numbers"
        try:
            point = [float(v) for v in values[:3]]
        except ValueError as error:
            raise ValueError(expected) from error
        if len(point) != 3 or not np.isfinite(point).all():
            raise ValueError(expected)
        self.vertices[-1] = point

    def open_group(self, name: str) -> None:
        if name not in self.names:
            self.names.append(name)
        self.group = self.names.index(name)

    def _numbers(self, values: list[str], least: str, count: int) -> list[int]:
        known = len(self.vertices)
        try:
            corners = [int(v.split("/")[0]) for v in values]
        except ValueError as error:
            raise ValueError("vertex numbers") from error
        corners = [c - 1 if c > 0 else known + c for c in corners]
        if len(corners) < count or not all(0 <= c < known for c in corners):
            raise ValueError(f"{least} or more vertices from 1 to {known}")
        return corners

    def _line(self, values: list[str]) -> None:
        if self.group is not None:
            points = self._numbers(values, "two", 2)
            self.lines |= {_ends(a, b): self.names[self.group] for a, b in pairwise(points)}

    def _face(self, values: list[str]) -> None:
        if self.group is None:
            raise ValueError("a group (g PANEL) before the first face")
        corners = self._numbers(values, "three", 3)
        for b, c in pairwise(corners[1:]):
            self.faces.append([corners[0], b, c])
            self.panel.append(self.group)

    def result(self) -> GroupedMesh:
        if self.errors:
            raise InputError(p for error in self.errors for p in error.problems)
        if not self.faces:
            raise InputError.single("f", got="no face", expected="faces", file=self.path)
        used = sorted(set(self.panel))
        sides = {_ends(a, b) for f in self.faces for a, b in pairwise([*f, f[0]])} & {*self.lines}
        return GroupedMesh(
            vertices=np.array(self.vertices),
            faces=np.array(self.faces, dtype=np.int64),
            seam_lines={ends: name for ends, name in self.lines.items() if ends in sides},
            panel=np.searchsorted(used, self.panel).astype(np.int64),
            panel_names=tuple(self.names[i] for i in used),
        )


def _ends(a: int, b: int) -> tuple[int, int]:
    return (a, b) if a < b else (b, a)


def _welded(vertices: FloatArray) -> tuple[FloatArray, IntArray]:
    """Return the places (k, 3) of vertices, in order of appearance, and the place of each (n,)."""
    cells = np.round(vertices / _SAME_M).astype(np.int64)
    _, first, index = np.unique(cells, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.empty(len(first), dtype=np.int64)
    rank[order] = np.arange(len(first))
    return vertices[first[order]], rank[index.reshape(-1)]


def write_surface(mesh: GroupedMesh, path: Path) -> None:
    """Write a design surface as OBJ in millimetres, all digits kept.

    One group per panel and per seam line.
    """
    rows = [_vertex_rows(mesh.vertices)]
    for index, name in enumerate(mesh.panel_names):
        rows.append(f"g {name}")
        rows.append(_face_rows(mesh.faces[mesh.panel == index]))
    for name in sorted(set(mesh.seam_lines.values())):
        rows.append(f"g {name}")
        rows += [f"l {a + 1} {b + 1}" for (a, b), own in mesh.seam_lines.items() if own == name]
    write_text(path, "\n".join(rows) + "\n")


def write_obj(vertices: FloatArray, faces: IntArray, path: Path) -> None:
    """Write a surface (n, 3) [m], (m, 3) as OBJ in millimetres, all digits kept."""
    write_text(path, f"{_vertex_rows(vertices)}\n{_face_rows(faces)}\n")


def _vertex_rows(vertices: FloatArray) -> str:
    return "\n".join(f"v {x!r} {y!r} {z!r}" for x, y, z in (1e3 * vertices).tolist())


def _face_rows(faces: IntArray) -> str:
    return "\n".join(f"f {a} {b} {c}" for a, b, c in (faces + 1).tolist())
