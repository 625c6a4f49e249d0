"""What a card of another program loses of a cloth, in numbers."""

from __future__ import annotations

import numpy as np

from seatlook.io.lsdyna.fabric_card import FabricCard
from seatlook.model import Fabric, FloatArray
from seatlook.model.table import number
from seatlook.solver.element.constitutive import constitutive_tables
from seatlook.solver.kernels import membrane as kernels

_STRAIN = 0.02  # at which states off the axes are compared


def law_stress(fabric: Fabric, strain: FloatArray) -> FloatArray:
    """Return the stresses (k, 3) [N/m] of the solver's law at (E11, E22, 2 E12)."""
    E = np.array(strain, dtype=np.float64, order="C")
    constants = np.array([[fabric.poisson * fabric.weft.stiffness[0], fabric.compression_ratio]])
    owner = np.zeros(len(E), dtype=np.int64)
    return np.asarray(kernels.stresses(E, owner, *constitutive_tables([fabric]), constants))


def losses(fabric: Fabric, card: FabricCard) -> tuple[tuple[str, str, str], ...]:
    """Return rows of (what, in the cloth, on the card) for all that differs.

    Stretched along warp or weft alone, or sheared, the card is the cloth; both ways at once it has
    no coupling but that of its coats.
    """
    e = _STRAIN
    states = np.array([[e, e, 0.0], [0.5 * e, 0.5 * e, e]])
    law, given = law_stress(fabric, states), card.stress(states)
    pull = np.array([0.5, 0.5, 1.0])  # along 45 degrees
    rows: list[tuple[str, str, str]] = [
        ("S11 both ways by 2 % [N/m]", number(law[0, 0]), number(given[0, 0])),
        ("S22 both ways by 2 % [N/m]", number(law[0, 1]), number(given[0, 1])),
        ("pull along 45 degrees by 2 % [N/m]", number(law[1] @ pull), number(given[1] @ pull)),
        ("stiffness in compression, of the first", number(fabric.compression_ratio), "0"),
    ]
    B = 1e-3 * card.bending
    for name in ("warp", "weft", "twist"):
        value = getattr(fabric, f"bending_{name}")
        own = B if name != "twist" else 0.35 * B
        rows.append((f"bending {name} [N m]", f"{value:.3g}", f"{own:.3g}"))
    if fabric.shear_hysteresis is not None:
        width = f"width {number(fabric.shear_hysteresis.width)} N/m"
        rows.append(("friction in shear", width, f"H = {number(card.hysteresis)}"))
    kept = ("bending_warp_hysteresis", "bending_weft_hysteresis")
    values = ((name, getattr(fabric, name)) for name in kept)
    rows += [(f"{name} [N]", f"{value:.3g}", "none") for name, value in values if value is not None]
    return tuple(rows)
