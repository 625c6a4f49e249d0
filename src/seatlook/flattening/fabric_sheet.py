"""Strain energy of a fabric that lies flat and is laid onto a form, for flattening."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

from seatlook.model import Curve, Fabric, FloatArray

Gradient = tuple[sp.csr_array, sp.csr_array]
Rows = tuple[list[FloatArray], list[list[sp.csr_array]]]

_TINY = 1e-12  # strain below which a curve is its first stiffness


def grain_strain(x: FloatArray, gradient: Gradient) -> FloatArray:
    """Green strain (m, 3) that the form gives to flat faces: warp, weft, angle 2 E12.

    Parameters
    ----------
    x : (n, 2) [m]     flat positions, warp along the second axis
    gradient : derivatives along two axes of each face on the form
    """
    stretched = _squared(_inverse(x, gradient))
    return np.column_stack(
        [
            0.5 * (stretched[:, 1, 1] - 1.0),
            0.5 * (stretched[:, 0, 0] - 1.0),
            stretched[:, 0, 1],
        ]
    )


def fabric_energy(strain: FloatArray, fabric: Fabric) -> FloatArray:
    """Energy (m,) [J/m2] of strains (m, 3) by warp, weft and shear curves.

    Compression costs what tension does. A fabric that gives way to it without a force does so in
    wrinkles, and a pattern is not to count on them.

    Examples
    --------
    >>> cloth = Fabric(thickness=0.001, density=0.3, warp=Curve.linear(2000.0),
    ...                weft=Curve.linear(1000.0), shear=Curve.linear(200.0),
    ...                bending_warp=1e-4, bending_weft=1e-4, bending_twist=1e-4)
    >>> strain = np.array([[0.01, 0, 0], [-0.01, 0, 0], [0, 0.01, 0], [0, 0, 0.01]])
    >>> fabric_energy(strain, cloth)
    array([0.1 , 0.1 , 0.05, 0.01])
    """
    a, b, c = (root for root, _ in _roots(strain, fabric))
    return np.asarray(0.5 * (a**2 + 2 * _coupling(fabric) * a * b + b**2 + c**2))


def fabric_rows(x: FloatArray, gradient: Gradient, root: FloatArray, fabric: Fabric) -> Rows:
    """Residuals (3 of (m,)), whose squares add up to twice the energy, and their derivatives.

    In units of the fabric's mean stiffness, so that they weigh as those of an isotropic sheet do.
    ``root`` (m,) is the square root of the faces' area. The derivatives are operators on x and y.
    """
    inverse = _inverse(x, gradient)
    squared = _squared(inverse)
    along = [combined(gradient, inverse[:, 0, b], inverse[:, 1, b]) for b in (0, 1)]
    changes = [
        [-_scaled(along[1], squared[:, 1, a]) for a in (0, 1)],
        [-_scaled(along[0], squared[:, 0, a]) for a in (0, 1)],
        [-combined((along[1], along[0]), squared[:, 0, a], squared[:, 1, a]) for a in (0, 1)],
    ]
    mean = np.sqrt(np.sqrt(fabric.warp.stiffness[0] * fabric.weft.stiffness[0]))
    parts = _roots(grain_strain(x, gradient), fabric)
    share = _coupling(fabric)
    values = [root * value / mean for value, _ in parts]
    blocks = [
        [_scaled(change, root * slope / mean) for change in pair]
        for pair, (_, slope) in zip(changes, parts, strict=True)
    ]
    (a, b, c), (of_a, of_b, of_c) = values, blocks
    rest = np.sqrt(1.0 - share**2)
    first = [sp.csr_array(p + share * q) for p, q in zip(of_a, of_b, strict=True)]
    return [a + share * b, rest * b, c], [first, [rest * q for q in of_b], of_c]


def combined(pair: Gradient, a: FloatArray, b: FloatArray) -> sp.csr_array:
    """Return the derivatives along two axes, weighted by (m,) each and added."""
    return sp.csr_array(_scaled(pair[0], a) + _scaled(pair[1], b))


def _roots(strain: FloatArray, fabric: Fabric) -> list[tuple[FloatArray, FloatArray]]:
    """Square roots of twice the energy of each strain, with its sign, and their slopes."""
    curves = (fabric.warp, fabric.weft, fabric.shear)
    return [_root(curve, e) for curve, e in zip(curves, strain.T, strict=True)]


def _root(curve: Curve, strain: FloatArray) -> tuple[FloatArray, FloatArray]:
    size = np.maximum(np.abs(strain), _TINY)
    value = np.sqrt(2.0 * _stored(curve, size))
    return np.copysign(value, strain), curve.tension(size) / value


def _stored(curve: Curve, strain: FloatArray) -> FloatArray:
    """Area (m,) [J/m2] below a tension curve up to strains of 0 and more."""
    knots = np.append(curve.strain, np.inf)
    reach = np.clip(strain[:, None] - knots[:-1], 0.0, np.diff(knots))
    rise = np.append(np.diff(curve.stiffness) / np.diff(curve.strain), 0.0)
    parts = curve.tension(curve.strain) + reach * (0.5 * curve.stiffness + rise * reach / 6.0)
    return np.asarray((reach * parts).sum(axis=1))


def _coupling(fabric: Fabric) -> float:
    """Poisson's coupling over the mean stiffness; below 1 where the fabric is stable."""
    ratio = fabric.weft.stiffness[0] / fabric.warp.stiffness[0]
    return float(fabric.poisson * np.sqrt(ratio))


def _inverse(x: FloatArray, gradient: Gradient) -> FloatArray:
    """Map (m, 2, 2) from the plane back to each face's axes."""
    return np.linalg.inv(np.stack([g @ x for g in gradient], axis=2))


def _squared(inverse: FloatArray) -> FloatArray:
    return np.asarray(np.einsum("mka,mkb->mab", inverse, inverse))


def _scaled(operator: sp.csr_array, rows: FloatArray) -> sp.csr_array:
    return sp.csr_array(sp.diags(rows) @ operator)
