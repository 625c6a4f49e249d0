"""What cannot be, with file, line, places, and the name by which a scene lets it pass."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from seatlook.errors import Problem
from seatlook.io.toml import Document, Key, read_document, spelled
from seatlook.model import Anchor, FloatArray, Scene


@dataclass(frozen=True, slots=True, kw_only=True)
class Contradiction:
    """What cannot be: its name out of ``ALLOWED``, what is said of it, and where it is.

    Parameters
    ----------
    places : (k, 3) float64 [m]   on the cover as it starts, the foam or a curve; may be none
    """

    name: str
    problem: Problem
    places: FloatArray


class Lines:
    """The lines of the scene's files; a scene that was made in memory has none."""

    def __init__(self, scene: Scene) -> None:
        self._scene = self._seams = None
        if scene.path is not None and scene.path.exists():
            self._scene = read_document(scene.path)
            seams = scene.path.parent / str(self._scene.data["pattern"]["seams"])
            self._seams = read_document(seams) if seams.exists() else None

    def tie(self, anchor: Anchor) -> Key:
        """Key of the hook or frame that an anchor comes from."""
        rows: list[dict[str, Any]] = []
        if self._scene is not None:
            rows = self._scene.data.get(anchor.kind, [])
        names = [row.get("name") for row in rows]
        number: str | int = names.index(anchor.name) if anchor.name in names else anchor.name
        return (anchor.kind, number)

    def problem(
        self, name: str, key: Key, places: list[FloatArray], got: str, expected: str
    ) -> Contradiction:
        """A contradiction in the scene file."""
        return _contradiction(self._scene, name, key, places, got, expected)

    def seam(
        self, name: str, number: int, places: list[FloatArray], got: str, expected: str
    ) -> Contradiction:
        """A contradiction of a seam in the seams file."""
        return _contradiction(self._seams, name, ("seam", number), places, got, expected)


def _contradiction(
    document: Document | None,
    name: str,
    key: Key,
    places: list[FloatArray],
    got: str,
    expected: str,
) -> Contradiction:
    problem = Problem(
        key=spelled(key),
        got=got,
        expected=expected,
        file=None if document is None else document.file,
        line=None if document is None else document.line(key),
        hint=f'if it is meant: [check] allow = ["{name}"] in the scene',
    )
    return Contradiction(
        name=name, problem=problem, places=np.array(places, dtype=np.float64).reshape(-1, 3)
    )


def place_text(point: FloatArray) -> str:
    """A place in the units of the scene file."""
    return f"({', '.join(f'{1e3 * value:.0f}' for value in point)}) mm"


def gap_between(a: FloatArray, b: FloatArray) -> float:
    """Mean distance of points (k, 3) from as many others."""
    return float(np.linalg.norm(a - b, axis=1).mean())
