"""A small pattern drawing in the making, as an exporter would write it."""

import warnings

import ezdxf
import numpy as np

from seatlook.errors import InputWarning
from seatlook.io import read_dxf

L_SHAPE = [(0, 0), (300, 0), (300, 100), (120, 100), (120, 200), (0, 200)]
L_AREA = 300 * 100 + 120 * 100


class Sheet:
    """A drawing in the making; its file is read with the warnings collected."""

    def __init__(self, path, version="R2000"):
        self.path = path
        self.document = ezdxf.new(version)
        self.document.header["$INSUNITS"] = 4
        self.space = self.document.modelspace()
        self.text(self.space, "Units: METRIC")

    def text(self, layout, words, at=(5, 5), layer="1"):
        layout.add_text(words, dxfattribs={"layer": layer, "insert": at})

    def block(self, name, outline=None, *, grain=True, texts=()):
        block = self.document.blocks.new(name)
        if outline is not None:
            self.line(block, outline)
        if grain:
            block.add_line((50, 20), (50, 80), dxfattribs={"layer": "7"})
        for words in texts:
            self.text(block, words)
        return block

    def line(self, layout, points, layer="1", *, closed=True):
        layout.add_polyline2d(points, close=closed, dxfattribs={"layer": layer})

    def insert(self, name, layout=None, **attributes):
        place = attributes.pop("at", (700, 900))
        layout = self.space if layout is None else layout
        return layout.add_blockref(name, place, dxfattribs={"layer": "1", **attributes})

    def read(self, **options):
        self.document.saveas(self.path)
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always", InputWarning)
            panels = read_dxf(self.path, **options)
        said = [str(w.message).removeprefix(f"{self.path}: ") for w in caught]
        return {p.name: p for p in panels}, said


def area(points):
    x, y = 1e3 * points.T
    return 0.5 * np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y)


def sides(points):
    return 1e3 * np.hypot(*(np.roll(points, -1, axis=0) - points).T)


def one_piece(name):
    rows = ["0", "SECTION", "2", "BLOCKS", "0", "BLOCK", "8", "1", "2", name, "70", "0"]
    rows += ["10", "0", "20", "0", "0", "POLYLINE", "8", "1", "66", "1", "70", "1"]
    for x, y in L_SHAPE:
        rows += ["0", "VERTEX", "8", "1", "10", str(x), "20", str(y)]
    rows += ["0", "SEQEND", "0", "LINE", "8", "7", "10", "50", "20", "20", "11", "50", "21", "80"]
    rows += ["0", "ENDBLK", "0", "ENDSEC", "0", "SECTION", "2", "ENTITIES", "0", "INSERT"]
    rows += ["8", "1", "2", name, "10", "0", "20", "0", "0", "TEXT", "8", "1", "10", "0"]
    rows += ["20", "0", "40", "1", "1", "UNITS: METRIC", "0", "ENDSEC", "0", "EOF", ""]
    return "\n".join(rows)
