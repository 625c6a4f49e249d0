"""The solved cover as a dynain file, the starting state of a further LS-DYNA calculation."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Literal

import numpy as np

from seatlook.errors import InputError
from seatlook.files import write_text
from seatlook.io.lsdyna.element_tables import unit_in_metres
from seatlook.mesh.kinematics import deformation_gradient, logarithmic_strain
from seatlook.model import FloatArray, Solution

_MOST = 99_999_999  # numbers are eight digits wide
_NO_LETTER = re.compile("[\x00-\x1f\x7f-\x9f\ud800-\udfff]")


def write_dynain(
    solution: Solution,
    path: Path,
    *,
    length_unit: str = "mm",
    strain_columns: Literal[20, 16] = 20,
) -> None:
    """Write nodes, shells with their thickness, and strains on both surfaces.

    One part per panel, numbered from 1 in the order of the panels and titled with its name, with a
    section of its mean thickness; its material has the same number and is not written. Shells are
    numbered as the faces, from 1, so their normals point to the visible side. Strains are
    logarithmic, in global axes, at T = -1 and T = +1; the strain through the thickness is not
    computed here and written as 0.

    Parameters
    ----------
    strain_columns : width of a strain
        LARGE=1 makes a field twice as long, says the manual of LS-DYNA: 20 columns. OpenRadioss
        reads 16.

    Raises
    ------
    InputError
        An unknown unit, a panel that cannot be stretched so far (strain of -1/2), too many nodes.
    """
    scale = 1.0 / unit_in_metres(length_unit)
    cover = solution.cover
    if max(len(cover.rest), len(cover.faces)) > _MOST:
        raise InputError.single("cover", got=f"{len(cover.rest)} nodes", expected=f"<= {_MOST}")
    inner, outer = (_global(solution, s) for s in (solution.strain_bottom, solution.strain_top))
    if not (np.isfinite(inner).all() and np.isfinite(outer).all()):
        raise InputError.single(
            "strains", got="-1/2 or less", expected="strains that a stretch can have"
        )
    lines = [*_head(solution, length_unit), *_nodes(solution.positions * scale)]
    lines += _parts(solution, cover.thickness * scale)
    lines += _shells(solution, cover.thickness * scale)
    lines += _strains(inner, outer, strain_columns)
    write_text(path, "\n".join([*lines, "*END", ""]))


def _head(solution: Solution, length_unit: str) -> Iterator[str]:
    yield "*KEYWORD"
    yield f"$ solved cover, status: {solution.status}; unit of length: {length_unit}"
    yield "$ materials are not written: each part needs one of its own number"


def _parts(solution: Solution, thickness: FloatArray) -> Iterator[str]:
    """Part and section of each panel that has faces."""
    cover = solution.cover
    for number, name in enumerate(cover.panel_names, 1):
        inside = cover.panel == number - 1
        if not inside.any():
            continue
        yield from ("*PART", _title(name), f"{number:10d}" * 3)
        yield from ("*SECTION_SHELL", f"{number:10d}{2:10d}")
        yield f"{float(thickness[inside].mean()):10.4g}" * 4


def _title(name: str) -> str:
    """Make a name a card: one line, and nothing that begins a keyword or a comment."""
    line = " ".join(_NO_LETTER.sub(" ", name).split())
    return f" {line}" if line.startswith(("*", "$")) else line


def _nodes(positions: FloatArray) -> Iterator[str]:
    yield "*NODE"
    for number, (x, y, z) in enumerate(positions.tolist(), 1):
        yield f"{number:8d}{x:16.9e}{y:16.9e}{z:16.9e}"


def _shells(solution: Solution, thickness: FloatArray) -> Iterator[str]:
    yield "*ELEMENT_SHELL_THICKNESS"
    cover = solution.cover
    rows = zip(
        (cover.faces + 1).tolist(), (cover.panel + 1).tolist(), thickness.tolist(), strict=True
    )
    for number, ((a, b, c), part, t) in enumerate(rows, 1):
        yield f"{number:8d}{part:8d}{a:8d}{b:8d}{c:8d}{c:8d}"
        yield f"{t:16.9e}" * 4


def _strains(inner: FloatArray, outer: FloatArray, w: int) -> Iterator[str]:
    """One entry per shell in the wide format: xx, yy, zz, xy, yz, zx and the level."""
    yield "*INITIAL_STRAIN_SHELL"
    for number, surfaces in enumerate(zip(inner.tolist(), outer.tolist(), strict=True), 1):
        yield f"{number:10d}{1:10d}{2:10d}{1:10d}"
        for level, (xx, yy, zz, xy, yz, zx) in zip((-1.0, 1.0), surfaces, strict=True):
            yield f"{xx:{w}.8e}{yy:{w}.8e}{zz:{w}.8e}{xy:{w}.8e}{yz:{w}.8e}"
            yield f"{zx:{w}.8e}{level:{w}.8e}"


def _global(solution: Solution, green: FloatArray) -> FloatArray:
    """Logarithmic strain (m, 6) in space, turned with the rotation of the mid surface."""
    cover = solution.cover
    F = deformation_gradient(cover.rest, solution.positions, cover.faces)
    left, _, right = np.linalg.svd(F, full_matrices=False)
    rotation = left @ right
    strain = rotation @ logarithmic_strain(green) @ np.swapaxes(rotation, 1, 2)
    return np.asarray(strain[:, [0, 1, 2, 0, 1, 2], [0, 1, 2, 1, 2, 0]])
