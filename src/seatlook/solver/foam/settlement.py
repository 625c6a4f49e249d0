"""How foam gives way under broad pressure: the column beneath short-wave stiffness.

Foam answers a wave of length lambda by pi E*/lambda, and a pressure broader than it is thick by its
column curve, 6 to 10 times softer. Kerr's foundation has both: springs that touch the sheet, a
layer below that spreads load, and columns underneath (Kerr 1964, J. Appl. Mech. 31, 491).
"""

from __future__ import annotations

import numpy as np
from scipy.sparse import csc_array, csr_array, diags_array

from seatlook.mesh import angles
from seatlook.model import Cover, FloatArray, FoamMaterial, IntArray
from seatlook.solver.foam.contact import FoamContact, settled_part
from seatlook.solver.kernels import settlement as kernel
from seatlook.solver.methods.factor import Factor, Preconditioner

_STIFFEST_COLUMN = 0.25  # of the short-wave stiffness, for which the fit below has an answer
_LEAST_STEP = 1e-4  # of the thickness between two knots, where the column is all but solid
_NEWTON = 6
_SEWN = 100.0  # stiffness that keeps both sides of a seam level, over that of the layer


def kerr_layers(column: float) -> tuple[float, float]:
    """Upper springs and shear layer that follow the half-space at lambda and 2 lambda.

    Parameters
    ----------
    column : stiffness of the columns over pi E*/lambda, the half-space's at lambda

    Returns
    -------
    upper : stiffness of the springs at the sheet, in the same unit
    shear : stiffness of the layer for a wave of lambda, in the same unit

    Notes
    -----
    A wave sees ``1 / (1 / upper + 1 / (column + shear (lambda / wave)^2))``: 1 at lambda and 1/2 at
    2 lambda, as for the half-space, and the column alone for long waves.

    Examples
    --------
    >>> upper, shear = kerr_layers(0.2)
    >>> [round(1 / (1 / upper + 1 / (0.2 + shear * r**2)), 6) for r in (1.0, 0.5)]
    [1.0, 0.5]
    """
    a = min(column, _STIFFEST_COLUMN)
    b = 0.75 - 1.25 * a
    shear = 2.0 * (b + np.sqrt(b * b - a * a))
    return float(1.0 / (1.0 - 1.0 / (a + shear))), float(shear)


