"""What lies below the cover: contact, settlement and friction of one foam."""

from __future__ import annotations

import numpy as np
from scipy.sparse import csc_array

from seatlook.model import Cover, FloatArray, Foam, IntArray
from seatlook.solver.energy import Energy
from seatlook.solver.foam.contact import FoamContact, foam_wavelength, settled_part, wave_stiffness
from seatlook.solver.foam.distance import distance_field
from seatlook.solver.foam.friction import Friction
from seatlook.solver.foam.settlement import SettledFactor, Settlement
from seatlook.solver.methods.factor import Factor, Preconditioner


class Foundation:
    """The foam of a cover, as energies over positions and settlements.

    Parameters
    ----------
    panel : (n,) int64   panel of each vertex
    seams : (k, n) sparse       weights of points sewn together, whose settlement is one
    """

    def __init__(self, cover: Cover, foam: Foam, panel: IntArray, seams: csc_array) -> None:
        fabrics = [material.fabric for material in cover.materials]
        half = np.array([0.5 * f.thickness for f in fabrics])
        springs = np.array([wave_stiffness(f, foam.material) for f in fabrics])
        waves = np.array([foam_wavelength(f, foam.material) for f in fabrics])
        area = np.zeros(len(cover.rest))
        np.add.at(area, cover.faces, cover.rest_area[:, None] / 3.0)
        field = distance_field(foam.vertices, foam.faces)
        self.foam, self.material, self.wavelength = foam, foam.material, float(waves.min())
        below = half[panel] if cover.hem is None else half[panel] + cover.hem.lift
        self.contact = FoamContact(field, below, springs[panel], area)
        self.friction = Friction(self.contact, foam.material.friction)
        self.settlement = Settlement(self.contact, cover, foam.material, waves[panel], seams)

    @property
    def energies(self) -> tuple[Energy, ...]:
        """The terms of the potential."""
        return (self.contact, self.settlement, self.friction)

    def begin(self, state: FloatArray) -> None:
        """Begin a stage: measure the foam below the sheet and let it settle."""
        self.settlement.begin(state)

    def lag(self, state: FloatArray) -> None:
        """Refresh what a minimisation holds fixed: normal forces, normals, friction anchors."""
        self.contact.update(state)
        self.friction.update(state)

    def energy(self, state: FloatArray, work: FloatArray) -> float:
        """Energy stored in the foam [J]; ``work`` is overwritten."""
        return self.contact.value(state, work) + self.settlement.value(state, work)

    def blocks(self, state: FloatArray) -> FloatArray:
        """Second derivative in each position, (n, 3, 3) [N/m], without what may be negative."""
        positions = state[: len(self.contact.area)]
        return self.contact.blocks(state, definite=True) + self.friction.blocks(positions)

    def extend(self, sheet: Preconditioner) -> Preconditioner:
        """Extend a preconditioner of the positions to the settlements."""
        link = np.where(self.contact.force > 0.0, self.contact.per_vertex, 0.0)
        columns = Factor(self.settlement.matrix())
        return SettledFactor(sheet, columns, link, self.contact.normal.copy())

    def figures(self, state: FloatArray) -> dict[str, float]:
        """Depths [m], pressures [Pa] and forces [N] at the last update."""
        contact, settlement = self.contact, settled_part(state, len(self.contact.area))
        touching = contact.force > 0.0
        depth = np.where(touching, contact.depth + settlement, 0.0)
        return {
            "contact_depth_max": float(depth.max()),
            "contact_settlement_max": float(settlement.max()),
            "contact_pressure_max": float(contact.pressure().max()),
            "contact_column_pressure_max": float(self.settlement.pressure(state).max()),
            "contact_compression_max": float((depth / self.settlement.thickness).max()),
            "contact_force": float(contact.force.sum()),
            "contact_vertices": float(np.count_nonzero(touching)),
        }
