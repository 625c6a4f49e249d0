"""What a cloth's numbers mean for wrinkles on a foam."""

from __future__ import annotations

import numpy as np

from seatlook.model import Fabric, FoamMaterial

_PER_WAVE = 8  # elements that a wave takes


def outlook(fabric: Fabric, foam: FoamMaterial) -> tuple[tuple[str, float, float], ...]:
    """Return rows of (what, along warp, along weft) for waves across these directions.

    A sheet on an elastic half-space: its line load is ``B k^2 + E / (2 k)`` at the wave number k,
    least at ``k^3 = E / (4 B)``, where it is ``3 B k^2``; E is Young's modulus in plane strain.

    Examples
    --------
    >>> from seatlook.io.material import read_foam_material, read_material
    >>> rows = outlook(read_material("woven").fabric, read_foam_material("foam-seat"))
    >>> round(rows[0][1])
    18
    """
    E = foam.young / (1.0 - foam.poisson**2)
    B = np.array([fabric.bending_warp, fabric.bending_weft])
    first = np.array([fabric.warp.stiffness[0], fabric.weft.stiffness[0]])
    k = np.cbrt(E / (4.0 * B))
    wave = 2e3 * np.pi / k
    load = 3.0 * B * k**2
    strain = 100.0 * load / (fabric.compression_ratio * first)
    rows = [
        ("wavelength on the foam [mm]", wave),
        ("line load at which it wrinkles [N/m]", load),
        ("compression at which it wrinkles [%]", strain),
        ("largest element [mm]", wave / _PER_WAVE),
    ]
    lost = (fabric.bending_warp_hysteresis, fabric.bending_weft_hysteresis)
    if None not in lost:
        radius = 1e3 * 2.0 * B / np.maximum(np.array(lost, dtype=float), 1e-12)
        rows.append(("radius that a fold keeps by itself [mm]", radius))
    return tuple((name, float(values[0]), float(values[1])) for name, values in rows)
