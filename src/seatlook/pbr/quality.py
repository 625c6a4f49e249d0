"""How much is spent on a picture."""

from __future__ import annotations

from dataclasses import dataclass, replace

from seatlook.errors import InputError, did_you_mean

# As many as the kernels have room for.
_MOST = 8


@dataclass(frozen=True, slots=True, kw_only=True)
class Quality:
    """How much is spent on a picture.

    Parameters
    ----------
    factor : samples per pixel and axis
    rays : shadow rays per sample where a shadow has its edge; 0 for no shadows
    strata : the half-space is seen along strata^2 rays per vertex; 0 leaves it all open
    relief : samples of a relief along each side of a pixel, 1 to 8
    bounces : how often light may go from cover to cover
    error : FLIP against the path tracer, the worst of ``gallery/work_precision_render.py``, and no
        less than that of the next tier
    """

    factor: int
    rays: int
    strata: int
    relief: int
    bounces: int
    error: float

    def __post_init__(self) -> None:
        if not 1 <= self.relief <= _MOST:
            raise InputError.single("relief", got=self.relief, expected=f"1 to {_MOST}")


# Cheapest first.
TIERS: dict[str, Quality] = {
    "T0": Quality(factor=1, rays=0, strata=0, relief=2, bounces=0, error=0.0672),
    "T1": Quality(factor=1, rays=1, strata=0, relief=2, bounces=0, error=0.0672),
    "T2": Quality(factor=2, rays=4, strata=0, relief=2, bounces=0, error=0.0672),
    "T3": Quality(factor=2, rays=4, strata=8, relief=2, bounces=1, error=0.0388),
    "T4": Quality(factor=4, rays=4, strata=16, relief=8, bounces=3, error=0.0200),
}
QUALITIES: dict[str, Quality] = {
    "draft": TIERS["T1"],
    "standard": TIERS["T3"],
    # A score compares two pictures: one ray of 64 that meets a highlight in only one of them shows,
    # and so does the noise of four relief samples.
    "score": replace(TIERS["T3"], strata=12, relief=4),
    "high": TIERS["T4"],
    **TIERS,
}


def quality_named(name: str) -> Quality:
    """Return one of ``QUALITIES``; InputError for another name."""
    if name not in QUALITIES:
        raise InputError.single(
            "quality",
            got=repr(name),
            expected=f"one of {', '.join(QUALITIES)}",
            hint=did_you_mean(name, QUALITIES),
        )
    return QUALITIES[name]


def quality_within(target_error: float) -> Quality:
    """Return the cheapest tier whose charted FLIP is at most ``target_error``.

    Raises
    ------
    InputError
        No tier is that good.
    """
    for tier in TIERS.values():
        if tier.error <= target_error:
            return tier
    best = min(tier.error for tier in TIERS.values())
    raise InputError.single("target_error", got=target_error, expected=f"at least {best:g}")
