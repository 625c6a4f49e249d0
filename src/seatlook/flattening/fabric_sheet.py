"""Strain energy of a fabric that lies flat and is laid onto a form, for flattening."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from seatlook.flattening.face_map import Gradient, gradient_of
from seatlook.model import Curve, Fabric, FloatArray, IntArray

_TINY = 1e-12  # strain below which a curve is its first stiffness
_STEP = 1e-6  # of F, by which the curvature is taken as a difference of slopes


def strains_by_grain(vertices: FloatArray, faces: IntArray, flat: FloatArray) -> FloatArray:
    """Return Green strains (m, 3) of the map from flat to space: warp, weft, angle 2 E12."""
    return grain_strain(flat, gradient_of(vertices, faces))


def grain_strain(x: FloatArray, gradient: Gradient) -> FloatArray:
    """Green strain (m, 3) that the form gives to flat faces: warp, weft, angle 2 E12.

    Parameters
    ----------
    x : (n, 2) [m]     flat positions, warp along the second axis
    gradient : derivatives along two axes of each face on the form
    """
    return _strain(_squared(_inverse(gradient.at(x))))


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


@dataclass(frozen=True, slots=True)
class FabricLaw:
    """The fabric's energy by F, in units of its mean stiffness: it weighs as an isotropic sheet."""

    fabric: Fabric

    def energy(self, F: FloatArray) -> FloatArray:
        """Return the energy (m,)."""
        strain = _strain(_squared(_inverse(F)))
        return fabric_energy(strain, self.fabric) / self._mean

    def derivatives(self, F: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return the slope (m, 2, 2), axes (m, 4, 4) of its differences, and their sizes (m, 4)."""
        curvature = np.empty((len(F), 4, 4))
        for k in range(4):
            step = np.zeros((2, 2))
            step.flat[k] = _STEP
            change = self._slope(F + step) - self._slope(F - step)
            curvature[:, k] = change.reshape(-1, 4) / (2 * _STEP)
        value, mode = np.linalg.eigh((curvature + curvature.transpose(0, 2, 1)) / 2)
        return self._slope(F), mode.transpose(0, 2, 1), value

    @property
    def _mean(self) -> float:
        return float(np.sqrt(self.fabric.warp.stiffness[0] * self.fabric.weft.stiffness[0]))

    def _slope(self, F: FloatArray) -> FloatArray:
        inverse = _inverse(F)
        squared = _squared(inverse)
        (a, of_a), (b, of_b), (c, of_c) = _roots(_strain(squared), self.fabric)
        share = _coupling(self.fabric)
        stress = np.empty_like(F)
        stress[:, 1, 1] = (a + share * b) * of_a / 2
        stress[:, 0, 0] = (b + share * a) * of_b / 2
        stress[:, 0, 1] = stress[:, 1, 0] = c * of_c / 2
        return -2 / self._mean * squared @ stress @ inverse.transpose(0, 2, 1)


def _strain(stretched: FloatArray) -> FloatArray:
    return np.column_stack(
        [
            0.5 * (stretched[:, 1, 1] - 1.0),
            0.5 * (stretched[:, 0, 0] - 1.0),
            stretched[:, 0, 1],
        ]
    )


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


def _inverse(F: FloatArray) -> FloatArray:
    """Map (m, 2, 2) from the plane back to each face's axes."""
    return np.asarray(np.linalg.inv(F), dtype=np.float64)


def _squared(inverse: FloatArray) -> FloatArray:
    return np.asarray(inverse.transpose(0, 2, 1) @ inverse)
