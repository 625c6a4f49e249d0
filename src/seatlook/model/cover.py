"""The meshed cover before solving, the solved one, and its wrinkle map."""

from __future__ import annotations

from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Literal

import numpy as np

from seatlook.errors import InputError
from seatlook.model._check import (
    FARTHEST,
    LARGEST_STRAIN,
    FloatArray,
    IntArray,
    floats,
    in_range,
    ints,
)
from seatlook.model.criteria import Criteria
from seatlook.model.fastenings import SeamKind, Thread, Wire
from seatlook.model.material import Foam, Material
from seatlook.model.stage import Stage

Status = Literal["converged", "not converged"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Points:
    """Points on mesh edges: ``x = w0 x[v0] + w1 x[v1]``, so they need no vertex of their own.

    Parameters
    ----------
    vertices : (s, 2) int64; weights : (s, 2) float64, each row sums to 1
    """

    vertices: IntArray
    weights: FloatArray

    def __post_init__(self) -> None:
        ints(self, "vertices", None, 2, below=2**31)
        floats(self, "weights", len(self.vertices), 2, most=2.0)

    def __len__(self) -> int:
        return len(self.vertices)

    def at(self, x: FloatArray) -> FloatArray:
        """Return the points (s, d) for vertex positions ``x`` (n, d)."""
        return np.asarray(np.einsum("sk,skd->sd", self.weights, x[self.vertices]))


@dataclass(frozen=True, slots=True, kw_only=True)
class Stitching:
    """Pairs of points that a seam pulls together.

    Parameters
    ----------
    a, b : Points               same length s
    length : (s,) float64 [m]   seam length that each pair stands for
    stage : name of the stage in which the seam closes
    notches : (k,) float64      pairs at which notches of both sides meet, counted from 0; one
                                between two pairs is a fraction
    """

    name: str
    a: Points
    b: Points
    length: FloatArray
    stage: str
    notches: FloatArray = field(default_factory=lambda: np.zeros(0))

    def __post_init__(self) -> None:
        floats(self, "length", len(self.a))
        floats(self, "notches", None)
        if len(self.a) != len(self.b):
            raise InputError.single(
                f"seam {self.name}", got=f"{len(self.a)} and {len(self.b)} points", expected="pairs"
            )


@dataclass(frozen=True, slots=True, kw_only=True)
class Anchor:
    """Points of the cover that are pulled to fixed targets: a wire (hook) or the frame.

    Parameters
    ----------
    points : Points; target : (s, 3) float64 [m]; length : (s,) float64 [m]
    at : (s,) float64 [m], optional   place of every point along the line that is pulled
    limit : float [N], optional       largest pull on one point that is allowed
    wire : Wire, optional             along which the points slide once they are drawn in
    """

    name: str
    kind: Literal["hook", "frame"]
    points: Points
    target: FloatArray
    length: FloatArray
    stage: str
    at: FloatArray | None = None
    limit: float | None = None
    wire: Wire | None = None

    def __post_init__(self) -> None:
        floats(self, "target", len(self.points), 3, most=FARTHEST)
        floats(self, "length", len(self.points))
        if self.at is not None:
            floats(self, "at", len(self.points))
        if self.wire is not None and len(self.wire.place) != len(self.points):
            raise InputError.single(
                f"{self.kind} {self.name}.wire",
                got=f"{len(self.wire.place)} places",
                expected=f"one for each of {len(self.points)} points",
            )


@dataclass(frozen=True, slots=True, kw_only=True)
class Hem:
    """Seam allowances folded inward: the second layer below the seams, and the folds.

    Parameters
    ----------
    bending : (m, 3, 3) float64 [N m]   what the allowance below a face adds to its bending matrix
    density : (m,) float64 [kg/m2]      and to its mass
    lift : (n,) float64 [m]             how much higher it keeps a vertex above the foam
    near : (k, 2) int64                 rim edges of the coarser side of the seams
    far : (p, 2) int64                  rim edges of the other side, each over against a near one,
    row : (p,) int64                    which this is,
    weight : (p,) float64               and the share of the near edge that they meet on
    length : (k,) float64 [m]           of the near edge
    stiffness : (k,) float64 [N]        moment per length and angle of the two folds in series
    """

    bending: FloatArray
    density: FloatArray
    lift: FloatArray
    near: IntArray
    far: IntArray
    row: IntArray
    weight: FloatArray
    length: FloatArray
    stiffness: FloatArray

    def __post_init__(self) -> None:
        k, n = len(self.near), len(self.lift)
        floats(self, "bending", None, 3, 3)
        floats(self, "density", len(self.bending))
        floats(self, "lift", None)
        ints(self, "near", None, 2, below=n)
        ints(self, "far", None, 2, below=n)
        ints(self, "row", len(self.far), below=k)
        floats(self, "weight", len(self.far))
        floats(self, "length", k)
        floats(self, "stiffness", k)


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Cover:
    """All panels meshed and placed, with what will pull on them.

    Parameters
    ----------
    rest : (n, 2) float64 [m]     X, panel by panel, first axis along the warp
    uv : (n, 2) float64 [m]       the same in pattern coordinates, for textures
    positions : (n, 3) float64 [m]  x before sewing, imperfection included
    faces : (m, 3) int64          counter-clockwise in ``rest``, so the normal is the visible side
    panel : (m,) int64            index into ``panel_names`` and ``materials``
    zone : (m,) int64             index into ``zone_names``
    element_size : float [m]      mean edge length h
    seam_kinds : seam -> how it is sewn, as far as that is seen; others are French, those that a
        hook pulls into a trench are plain and flat
    criteria : how it is assessed: the scene's mode, and the thresholds of its panels
    scene_digest : of everything that it was made from, see ``assembly.digest``
    """

    rest: FloatArray
    uv: FloatArray
    positions: FloatArray
    faces: IntArray
    panel: IntArray
    panel_names: tuple[str, ...]
    materials: tuple[Material, ...]
    zone: IntArray
    zone_names: tuple[str, ...]
    stitchings: tuple[Stitching, ...] = ()
    anchors: tuple[Anchor, ...] = ()
    hem: Hem | None = None
    stages: tuple[Stage, ...] = ()
    foam: Foam | None = None
    thread: Thread = field(default_factory=Thread)
    seam_kinds: MappingProxyType[str, SeamKind] = field(
        default_factory=lambda: MappingProxyType({})
    )
    criteria: Criteria | None = None
    element_size: float
    seed: int = 0
    scene_digest: str = ""

    def __post_init__(self) -> None:
        n, m = len(self.rest), len(self.faces)
        if m == 0:
            raise InputError.single("Cover.faces", got="none", expected="at least one")
        floats(self, "rest", None, 2, most=FARTHEST)
        floats(self, "uv", n, 2, most=FARTHEST)
        floats(self, "positions", n, 3, most=FARTHEST)
        ints(self, "faces", None, 3, below=n)
        in_range(self, "element_size", 0.0, FARTHEST)
        ints(self, "panel", m, below=len(self.panel_names))
        ints(self, "zone", m, below=len(self.zone_names))
        if len(self.materials) != len(self.panel_names):
            raise InputError.single(
                "Cover.materials",
                got=f"{len(self.materials)}",
                expected=f"one for each of {len(self.panel_names)} panels",
            )
        self._check_points(n)
        if self.hem is not None and (len(self.hem.density), len(self.hem.lift)) != (m, n):
            raise InputError.single(
                "Cover.hem",
                got=f"{len(self.hem.density)} faces and {len(self.hem.lift)} vertices",
                expected=f"{m} and {n}",
            )

    def _check_points(self, count: int) -> None:
        """Refuse ties to vertices that there are not."""
        ties = {f"seam {s.name}": (s.a, s.b) for s in self.stitchings}
        ties |= {f"{a.kind} {a.name}": (a.points, a.points) for a in self.anchors}
        for name, sides in ties.items():
            most = max(int(points.vertices.max(initial=0)) for points in sides)
            if most >= count:
                raise InputError.single(name, got=f"vertex {most}", expected=f"0..{count - 1}")

    def __repr__(self) -> str:
        return (
            f"Cover({len(self.panel_names)} panels, {len(self.rest)} vertices, "
            f"h {1e3 * self.element_size:.3g} mm)"
        )

    @property
    def thickness(self) -> FloatArray:
        """Thickness t per face, (m,) [m]."""
        return np.array([m.fabric.thickness for m in self.materials])[self.panel]

    @property
    def rest_area(self) -> FloatArray:
        """Area per face at rest, (m,) [m2]."""
        p = self.rest[self.faces]
        u, v = p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]
        return np.asarray(0.5 * (u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]))


