"""Solved covers of one or two flat panels bent into a given shape, strains from the element."""

import numpy as np

from seatlook.model import Cover, Solution
from seatlook.solver.element.elastic import ElasticSheet
from support.meshes import rectangle
from support.scenes import fabric, material

SIZE = 0.12


def shaped(shape, *, h=0.005, kind="uns", size=SIZE, panels=1, grain=0.0, **cover):
    """Solve nothing: panels side by side (0.2 m apart at rest) are put where ``shape`` says.

    ``shape(rest) -> (n, 3)`` takes rest coordinates; zones are the panels. ``size`` is a side or
    both; the pattern is the rest plane turned by ``grain`` [rad] and moved.
    """
    X, T = rectangle(kind, *np.broadcast_to(size, 2), h)
    rest = np.concatenate([X + np.array([0.2 * k, 0.0]) for k in range(panels)])
    faces = np.concatenate([T + k * len(X) for k in range(panels)])
    panel = np.repeat(np.arange(panels), len(T))
    names = tuple(f"P{k}" for k in range(panels))
    x = shape(rest)
    sheet = ElasticSheet(rest, faces, panel, [fabric()] * panels)
    top, mid, bottom = sheet.strains(x)
    return Solution(
        cover=Cover(
            rest=rest, uv=pattern_of(rest, grain), positions=x, faces=faces, panel=panel,
            panel_names=names, materials=(material(),) * panels, zone=panel, zone_names=names,
            element_size=h, **cover,
        ),
        positions=x, velocities=np.zeros_like(x), friction_anchor=np.full_like(x, np.nan),
        strain_top=top, strain_mid=mid, strain_bottom=bottom, stage="end", status="converged",
    )  # fmt: skip


def pattern_of(rest, grain=0.0):
    """Pattern coordinates (k, 2) of rest coordinates."""
    c, s = np.cos(grain), np.sin(grain)
    return rest @ [[c, s], [-s, c]] + 0.01


def wave(amplitude, wavelength):
    """A sine along the first axis; the sheet is not stretched to first order."""
    k = 2 * np.pi / wavelength
    return lambda X: np.column_stack([X, amplitude * np.sin(k * X[:, 0])])
