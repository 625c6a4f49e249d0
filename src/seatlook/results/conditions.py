"""What must hold before a result is trusted, with the values that were reached."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from types import MappingProxyType

from seatlook.model import Solution
from seatlook.results.resolution import PER_WAVE, SHARPEST, Resolution
from seatlook.solver.process import coverage, verdict
from seatlook.solver.process.process import RESIDUAL


@dataclass(frozen=True, slots=True, kw_only=True)
class Condition:
    """One condition of "converged"; value and limit in ``unit``, "" for a number."""

    figure: str
    meaning: str
    value: float
    limit: float
    unit: str

    @property
    def kept(self) -> bool:
        """Whether the value is at most the limit."""
        return self.value <= self.limit


# figure -> what it is, its limit, factor to the unit, unit
_CONDITIONS: Mapping[str, tuple[str, float, float, str]] = MappingProxyType(
    {
        "residual": ("out-of-balance force over mean elastic force", RESIDUAL, 1.0, ""),
        "kinetic_ratio": ("kinetic over elastic energy", verdict.KINETIC, 1.0, ""),
        "seam_gap_max": ("largest seam gap", verdict.SEAM_GAP, 1e3, "mm"),
        "hook_gap_max": ("largest distance of a hook from its wire", verdict.ANCHOR_GAP, 1e3, "mm"),
        "frame_gap_max": (
            "largest distance of a free edge from its frame", verdict.ANCHOR_GAP, 1e3, "mm"
        ),
        "contact_compression_max": (
            "foam compression, share of its thickness", verdict.COMPRESSION, 1e2, "%"
        ),
        "contact_resultant_error": (
            "difference of foam pressure and resultant", verdict.RESULTANT, 1e2, "%"
        ),
        **{
            coverage.buried(depth): (
                f"share of the cover more than {1e3 * depth:.0f} mm deep in the foam",
                share, 1e2, "%",
            )
            for depth, share in coverage.BURIED.items()
        },
        "bare_foam": ("foam bare above the cover, to the cover's area", coverage.BARE, 1e2, "%"),
        "untouched": ("share of the cover that does not touch", coverage.UNTOUCHED, 1e2, "%"),
        "intersecting_pairs": ("pairs of triangles that pass through each other", 0.0, 1.0, ""),
        "hem_crossing_pairs": ("triangles of the hem that come through", 0.0, 1.0, ""),
    }
)  # fmt: skip


def conditions(solution: Solution, found: Resolution) -> tuple[Condition, ...]:
    """Conditions that a result has a value of: a cover without foam touches none.

    Parameters
    ----------
    found : ``resolution(solution)``
    """
    balance = tuple(
        Condition(
            figure=name,
            meaning=meaning,
            value=factor * solution.figures[name],
            limit=factor * limit,
            unit=unit,
        )
        for name, (meaning, limit, factor, unit) in _CONDITIONS.items()
        if name in solution.figures
    )
    return (*balance, *_of_mesh(found))


def _of_mesh(found: Resolution) -> Iterator[Condition]:
    """Conditions of "resolved"."""
    yield Condition(
        figure="largest_fold",
        meaning="largest fold of an edge inside a panel",
        value=found.largest_fold,
        limit=SHARPEST,
        unit="degrees",
    )
    if found.error is not None and found.tolerance is not None:
        yield Condition(
            figure="w2_error",
            meaning="mesh error of zone means of W2",
            value=100.0 * found.error,
            limit=100.0 * found.tolerance,
            unit="%",
        )
        return
    for wave in found.waves:
        yield Condition(
            figure=f"element_size/{wave.material}",
            meaning=f"elements of {wave.material}, to an eighth of its wavelength",
            value=1e3 * wave.element_size,
            limit=1e3 * wave.wavelength / PER_WAVE,
            unit="mm",
        )
