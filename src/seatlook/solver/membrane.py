"""Membrane of a flat sheet: one averaged Green strain and one law for each triangle."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.sparse import csc_array, csr_array

from seatlook.errors import InputError
from seatlook.model import Curve, Fabric, FloatArray, IntArray
from seatlook.solver.edgeslope import Samples
from seatlook.solver.kernels import membrane as kernels


class Membrane:
    """Membrane energy ``sum A psi(E)`` [J] over all panels.

    psi = warp curve (E11) + weft curve (E22) + shear curve (2 E12) + coupling. Stiffness is
    piecewise linear in Green strain, so stress is smooth and energy a cubic. In compression it
    falls to ``compression_ratio`` times its first value over 2e-3 of strain; the coupling
    ``C12 ((1 - c) p(E11) p(E22) + c E11 E22)``, p = e^2 / (e + 2e-3) in tension and 0 else, keeps
    the same share c, so that psi stays convex and c = 1 is the linear orthotropic law.

    Parameters
    ----------
    samples : where the deformation gradient is taken
    area : (m,) float64 [m2]
    fabric : (m,) int64      index into ``fabrics``
    """

    def __init__(
        self, samples: Samples, area: FloatArray, fabric: IntArray, fabrics: Sequence[Fabric]
    ) -> None:
        self._samples, self._area, self._fabric = samples, area, fabric
        self._tables, self._counts = law_tables(fabrics)
        self._constants = np.array(
            [[f.poisson * f.weft.stiffness[0], f.compression_ratio] for f in fabrics]
        )
        self._F = np.empty((len(samples.ends), 6))
        self._load = np.empty((len(samples.ends), 3))
        self._E = np.empty((len(area), 3))

    def strain(self, x: FloatArray) -> FloatArray:
        """Return the Green strain (E11, E22, 2 E12) of every triangle, (m, 3) [1]."""
        self._deform(x)
        return self._E.copy()

    def stress(self, x: FloatArray) -> FloatArray:
        """Return the second Piola-Kirchhoff stress (S11, S22, S12), (m, 3) [N/m]."""
        return np.asarray(
            kernels.laws(self.strain(x), self._fabric, self._tables, self._counts, self._constants)
        )

    def value(self, x: FloatArray, gradient: FloatArray) -> float:
        """Return the energy [J] and add its gradient [N] to ``gradient``."""
        self._deform(x)
        s = self._samples
        energy = kernels.stresses(
            self._E,
            s.of_face,
            self._area,
            self._fabric,
            self._tables,
            self._counts,
            self._constants,
            self._load,
        )
        kernels.forces(
            self._F,
            self._load,
            s.ends,
            s.length,
            s.normal,
            s.rows.start,
            s.rows.nodes,
            s.rows.weights,
            gradient,
        )
        return float(energy)

    def _deform(self, x: FloatArray) -> None:
        s = self._samples
        kernels.gradients(
            x, s.ends, s.length, s.normal, s.rows.start, s.rows.nodes, s.rows.weights, self._F
        )
        kernels.strains(self._F, s.of_face, self._E)


def law_tables(fabrics: Sequence[Fabric]) -> tuple[FloatArray, IntArray]:
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
    longest = max(len(strain) for row in curves for strain, _ in row)
    tables = np.zeros((len(curves), 3, longest, 5))
    counts = np.empty((len(curves), 3), dtype=np.int64)
    for i, row in enumerate(curves):
        _check(fabrics[i])
        for j, (strain, stiffness) in enumerate(row):
            counts[i, j] = len(strain)
            tables[i, j, : len(strain)] = _integrate(strain, stiffness)
    return tables, counts


def typical_stiffness(curve: Curve) -> float:
    """Stiffness [N/m] between the toe and the middle knot of a curve."""
    return float(0.5 * (curve.stiffness[0] + curve.stiffness[len(curve.stiffness) // 2]))


def _with_slack(curve: Curve, ratio: float) -> tuple[FloatArray, FloatArray]:
    strain = np.concatenate([[-kernels.BLEND], curve.strain])
    return strain, np.concatenate([[ratio * curve.stiffness[0]], curve.stiffness])


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
    """Refuse curves that soften so far that the coupling makes the law lose its convexity."""
    coupling = fabric.poisson * fabric.weft.stiffness[0]
    lowest = fabric.warp.stiffness.min() * fabric.weft.stiffness.min()
    if coupling**2 >= lowest:
        raise InputError.single(
            "Fabric.poisson",
            got=f"coupling {coupling:.4g} N/m",
            expected=f"below {np.sqrt(lowest):.4g} N/m, where the curves are softest",
        )


def laplacian(
    gradients: tuple[csr_array, csr_array],
    area: FloatArray,
    fabric: IntArray,
    fabrics: Sequence[Fabric],
) -> csc_array:
    """Scalar membrane stiffness (n, n) [N/m] of plane triangles with the fabrics' stiffness."""
    warp = np.array([typical_stiffness(f.warp) for f in fabrics])[fabric]
    weft = np.array([typical_stiffness(f.weft) for f in fabrics])[fabric]
    total = sum(
        g.T @ g.multiply((area * k)[:, None]) for g, k in zip(gradients, (warp, weft), strict=True)
    )
    return csc_array(total)
