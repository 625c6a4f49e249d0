"""Every index and measure by its name: maps, zones, limits, exports and pages read this list.

A new one is a function of a :class:`Surface` in a file of this room, and one entry here.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np

from seatlook.errors import InputError
from seatlook.mesh.statistics import quantile
from seatlook.model import FloatArray
from seatlook.wrinkle.measures import (
    excess_strain,
    signed_ratio,
    tension_state,
    w2_net,
)
from seatlook.wrinkle.surface import Surface

# Which ends the colours of a map have: those of W2, those of W2 and below 0, or of the values.
Ends = Literal["w2", "w1", "values"] | tuple[float, float]


def mean(values: FloatArray, weight: FloatArray) -> float:
    """Mean weighted by area."""
    return float(values @ weight / weight.sum())


@dataclass(frozen=True, slots=True)
class Statistic:
    """A figure of a zone: a function of values and areas (m,), its label, the factor to it."""

    of: Callable[[FloatArray, FloatArray], float]
    label: str
    factor: float = 1.0

    def __call__(self, values: FloatArray, weight: FloatArray) -> float:
        """Return the figure of values (m,) with areas (m,)."""
        return self.of(values, weight)


def _share(test: Callable[[FloatArray], np.ndarray]) -> Callable[[FloatArray, FloatArray], float]:
    return lambda values, weight: mean(test(values).astype(float), weight)


STATISTICS: Mapping[str, Statistic] = {
    "mean": Statistic(mean, "mean"),
    "p95": Statistic(lambda values, weight: quantile(values, weight, 0.95), "95 %"),
    "area_share": Statistic(_share(lambda v: v > 1), "above 1 [% of area]", 100.0),
    "slack_share": Statistic(_share(lambda v: v == 0), "slack [% of area]", 100.0),
    "wrinkled_share": Statistic(_share(lambda v: v == 1), "wrinkled [% of area]", 100.0),
}


@dataclass(frozen=True, slots=True, kw_only=True)
class Index:
    """One index or measure, face by face.

    Parameters
    ----------
    name : key in files, such as "w_stretch"
    symbol : as it is written in texts, such as "W_stretch"
    unit : of ``values``; "1" for a number
    limits : smallest and largest value that is possible
    meaning : one sentence for a reader who does not know the equation
    of : function of a Surface, (m,) float64 in SI units
    scale : from SI to ``unit``
    statistics : names of ``STATISTICS``: figures of a zone, and what [accept] can limit
    listed : those of them that the page's table of zones shows; None for all
    ends : which ends the colours of its map have
    own_range : whether it is drawn once more in a range of its own values
    whole_shape : whether it needs the shape that was meant, which takes as long as all the others
    """

    name: str
    symbol: str
    unit: str
    limits: tuple[float, float]
    meaning: str
    of: Callable[[Surface], FloatArray]
    scale: float = 1.0
    statistics: tuple[str, ...] = ("mean",)
    listed: tuple[str, ...] | None = None
    ends: Ends = "values"
    own_range: bool = False
    whole_shape: bool = False

    def __post_init__(self) -> None:
        if not (self.name.isidentifier() and self.name.islower()):
            raise InputError.single(
                "index", got=repr(self.name), expected="a name of small letters, digits and _"
            )
        for statistic in self.statistics:
            if statistic not in STATISTICS:
                raise InputError.single(
                    f"index {self.name}", got=statistic, expected=f"one of {', '.join(STATISTICS)}"
                )

    @property
    def key(self) -> str:
        """The name with the unit, as it stands in tables: ``c_per_mm``."""
        return self.name if self.unit == "1" else f"{self.name}_{_UNIT_NAMES[self.unit]}"

    @property
    def export_name(self) -> str:
        """Name in files for other programs, the same in all: ``_W2``, as glTF asks for."""
        return f"_{self.key.upper()}"

    @property
    def figures(self) -> tuple[str, ...]:
        """Names of its figures of a zone: ``w2_mean``, ``w2_p95``."""
        return tuple(f"{self.key}_{statistic}" for statistic in self.statistics)

    @property
    def columns(self) -> tuple[tuple[str, str, float], ...]:
        """Figure, head and factor of each column of the page's table of zones."""
        unit = "" if self.unit == "1" else f" [{self.unit}]"
        shown = self.statistics if self.listed is None else self.listed
        return tuple(
            (
                f"{self.key}_{name}",
                f"{self.symbol} {s.label}{unit if s.factor == 1 else ''}",
                s.factor,
            )
            for name, s in ((name, STATISTICS[name]) for name in shown)
        )

    def values(self, surface: Surface) -> FloatArray:
        """Values (m,) float64 in ``unit``.

        Raises
        ------
        InputError
            The function gives something else than one number per face.
        """
        out = np.asarray(self.of(surface), dtype=float)
        count = len(surface.solution.cover.faces)
        if out.shape != (count,):
            raise InputError.single(
                f"index {self.name}", got=f"shape {out.shape}", expected=f"({count},)"
            )
        return out if self.scale == 1.0 else self.scale * out


