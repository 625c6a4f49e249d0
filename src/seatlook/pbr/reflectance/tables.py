"""The tabulated directional albedos, shipped as a file because good quadrature takes a while."""

from __future__ import annotations

import functools
from pathlib import Path

import numpy as np

from seatlook.model import FloatArray
from seatlook.pbr.kernels.brdf import Tables
from seatlook.pbr.kernels.lookup import ROUGHNESS_LOW

_FILE = Path(__file__).with_name("tables.npz")
ROUGHNESSES = 80
COSINES = 56
# Roughness, anisotropy, azimuth and cosine of what anisotropy adds.
STRETCHED = (16, 9, 9, 20)


@functools.cache
def load_tables() -> Tables:
    """Return the tables of the shipped file."""
    with np.load(_FILE) as file:
        return Tables(*(np.ascontiguousarray(file[name]) for name in Tables._fields))


def compute_tables(grid: int = 256) -> Tables:
    """Integrate all lobes anew with ``grid`` x ``grid`` directions per node; 256 takes 40 s.

    ``numpy.savez_compressed(file, **compute_tables()._asdict())`` writes the shipped file.
    """
    from seatlook.pbr.kernels.tables import integrate, integrate_stretched

    # Rounded, they are packed in a fifth of the space.
    stretched = (field.round(5) for field in integrate_stretched(STRETCHED, max(16, grid // 4)))
    return Tables(*integrate(ROUGHNESSES, COSINES, grid), *stretched)


def roughness_nodes() -> FloatArray:
    """Roughness of the tables' rows."""
    return np.linspace(ROUGHNESS_LOW, 1.0, ROUGHNESSES)


def cosine_nodes() -> FloatArray:
    """Cosine of the tables' columns: even in sqrt(mu), dense where the albedo bends."""
    return np.linspace(0.0, 1.0, COSINES) ** 2
