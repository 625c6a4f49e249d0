"""Every key of a scene file, with its type, range and default.

docs/reference/scene.md explains them.
"""

from __future__ import annotations

from seatlook.io.colour import Colour
from seatlook.io.pattern.units import UNITS as PATTERN_UNITS
from seatlook.io.scene.views import CAMERA, RIG
from seatlook.io.schema import (
    FAR_MM,
    MM,
    THRESHOLD,
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
)
from seatlook.io.surface.axes import UNITS, UPS
from seatlook.model.fastenings import SEAM_KINDS
from seatlook.model.light.surroundings import SURROUNDINGS
from seatlook.model.scene import ALLOWED, ELEMENT_SIZES, LARGEST_SEED, SCORE_MEASURES, TOLERANCES
from seatlook.model.stage import LONGEST, RAMPS, SHORTEST
from seatlook.wrinkle import INDICES

AS_BUILT = "as built"
LOWEST_PERCENT, HIGHEST_PERCENT = (100 * share for share in TOLERANCES)
FINEST_MM, COARSEST_MM = (1e3 * size for size in ELEMENT_SIZES)
_NAME = Text(required=True)

KEYS: dict[str, Kind] = {
    "schema": Integer(low=1, high=1, required=True),
    "name": Text(),
    "hem": Flag(default=False),
    "pattern": Table(
        {
            "file": Text(required=True),
            "seams": Text(required=True),
            "size": Text(),
            "units": Text(choices=PATTERN_UNITS),
            "encoding": Text(),
            "grain_deg": Number(low=-360, high=360),
            "allowance_mm": Number(above=0, high=100, scale=MM),
            "layers": Named(Text()),
            "material": Text(),
        },
        required=True,
    ),
    "foam": Table(
        {
            "file": Text(required=True),
            "unit": Text(choices=UNITS, required=True),
            "up": Text(choices=UPS),
            "material": Text(required=True),
            "curves": Text(),
            "close": Flag(default=False),
            "thicken_mm": Number(above=0, high=500, scale=MM),
            "unite": Flag(default=False),
            "body": Integer(low=1),
            "smooth_mm": Number(above=0, high=500, scale=MM),
        },
        required=True,
    ),
    "design": Table(
        {
            "file": Text(),
            "unit": Text(choices=UNITS, default="mm"),
            "up": Text(choices=UPS),
            "side": Text(choices=("middle", "visible"), default="middle"),
        }
    ),
    "check": Table({"allow": Texts(choices=ALLOWED, default=())}),
    "mesh": Table(
        {
            "element_size_mm": Number(low=FINEST_MM, high=COARSEST_MM, scale=MM),
            "tolerance_percent": Number(low=LOWEST_PERCENT, high=HIGHEST_PERCENT, scale=0.01),
            "smallest_notch_mm": Number(low=0, high=100, scale=MM, default=5.0),
            "seed": Integer(high=LARGEST_SEED, default=0),
        },
        required=True,
    ),
    "placement": Named(
        Table(
            {
                "axes": Texts(),
                "rotation": Array(shape=(3, 3)),
                "translation_mm": Array(
                    shape=(3,), low=-FAR_MM, high=FAR_MM, scale=MM, required=True
                ),
            }
        )
    ),
    "panel": Named(
        Table(
            {
                "material": Text(),
                "grain_deg": Number(low=-360, high=360),
                "element_size_mm": Number(low=FINEST_MM, high=COARSEST_MM, scale=MM),
            }
        )
    ),
    "stage": Rows(
        Table(
            {
                "name": _NAME,
                "start_s": Number(low=0, high=LONGEST, required=True),
                "end_s": Number(low=SHORTEST, high=LONGEST, required=True),
                "ramp": Text(choices=RAMPS, default="linear"),
                "group": Text(),
                "seams": Texts(or_one=True, default=()),
            }
        ),
        required=True,
    ),
    "hook": Rows(
        Table(
            {
                **dict.fromkeys(("name", "wire", "stage"), _NAME),
                "line": Text(),
                "chain": Texts(),
                "junctions_mm": Array(shape=(None,), low=0, high=FAR_MM, scale=MM),
                "pitch_mm": Number(low=1, high=1000, scale=MM),
                "from_mm": Number(low=0, high=FAR_MM, scale=MM, default=0.0),
                "to_mm": Number(above=0, high=FAR_MM, scale=MM),
                "limit_n": Number(low=1e-3, high=1e6),
                "slides": Flag(default=False),
            }
        )
    ),
    "frame": Rows(
        Table(
            {
                "name": _NAME,
                "edges": Texts(or_one=True, required=True),
                "curve": _NAME,
                "junctions_mm": Array(shape=(None,), low=0, scale=MM),
                "stage": _NAME,
            }
        )
    ),
    "rig": Rows(Table(RIG), required=True),
    "camera": Table(CAMERA),
    "gallery": Table(
        {
            "textures": Texts(or_one=True, default=(AS_BUILT,)),
            "surroundings": Text(choices=tuple(SURROUNDINGS), default="plain"),
        }
    ),
    "thread": Table(
        {
            "colour": Colour(),
            "offset_mm": Number(low=0, high=20, scale=MM, default=5.0),
            "pitch_mm": Number(low=0.5, high=50, scale=MM, default=5.0),
            "length_mm": Number(low=0.1, high=50, scale=MM, default=4.0),
            "width_mm": Number(low=0, high=5, scale=MM, default=0.9),
            "gauge_mm": Number(low=1, high=8, scale=MM, default=6.0),
        }
    ),
    "seam": Named(
        Table(
            {
                "kind": Text(choices=SEAM_KINDS, required=True),
                "side": Text(choices=("a", "b"), default="a"),
            }
        )
    ),
    "zones": Table(
        {
            "box": Rows(
                Table(
                    {
                        "name": _NAME,
                        "panel": _NAME,
                        "low_mm": Array(
                            shape=(2,), low=-FAR_MM, high=FAR_MM, scale=MM, required=True
                        ),
                        "high_mm": Array(
                            shape=(2,), low=-FAR_MM, high=FAR_MM, scale=MM, required=True
                        ),
                        "class": Text(choices=("A", "B", "C"), default="A"),
                    }
                )
            )
        }
    ),
    "improve": Table(
        {
            "frozen": Texts(default=()),
            "edge_mm": Number(low=0, high=50, scale=MM, default=5.0),
            "length_mm": Number(low=0, high=100, scale=MM, default=15.0),
            "hook_mm": Number(low=0, high=50, scale=MM, default=10.0),
            "foam_mm": Number(low=0, high=50, scale=MM, default=0.0),
            "symmetric": Flag(default=True),
            "corrections": Integer(low=1, high=20, default=3),
        }
    ),
    "wrinkle": Table(
        {
            "curvature": Text(choices=("tensor", "paper"), default="tensor"),
            "c_threshold_per_mm": THRESHOLD,
        }
    ),
}


def scene_keys() -> dict[str, Kind]:
    """All keys: those above, and the limits, of which there are as many as the registry has."""
    limits = {
        figure: Number(low=0) if index.limits[0] >= 0 else Number()
        for index in INDICES.values()
        for figure in index.figures
    } | dict.fromkeys(SCORE_MEASURES, Number(low=0))
    return KEYS | {"accept": Named(Table(limits))}
