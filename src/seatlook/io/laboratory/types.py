"""What a laboratory hands over: tests of a cloth or a foam, each with its specimens."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from types import MappingProxyType
from typing import Literal

from seatlook.model import FloatArray, IntArray

TestKind = Literal[
    "tensile", "shear", "bias-extension", "bending", "cantilever", "hanging-strip",
    "compression", "numbers", "foam", "incline", "surface",
]  # fmt: skip
Direction = Literal["warp", "weft", "bias"]
Sides = Literal["held", "free"]


@dataclass(frozen=True, slots=True, kw_only=True)
class Specimen:
    """One piece that was tested, in the order of the record.

    Parameters
    ----------
    x, y : (k,) float64   what was prescribed and what was read, SI, see ``LabTest``
    across : (k,) float64 [1], optional   contraction across a strip
    file : Path; lines : (k,) int64        where every point stands
    """

    x: FloatArray
    y: FloatArray
    across: FloatArray | None = None
    file: Path
    lines: IntArray


@dataclass(frozen=True, slots=True, kw_only=True)
class LabTest:
    """One test.

    ============== ============================== ============================
    kind           x                              y
    ============== ============================== ============================
    tensile        engineering strain [1]         force per width [N/m]
    shear          shear angle [rad]              force per width [N/m]
    bias-extension displacement [m]               force [N]
    bending        curvature [1/m]                moment per width [N]
    cantilever     overhang [m]                   angle of the chord [rad]
    hanging-strip  distance from the clamp [m]    depth [m]
    compression    pressure [Pa]                  thickness [m]
    foam           engineering strain [1]         stress [Pa]
    incline        angle at which it slides [rad] the same
    surface        height of the profile [m]      the same
    numbers        none                           none: see ``numbers``
    ============== ============================== ============================

    Parameters
    ----------
    name : as spelled in the file, "test[2]"
    direction : of the specimen's length, or of the axis that is bent over
    sides : of a strip: held (no contraction, as in KES) or free
    length, width : float [m], or None
    numbers : name -> value in SI, what the kind asks for besides its curve
    knots : (k,) float64 [1], or None   strains at which the curve may change its course
    """

    kind: TestKind
    name: str
    direction: Direction | None = None
    sides: Sides = "held"
    length: float | None = None
    width: float | None = None
    specimens: tuple[Specimen, ...] = ()
    numbers: MappingProxyType[str, float] = field(default_factory=lambda: MappingProxyType({}))
    knots: FloatArray | None = None

    @property
    def title(self) -> str:
        """Kind and direction in words."""
        return " ".join(filter(None, (self.kind, self.direction)))


@dataclass(frozen=True, slots=True, kw_only=True)
class Look:
    """What instruments say of the surface: a colour and a gloss, or a goniometer's table.

    Parameters
    ----------
    lab : (3,) float64         CIE L*a*b* under D65 by ``geometry``
    gloss_60 : gloss units at 60 degrees
    angles : (k, 6) float64    theta_i, phi, theta_o [rad], reflectance factors R, G, B (linear)
    file : where it stands
    """

    lab: FloatArray | None = None
    geometry: str = "45/0"
    gloss_60: float | None = None
    angles: FloatArray | None = None
    file: Path


@dataclass(frozen=True, slots=True, kw_only=True)
class Laboratory:
    """All tests of one material.

    Parameters
    ----------
    base : name or path of the material that stands in for what was not measured
    place, date : of the laboratory, for the sources
    thickness [m], density [kg/m2] : as measured, or None
    """

    file: Path
    base: str
    place: str
    date: str
    thickness: float | None
    density: float | None
    tests: tuple[LabTest, ...]
    look: Look | None = None
