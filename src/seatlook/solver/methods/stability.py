"""Whether an equilibrium is stable, found from the gradient alone."""

from __future__ import annotations

import numpy as np

from seatlook.model import FloatArray
from seatlook.solver.kernels import lbfgs as kernel
from seatlook.solver.methods.factor import Preconditioner
from seatlook.solver.methods.lbfgs import Potential

_WAY = 1e-7  # m, of the differences
_ENOUGH = 1e-6  # of the first residual: no direction was left out
_DOWN = -1e-6  # of what the preconditioner says of the direction; above it is rounding


def downhill(
    potential: Potential, x: FloatArray, factor: Preconditioner, *, most: int
) -> FloatArray | None:
    """Return a direction in which the potential curves downwards at ``x``, None if none is found.

    Conjugate gradients on the Hessian, whose products are differences of the gradient, from a
    random right-hand side: before they can end on an indefinite matrix they come across such a
    direction (Nocedal and Wright 2006, Numerical Optimization, section 7.1). They stop after
    ``most`` products; directions that hardly lead down are found last and may be left out then, so
    this is a search and no proof.

    Parameters
    ----------
    factor : of a positive definite matrix close to the Hessian; what it is close to is found last
    """
    ahead, behind = np.empty_like(x), np.empty_like(x)
    residual, solved = np.random.default_rng(0).standard_normal(x.shape), np.empty_like(x)
    factor.solve(residual, solved)
    direction = solved.copy()
    square = first = guess = kernel.dot(residual, solved)
    for _ in range(most):
        size = kernel.largest_row(direction)
        if not square > _ENOUGH**2 * first or size == 0.0:
            break
        way = _WAY / size
        potential.value(x + way * direction, ahead)
        potential.value(x - way * direction, behind)
        product = (ahead - behind) / (2.0 * way)
        curvature = kernel.dot(direction, product)
        if curvature <= 0.0:
            return direction if curvature < _DOWN * guess else None
        residual -= square / curvature * product
        factor.solve(residual, solved)
        new_square = kernel.dot(residual, solved)
        share, square = new_square / square, new_square
        direction = solved + share * direction
        # The new part and the old direction are conjugate in the factor's own matrix.
        guess = new_square + share**2 * guess
    return None
