"""Curves of fabrics as the tables that the kernels read."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from seatlook.errors import InputError
from seatlook.model import Curve, Fabric, FloatArray, IntArray
from seatlook.solver.kernels import membrane as kernels


def constitutive_tables(fabrics: Sequence[Fabric]) -> tuple[FloatArray, IntArray]:
    """Return knots (f, 3, k, 5) of warp, weft and shear of every fabric, and their counts (f, 3).

    Columns: strain, stiffness, stress, energy at the knot, and slope of the stiffness after it.
    """
    curves = [
        [
            _with_slack(f.warp, f.compression_ratio),
            _with_slack(f.weft, f.compression_ratio),
            (f.shear.strain, f.shear.stiffness),
        ]
        for f in fabrics
    ]
    for fabric in fabrics:
        _check(fabric)
    return _tables(curves)


def unloading_tables(fabrics: Sequence[Fabric]) -> tuple[FloatArray, IntArray]:
    """Return the same for unloading in warp and weft, (f, 2, k, 5) and (f, 2), count 0 if none."""
    return _tables(
        [
            [
                _way_back(f.warp_unloading, f.warp, f.compression_ratio),
                _way_back(f.weft_unloading, f.weft, f.compression_ratio),
            ]
            for f in fabrics
        ]
    )


def typical_stiffness(curve: Curve) -> float:
    """Stiffness [N/m] between the toe and the middle knot of a curve."""
    return float(0.5 * (curve.stiffness[0] + curve.stiffness[len(curve.stiffness) // 2]))


def _with_slack(curve: Curve, ratio: float) -> tuple[FloatArray, FloatArray]:
    strain = np.concatenate([[-kernels.BLEND], curve.strain])
    return strain, np.concatenate([[ratio * curve.stiffness[0]], curve.stiffness])


def _way_back(
    unloading: Curve | None, loading: Curve, ratio: float
) -> tuple[FloatArray, FloatArray]:
    """Unloading curve, as soft in compression as a fabric that was never loaded; empty if none."""
    if unloading is None:
        return np.zeros(0), np.zeros(0)
    strain, stiffness = _with_slack(unloading, ratio)
    stiffness[0] = ratio * loading.stiffness[0]
    return strain, stiffness


def _tables(
    curves: Sequence[Sequence[tuple[FloatArray, FloatArray]]],
) -> tuple[FloatArray, IntArray]:
    longest = max(len(strain) for row in curves for strain, _ in row)
    tables = np.zeros((len(curves), len(curves[0]), longest, 5))
    counts = np.empty((len(curves), len(curves[0])), dtype=np.int64)
    for i, row in enumerate(curves):
        for j, (strain, stiffness) in enumerate(row):
            counts[i, j] = len(strain)
            if len(strain):
                tables[i, j, : len(strain)] = _integrate(strain, stiffness)
    return tables, counts


def _integrate(strain: FloatArray, stiffness: FloatArray) -> FloatArray:
    """Stress and energy at the knots, both zero at zero strain."""
    step, mean = np.diff(strain), 0.5 * (stiffness[1:] + stiffness[:-1])
    stress = np.concatenate([[0.0], np.cumsum(mean * step)])
    stress -= np.interp(0.0, strain, stress)
    slope = np.append(np.diff(stiffness) / step, 0.0)
    lift = stress[:-1] * step + 0.5 * stiffness[:-1] * step**2 + slope[:-1] * step**3 / 6.0
    energy = np.concatenate([[0.0], np.cumsum(lift)])
    energy -= energy[np.flatnonzero(strain == 0.0)[0]]
    return np.stack([strain, stiffness, stress, energy, slope], axis=1)


def _check(fabric: Fabric) -> None:
    """Refuse curves that soften so far that the coupling makes the energy lose its convexity."""
    coupling = fabric.poisson * fabric.weft.stiffness[0]
    # The way back lies above the way out but may be softer at its foot.
    warp, weft = (
        min(curve.stiffness.min() for curve in curves if curve is not None)
        for curves in ((fabric.warp, fabric.warp_unloading), (fabric.weft, fabric.weft_unloading))
    )
    lowest = warp * weft
    if coupling**2 >= lowest:
        raise InputError.single(
            "Fabric.poisson",
            got=f"coupling {coupling:.4g} N/m",
            expected=f"below {np.sqrt(lowest):.4g} N/m, where the curves are softest",
        )
