"""Solved covers of one or two flat panels bent into a given shape, strains from the element."""

import numpy as np

from seatlook.model import Cover, Solution, Stitching
from seatlook.solver.element.elastic import ElasticSheet
from support.covers import points_along, row
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


def sewn(shape, *, h=0.005, notches=(), **options):
    """Two panels sewn at the right border of P0 and the left one of P1, notches at shares of it."""
    plain = shaped(shape, h=h, panels=2, **options)
    rest = plain.cover.rest
    count = round(SIZE / h) + 1
    at = np.linspace(0.0, 1.0, count)
    a, b = (points_along(rest, row(rest, 0, x), at) for x in (SIZE, 0.2))
    seam = Stitching(
        name="P0-P1", a=a, b=b, length=np.full(count, h), stage="end",
        notches=np.array(notches) * (count - 1),
    )  # fmt: skip
    return shaped(shape, h=h, panels=2, stitchings=(seam,), **options)


def stretched_along(strain_a, strain_b):
    """Shape of two panels whose strain along their seam is a function of the distance from it."""

    def shape(X):
        first = X[:, 0] < 0.16
        distance = np.where(first, SIZE - X[:, 0], X[:, 0] - 0.2)
        strain = np.where(first, strain_a(distance), strain_b(distance))
        y = X[:, 1] - SIZE / 2
        return np.column_stack([X[:, 0], SIZE / 2 + y * (1.0 + strain), np.zeros(len(X))])

    return shape
