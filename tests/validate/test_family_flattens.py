"""The family of seats is flattened at every surface size, in every material, eased and short."""

import warnings

import pytest

from seatlook import io
from seatlook.errors import InputWarning
from seatlook.flattening import flatten
from seatlook.seats import SHAPES, design_surface, shaped

SIZES = (0.006, 0.008, 0.010, 0.012)

pytestmark = pytest.mark.validate


@pytest.fixture(scope="module", params=SHAPES)
def surfaces(request):
    form = shaped(request.param)
    return {size: design_surface(form, element_size=size) for size in SIZES}


def flattened(surface, **choices):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", InputWarning)
        flat = flatten(surface, **choices)
    edges = flat.pattern.edges
    spoiled = {*choices.get("ease", {})} | {
        seam.name  # which may be called after a line, not after its panels
        for seam in flat.pattern.seams
        if {edges[name].panel for name in (seam.a, *seam.b)} & {*choices.get("short", {})}
    }
    even = [s for s in flat.seams if s.seam not in spoiled]
    assert all(abs(seam.difference) < 5e-5 for seam in even)
    return flat


@pytest.mark.parametrize("size", SIZES)
def test_at_every_size(surfaces, size):
    strains = [panel.rms for panel in flattened(surfaces[size]).panels]
    assert max(strains) < 0.08


@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("material", io.list_materials())
def test_in_every_material(surfaces, size, material):
    surface = surfaces[size]
    fabric = io.read_material(material).fabric
    flattened(surface, tension=0.01, fabrics=dict.fromkeys(surface.panel_names, fabric))


@pytest.mark.parametrize("share", [0.02, 0.04, -0.03])
def test_eased_and_short(surfaces, share):
    surface = surfaces[0.010]
    seam = flattened(surface).pattern.seams[0].name
    flattened(surface, ease={seam: share}, tension=0.01)
    for panel in surface.panel_names:
        flattened(surface, short={panel: abs(share)})
