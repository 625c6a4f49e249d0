"""No panel is strained more than an earlier revision strained it, where that could flatten it."""

import warnings

import pytest

from seatlook.errors import InputWarning
from seatlook.flattening import flatten
from support import flattening_before

SURFACES = flattening_before.kept()


@pytest.mark.parametrize("name", SURFACES)
def test_strain_is_that_of_the_earlier_revision_or_less(name):
    surface, before = SURFACES[name]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        now = flattening_before.figures(surface, flatten(surface).strain)
    ratio = now / before
    assert ratio.max() <= 1.02, dict(zip(surface.panel_names, ratio.round(3).tolist(), strict=True))
