"""What every octave of two pictures shows of their difference."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from seatlook.errors import InputError
from seatlook.model import FloatArray
from seatlook.visibility.kernels.band import contrasts, weigh
from seatlook.visibility.kernels.pyramid import blur, expand, reduce, soften
from seatlook.visibility.observer import (
    LOWEST_OCTAVE,
    NODES_PER_OCTAVE,
    Observer,
    sensitivity_table,
)

# Frequency [cycles/pixel] to which the finest band answers most; each further one to half of it.
PEAK = 0.2194


@dataclass(frozen=True, slots=True, kw_only=True)
class Response:
    """One octave, both figures to the power of the pooling exponent.

    Parameters
    ----------
    frequency : [cycles/deg]       to which the band answers most
    visible : (h, w) float64       change in contrast over its threshold, h and w halved per octave
    contrast : (h, w) float64      change in contrast less its threshold, 0 below it
    """

    frequency: float
    visible: FloatArray
    contrast: FloatArray


@dataclass(frozen=True, slots=True)
class _Level:
    """Change in contrast, the same in thresholds, squared thresholds of what both share (h, w)."""

    frequency: float
    change: FloatArray
    seen: FloatArray
    shared: FloatArray


def responses(
    test: FloatArray,
    reference: FloatArray,
    pixels_per_degree: float,
    observer: Observer,
    highest: float = np.inf,
) -> list[Response]:
    """Split two pictures (h, w) [cd/m2] into octaves and weigh their difference, finest first.

    Parameters
    ----------
    highest : [cycles/deg]    octaves that peak above are left out, though what they show hides
        others; one below counts by how far it is below, and in full an octave lower, so that no
        score jumps where a camera moves or a mesh is a little finer

    Raises
    ------
    InputError
        No octave above the lowest frequency of the observer and below ``highest``.
    """
    levels = list(_levels(test, reference, pixels_per_degree, observer))
    octaves = np.array([level.frequency for level in levels])
    shares = np.clip(np.log2(highest / octaves), 0.0, 1.0)
    if not shares.any():
        raise InputError.single(
            "pixels_per_degree",
            got=f"{pixels_per_degree:g}, frequencies up to {highest:.3g} cycles/deg",
            expected=f"at least one octave above {observer.lowest_frequency:g} cycles/deg",
            hint="a finer mesh carries shorter waves, and from further away more of them are seen",
        )
    return [_response(levels, int(k), float(shares[k]), observer) for k in np.flatnonzero(shares)]


def _levels(
    test: FloatArray, reference: FloatArray, pixels_per_degree: float, observer: Observer
) -> Iterator[_Level]:
    """Give the octaves from fine to coarse, down to the lowest frequency or four pixels."""
    frequency = PEAK * pixels_per_degree
    test, reference = soften(test), soften(reference)
    while frequency >= observer.lowest_frequency and min(test.shape) >= 4:
        test_next, reference_next = reduce(test), reduce(reference)
        ground, ground_reference = np.empty_like(test), np.empty_like(test)
        expand(test_next, ground)
        expand(reference_next, ground_reference)
        change, shared = np.empty_like(test), np.empty_like(test)
        contrasts(test, reference, ground, ground_reference, observer.darkest, change, shared)
        table = sensitivity_table(frequency, observer)
        weigh(change, shared, ground, table, LOWEST_OCTAVE, NODES_PER_OCTAVE)
        yield _Level(frequency, change, ground, blur(shared))
        test, reference, frequency = test_next, reference_next, frequency / 2


def _response(levels: list[_Level], k: int, share: float, observer: Observer) -> Response:
    """Compare the change in one octave with its threshold beside what this and the next two hide.

    The threshold is raised by sqrt(1 + k^2 (M_b^2 + w (M_b-1^2 + M_b+1^2))).
    """
    level = levels[k]
    hidden = level.shared.copy()
    for other in levels[max(k - 1, 0) : k]:
        hidden += observer.masking_neighbours * reduce(other.shared)
    for other in levels[k + 1 : k + 2]:
        grown = np.empty_like(hidden)
        expand(other.shared, grown)
        hidden += observer.masking_neighbours * grown
    hidden *= observer.masking_gain**2
    hidden += 1
    visible = level.seen / np.sqrt(hidden)
    above = np.maximum(1 - 1 / np.maximum(visible, 1e-12), 0)
    return Response(
        frequency=level.frequency,
        visible=share * visible**observer.pooling,
        contrast=share * (level.change * above) ** observer.pooling,
    )
