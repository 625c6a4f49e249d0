"""One scene: what is sewn, on which foam, how it is judged and looked at."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import Literal

import numpy as np

from seatlook.errors import InputError
from seatlook.model._check import FARTHEST, FloatArray, IntArray, floats, ints, positive
from seatlook.model.criteria import CurvatureMode
from seatlook.model.fastenings import SeamKind, Thread
from seatlook.model.light.camera import Camera
from seatlook.model.light.lamps import Rig
from seatlook.model.light.surroundings import surroundings_named
from seatlook.model.material import Appearance, Foam, Material
from seatlook.model.pattern import Pattern
from seatlook.model.stage import Stage

# What [accept] can limit besides the figures of a zone: its worst score over textures and rigs.
SCORE_MEASURES = ("vwi", "equivalent_height_mm")
FIRST_SIZE = 0.007  # [m] of a mesh that is made before it is known where it is to be finer
TOLERANCES = (0.01, 0.5)  # [1] of zone means: finer no mesh gets in hours, coarser says nothing
ELEMENT_SIZES = (5e-4, 0.1)  # [m] from fine to coarse: below is thread, above no seat is left
LARGEST_SEED = 2**31
# Of fields that change no result: they are no part of a digest.
NO_RESULT = {"digest": False}
# Contradictions that [check] can let pass.
ALLOWED = (
    "twisted seam",
    "exchanged seams",
    "ties apart",
    "scale",
    "start inside",
    "curve inside",
    "hook far",
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Pose:
    """Where a flat panel starts: ``x = rotation @ (u, v, 0) + translation``.

    Parameters
    ----------
    rotation : (3, 3) float64, proper orthogonal; translation : (3,) float64 [m]
    """

    rotation: FloatArray
    translation: FloatArray

    def __post_init__(self) -> None:
        floats(self, "rotation", 3, 3)
        floats(self, "translation", 3, most=FARTHEST)
        error = np.abs(self.rotation @ self.rotation.T - np.eye(3)).max()
        if error > 1e-6 or np.linalg.det(self.rotation) < 0:
            raise InputError.single(
                "Pose.rotation", got=self.rotation.tolist(), expected="a proper rotation matrix"
            )

    def at(self, flat: FloatArray) -> FloatArray:
        """Places (n, 3) [m] of points (n, 2) [m] of the panel."""
        return np.asarray(flat @ self.rotation[:, :2].T + self.translation)

    def moved(self, way: FloatArray) -> Pose:
        """The pose moved by (3,) [m]."""
        return Pose(rotation=self.rotation, translation=self.translation + way)


@dataclass(frozen=True, slots=True, kw_only=True)
class Hook:
    """A sew line, or a chain of them, pulled to a wire.

    Parameters
    ----------
    line : name of a seam, or ``PANEL/LINE`` for an internal line
    chain : instead of ``line``: such names, one after the other along the wire
    wire : name of a curve of the foam
    stage : stage in which it is pulled in
    junctions : float [m], one more than lines, optional
        Places along the wire where the lines of the chain begin and the last one ends, as far as
        they are pulled. Without them the lines share the whole wire by their lengths.
    pitch : float [m], optional     distance of hog rings; without it, pulled all along
    start, end : float [m]          part of the whole length that is pulled; ``end`` None is all
    limit : float [N], optional     largest pull allowed on one ring
    slides : the rings slide along the wire, and pull across it only; else they hold their places
    """

    name: str
    line: str = ""
    chain: tuple[str, ...] = ()
    wire: str
    stage: str
    junctions: tuple[float, ...] = ()
    pitch: float | None = None
    start: float = 0.0
    end: float | None = None
    limit: float | None = None
    slides: bool = False

    @property
    def lines(self) -> tuple[str, ...]:
        """The lines that are pulled, in their order along the wire."""
        return self.chain or (self.line,)


@dataclass(frozen=True, slots=True, kw_only=True)
class Frame:
    """Free edges, one after the other, pulled to a curve below the foam.

    Parameters
    ----------
    junctions : float [m], one more than edges, optional
        Places along the curve where the edges begin and the last one ends. Without them the edges
        share the whole curve by their lengths.
    """

    name: str
    edges: tuple[str, ...]
    curve: str
    stage: str
    junctions: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True, kw_only=True)
class Border:
    """One free border of a cover: a closed line of free edges, and the curve they are pulled to.

    Parameters
    ----------
    name : ``border``, or ``border.PLACE`` where a cover has several
    edges : names of the panels' free edges, one after the other
    curve : (k, 3) float64 [m]     closed, the first point repeated
    junctions : float [m], one more than edges    where along the curve the edges begin and end
    """

    name: str
    edges: tuple[str, ...]
    curve: FloatArray
    junctions: tuple[float, ...]

    def frame(self, stage: str) -> Frame:
        """Return the tie that pulls the edges to the curve, which has the border's name."""
        return Frame(
            name=self.name, edges=self.edges, curve=self.name, stage=stage, junctions=self.junctions
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class ZoneBox:
    """A user's rectangle in pattern coordinates [m] with a visibility class."""

    name: str
    panel: str
    low: FloatArray
    high: FloatArray
    visibility: Literal["A", "B", "C"] = "A"

    def __post_init__(self) -> None:
        floats(self, "low", 2, most=FARTHEST)
        floats(self, "high", 2, most=FARTHEST)


@dataclass(frozen=True, slots=True, kw_only=True)
class Limit:
    """A limit of ``[accept]``: a zone's name or class, the measure, the largest good value."""

    zone: str
    measure: str
    maximum: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Verdict:
    """One limit of ``[accept]`` and what was found.

    Parameters
    ----------
    resolved : whether the result can be judged; no limit is kept by one that cannot
    """

    limit: Limit
    value: float
    resolved: bool

    @property
    def kept(self) -> bool:
        """Whether the result is resolved, and its value at most the limit's maximum."""
        return self.resolved and self.value <= self.limit.maximum

    @property
    def note(self) -> str:
        """What stands after the value: that it is of a result that is not resolved."""
        return "" if self.resolved else ", not resolved"


@dataclass(frozen=True, slots=True, kw_only=True)
class Freedom:
    """What a correction may change, and by how much.

    Parameters
    ----------
    frozen : names of edges, of seams with all their edges, of hooks, wires, and of panels below
        which the foam stays
    edge, length, hook, foam : float [m]
        largest offset of an edge, change of its length, of a hook's depth, of the foam's height;
        0 freezes all of a kind
    symmetric : what mirrors each other moves together where both gain by it
    corrections : most of them that are made; what moves together counts as one
    """

    frozen: tuple[str, ...] = ()
    edge: float = 0.005
    length: float = 0.015
    hook: float = 0.010
    foam: float = 0.0
    symmetric: bool = True
    corrections: int = 3


@dataclass(frozen=True, slots=True, kw_only=True)
class Design:
    """The shape that the finished cover is to have.

    Parameters
    ----------
    vertices : (n, 3) float64 [m]; faces : (m, 3) int64, normals outward; need not be closed
    panel : (m,) int64, index into ``panel_names``; two panels share the vertices of their seam
    visible : whether it is the visible side that was drawn, not the middle of the cover
    seam_lines : edge, smaller vertex first -> name of the line along it, such as a dart's
    """

    vertices: FloatArray
    faces: IntArray
    panel: IntArray
    panel_names: tuple[str, ...]
    visible: bool = False
    seam_lines: Mapping[tuple[int, int], str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        floats(self, "vertices", None, 3)
        ints(self, "faces", None, 3, below=len(self.vertices))
        ints(self, "panel", len(self.faces), below=len(self.panel_names))


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Scene:
    """Everything a run needs, checked and in SI units.

    Parameters
    ----------
    digest : sha256 of the scene file and of every file it names
    materials : panel name -> Material
    placement : panel name -> Pose; a panel without one is laid out over the foam
    design : what the finished shape is compared with, if given
    hem : whether seam allowances are folded inward; if not, seams are free hinges
    allowed : contradictions out of ``ALLOWED`` that a check lets pass
    element_sizes : panel name -> float [m]     of panels that are meshed finer or coarser
    surroundings : name of what is around the seat in pictures, of ``SURROUNDINGS``; never in scores
    tolerance : float [1]       of zone means of W2, from which the mesh follows; None: it is
        ``element_size``, which is that of the first mesh only where there is a tolerance
    element_size : float [m]; smallest_notch : float [m], below which reading closed cuts
    c_threshold : float [1/m]
    textures : name -> Appearance, or None for the panels' own materials
    seam_kinds : seam -> how it is sewn; of others see ``Cover``
    """

    name: str
    path: Path | None
    digest: str
    pattern: Pattern
    foam: Foam
    materials: MappingProxyType[str, Material]
    placement: MappingProxyType[str, Pose]
    stages: tuple[Stage, ...]
    hooks: tuple[Hook, ...] = ()
    frames: tuple[Frame, ...] = ()
    rigs: tuple[Rig, ...]
    cameras: tuple[Camera, ...]
    textures: MappingProxyType[str, Appearance | None] = field(
        default_factory=lambda: MappingProxyType({"as built": None})
    )
    surroundings: str = "plain"
    boxes: tuple[ZoneBox, ...] = ()
    limits: tuple[Limit, ...] = ()
    improve: Freedom = field(default_factory=Freedom, metadata=NO_RESULT)
    design: Design | None = None
    hem: bool = False
    allowed: tuple[str, ...] = ()
    thread: Thread = field(default_factory=Thread)
    seam_kinds: MappingProxyType[str, SeamKind] = field(
        default_factory=lambda: MappingProxyType({})
    )
    element_size: float
    element_sizes: MappingProxyType[str, float] = field(
        default_factory=lambda: MappingProxyType({})
    )
    tolerance: float | None = None
    smallest_notch: float = 0.005
    seed: int = 0
    curvature: CurvatureMode = "tensor"
    c_threshold: float = 20.0

    def __post_init__(self) -> None:
        positive(self, "element_size", "c_threshold")
        surroundings_named(self.surroundings)

    def __repr__(self) -> str:
        return (
            f"Scene({self.name!r}: {len(self.pattern.panels)} panels, "
            f"{len(self.pattern.seams)} seams, {len(self.textures)} textures, "
            f"{len(self.rigs)} rigs)"
        )

    @property
    def mesh_asked_by(self) -> str:
        """Which field the mesh follows from: ``tolerance`` where there is one."""
        return "element_size" if self.tolerance is None else "tolerance"

    def stage_of(self, seam: str) -> Stage:
        """Return the stage in which a seam closes: the one that names it, else the first."""
        return next((stage for stage in self.stages if seam in stage.seams), self.stages[0])

    def limited_zones(self, limit: Limit, zones: Iterable[str]) -> tuple[str, ...]:
        """Of ``zones``, those that a limit is on: one zone, or all boxes of a class."""
        classes = {box.name: box.visibility for box in self.boxes}
        return tuple(zone for zone in zones if limit.zone in (zone, classes.get(zone)))
