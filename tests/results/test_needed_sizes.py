"""Which element size each place needs, from the wrinkles of a coarser result."""

import dataclasses

import numpy as np
import pytest

from seatlook.assembly import assemble
from seatlook.results.needed_sizes import GROWTH, SMALL, needed_sizes, zone_sizes
from seatlook.results.resolution import CURVATURE_ERROR
from seatlook.solver import foam_wavelength
from support.covers import cover, flat_foam, sheet
from support.scenes import two_panels

COARSEST = 0.01


def strip():
    return cover([sheet(0.4, 0.1, 0.01)], foam=flat_foam(), h=0.01)


def wave_of(mesh):
    return foam_wavelength(mesh.materials[0].fabric, mesh.foam.material)


def test_where_all_wrinkles_the_size_is_that_of_the_error():
    mesh = strip()
    wave = wave_of(mesh)
    tolerance = CURVATURE_ERROR * (0.5 * COARSEST / wave) ** 2
    size = needed_sizes(mesh, np.full(len(mesh.faces), 0.5), tolerance, COARSEST)
    np.testing.assert_allclose(size, 0.5 * COARSEST)
    sizes, errors = zone_sizes(mesh, np.full(len(mesh.faces), 0.5))
    for name, own in sizes.items():
        assert own == pytest.approx(0.01, rel=0.2)
        assert errors[name] == pytest.approx(CURVATURE_ERROR * (own / wave) ** 2)


def test_a_quarter_of_the_tolerance_halves_the_elements():
    mesh = strip()
    w2 = np.full(len(mesh.faces), 0.5)
    tolerance = CURVATURE_ERROR * (0.5 * COARSEST / wave_of(mesh)) ** 2
    both = [needed_sizes(mesh, w2, share * tolerance, COARSEST) for share in (1.0, 0.25)]
    np.testing.assert_allclose(both[1], 0.5 * both[0])


def test_little_wrinkles_count_by_what_they_add_and_none_not_at_all():
    mesh = strip()
    tolerance = CURVATURE_ERROR * (0.25 * COARSEST / wave_of(mesh)) ** 2
    level, little, none = (
        needed_sizes(mesh, np.full(len(mesh.faces), w2), tolerance, COARSEST)
        for w2 in (SMALL, SMALL / 4, 0.0)
    )
    np.testing.assert_allclose(little, 2.0 * level)
    np.testing.assert_allclose(none, COARSEST)


def test_sizes_grow_slowly_away_from_wrinkles():
    mesh = strip()
    x = mesh.rest[mesh.faces].mean(axis=1)[:, 0]
    tolerance = CURVATURE_ERROR * (0.2 * COARSEST / wave_of(mesh)) ** 2
    size = needed_sizes(mesh, np.where(x < 0.02, 0.5, 0.0), tolerance, COARSEST)
    ends = np.concatenate([mesh.faces[:, [0, 1]], mesh.faces[:, [1, 2]], mesh.faces[:, [2, 0]]])
    away = np.linalg.norm(mesh.rest[ends[:, 0]] - mesh.rest[ends[:, 1]], axis=1)
    assert (np.abs(size[ends[:, 0]] - size[ends[:, 1]]) <= GROWTH * away + 1e-12).all()
    assert size.min() == pytest.approx(0.2 * COARSEST)
    assert size[mesh.rest[:, 0] > 0.3] == pytest.approx(COARSEST)


def test_the_other_side_of_a_seam_is_as_fine():
    mesh = assemble(two_panels())
    x = mesh.uv[mesh.faces].mean(axis=1)[:, 0]
    w2 = np.where((mesh.panel == 0) & (x > 0.08), 0.5, 0.0)
    tolerance = CURVATURE_ERROR * (0.3 * COARSEST / wave_of(mesh)) ** 2
    size = needed_sizes(mesh, w2, tolerance, COARSEST)
    seam = mesh.stitchings[0]
    for side in (seam.a, seam.b):
        assert size[side.vertices].max() == pytest.approx(0.3 * COARSEST, rel=1e-3)
    alone = needed_sizes(dataclasses.replace(mesh, stitchings=()), w2, tolerance, COARSEST)
    assert alone[seam.b.vertices].min() == pytest.approx(COARSEST)