class Settlement:
    """Energy of columns and shear layer, in the settlement s [m] of the foam below each vertex.

    Parameters
    ----------
    contact : its stiffness becomes that of the upper springs
    foam : column curve
    wavelength : (n,) float64 [m]   lambda of each vertex's fabric
    seams : (k, n) sparse           weights of points sewn together, whose settlement is one
    """

    def __init__(
        self,
        contact: FoamContact,
        cover: Cover,
        foam: FoamMaterial,
        wavelength: FloatArray,
        seams: csc_array,
    ) -> None:
        self.contact, self._foam = contact, foam
        self._wave = contact.per_vertex / contact.area
        self._wavelength = wavelength
        flat = _laplacian(cover.rest, np.array(cover.faces))
        self._spread = csr_array(flat + _SEWN * (seams.T @ seams))
        self._slope = np.zeros(len(wavelength))

    def begin(self, state: FloatArray) -> None:
        """Measure the foam's thickness below the sheet and settle fully, from nothing."""
        n = len(self._wavelength)
        self.thickness = self.contact.foam_thickness(state[:n])
        wave, length = float(self._wave.mean()), float(self._wavelength.mean())
        modulus = self._foam.stress[1] / self._foam.strain[1]
        upper, shear = kerr_layers(modulus / float(np.median(self.thickness)) / wave)
        self.contact.per_vertex = upper * self._wave * self.contact.area
        self._layer = csr_array(shear * wave * (length / (2.0 * np.pi)) ** 2 * self._spread)
        self._knots = self._column(upper)
        s = settled_part(state, n)
        s.fill(0.0)
        gradient = np.zeros_like(state)
        for _ in range(_NEWTON):
            gradient.fill(0.0)
            self.contact.value(state, gradient)
            self.value(state, gradient)
            self.contact.update(state)
            s -= Factor(self.matrix()).column(settled_part(gradient, n))

    def value(self, x: FloatArray, gradient: FloatArray) -> float:
        """Return the energy [J] and add its gradient [N]."""
        n = len(self._slope)
        s, pull = settled_part(x, n), settled_part(gradient, n)
        energy = kernel.column_energy(
            s, self._knots, self._foam.stress, self.contact.area, pull, self._slope
        )
        spread = self._layer @ s
        pull += spread
        return float(energy) + 0.5 * float(np.einsum("i,i->", s, spread))

    def stiffness(self) -> None:
        """None in the positions."""

    def hessian(self, x: FloatArray, *, definite: bool = False) -> csc_array:
        """Nothing in the positions."""
        del definite
        n = 3 * len(self._slope)
        return csc_array((n, n))

    def matrix(self) -> csc_array:
        """Second derivative (n, n) [N/m] in the settlements, springs in contact included."""
        springs = np.where(self.contact.force > 0.0, self.contact.per_vertex, 0.0)
        return csc_array(self._layer + diags_array(self._slope + springs))

    def pressure(self, state: FloatArray) -> FloatArray:
        """Pressure on the columns, spread by the layer, (n,) [Pa]."""
        s, force = settled_part(state, len(self._slope)), np.zeros(len(self._slope))
        kernel.column_energy(
            s, self._knots, self._foam.stress, self.contact.area, force, self._slope
        )
        return np.asarray(force / self.contact.area)

    def _column(self, upper: float) -> FloatArray:
        """Settlement at the knots of the curve, (n, k): what the springs above do not give."""
        way = self.thickness[:, None] * np.diff(self._foam.strain)
        way = way - np.diff(self._foam.stress) / (upper * self._wave)[:, None]
        way = np.maximum(way, _LEAST_STEP * self.thickness[:, None])
        return np.ascontiguousarray(np.pad(np.cumsum(way, axis=1), ((0, 0), (1, 0))))


class SettledFactor:
    """Preconditioner of positions and settlements together, by block elimination.

    Parameters
    ----------
    sheet : preconditioner of the positions; best on the upper springs alone, although foam that
        settles is softer (measured: half the iterations)
    columns : factor of ``Settlement.matrix``
    link : (n,) float64 [N/m]   springs in contact between sheet and columns
    normal : (n, 3) float64     their directions
    """

    def __init__(
        self, sheet: Preconditioner, columns: Factor, link: FloatArray, normal: FloatArray
    ) -> None:
        self._sheet, self._columns = sheet, columns
        self._link, self._normal = link, normal
        self._force = np.zeros_like(normal)

    def solve(self, right: FloatArray, out: FloatArray) -> None:
        """Solve for a state's gradient by blocks, L D L^T."""
        n = len(self._link)
        pull, s = settled_part(right, n), settled_part(out, n)
        below = self._columns.column(pull)
        np.multiply(self._normal, -(self._link * below)[:, None], out=self._force)
        self._force += right[:n]
        self._sheet.solve(self._force, out[:n])
        out[n:] = 0.0
        s[:] = self._columns.column(
            pull - self._link * np.einsum("ij,ij->i", self._normal, out[:n])
        )


def _laplacian(rest: FloatArray, faces: IntArray) -> csc_array:
    """Cotangent Laplacian (n, n) of the flat panels."""
    half_cotangent = 0.5 / np.tan(angles(rest, faces))
    matrix = csc_array((len(rest), len(rest)))
    for k in range(3):
        i, j, w = faces[:, k - 2], faces[:, k - 1], half_cotangent[:, k]
        rows, columns = np.concatenate([i, j, i, j]), np.concatenate([i, j, j, i])
        values = np.concatenate([w, w, -w, -w])
        matrix = matrix + csc_array((values, (rows, columns)), shape=matrix.shape)
    return csc_array(matrix)
