"""Maps that were drawn, as the page shows them."""

from __future__ import annotations

from seatlook.chain.draw import Drawn
from seatlook.report.page.types import MapView


def map_view(drawn: Drawn) -> MapView:
    """A drawn map as the page shows it."""
    low, high = drawn.picture.value_range
    return MapView(
        name=drawn.name,
        image=drawn.path,
        low=low,
        high=high,
        unit=drawn.unit,
        meaning=drawn.meaning,
        alone=drawn.alone,
        alone_high=drawn.alone_high,
    )
