"""How a flattened pattern lies in space: poses of its panels, borders and seams on the form."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import MappingProxyType

from seatlook.files import reader, write_text
from seatlook.flattening.border import borders
from seatlook.flattening.flatten import Flattened
from seatlook.flattening.pattern import pair
from seatlook.flattening.surface import DesignSurface, sides
from seatlook.io.schema import MM, Array, Kind, Named, Table, Texts, place_mm, read_table
from seatlook.io.toml import quoted, read_document, toml_key
from seatlook.model import Border, FloatArray, Pose

_POINTS = place_mm(3, many=True)
_KEYS: dict[str, Kind] = {
    "placement": Named(
        Table(
            {
                "rotation": Array(shape=(3, 3), required=True),
                "translation_mm": place_mm(3),
            }
        ),
        required=True,
    ),
    "border": Named(
        Table(
            {
                "edges": Texts(required=True),
                "junctions_mm": Array(shape=(None,), scale=MM, required=True),
                "points_mm": _POINTS,
            }
        )
    ),
    "seam": Named(Table({"points_mm": _POINTS})),
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Lie:
    """How a flattened pattern lies on the design surface.

    Parameters
    ----------
    poses : panel -> where it starts, flat
    borders : free borders, each a curve with the edges that belong on it
    seams : seam -> (k, 3) [m] on the surface
    """

    poses: Mapping[str, Pose]
    borders: tuple[Border, ...]
    seams: Mapping[str, FloatArray]


def lie_of(form: DesignSurface, flat: Flattened) -> Lie:
    """Return how the pattern of a design surface lies on it."""
    all_sides = sides(form.patches())
    points = {side.name: form.vertices[side.vertices] for side in all_sides}
    seams = {seam.name: points[seam.a] for seam in pair(all_sides, form.seam_lines)}
    return Lie(poses=flat.placement, borders=borders(form), seams=MappingProxyType(seams))


def write_lie(lie: Lie, path: Path) -> None:
    """Write ``[placement.PANEL]`` as in a scene, ``[border.NAME]`` and ``[seam.NAME]``."""
    blocks = [
        f"[placement.{toml_key(name)}]\n"
        f"rotation = {pose.rotation.tolist()}\n"
        f"translation_mm = {(1e3 * pose.translation).tolist()}"
        for name, pose in lie.poses.items()
    ]
    blocks += [
        f"[border.{toml_key(border.name)}]\n"
        f"edges = [{', '.join(map(quoted, border.edges))}]\n"
        f"junctions_mm = {[1e3 * place for place in border.junctions]}\n"
        f"points_mm = {(1e3 * border.curve).tolist()}"
        for border in lie.borders
    ]
    blocks += [
        f"[seam.{toml_key(name)}]\npoints_mm = {(1e3 * points).tolist()}"
        for name, points in lie.seams.items()
    ]
    write_text(path, "\n\n".join(blocks) + "\n")


@reader("what flatten left")
def read_lie(path: Path) -> Lie:
    """Read what :func:`write_lie` wrote.

    Raises
    ------
    InputError
        For a key that is unknown, missing or of the wrong type, and for a pose that is none.
    """
    document = read_document(path)
    row = read_table(document, _KEYS)
    document.finish()
    poses = {}
    for name, pose in row["placement"].items():
        with document.blame(("placement", name)):
            poses[name] = Pose(rotation=pose["rotation"], translation=pose["translation_mm"])
    document.finish()
    return Lie(
        poses=MappingProxyType(poses),
        borders=tuple(
            Border(
                name=name,
                edges=border["edges"],
                curve=border["points_mm"],
                junctions=tuple(border["junctions_mm"].tolist()),
            )
            for name, border in row["border"].items()
        ),
        seams=MappingProxyType({name: seam["points_mm"] for name, seam in row["seam"].items()}),
    )