_UNIT_NAMES = {"1/mm": "per_mm", "1/m": "per_m", "mm": "mm", "%": "percent", "deg": "deg"}
_W2_STATISTICS = ("mean", "p95", "area_share")
_ALL: tuple[Index, ...] = (
    Index(
        name="w1",
        symbol="W1",
        unit="1",
        limits=(-math.inf, math.inf),
        meaning="curvature over the threshold: crowns above 0, valleys below",
        of=lambda s: s.indices.w1,
        listed=(),
        ends="w1",
    ),
    Index(
        name="w2",
        symbol="W2",
        unit="1",
        limits=(0.0, math.inf),
        meaning="valleys only: 1 is a wrinkle as deep as the threshold",
        of=lambda s: s.indices.w2,
        statistics=_W2_STATISTICS,
        ends="w2",
    ),
    Index(
        name="w_stretch",
        symbol="W_stretch",
        unit="1",
        limits=(0.0, math.inf),
        meaning="the part of W2 where the fabric is stretched one way",
        of=lambda s: s.indices.w_stretch,
        ends="w2",
        own_range=True,
    ),
    Index(
        name="w_compression",
        symbol="W_compression",
        unit="1",
        limits=(0.0, math.inf),
        meaning="the part of W2 where there is too much fabric",
        of=lambda s: s.indices.w_compression,
        ends="w2",
        own_range=True,
    ),
    Index(
        name="w2_net",
        symbol="W2 net",
        unit="1",
        limits=(0.0, math.inf),
        meaning="valleys that the design does not ask for: a trench or bolster root is no wrinkle",
        of=w2_net,
        statistics=_W2_STATISTICS,
        listed=("mean", "area_share"),
        ends="w2",
        whole_shape=True,
    ),
    Index(
        name="w2_net_stretch",
        symbol="W2 net, stretch",
        unit="1",
        limits=(0.0, math.inf),
        meaning="the part of W2 net where the fabric is stretched one way",
        of=lambda s: w2_net(s) * signed_ratio(s.strain_mid),
        listed=(),
        ends="w2",
        whole_shape=True,
    ),
    Index(
        name="w2_net_compression",
        symbol="W2 net, compression",
        unit="1",
        limits=(0.0, math.inf),
        meaning="the part of W2 net where there is too much fabric",
        of=lambda s: w2_net(s) * (1.0 - signed_ratio(s.strain_mid)),
        listed=(),
        ends="w2",
        whole_shape=True,
    ),
    Index(
        name="c",
        symbol="C",
        unit="1/mm",
        scale=1e-3,
        limits=(-math.inf, math.inf),
        meaning="curvature of the bent cover: crowns above 0, valleys below",
        of=lambda s: s.indices.c,
        listed=(),
    ),
    Index(
        name="r_stretch",
        symbol="R_stretch",
        unit="1",
        limits=(0.0, 1.0),
        meaning="how far the stretch is to one side: 0 the same both ways, 1 one way only",
        of=lambda s: s.indices.r_stretch,
        listed=(),
        ends=(0.0, 1.0),
    ),
    Index(
        name="signed_ratio",
        symbol="signed ratio",
        unit="1",
        limits=(0.0, 1.0),
        meaning="0 stretched the same both ways, 0.5 one way, 1 sheared",
        of=lambda s: signed_ratio(s.strain_mid),
        listed=(),
        ends=(0.0, 1.0),
    ),
    Index(
        name="excess_strain",
        symbol="excess strain",
        unit="%",
        scale=100.0,
        limits=(0.0, math.inf),
        meaning="fabric in excess, as a share of its length",
        of=excess_strain,
        statistics=("mean", "p95"),
        listed=("mean",),
    ),
    Index(
        name="tension_state",
        symbol="tension state",
        unit="1",
        limits=(0.0, 2.0),
        meaning="0 slack, 1 wrinkled: pulled one way and too long the other, 2 taut",
        of=lambda s: tension_state(s.strain_mid, s.membrane).astype(float),
        statistics=("slack_share", "wrinkled_share"),
        listed=("wrinkled_share",),
        ends=(0.0, 2.0),
    ),
)
INDICES: dict[str, Index] = {index.name: index for index in _ALL}


def register(index: Index) -> Index:
    """Add an index: it appears in maps, zones, limits, exports and on pages.

    Raises
    ------
    InputError
        There is one of this name.

    Examples
    --------
    >>> index = register(Index(name="flat", symbol="flat", unit="1", limits=(0.0, 1.0),
    ...     meaning="1 where nothing bends", of=lambda s: (abs(s.indices.c) < 1.0).astype(float)))
    >>> INDICES.pop("flat").figures
    ('flat_mean',)
    """
    if index.name in INDICES:
        raise InputError.single("index", got=repr(index.name), expected="a new name")
    INDICES[index.name] = index
    return index


def figure_names() -> tuple[str, ...]:
    """Names of all figures of a zone, in the order of the table."""
    return tuple(name for index in INDICES.values() for name in index.figures)
