"""The cover as it starts, over its foam, and what ``check`` refuses, each in its place; in mm."""

from __future__ import annotations

import hashlib
import threading
import time
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from seatlook.assembly import assemble
from seatlook.assembly.contradictions import Contradiction, contradictions
from seatlook.assembly.contradictions.find import out_of_scale
from seatlook.assembly.start_lines import StartLine, start_lines
from seatlook.errors import InputError, Problem
from seatlook.model import Cover, FloatArray, IntArray, Scene
from seatlook.report.assembly_picture import SEAM_COLOURS
from seatlook.studio.folder import Contents, Folder
from seatlook.studio.pattern_state import Values
from seatlook.studio.reading import Reading
from seatlook.studio.state import problem_values

_MOST_TIES = 60  # of a line that are sent
_DIGITS = 2  # of a mm, on a screen
# Keys of a scene that change nothing of how a cover starts.
_NO_MATTER = ("rig", "camera", "gallery", "accept", "improve", "thread", "wrinkle", "name", "zones")


class AssemblyView:
    """The assembly of the last state that was asked for, kept until it would be another one."""

    def __init__(self, folder: Folder) -> None:
        self._folder = folder
        self._lock = threading.Lock()
        self._key, self._values = "", dict[str, Any]()

    def values(self, tag: str, contents: Contents, reading: Reading) -> Mapping[str, Any]:
        """The assembly of a state of the folder.

        Parameters
        ----------
        tag : of the state
        """
        with self._lock:
            key, begun = self._key_of(contents, reading), time.perf_counter()
            if key != self._key:
                self._values = self._made(reading)
                self._key = key
            return {
                "etag": tag, **self._values, "seconds": round(time.perf_counter() - begun, 3)
            }  # fmt: skip

    def _key_of(self, contents: Contents, reading: Reading) -> str:
        scene = {key: value for key, value in reading.data.items() if key not in _NO_MATTER}
        own = {n: c for n, c in contents.items() if c and n.endswith(".toml")}
        digest = hashlib.sha256(repr((scene, reading.problems)).encode())
        digest.update(self._folder.signature_of("pattern", "foam").encode())
        for name, content in sorted(own.items()):
            if name != self._folder.scene:
                digest.update(name.encode() + hashlib.sha256(content).digest())
        return digest.hexdigest()

    def _made(self, reading: Reading) -> Values:
        scene, problems = reading.scene, reading.problems
        if scene is None:
            return self._empty(problems)
        try:
            scaled = out_of_scale(scene)
            if scaled:
                return self._empty([one.problem for one in scaled])
            cover = assemble(scene)
            found = contradictions(scene, cover)
        except InputError as error:
            return self._empty(error.problems)
        return {
            "foam": _mesh(scene.foam.vertices, scene.foam.faces),
            "panels": _panels(cover),
            "ties": [_tie(line) for line in start_lines(scene, cover)],
            "wires": _curves(scene, framed=False),
            "frames": _curves(scene, framed=True),
            "vertices": len(cover.rest),
            "faults": [self._fault(one) for one in found],
        }

    def _empty(self, problems: Iterable[Problem]) -> Values:
        nothing: Values = {key: [] for key in ("panels", "ties", "wires", "frames")}
        faults = [
            {"kind": "input", **problem_values(self._folder, one), "places_mm": []}
            for one in problems
        ]
        return {"foam": None, **nothing, "vertices": 0, "faults": faults}

    def _fault(self, one: Contradiction) -> Values:
        values = problem_values(self._folder, one.problem)
        return {"kind": one.name, **values, "places_mm": _rounded(one.places)}


def _panels(cover: Cover) -> list[Values]:
    panels = []
    for number, name in enumerate(cover.panel_names):
        faces = cover.faces[cover.panel == number]
        used, own = np.unique(faces, return_inverse=True)
        panels.append({"name": name, **_mesh(cover.positions[used], own.reshape(-1, 3))})
    return panels


def _mesh(vertices: FloatArray, faces: IntArray) -> Values:
    return {"positions_mm": _rounded(vertices.ravel()), "triangles": faces.ravel().tolist()}


def _rounded(metres: FloatArray) -> list[Any]:
    rounded: list[Any] = (np.round(1e3 * metres, _DIGITS) + 0.0).tolist()
    return rounded


def _tie(line: StartLine) -> Values:
    step = max(1, len(line.start) // _MOST_TIES)
    segments = np.hstack([line.start[::step], line.end[::step]])
    colour = (
        SEAM_COLOURS[(int(line.number) - 1) % len(SEAM_COLOURS)] if line.kind == "seam" else None
    )
    return {
        "kind": line.kind,
        "number": line.number,
        "name": line.name,
        "target": line.target,
        "colour": None if colour is None else "#{:02x}{:02x}{:02x}".format(*colour),
        "gap_mm": round(1e3 * line.gap, 2),
        "segments_mm": _rounded(segments),
    }


def _curves(scene: Scene, *, framed: bool) -> list[Values]:
    own = {frame.curve for frame in scene.frames}
    return [
        {"name": name, "points_mm": _rounded(points)}
        for name, points in scene.foam.curves.items()
        if (name in own) == framed
    ]
