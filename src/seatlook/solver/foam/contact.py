"""Foam under the cover: how stiff, how deep, how hard it presses."""

from __future__ import annotations

import math

import numpy as np
from scipy.sparse import bsr_array, csc_array, diags_array

from seatlook.model import Fabric, FloatArray, FoamMaterial
from seatlook.solver.foam.distance import DistanceField
from seatlook.solver.kernels import contact as kernel


def plane_strain_modulus(foam: FoamMaterial) -> float:
    """E* = E / (1 - nu^2) of the foam [Pa]."""
    return foam.young / (1.0 - foam.poisson**2)


def foam_wavelength(fabric: Fabric, foam: FoamMaterial) -> float:
    """Shortest wrinkle that the fabric makes on its foam, lambda = 2 pi (4 B / E*)^(1/3) [m].

    Parameters
    ----------
    fabric : its softer direction of bending counts
    foam : taken as an elastic half-space

    Notes
    -----
    A film on a half-space (Allen 1969; Bowden et al. 1998), lambda = 2 pi t (Ef / (3 E*))^(1/3),
    written with the bending stiffness B = Ef t^3 / 12. Elements of lambda / 8 resolve the shape,
    lambda / 12 the curvature.
    """
    bending = min(fabric.bending_warp, fabric.bending_weft)
    return 2.0 * math.pi * math.cbrt(4.0 * bending / plane_strain_modulus(foam))


def wave_stiffness(fabric: Fabric, foam: FoamMaterial) -> float:
    """Half-space stiffness pi E* / lambda against a wave of ``foam_wavelength`` [N/m3]."""
    return math.pi * plane_strain_modulus(foam) / foam_wavelength(fabric, foam)


def settled_rows(count: int) -> int:
    """Rows of three that hold one settlement for each of ``count`` vertices."""
    return -(-count // 3)


def settled_part(state: FloatArray, count: int) -> FloatArray:
    """View (count,) of the settlements that follow the positions in a state or gradient."""
    return state[count:].reshape(-1)[:count]


class FoamContact:
    """Energy of the foam pressed in by the sheet's lower face.

    The state holds n positions and, if it goes on, the settlements of the foam below them.

    Parameters
    ----------
    field : distance from the foam
    half_thickness : (n,) float64 [m]   of the sheet at each vertex
    stiffness : (n,) float64 [N/m3]     of the foam below it
    area : (n,) float64 [m2]            at rest, that the vertex stands for
    """

    def __init__(
        self,
        field: DistanceField,
        half_thickness: FloatArray,
        stiffness: FloatArray,
        area: FloatArray,
    ) -> None:
        self.field, self.area, self.half_thickness = field, area, half_thickness
        self.per_vertex = stiffness * area
        n = len(area)
        self.force, self.depth, self.normal = np.zeros(n), np.zeros(n), np.zeros((n, 3))
        self._blocks, self._firm = np.zeros((n, 3, 3)), np.zeros((2, n))
        # The same shape is measured several times: value, forces, state.
        self._places, self._distances = np.full((n, 3), np.nan), np.empty((n, 5))

    def value(self, x: FloatArray, gradient: FloatArray) -> float:
        """Return the energy [J] and add its gradient [N]."""
        pull = settled_part(gradient, len(self.area)) if len(x) > len(self.area) else self._firm[1]
        settlement = self._measure(x)
        return float(
            kernel.contact_value(
                self._distances, self.half_thickness, settlement, self.per_vertex, gradient, pull
            )
        )

    def update(self, x: FloatArray) -> None:
        """Refresh normal force, normal and depth of the springs at ``x``."""
        settlement = self._measure(x)
        kernel.contact_state(
            self._distances,
            self.half_thickness,
            settlement,
            self.per_vertex,
            self.force,
            self.normal,
            self.depth,
        )

    def pressure(self) -> FloatArray:
        """Pressure at the last update, per rest area, (n,) [Pa]."""
        return np.asarray(self.force / self.area)

    def foam_thickness(self, x: FloatArray) -> FloatArray:
        """Thickness of the foam below each vertex, (n,) [m]; never more than its least extent.

        Load on a tall side spreads over the side's height rather than go through the whole cushion.
        """
        phi, normal = self.field.at(x)
        near = np.isfinite(phi)
        unit = normal[near] / np.linalg.norm(normal[near], axis=1, keepdims=True)
        depth = np.empty(len(unit))
        surface = x[near] - phi[near, None] * unit
        kernel.thickness(self.field.coefficients, self.field.grid, surface, unit, depth)
        thickness = np.clip(depth, self.field.grid[3], self.field.least_extent)
        result = np.full(
            len(x), float(np.median(thickness)) if len(thickness) else self.field.least_extent
        )
        result[near] = thickness
        return result

    def stiffness(self) -> csc_array:
        """Foam stiffness of the vertices that touched at the last update."""
        return diags_array(np.where(self.force > 0.0, self.per_vertex, 0.0)).tocsc()

    def hessian(self, x: FloatArray, *, definite: bool = False) -> csc_array:
        """Second derivative in the positions [N/m]; ``definite`` leaves phi's curvature out."""
        return diagonal_blocks(self.blocks(x, definite=definite))

    def blocks(self, x: FloatArray, *, definite: bool = False) -> FloatArray:
        """Diagonal blocks (n, 3, 3) of the Hessian; overwritten by the next call."""
        settlement = self._measure(x)
        kernel.contact_blocks(
            x,
            self.field.coefficients,
            self.field.grid,
            self._distances,
            self.half_thickness,
            settlement,
            self.per_vertex,
            definite,
            self._blocks,
        )
        return self._blocks

    def _measure(self, x: FloatArray) -> FloatArray:
        """Measure the distances at ``x``; return the settlements there."""
        n = len(self.area)
        settlement = settled_part(x, n) if len(x) > n else self._firm[0]
        field = self.field
        kernel.measure(
            x,
            field.coefficients,
            field.grid,
            self.half_thickness,
            settlement,
            self._places,
            self._distances,
        )
        return settlement


def diagonal_blocks(blocks: FloatArray) -> csc_array:
    """Sparse (3n, 3n) matrix of (n, 3, 3) diagonal blocks."""
    n = len(blocks)
    bsr = bsr_array((blocks.copy(), np.arange(n), np.arange(n + 1)), shape=(3 * n, 3 * n))
    return csc_array(bsr)
