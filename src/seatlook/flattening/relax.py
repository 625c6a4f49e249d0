"""Flattening one patch: least elastic energy, with edges of given length and darts open."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from seatlook.errors import SeatlookError
from seatlook.flattening.fabric_sheet import FabricLaw
from seatlook.flattening.face_map import face_axes, gradient_of, grown
from seatlook.flattening.newton import Law, Separable, Tie, minimise
from seatlook.flattening.start import unfolded_start
from seatlook.mesh import face_areas
from seatlook.model import Fabric, FloatArray, IntArray

_MAX_STEPS = 400
_CONVERGED = 1e-7  # [m] that the last step moved at most
_SETTLED = 1e-8  # share of the energy that the last step won
_STRAINLESS = 1e-16  # mean squared strain that is none
# Weight of a held edge length against the faces beside it: 1e4 holds lengths to about 1e-6.
_HOLD = 1e4
# Where lengths, or sides of darts [m], are far from those asked for, lengths are drawn there by and
# by: at once, a border that is to become much shorter crumples.
_FAR, _OVERLAP, _FAR_HOLDS, _FAR_SETTLED = 0.03, 1e-4, (1.0, 1e2), 1e-3
# Of the sides of a dart that lie over each other [1]: it leaves them some hundredths of a mm.
_APART = 1e2
# Green's strain gives way far from 0. Faces beyond this stretch, where the form strains the panel
# by a quarter, resist more, the weight times as much.
_BOUND, _RESISTANCE = 0.8, 2.0


@dataclass(frozen=True, slots=True, kw_only=True)
class HeldEdges:
    """Mesh edges (k, 2) whose flat length (k,) [m] is prescribed."""

    vertices: IntArray
    length: FloatArray


@dataclass(frozen=True, slots=True, kw_only=True)
class Openings:
    """Pairs of vertices (k, 2) on both sides of darts, which may not lie over each other.

    Parameters
    ----------
    across : (k, 2)       unit vectors from the first side to the second
    least : (k,) [m]      by which the second is to lie that way
    """

    vertices: IntArray
    across: FloatArray
    least: FloatArray

    def energy(self, span: FloatArray) -> FloatArray:
        """Return what it costs (k,) that sides lie over each other."""
        return np.asarray(_APART * self.missing(span) ** 2 / 2)

    def derivatives(self, span: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return slope (k, 2) and curvature (k, 2, 2) of the energy; none of it is below 0."""
        missing = self.missing(span)
        square = self.across[:, :, None] * self.across[:, None, :]
        active = np.where(missing > 0, _APART, 0.0)
        stiff = active[:, None, None] * square
        return -_APART * missing[:, None] * self.across, stiff, np.zeros_like(stiff)

    def missing(self, span: FloatArray) -> FloatArray:
        """Return how far (k,) [m] the sides are from where they are to be at least."""
        return np.asarray(np.maximum(self.least - (span * self.across).sum(axis=1), 0.0))


def flatten_patch(
    vertices: FloatArray,
    faces: IntArray,
    held: HeldEdges | None = None,
    *,
    openings: Openings | None = None,
    growth: FloatArray | None = None,
    start: FloatArray | None = None,
    fabric: Fabric | None = None,
) -> FloatArray:
    """Return flat positions (n, 2) [m] of least strain energy with edges of given length.

    Without a fabric that of an isotropic sheet without Poisson effect, ``sum A |G|^2`` with the
    Green strain ``G = (F^T F - I) / 2`` of the map from space to the plane, and more where the
    form stretches the sheet by over a quarter. With one that of the fabric laid onto the form,
    ``sum A psi(E)`` with the strain E of the map from the plane to space, warp along the second
    axis, and more where there is a quarter too much of it; the patch then keeps the direction of
    ``start``. No face is ever turned over.

    Parameters
    ----------
    vertices : (n, 3) float64 [m]; faces : (m, 3) int64, a disk
    held : edges with a length of their own; None for none
    openings : sides of darts that are kept apart; None for none
    growth : (m, 3, 3)   symmetric stretch that each face is to have in the plane; None for none
    start : (n, 2) [m]   first guess without a turned face; None takes ``unfolded_start``
    fabric : warp, weft and shear curves; compression counts as tension does

    Raises
    ------
    SeatlookError
        The mesh has faces without area, or the steps do not converge; says where.
    """
    gradient = gradient_of(vertices, faces)
    if growth is not None:
        gradient = grown(gradient, growth, face_axes(vertices, faces))
    x = unfolded_start(vertices, faces) if start is None else start
    area = face_areas(vertices, faces)
    laws: list[Law] = [_SHEET] if fabric is None else [FabricLaw(fabric), _CRUSHED]
    ties: list[Tie] = [] if openings is None else [openings]
    if fabric is not None or openings is not None:
        # Both know directions of the plane; free to turn, the panel would follow them slowly.
        ties.append(_chord(x, float(area.sum())))
    nothing = _STRAINLESS * float(area.sum())
    left = None
    for hold, settled in _holds(x, held, openings):
        lengths = [] if held is None else [_lengths(held, hold * float(area.mean()))]
        x, left = minimise(
            x, gradient, area, laws, [*ties, *lengths], steps=_MAX_STEPS,
            enough=lambda won, value, moved, share=settled: (  # type: ignore[misc]
                moved < _CONVERGED or won < share * value + nothing
            ),
        )  # fmt: skip
    if left is None:
        return x
    worst = 1e3 * vertices[np.linalg.norm(left, axis=1).argmax()]
    raise SeatlookError(
        f"flattening does not converge in {_MAX_STEPS} steps and still moves near "
        f"{worst.round(1)} mm"
    )


