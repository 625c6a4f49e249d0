"""The virtual test rig: small sheets that the solver pulls, shears, bends and lets hang."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from seatlook.model import Fabric, FloatArray, IntArray
from seatlook.solver import Load, Sheet, SheetSettings, Support, solve_sheet
from seatlook.solver.sheet import SheetSolution

_TIGHT = SheetSettings(tolerance=1e-7)
_ROWS = 3  # elements along the side of a square that is strained evenly
_LONG = 24  # elements along a strip that is bent
_GRAVITY = 9.80665


def pull(fabric: Fabric, axis: int, path: FloatArray, *, held: bool) -> FloatArray:
    """Nominal force per width [N/m] of a strip at engineering strains, one after the other.

    Parameters
    ----------
    axis : 0 along warp, 1 along weft
    held : sides may not contract, as in a wide short specimen
    """
    X, faces = _grid(_ROWS, _ROWS, 1.0, 1.0)
    low, high = X[:, axis] < 1e-9, X[:, axis] > 1.0 - 1e-9
    fixed = np.zeros((len(X), 3), dtype=bool)
    fixed[:, 2] = True
    fixed[low | high, axis] = True
    fixed[:, 1 - axis] = held
    fixed[np.flatnonzero(low)[0], 1 - axis] = True
    forces, before = [], None
    for e in path:
        target = np.pad(X, ((0, 0), (0, 1)))
        target[:, axis] *= 1.0 + e
        before = _solved(X, faces, fabric, fixed, target, before)
        forces.append(float(before.reactions[high, axis].sum()))
    return np.array(forces)


def shear(fabric: Fabric, path: FloatArray) -> FloatArray:
    """Shear stress [N/m] of a square between parallel jaws, at the tangents of the shear angle."""
    X, faces = _grid(_ROWS, _ROWS, 1.0, 1.0)
    rim = ((X < 1e-9) | (X > 1.0 - 1e-9)).any(axis=1)
    fixed = np.stack([rim, rim, np.ones_like(rim)], axis=1)
    stresses, before = [], None
    for tangent in path:
        if before is None and tangent == 0.0:
            stresses.append(0.0)  # nothing carries anything yet
            continue
        target = np.pad(X, ((0, 0), (0, 1)))
        target[:, 0] += tangent * X[:, 1]
        before = _solved(X, faces, fabric, fixed, target, before)
        stresses.append(float(before.sheet.membrane.stress(before.positions)[:, 2].mean()))
    return np.array(stresses)


def bend(fabric: Fabric, axis: int, path: FloatArray, length: float = 0.01) -> FloatArray:
    """Moment per width [N] in the middle of a wide strip whose ends are held on circles [1/m].

    Three times as wide as long: as in a bending tester it cannot curve across.
    """
    width = 3.0 * length
    X, faces = _grid(_LONG, _LONG, length, width)
    rest = X if axis == 0 else X[:, ::-1].copy()
    faces = faces if axis == 0 else faces[:, ::-1].copy()
    ends = np.abs(X[:, 0] - 0.5 * length) > 0.42 * length
    away = np.abs(X[faces].mean(axis=1) - 0.5 * np.array([length, width])) / length
    middle = (away[:, 0] < 0.2) & (away[:, 1] < 0.5)
    D = fabric.bending_matrix
    moments = []
    for k in path:
        s = X[:, 0] - 0.5 * length
        shape = np.column_stack([np.sin(k * s) / k, X[:, 1], (1.0 - np.cos(k * s)) / k])
        if axis == 1:
            shape = shape[:, [1, 0, 2]]
        solved = solve_sheet(Sheet(rest, faces, fabric), start=shape, support=Support(fixed=ends))
        kappa = solved.sheet.curvatures(solved.positions)[middle].mean(axis=0)
        along = np.array([kappa[0, 0], kappa[1, 1]])
        moments.append(float(np.abs(D[axis, :2] @ along)))
    return np.array(moments)


def hang(fabric: Fabric, axis: int, length: float) -> FloatArray:
    """Middle line (k, 2) [m], along and down, of a strip that is clamped level and hangs over."""
    width = length / _LONG * 4
    X, faces = _grid(_LONG, 4, length, width)
    rest = X if axis == 0 else X[:, ::-1].copy()
    faces = faces if axis == 0 else faces[:, ::-1].copy()
    solved = solve_sheet(
        Sheet(rest, faces, _flat(fabric)), support=Support(clamped=X[:, 0] < 1e-9),
        load=Load(gravity=(0.0, 0.0, -_GRAVITY)), settings=replace(SheetSettings(), steps=4),
        strict=True,
    )  # fmt: skip
    line = np.abs(X[:, 1] - 0.5 * width) < 1e-9
    order = np.argsort(X[line, 0])
    points = solved.positions[line][order]
    return np.column_stack([points[:, axis], -points[:, 2]])


def _flat(fabric: Fabric) -> Fabric:
    """The same cloth as stiff in compression: a hanging strip's own weight wrinkles no mesh."""
    return replace(fabric, compression_ratio=1.0)


def _solved(
    X: FloatArray, faces: IntArray, fabric: Fabric, fixed: np.ndarray, target: FloatArray,
    before: SheetSolution | None,
) -> SheetSolution:  # fmt: skip
    return solve_sheet(
        Sheet(X, faces, fabric), start=before, support=Support(fixed=fixed, prescribed=target),
        settings=_TIGHT, strict=True,
    )  # fmt: skip


def _grid(columns: int, rows: int, length: float, width: float) -> tuple[FloatArray, IntArray]:
    """Vertices and triangles of a rectangle; diagonals alternate, so that no direction is stiff."""
    x, y = np.meshgrid(np.linspace(0, length, columns + 1), np.linspace(0, width, rows + 1),
                       indexing="ij")  # fmt: skip
    number = np.arange(x.size).reshape(x.shape)
    a, b, c, d = number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]
    turn = (np.add.outer(np.arange(columns), np.arange(rows)) % 2).astype(bool)[..., None]
    first = np.where(turn, np.stack([a, b, d], axis=2), np.stack([a, b, c], axis=2))
    second = np.where(turn, np.stack([b, c, d], axis=2), np.stack([a, c, d], axis=2))
    faces = np.concatenate([first.reshape(-1, 3), second.reshape(-1, 3)])
    return np.column_stack([x.ravel(), y.ravel()]), faces.astype(np.int64)