@dataclass(frozen=True, slots=True, kw_only=True)
class Strains:
    """In-plane strains of elements on both surfaces and in the middle, each (m, 2, 2) float64.

    Parameters
    ----------
    thickness : (m,) float64 [m]
    panel : (m,) int64    which threshold counts for each
    """

    top: FloatArray
    mid: FloatArray
    bottom: FloatArray
    thickness: FloatArray
    panel: IntArray


@dataclass(frozen=True, slots=True, kw_only=True, repr=False)
class Solution:
    """The solved cover; everything needed to restart it, map it or draw it.

    Parameters
    ----------
    positions, velocities : (n, 3) float64 [m], [m/s]
    strain_top, strain_mid, strain_bottom : (m, 2, 2) float64 [1]
        Green strain in warp/weft axes on both faces and the mid surface.
    multipliers : name of stitching or anchor -> (s, 3) [N], the part that is not the spring's
    forces : name of stitching or anchor -> (s, 3) [N], whole pull on side a or on the cover
    friction_anchor : (n, 3) float64 [m]   where each vertex last stuck to the foam; nan = free
    strain_peak : (m, 2 or 3) float64 [1]
        largest strains so far along warp and weft, -inf = none, of fabrics that unload another way;
        where shear has friction, also the shear 2 E12 at which that rests
    history : column -> (k,), one row per step: time, energy, residual, gap, iterations, ...
    figures : name -> final value, e.g. "seam_gap_max" [m], "residual" [1], "cpu_seconds"
    settings : how it was solved: revision of the solver, method, time step
    """

    cover: Cover
    positions: FloatArray
    velocities: FloatArray
    strain_top: FloatArray
    strain_mid: FloatArray
    strain_bottom: FloatArray
    multipliers: MappingProxyType[str, FloatArray] = field(
        default_factory=lambda: MappingProxyType({})
    )
    forces: MappingProxyType[str, FloatArray] = field(default_factory=lambda: MappingProxyType({}))
    friction_anchor: FloatArray
    strain_peak: FloatArray | None = None
    stage: str
    status: Status
    reason: str = ""
    history: MappingProxyType[str, FloatArray] = field(default_factory=lambda: MappingProxyType({}))
    figures: MappingProxyType[str, float] = field(default_factory=lambda: MappingProxyType({}))
    settings: str = ""
    version: str = ""

    def __post_init__(self) -> None:
        n, m = len(self.cover.rest), len(self.cover.faces)
        floats(self, "positions", n, 3, most=FARTHEST)
        floats(self, "velocities", n, 3, most=1e6)
        for name in ("strain_top", "strain_mid", "strain_bottom"):
            floats(self, name, m, 2, 2, most=LARGEST_STRAIN)
        floats(self, "friction_anchor", n, 3, finite=False)
        if self.strain_peak is not None:
            columns = 3 if np.ndim(self.strain_peak) == 2 and self.strain_peak.shape[1] == 3 else 2
            floats(self, "strain_peak", m, columns, finite=False)

    def __repr__(self) -> str:
        reason = f": {self.reason}" if self.reason else ""
        return f"Solution({self.cover!r}, {self.stage}, {self.status}{reason})"

    @property
    def strains(self) -> Strains:
        """Green strains in warp/weft axes, with the thickness and the panel of each face."""
        return Strains(
            top=self.strain_top,
            mid=self.strain_mid,
            bottom=self.strain_bottom,
            thickness=self.cover.thickness,
            panel=self.cover.panel,
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class WrinkleMap:
    """Indices per face, each (m,) float64.

    Parameters
    ----------
    c : [1/m]                       curvature index, positive on a crown seen from outside
    w1, w2 : [1]                    C / C_threshold and its wrinkle side, w2 >= 0
    r_stretch : [1] in [0, 1]       share of stretch
    w_stretch, w_compression : [1]  w2 split by cause; they add up to w2
    """

    c: FloatArray
    w1: FloatArray
    w2: FloatArray
    r_stretch: FloatArray
    w_stretch: FloatArray
    w_compression: FloatArray

    def __post_init__(self) -> None:
        m = len(self.c)
        for name in ("c", "w1", "w2", "r_stretch", "w_stretch", "w_compression"):
            floats(self, name, m)