def _holds(
    x: FloatArray, held: HeldEdges | None, openings: Openings | None
) -> list[tuple[float, float]]:
    """Return how much lengths are held, one time after the other, and when each is settled."""
    if held is None or len(held.length) == 0:
        return [(_HOLD, _SETTLED)]
    span = x[held.vertices[:, 1]] - x[held.vertices[:, 0]]
    far = np.abs(np.linalg.norm(span, axis=1) / held.length - 1).max() > _FAR
    if openings is not None:
        span = x[openings.vertices[:, 1]] - x[openings.vertices[:, 0]]
        far |= openings.missing(span).max() > _OVERLAP
    softly = [(hold, _FAR_SETTLED) for hold in _FAR_HOLDS] if far else []
    return [*softly, (_HOLD, _SETTLED)]


def _sheet(s: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Half the square of Green's strain, and of ``share / s - 1`` for stretches below the share."""
    beyond = np.maximum(_BOUND / s - 1, 0.0)
    slope = np.where(beyond > 0, -_BOUND / s**2, 0.0)
    more = np.where(beyond > 0, 2 * _BOUND / s**3, 0.0)
    green = ((s**2 - 1) ** 2 / 8, (s**2 - 1) * s / 2, (3 * s**2 - 1) / 2)
    value, first, second = map(np.add, green, _squares(beyond, slope, more))
    return value, first, second


def _crushed(s: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Half the square of ``share s - 1``.

    A fabric's strain counts the other way, from the plane to the form: it resists crushed faces
    without bound, and gives way where there is much too much cloth.
    """
    beyond = np.maximum(_BOUND * s - 1, 0.0)
    return _squares(beyond, np.where(beyond > 0, _BOUND, 0.0), np.zeros_like(s))


def _squares(
    beyond: FloatArray, slope: FloatArray, curvature: FloatArray
) -> tuple[FloatArray, FloatArray, FloatArray]:
    weight = _RESISTANCE**2
    return (
        weight * beyond**2 / 2,
        weight * beyond * slope,
        weight * (slope**2 + beyond * curvature),
    )


_SHEET, _CRUSHED = Separable(_sheet), Separable(_crushed)


@dataclass(frozen=True, slots=True)
class _Lengths:
    """Edges held at their length."""

    held: HeldEdges
    weight: FloatArray

    @property
    def vertices(self) -> IntArray:
        return self.held.vertices

    def energy(self, span: FloatArray) -> FloatArray:
        return self.weight * self._off(span) ** 2 / 2

    def derivatives(self, span: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        off, along = self._off(span), span / self.held.length[:, None] ** 2
        spread = (self.weight * off / self.held.length**2)[:, None, None] * np.eye(2)
        stiff = self.weight[:, None, None] * along[:, :, None] * along[:, None, :]
        return (
            (self.weight * off)[:, None] * along,
            stiff + np.maximum(spread, 0.0),
            np.minimum(spread, 0.0),
        )

    def _off(self, span: FloatArray) -> FloatArray:
        return np.asarray(((span**2).sum(axis=1) / self.held.length**2 - 1) / 2)


def _lengths(held: HeldEdges, weight: float) -> _Lengths:
    """Hold edges by their length: a line is equally stiff all along, however it is divided."""
    mean = held.length.mean() if len(held.length) else 1.0
    return _Lengths(held, weight * held.length / mean)


@dataclass(frozen=True, slots=True)
class _Chord:
    """Two vertices far apart; the line between them keeps its direction, and so the grain."""

    vertices: IntArray
    across: FloatArray
    weight: float

    def energy(self, span: FloatArray) -> FloatArray:
        return np.asarray(self.weight * (span @ self.across) ** 2 / 2)

    def derivatives(self, span: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
        stiff = self.weight * np.outer(self.across, self.across)[None]
        return span @ stiff[0], stiff, np.zeros_like(stiff)


def _chord(x: FloatArray, area: float) -> _Chord:
    first = int(np.linalg.norm(x - x.mean(axis=0), axis=1).argmax())
    second = int(np.linalg.norm(x - x[first], axis=1).argmax())
    along = x[second] - x[first]
    length = float(np.linalg.norm(along))
    across = np.array([-along[1], along[0]]) / length
    return _Chord(np.array([[first, second]]), across, _HOLD * area / length**2)
