"""A rig as the head of its column: its exposure, lux at the seat, and lights."""

from __future__ import annotations

import numpy as np

from seatlook.model import Light, Rig
from seatlook.model.table import number
from seatlook.pbr import ev100, lux_at_seat
from seatlook.report.page.data import RigHead


def rig_head(rig: Rig) -> RigHead:
    """Describe a rig by its exposure, lux at the seat and lights."""
    lights = [_described(light) for light in rig.lights]
    if rig.ambient > 0:
        lights.append(f"sky, {number(rig.ambient)} cd/m2")
    return RigHead(
        name=rig.name,
        ev100=ev100(rig),
        illuminance=lux_at_seat(rig)["total"],
        lights=tuple(lights),
        places=tuple((light.name, *_seen_at(light), light.near) for light in rig.lights),
    )


def _seen_at(light: Light) -> tuple[float, float]:
    """Azimuth and elevation [deg] of a light from the seat, which lies about the origin."""
    x, y, z = light.vector / np.linalg.norm(light.vector)
    return float(np.degrees(np.arctan2(x, -y)) % 360), float(np.degrees(np.arcsin(z)))


def _described(light: Light) -> str:
    if light.near:
        x, y, z = (number(round(1e3 * v)) for v in light.vector)
        bulb = f"{light.name}, {number(light.intensity)} cd at ({x}, {y}, {z}) mm"
        if not light.is_rectangle:
            return bulb
        long, short = (number(round(2e3 * side)) for side in np.linalg.norm(light.sides, axis=1))
        return f"{bulb}, {long} x {short} mm"
    return f"{light.name}, {number(light.intensity)} lx facing"
