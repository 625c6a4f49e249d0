"""Where the work goes that is done on a cover while it is made."""

from __future__ import annotations

from dataclasses import dataclass

from seatlook.model import Solution


@dataclass(frozen=True, slots=True, kw_only=True)
class EnergyBalance:
    """Work and energies [J] from the placed panels to the cover at rest.

    Parameters
    ----------
    ties : work of seams, hooks and frame on the cover; weight : of gravity
    placed : elastic energy of the panels where they begin, as their unevenness stores it
    stored : elastic energy of sheet and foam at the end, less ``placed``
    friction : taken up by the foam's friction
    damping : loss of the potential in the time steps, which an implicit step does not store
    """

    ties: float
    weight: float
    placed: float
    stored: float
    friction: float
    damping: float

    @property
    def work_in(self) -> float:
        """All work done on the cover [J]."""
        return self.ties + self.weight

    @property
    def at_rest(self) -> float:
        """Elastic energy of sheet and foam at the end [J]."""
        return self.placed + self.stored

    @property
    def supplied(self) -> float:
        """What there was to spend [J]: the work that was done on the cover, and its start."""
        return sum(max(part, 0.0) for part in (self.ties, self.weight, self.placed))

    @property
    def unexplained(self) -> float:
        """What is left of the work [J]: lost or won where lagging forces are taken up anew."""
        return self.work_in - self.stored - self.friction - self.damping

    @property
    def share(self) -> float:
        """What is left over the work done."""
        return abs(self.unexplained) / self.work_in if self.work_in else 0.0


def energy_balance(solution: Solution) -> EnergyBalance | None:
    """Sum the work of all time steps; None for a result without these columns, or explicit."""
    history = solution.history
    if "damping" not in history or not history["damping"].any():
        return None
    placed = float(history["placed"].sum())
    return EnergyBalance(
        ties=float(history["tie_work"].sum()),
        weight=float(history["weight_work"].sum()),
        placed=placed,
        stored=solution.figures["elastic_energy"] + solution.figures["foam_energy"] - placed,
        friction=float(history["friction_work"].sum()),
        damping=float(history["damping"].sum()),
    )
