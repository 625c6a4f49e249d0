"""The cover while it is made: its state, the potential it moves in, its time steps."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import partial
from typing import NamedTuple

import numpy as np
from scipy.sparse import csc_array, diags_array

from seatlook.errors import SolverError
from seatlook.mesh import vertex_normals
from seatlook.model import Cover, Fabric, FloatArray, Solution
from seatlook.solver.element.elastic import ElasticSheet
from seatlook.solver.element.inertia import Gravity, Inertia
from seatlook.solver.energy import Energy
from seatlook.solver.foam.contact import settled_rows
from seatlook.solver.foam.foundation import Foundation
from seatlook.solver.kernels.lbfgs import largest_row
from seatlook.solver.methods.choice import Method, method_of, minimiser
from seatlook.solver.methods.explicit import Explicit, Integrator
from seatlook.solver.methods.factor import (
    Factor,
    Preconditioner,
    Renewed,
    SlidingFactor,
    SplitFactor,
)
from seatlook.solver.methods.lbfgs import Potential
from seatlook.solver.methods.stability import downhill
from seatlook.solver.process.nearest import NearestHessian
from seatlook.solver.process.settings import DEFAULT, SolverSettings
from seatlook.solver.process.stages import Step
from seatlook.solver.process.state import OfPositions, StatePotential, masses
from seatlook.solver.process.ties import Ties
from seatlook.solver.process.transfer import transfer, transfer_peaks

_CARRIED_VELOCITY = 0.5  # share of the velocity that a step hands to the next
_STEP_TOLERANCE = 0.02  # out-of-balance force over mean elastic force that ends a time step
_REST_TOLERANCE = 3e-4  # the same for a static solve, safely below RESIDUAL
# Above this ratio B / (E h^2) bending sets the pace of the minimiser and joins the matrix.
_STIFF_BENDING = 0.02

# Strain of a taut cover, for its stiffness across itself; raised when steps prove too long.
_TAUT = 0.01
_BACKTRACKING = 1.5  # evaluations per iteration from which they are too long
_HELD = 1e12  # N/m, keeps tied vertices out of the normal motion
# Products of the Hessian that look for a way down. With the factor at hand a flat cover 4 % past
# its buckling load shows one within 9, and to know that there is none takes 30 to 190.
_LOOK, _SEARCH = 20, 200

RESIDUAL = 1e-3  # "converged": largest out-of-balance force over mean elastic nodal force


class Record(NamedTuple):
    """One row of the history: time [s], energies [J], gap [m]; ``elastic`` is the sheet's own.

    Work [J] in the step: of the ties and of the weight on the cover, of the cover on what rubs;
    ``damping`` is the loss of the whole potential, which nothing stores; ``placed``
    what the panels' imperfection stored before the first step.
    """

    time: float
    energy: float
    elastic: float
    foam: float
    kinetic: float
    residual: float
    seam_gap: float
    iterations: int
    tie_work: float = 0.0
    weight_work: float = 0.0
    friction_work: float = 0.0
    damping: float = 0.0
    placed: float = 0.0


class Process:
    """State and energies of a cover in the making.

    Parameters
    ----------
    cover : what is made
    settings : how each step is minimised, or integrated
    """

    def __init__(self, cover: Cover, settings: SolverSettings = DEFAULT) -> None:
        self.cover, self.dt, self.iterations = cover, settings.dt, settings.iterations
        fabrics = [material.fabric for material in cover.materials]
        self.sheet = ElasticSheet(cover.rest, cover.faces, cover.panel, fabrics, hem=cover.hem)
        self.panel = np.zeros(len(cover.rest), dtype=np.int64)
        self.panel[cover.faces] = cover.panel[:, None]
        self._tension = tension = _tension(fabrics)
        self._bending_in_factor = _stiffness_ratio(fabrics, cover.element_size) > _STIFF_BENDING
        self._mass: FloatArray = np.array(self.sheet.mass, dtype=np.float64)
        self.gravity = Gravity(self._mass)
        self.inertia = Inertia(self._mass, self.dt)
        self.ties = Ties(cover, tension[self.panel] / cover.element_size)
        self.foundation: Foundation | None = None
        n = len(cover.rest)
        if cover.foam is not None:
            self.foundation = Foundation(cover, cover.foam, self.panel, self.ties.points("seam"))
        below = () if self.foundation is None else self.foundation.energies
        self._outer = Potential([self.gravity, self.ties, *below])
        sheet = [OfPositions(energy, n) for energy in self.sheet.energies]
        self._elastic = Potential(sheet)
        self._static = StatePotential([*sheet, *self._outer.energies], self.foundation)
        self._moving = StatePotential([*self._static.energies, self.inertia], self.foundation)
        self.state = np.zeros((n + (0 if self.foundation is None else settled_rows(n)), 3))
        self.x = self.state[:n]
        np.copyto(self.x, cover.positions)
        self.v = np.zeros_like(self.x)
        self.time = 0.0
        self._factor: Preconditioner | None = None
        self._nearest: NearestHessian | None = None
        self.take(method_of(settings.method))
        self._integrator: Integrator | None = None
        self._taut, self._evaluations, self._fresh = _TAUT, 0, True
        # Asked for several times between two minimisations, at one and the same shape.
        self._measured, self._measured_energy = np.full_like(self.x, np.nan), 0.0
        self._sheet_force = np.zeros_like(self.state)
        self._work, self._start = np.zeros_like(self.state), np.zeros_like(self.x)

    def resume(self, start: Solution, *, time: float) -> None:
        """Take over the state of an earlier solution, or the shape of one on another mesh.

        ``time`` [s]: when the stage of ``start`` ended, that of all records until the next step.
        """
        self._fresh, self.time = False, time
        if not np.array_equal(start.cover.faces, self.cover.faces):
            np.copyto(self.x, transfer(start.cover, start.positions, self.cover))
            if start.strain_peak is not None:
                peaks = transfer_peaks(start.cover, start.strain_peak, self.cover)
                self.sheet.membrane.remember(peaks)
            return
        np.copyto(self.x, start.positions)
        np.copyto(self.v, start.velocities)
        for tie in self.ties.ties:
            if tie.name in start.multipliers:
                self.ties.multiplier[tie.rows] = start.multipliers[tie.name]
        if self.foundation is not None:
            np.copyto(self.foundation.friction.anchor, start.friction_anchor)
        if start.strain_peak is not None:
            self.sheet.membrane.remember(start.strain_peak)

    def take(self, method: Method) -> None:
        """Go on by this method."""
        self.method: Method = method
        self._factor, self._nearest = None, None
        self._minimiser = minimiser(method, self.state.shape)
        if method == "newton":
            self._nearest = NearestHessian(self.sheet, self.cover.positions, self.ties.pattern())

    def step(self, step: Step, *, refactor: bool) -> Record:
        """Advance by one time step; ``refactor`` renews what is made from the stiffness."""
        self.time = step.time
        self.ties.pull(self.x, step.before, step.progress)
        self.lag()
        if isinstance(self.method, Explicit):
            return self._integrate(self.method, refactor=refactor)
        np.multiply(self.v, _CARRIED_VELOCITY * self.dt, out=self.inertia.free)
        self.inertia.free += self.x
        if refactor or self._factor is None:
            self._factor = None
            self._factor = self._preconditioner(Factor)
        limit = _STEP_TOLERANCE * self.force_scale()
        return self._descend(self._factor, limit, self.iterations)

    def begin(self, *, rest: bool = False) -> None:
        """Begin a stage, or the way to rest with all ties closed."""
        self._factor, self._integrator = None, None
        self.ties.sliding.forget()
        if self.foundation is not None:
            self.foundation.begin(self.state)
        if rest:
            self.ties.close()

    def approach_rest(self, dt: float, record: Record, iterations: int) -> Record:
        """Minimise from rest with an inertia of step ``dt``, hardly felt when that is long."""
        self.inertia.set_step(dt)
        self.lag()
        np.copyto(self.inertia.free, self.x)
        limit = max(_REST_TOLERANCE, 0.02 * record.residual) * self.force_scale()
        self._factor = None  # two at a time would be most of the memory
        self._factor = self._preconditioner(self._split)
        record = self._descend(self._factor, limit, iterations)
        if self._evaluations > _BACKTRACKING * record.iterations:
            self._taut = min(5.0 * self._taut, 1.0)
        return record

    def record(self, iterations: int = 0) -> Record:
        """Measure the state with nothing lagging: the balance is that of forces at ``x``."""
        self.lag()
        scale = self.force_scale()
        elastic = self._sheet_energy()
        foam = 0.0
        if self.foundation is not None:
            foam = self.foundation.energy(self.state, self._work)
        energy = self._static_value()
        if not np.isfinite(energy):
            raise SolverError(
                f"energy is {energy} at {self.time:.3g} s: the solution grew without bound"
            )
        speed2 = np.einsum("ij,ij->i", self.v, self.v)
        return Record(
            time=self.time,
            energy=energy,
            elastic=elastic,
            foam=foam,
            kinetic=0.5 * float(self._mass @ speed2),
            residual=largest_row(self._work) / scale,
            seam_gap=self.ties.largest_gap(self.x, "seam"),
            iterations=iterations,
        )

    def downhill(self, kick: float = 0.0) -> bool:
        """Whether the static stiffness is negative in a direction; with a kick [m], move that way.

        What lags (friction, multipliers) is held. False for the explicit method: it has no factor.
        """
        factor, most = self._factor or self._preconditioner(self._split), _LOOK
        if self._nearest is not None:
            factor, most = self._projected(self._nearest), _SEARCH
        if factor is None:
            return False
        mode = downhill(self._static, self.state, factor, most=most)
        if mode is None:
            return False
        mode *= kick / largest_row(mode)
        sides = [self.state + mode, self.state - mode]
        values = [self._static.value(side, self._work) for side in sides]
        np.copyto(self.state, sides[int(np.argmin(values))])
        return True

    def forces(self) -> FloatArray:
        """Gradient (rows of the state, 3) [N] of all but inertia; what lags is as it was."""
        gradient = np.empty_like(self.state)
        self._static.value(self.state, gradient)
        return gradient

    def stiffness(self) -> csc_array:
        """Second derivative of the same over the flattened state [N/m], exact, not projected."""
        self.forces()  # columns of the foam know their slope at the last shape that was measured
        return self._static.hessian(self.state)

    def resultants(self) -> dict[str, FloatArray]:
        """Sum of the forces on the cover by cause, each (3,) [N]."""
        forces = {}
        parts: dict[str, Energy] = {"weight": self.gravity, "ties": self.ties}
        if self.foundation is not None:
            parts |= {"contact": self.foundation.contact, "friction": self.foundation.friction}
        for name, energy in parts.items():
            self._work.fill(0.0)
            energy.value(self.state, self._work)
            forces[name] = -self._work[: len(self.x)].sum(axis=0)
        return forces

    def _descend(self, factor: Preconditioner | None, limit: float, iterations: int) -> Record:
        """Minimise the moving potential until no vertex is out of balance by ``limit`` [N]."""
        np.copyto(self._start, self.x)
        placed = self._sheet_energy() if self._fresh else 0.0
        self._fresh = False
        before = self._outside()
        descent = self._minimiser.minimise(
            self._moving,
            self.state,
            factor,
            stop=lambda gradient: largest_row(gradient) <= limit,
            iterations=iterations,
        )
        np.subtract(self.x, self._start, out=self.v)
        # On the way to rest, too, movement counts by the time step of the process.
        self.v /= self.dt
        self._evaluations = descent.evaluations
        after = self._outside()
        ties, weight, friction, whole = np.subtract(before, after).tolist()
        record = self.record(descent.iterations)._replace(
            tie_work=ties, weight_work=weight, friction_work=-friction, damping=whole, placed=placed
        )
        self.ties.update(self.x)
        return record

    def _outside(self) -> tuple[float, float, float, float]:
        """Potential [J] of ties, weight, friction and of all, with what lags as it is."""
        friction, n = 0.0, len(self.x)
        if self.foundation is not None:
            friction = self.foundation.friction.value(self.state, self._work)
        ties = self.ties.value(self.x, self._work[:n])
        weight = self.gravity.value(self.x, self._work[:n])
        return ties, weight, friction, self._static_value()

    def _integrate(self, options: Explicit, *, refactor: bool) -> Record:
        """Go through a time step by central differences."""
        if self._integrator is None:
            damping = -np.log(_CARRIED_VELOCITY) / self.dt
            own = masses(self._mass, len(self.state))
            self._integrator = Integrator(options, own, damping)
            refactor = True
        if refactor:
            self._integrator.renew(self._static, self.state)
        n = len(self.x)
        np.copyto(self._integrator.velocity[:n], self.v)
        steps = self._integrator.run(self._static, self.state, self.dt)
        np.copyto(self.v, self._integrator.velocity[:n])
        record = self.record(steps)
        self.ties.update(self.x)
        return record

    def lag(self) -> None:
        """Let all that lags agree with the state: history, wires, normal forces, anchors."""
        self.sheet.membrane.wear(self.x)
        self.ties.lag(self.x)
        if self.foundation is not None:
            self.foundation.lag(self.state)

    def _preconditioner(self, make: Callable[[csc_array], Preconditioner]) -> Preconditioner | None:
        """Matrix for a method that uses one, of the positions and what lies below."""
        if self._nearest is not None:
            return Renewed(partial(self._projected, self._nearest))
        if isinstance(self.method, Explicit):
            return None
        matrix = self._matrix()
        factor = make(matrix)
        if self.ties.sliding.rings:
            free = matrix - self.ties.released(self.x).scalar(len(self.x))
            factor = SlidingFactor(factor, csc_array(free), *self.ties.sliding.along(self.x))
        return factor if self.foundation is None else self.foundation.extend(factor)

    def _projected(self, nearest: NearestHessian) -> Preconditioner:
        """Factor of the projected Hessian at the state at hand."""
        scalar = csc_array(self.ties.stiffness() + self.inertia.stiffness())
        released = self.ties.released(self.x)
        if self.foundation is None:
            nearest.factor(self.x, scalar, np.zeros((len(self.x), 3, 3)), released)
            return nearest
        nearest.factor(self.x, scalar, self.foundation.blocks(self.state), released)
        self.foundation.contact.update(self.state)
        return self.foundation.extend(nearest)

    def force_scale(self) -> float:
        """Mean over the vertices of the elastic force [N], or of the weight if that is more.

        A sheet that lies level has weight but no elastic forces.
        """
        self._sheet_energy()
        force = self._sheet_force
        elastic = np.sqrt(np.einsum("ij,ij->i", force, force)).sum() / len(self.x)
        return max(float(elastic), float(self.gravity.weight.mean()))

    def _sheet_energy(self) -> float:
        """Elastic energy [J] of the sheet, gradient in ``_sheet_force``; once for each shape."""
        if not np.array_equal(self._measured, self.x):
            self._measured_energy = self._elastic.value(self.state, self._sheet_force)
            np.copyto(self._measured, self.x)
        return self._measured_energy

    def _static_value(self) -> float:
        """Potential [J] of all but inertia, its gradient in ``_work``."""
        outer = self._outer.value(self.state, self._work)
        energy = self._sheet_energy() + outer
        self._work += self._sheet_force
        return energy

    def _matrix(self) -> csc_array:
        """Scalar stiffness (n, n) [N/m] of everything for the factor."""
        sheet = self.sheet.stiffness(self._bending_in_factor)
        return csc_array(sheet + self._outer.stiffness() + self.inertia.stiffness())

    def _split(self, matrix: csc_array) -> SplitFactor:
        """Factor of ``matrix`` along the sheet, of its resistance to waves across it.

        Across, the sheet answers by bending, tension, curvature (k^2 E h as in a shell) and foam.
        """
        tied = self.ties.vertices[self.ties.weights != 0.0]
        normal = vertex_normals(self.x, self.cover.faces)
        normal[tied] = 0.0
        curvature2 = np.einsum("tij,tij->t", *2 * (self.sheet.curvatures(self.x),))
        arch = np.zeros(len(self.x))
        np.add.at(arch, self.cover.faces, (curvature2 * self.cover.rest_area / 3.0)[:, None])
        diagonal = self._tension[self.panel] * arch + self.inertia.rate
        diagonal[tied] += _HELD
        if self.foundation is not None:
            diagonal += self.foundation.contact.stiffness().diagonal()
        across = self.sheet.across() + self._taut * self.sheet.stiffness() + diags_array(diagonal)
        return SplitFactor(matrix, csc_array(across), normal)


def _tension(fabrics: Sequence[Fabric]) -> FloatArray:
    """Membrane stiffness [N/m] of every fabric, the mean of warp and weft."""
    return np.array([np.sqrt(f.warp.stiffness[0] * f.weft.stiffness[0]) for f in fabrics])


def _stiffness_ratio(fabrics: Sequence[Fabric], h: float) -> float:
    """Largest bending stiffness of the fabrics over that of their membrane, B / (E h^2)."""
    bending = np.array([max(f.bending_warp, f.bending_weft) for f in fabrics])
    return float((bending / (_tension(fabrics) * h**2)).max())
