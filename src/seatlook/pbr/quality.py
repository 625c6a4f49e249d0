"""How much is spent on a picture."""

from __future__ import annotations

from dataclasses import dataclass

from seatlook.errors import InputError, did_you_mean


@dataclass(frozen=True, slots=True, kw_only=True)
class Quality:
    """How much is spent on a picture.

    Parameters
    ----------
    factor : samples per pixel and axis
    rays : shadow rays per sample where a shadow has its edge
    strata : the half-space is seen along strata^2 rays per vertex; 0 leaves it all open
    bounces : how often light may go from cover to cover
    """

    factor: int
    rays: int
    strata: int
    bounces: int


QUALITIES: dict[str, Quality] = {
    "draft": Quality(factor=1, rays=1, strata=0, bounces=0),
    "standard": Quality(factor=2, rays=4, strata=8, bounces=1),
    "high": Quality(factor=4, rays=4, strata=16, bounces=3),
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
