"""What the layers of a pattern file mean, by the numbers of AAMA / ASTM D6673 or by names."""

from __future__ import annotations

from seatlook.model.pattern import NotchKind

BOUNDARY, TURN, CURVE, NOTCH, MIRROR, GRAIN, INTERNAL, CUT_OUT, SEW = (
    "1", "2", "3", "4", "6", "7", "8", "11", "14",
)  # fmt: skip
# A notch on layer 4 is a mark without a cut when it has no depth.
NOTCH_LAYERS: dict[str, NotchKind] = {
    NOTCH: "v", "80": "t", "81": "castle", "82": "check", "83": "u",
}  # fmt: skip
LINE_LAYERS = (BOUNDARY, MIRROR, GRAIN, INTERNAL, CUT_OUT, SEW, *NOTCH_LAYERS)

# Known, and of no use for a cover.
UNREAD = {
    CURVE: "curve points", "5": "grading", "9": "stripes", "10": "plaids", "12": "drill holes",
    "13": "drill holes", "15": "annotation", "19": "annotation", "26": "annotation",
    "84": "a copy for checks", "85": "a copy for checks", "86": "a copy for checks",
    "87": "a copy for checks",
}  # fmt: skip

_NAMES = {
    BOUNDARY: (
        "boundary",
        "pieceboundary",
        "cut",
        "cutline",
        "cuttingline",
        "outline",
        "contour",
        "perimeter",
    ),
    SEW: ("sew", "sewline", "sewing", "sewingline", "seam", "seamline", "stitch", "stitchline"),
    NOTCH: ("notch", "notches"),
    GRAIN: ("grain", "grainline"),
    INTERNAL: ("internal", "internalline", "internallines"),
    MIRROR: ("mirror", "mirrorline", "fold", "foldline"),
    CUT_OUT: ("cutout", "cutouts", "internalcutout"),
    TURN: ("turn", "turnpoint", "turnpoints"),
    CURVE: ("curve", "curvepoint", "curvepoints"),
    "13": ("drill", "drillhole", "drillholes"),
    "15": ("annotation", "annotations", "text", "texts"),
}
MEANINGS = ("CUT", "SEW", "NOTCH", "GRAIN", "INTERNAL", "MIRROR", "CUTOUT", "TURN")
_BY_NAME = {name: layer for layer, names in _NAMES.items() for name in names}


def meaning(layer: str) -> str:
    """Return the number of a layer that has a name instead.

    Examples
    --------
    >>> [meaning(name) for name in ("1", "01", "Layer 1", "Cut_Line", "SEW", "Defpoints")]
    ['1', '1', '1', '1', '14', 'Defpoints']
    """
    if layer.isascii() and layer.isdigit():
        return layer.lstrip("0") or "0"
    letters = "".join(character for character in layer.casefold() if character.isalnum())
    number = letters.removeprefix("layer")
    if number != letters and number.isascii() and number.isdigit():
        return number.lstrip("0") or "0"
    return _BY_NAME.get(letters, layer)
