"""The solved cover as VTK polygonal data (.vtp), for ParaView and the like."""

from __future__ import annotations

import base64
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any
from xml.sax.saxutils import quoteattr

import numpy as np

from seatlook.files import write_text
from seatlook.model import Field, FloatArray, Solution

_VTK_TYPES = {"float64": "Float64", "int64": "Int64"}


def write_vtp(solution: Solution, fields: Sequence[Field], path: Path) -> None:
    """Write positions [m] and, per face, fields, thickness [m], strains, panel and zone.

    Strains are E11, E22, E12 in warp/weft axes. ``rest`` and ``uv`` [m] are data of the points. The
    names of panels and zones are field data, in the order of their numbers.

    Notes
    -----
    XML with base64 arrays, uncompressed, as described in "VTK File Formats"; written here so that
    exporting needs no VTK.
    """
    cover = solution.cover
    n, m = len(cover.rest), len(cover.faces)
    rows = [
        '<?xml version="1.0"?>',
        '<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64">',
        "<PolyData>",
        "<FieldData>",
        _strings("panel_names", cover.panel_names),
        _strings("zone_names", cover.zone_names),
        "</FieldData>",
        f'<Piece NumberOfPoints="{n}" NumberOfPolys="{m}">',
        *_section("PointData", {"rest": cover.rest, "uv": cover.uv}),
        *_section("CellData", cell_data(solution, fields)),
        *_section("Points", {"Points": solution.positions}),
        *_section(
            "Polys",
            {"connectivity": cover.faces.ravel(), "offsets": 3 * np.arange(1, m + 1)},
        ),
        "</Piece>",
        "</PolyData>",
        "</VTKFile>",
    ]
    write_text(path, "\n".join(rows) + "\n")


def cell_data(solution: Solution, fields: Sequence[Field]) -> dict[str, Any]:
    """Return name -> array (m,) or (m, 3) of what is exported for each face."""
    cover = solution.cover
    return {
        **{field.name: field.values for field in fields},
        "thickness": cover.thickness,
        "panel": cover.panel,
        "zone": cover.zone,
        "strain_top": voigt(solution.strain_top),
        "strain_mid": voigt(solution.strain_mid),
        "strain_bottom": voigt(solution.strain_bottom),
    }


def voigt(strain: FloatArray) -> FloatArray:
    """Return E11, E22, E12 (m, 3) of symmetric tensors (m, 2, 2)."""
    return np.column_stack([strain[:, 0, 0], strain[:, 1, 1], strain[:, 0, 1]])


def _section(name: str, arrays: Mapping[str, Any]) -> Iterator[str]:
    yield f"<{name}>"
    for array_name, values in arrays.items():
        columns = 1 if values.ndim == 1 else values.shape[1]
        little = np.ascontiguousarray(values, dtype=values.dtype.newbyteorder("<"))
        content = np.array([little.nbytes], dtype="<u8").tobytes() + little.tobytes()
        yield (
            f'<DataArray type="{_VTK_TYPES[values.dtype.name]}" Name={quoteattr(array_name)} '
            f'NumberOfComponents="{columns}" format="binary">'
            f"{base64.b64encode(content).decode()}</DataArray>"
        )
    yield f"</{name}>"


def _strings(name: str, texts: tuple[str, ...]) -> str:
    codes = " ".join(str(byte) for text in texts for byte in (*text.encode(), 0))
    return (
        f'<Array type="String" Name="{name}" NumberOfTuples="{len(texts)}" format="ascii">'
        f"{codes}</Array>"
    )
