"""Units of test rigs, SI and those that the KES instruments print."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from types import MappingProxyType

GF_PER_CM = 0.980665  # N/m
STANDARD_GRAVITY = 9.80665  # m/s2


@dataclass(frozen=True, slots=True)
class Unit:
    """A factor to SI; ``per`` is the size of the specimen [m] by which the reading is divided."""

    factor: float
    per: str = ""


Units = MappingProxyType[str, Unit]

STRAIN: Units = MappingProxyType(
    {"1": Unit(1.0), "%": Unit(0.01), "mm": Unit(1e-3, "length"), "m": Unit(1.0, "length")}
)
FORCE_PER_WIDTH: Units = MappingProxyType(
    {
        "N/m": Unit(1.0),
        "kN/m": Unit(1e3),
        "N/cm": Unit(100.0),
        "N/mm": Unit(1e3),
        "gf/cm": Unit(GF_PER_CM),
        "N": Unit(1.0, "width"),
        "gf": Unit(STANDARD_GRAVITY * 1e-3, "width"),
        "kgf": Unit(STANDARD_GRAVITY, "width"),
    }
)
FORCE: Units = MappingProxyType(
    {"N": Unit(1.0), "gf": Unit(STANDARD_GRAVITY * 1e-3), "kgf": Unit(STANDARD_GRAVITY)}
)
LENGTH: Units = MappingProxyType({"mm": Unit(1e-3), "cm": Unit(1e-2), "m": Unit(1.0)})
ANGLE: Units = MappingProxyType({"deg": Unit(math.pi / 180.0), "rad": Unit(1.0)})
CURVATURE: Units = MappingProxyType({"1/m": Unit(1.0), "1/cm": Unit(100.0), "1/mm": Unit(1000.0)})
MOMENT_PER_WIDTH: Units = MappingProxyType(
    {
        "N": Unit(1.0),
        "N m/m": Unit(1.0),
        "mN": Unit(1e-3),
        "gf cm/cm": Unit(STANDARD_GRAVITY * 1e-3),
        "N mm": Unit(1e-3, "width"),
        "gf cm": Unit(STANDARD_GRAVITY * 1e-5, "width"),
    }
)
PRESSURE: Units = MappingProxyType(
    {
        "Pa": Unit(1.0),
        "kPa": Unit(1e3),
        "gf/cm2": Unit(STANDARD_GRAVITY * 10.0),
        "N/cm2": Unit(1e4),
    }
)
# What KES prints as single numbers: name of the key -> factor to SI.
KES_NUMBERS: MappingProxyType[str, float] = MappingProxyType(
    {
        "lt": 1.0,
        "wt_gf_cm_per_cm2": GF_PER_CM,
        "rt_percent": 0.01,
        "peak_gf_per_cm": GF_PER_CM,
        "g_gf_per_cm_deg": GF_PER_CM * 180.0 / math.pi,
        "full_2hg_gf_per_cm": GF_PER_CM,
        "full_2hg5_gf_per_cm": GF_PER_CM,
        "b_gf_cm2_per_cm": STANDARD_GRAVITY * 1e-5,
        "full_2hb_gf_cm_per_cm": STANDARD_GRAVITY * 1e-3,
    }
)
_BRACKETED = re.compile(r"[\[(]\s*([^\])]+?)\s*[\])]")


def unit_in_head(head: str) -> str | None:
    """Return the unit that a column's head names in brackets.

    Examples
    --------
    >>> unit_in_head("Force [N]"), unit_in_head("strain (%)"), unit_in_head("load")
    ('N', '%', None)
    """
    match = _BRACKETED.search(head)
    return match[1].replace("²", "2").replace("·", " ") if match else None
