"""Flattening by the strain energy of a fabric: derivatives, energies, what it is better at."""

import dataclasses

import numpy as np
import pytest
from PIL import Image

from seatlook.errors import InputError
from seatlook.flattening import flatten
from seatlook.flattening.fabric_sheet import (
    FabricLaw,
    fabric_energy,
    grain_strain,
    strains_by_grain,
)
from seatlook.flattening.face_map import gradient_of
from seatlook.flattening.flatten import SEAM_TOLERANCE
from seatlook.flattening.relax import _CRUSHED, _SHEET, flatten_patch
from seatlook.flattening.strain_map import write_strain_maps
from seatlook.mesh import face_areas
from seatlook.model import Curve, Fabric
from support.rolls import rolled, sheet

CLOTH = Fabric(
    thickness=0.001, density=0.3,
    warp=Curve(strain=np.array([0.0, 0.05]), stiffness=np.array([8000.0, 2000.0])),
    weft=Curve.linear(1500.0), shear=Curve.linear(400.0), poisson=0.4,
    bending_warp=1e-4, bending_weft=1e-4, bending_twist=1e-4,
)  # fmt: skip


def deformations(count=40, seed=0):
    rng = np.random.default_rng(seed)
    return np.array([[1.03, 0.02], [-0.01, 0.96]]) + 0.02 * rng.normal(size=(count, 2, 2))


@pytest.mark.parametrize(
    "law", [FabricLaw(CLOTH), _SHEET, _CRUSHED], ids=["cloth", "sheet", "much"]
)
def test_derivatives_of_an_energy_are_those_of_differences(law):
    """Taylor: what is left of the energy falls with the cube of the step."""
    F = deformations() * (1.5 if law is _CRUSHED else 1.0)
    way = 0.01 * np.random.default_rng(1).normal(size=F.shape)
    slope, axes, size = law.derivatives(F)
    first = (slope * way).sum(axis=(1, 2))
    along = np.einsum("mak,mk->ma", axes, way.reshape(-1, 4))
    second = (size * along**2).sum(axis=1)
    left = [
        np.abs(law.energy(F + s * way) - law.energy(F) - s * first - s * s * second / 2)
        for s in (1.0, 0.1)
    ]
    # The curve of the cloth has a kink, where its energy has one derivative less.
    assert np.median(left[0] / left[1]) > 800
    assert np.allclose(np.einsum("mak,mbk->mab", axes, axes), np.eye(4), atol=1e-9)


def test_fabric_law_is_the_energy_of_the_fabric_over_its_stiffness():
    flat, faces = sheet(h=0.03)
    space = rolled(flat, 0.12)
    gradient, area = gradient_of(space, faces), face_areas(space, faces)
    x = flat @ np.array([[1.03, 0.02], [-0.01, 0.96]])
    mean = np.sqrt(CLOTH.warp.stiffness[0] * CLOTH.weft.stiffness[0])
    stored = area @ fabric_energy(grain_strain(x, gradient), CLOTH)
    assert mean * area @ FabricLaw(CLOTH).energy(gradient.at(x)) == pytest.approx(stored)


def test_energy_is_the_area_below_the_curve():
    """Warp alone, across a knot, against numeric integration."""
    strain = np.array([0.03, 0.08])
    for e, result in zip(strain, fabric_energy(np.outer(strain, [1, 0, 0]), CLOTH), strict=True):
        at = np.linspace(0, e, 20_001)
        tension = CLOTH.warp.tension(at)
        assert result == pytest.approx(np.sum((tension[1:] + tension[:-1]) / 2) * at[1], rel=1e-6)


def test_stretch_along_the_grain_is_that_of_the_form():
    """A patch cut 2 % short along y and 1 % wide along x, laid back onto the form."""
    flat, faces = sheet(h=0.03)
    space = np.column_stack([flat, np.zeros(len(flat))])
    strain = strains_by_grain(space, faces, flat * [1.01, 0.98])
    expected = [0.5 * (0.98**-2 - 1), 0.5 * (1.01**-2 - 1), 0]
    np.testing.assert_allclose(strain, np.tile(expected, (len(faces), 1)), atol=1e-12)


def test_fabric_flattens_a_developable_patch_exactly_and_keeps_its_direction():
    flat, faces = sheet(h=0.02)
    turned = flat @ np.array([[np.cos(0.3), np.sin(0.3)], [-np.sin(0.3), np.cos(0.3)]])
    back = flatten_patch(rolled(flat, 0.12), faces, start=1.02 * turned, fabric=CLOTH)
    moved = (back - back.mean(axis=0)) - (turned - turned.mean(axis=0))
    assert np.abs(moved).max() < 1e-3 * np.ptp(flat)


def test_demo_stores_less_in_the_fabric_it_was_flattened_for(surface, flattened):
    """Cloth four times as stiff along as across: at least a tenth less in every panel."""
    cut = flatten(surface, fabrics=dict.fromkeys(surface.panel_names, CLOTH))
    area = face_areas(surface.vertices, surface.faces)
    for i, panel in enumerate(cut.panels):
        own = surface.panel == i
        plain = area[own] @ fabric_energy(flattened.grain_strain[own], CLOTH)
        assert panel.energy < 0.9 * plain, panel.panel
        assert panel.energy == pytest.approx(
            area[own] @ fabric_energy(cut.grain_strain[own], CLOTH)
        )
    assert max(abs(seam.difference) for seam in cut.seams) < SEAM_TOLERANCE
    assert all(panel.energy is None for panel in flattened.panels)
    for name, x in cut.flat.items():
        assert np.ptp(x, axis=0) == pytest.approx(np.ptp(flattened.flat[name], axis=0), rel=0.02)


def test_unknown_panel_is_named(surface):
    with pytest.raises(InputError, match=r"fabrics: got 'INSRT', .*did you mean 'INSERT'"):
        flatten(surface, fabrics={"INSRT": CLOTH})


def test_strain_is_drawn_panel_by_panel(surface, flattened, tmp_path):
    """Every panel in the colours of its strain; one that is cut small is red all over."""
    paths = write_strain_maps(surface, flattened, tmp_path)
    assert [p.name for p in paths][:2] == ["strain-insert.png", "strain-bolster-l.png"]
    strain = np.full(flattened.strain.shape, 0.02)
    (first, *_) = write_strain_maps(
        surface, dataclasses.replace(flattened, strain=strain), tmp_path / "tight"
    )
    with Image.open(first) as picture:
        pixels = np.asarray(picture).astype(int)[56:, :750]
    red = (pixels[..., 0] > 1.5 * pixels[..., 2]).mean()
    outline = flattened.pattern.panel("INSERT").outline
    assert 0.2 < red < 0.95
    rows = np.flatnonzero((pixels[..., 0] > 1.5 * pixels[..., 2]).any(axis=1))
    columns = np.flatnonzero((pixels[..., 0] > 1.5 * pixels[..., 2]).any(axis=0))
    shape = (columns[-1] - columns[0]) / (rows[-1] - rows[0])
    width, height = np.ptp(outline, axis=0)
    assert shape == pytest.approx(width / height, rel=0.02)
