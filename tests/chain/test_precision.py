import dataclasses
import math
from types import MappingProxyType

import numpy as np
import pytest

from seatlook.chain.precision import ZoneMean, compare_means, plan, solve_to
from seatlook.errors import InputError
from seatlook.solver import foam_wavelength
from seatlook.wrinkle import ZoneRow
from support.scenes import two_panels


def zone_row(zone, area, mean):
    return ZoneRow(
        zone=zone,
        criterion="tensor, 0.02 per mm",
        area=area,
        element_size=0.0,
        stretch_share=0.0,
        w2_face_rms=0.0,
        figures=MappingProxyType({"w2_mean": mean}),
    )


def test_element_size_follows_from_the_tolerance_and_the_wavelength():
    scene = two_panels()
    fabric = scene.materials["LEFT"].fabric
    wave = foam_wavelength(fabric, scene.foam.material)
    chosen = plan(scene, 0.05)
    assert chosen.wavelength == wave
    assert 3.9 * (chosen.element_size / wave) ** 2 == pytest.approx(0.025)
    finer = plan(scene, 0.0125)
    assert finer.element_size == pytest.approx(0.5 * chosen.element_size)
    assert finer.dt < chosen.dt <= 0.02
    # However loose, the shape of a wave needs eight elements.
    assert plan(scene, 0.9).element_size == pytest.approx(wave / 8)


def test_tolerance_that_would_take_too_many_vertices_is_refused():
    with pytest.raises(InputError, match=r"tolerance: got 1e-06, expected .* or more .* vertices"):
        plan(two_panels(), 1e-6)
    with pytest.raises(InputError, match="tolerance: got 5, expected a share between 0 and 1"):
        plan(two_panels(), 5)


def test_error_is_the_difference_of_the_means():
    fine = [zone_row("a", 1.0, 0.2), zone_row("b", 3.0, 0.4), zone_row("new", 1.0, 0.1)]
    zones, error = compare_means(fine, [zone_row("b", 2.0, 0.3), zone_row("a", 2.0, 0.2)])
    assert zones[:2] == (ZoneMean("a", 0.2, 0.0), ZoneMean("b", 0.4, pytest.approx(0.1)))
    assert math.isnan(zones[2].error)
    mean = (0.2 + 3 * 0.4 + 0.1) / 5
    assert error == pytest.approx(np.sqrt(3 * 0.01 / 4) / mean)


def test_scene_is_solved_to_a_tolerance():
    found = solve_to(two_panels(), 0.9)
    assert found.solution.cover.element_size < found.coarse.cover.element_size
    assert found.solution.status == found.coarse.status == "converged"
    assert 0.0 < found.error < 0.9
    assert found.reached
    assert {zone.zone for zone in found.zones} >= {"seam middle", "LEFT interior"}
    tighter = dataclasses.replace(found, tolerance=0.5 * found.error)
    assert not tighter.reached
