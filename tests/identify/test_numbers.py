import numpy as np
import pytest

from seatlook.identify.numbers import Printed, curves_of, reading
from seatlook.io.laboratory import units


@pytest.mark.parametrize("lt", [0.5, 0.6, 0.7, 0.9, 1.0])
@pytest.mark.parametrize("rt", [0.4, 0.65, 0.9])
def test_three_numbers_come_back_from_the_curve(lt, rt):
    given = Printed(lt=lt, wt=9.0, rt=rt, peak=490.0)
    found = reading(*curves_of(given), given.strain)
    for name in ("lt", "wt", "rt", "peak"):
        assert getattr(found, name) == pytest.approx(getattr(given, name), rel=1e-3)


def test_work_of_a_power_law_by_hand():
    given = Printed(lt=0.5, wt=10.0, rt=0.5, peak=500.0)
    assert given.exponent == pytest.approx(3.0)
    assert given.strain == pytest.approx(0.08)
    assert given.peak * given.strain / (given.exponent + 1) == pytest.approx(given.wt)


def test_conversions():
    assert units.FORCE_PER_WIDTH["gf/cm"].factor == pytest.approx(0.980665, rel=1e-12)
    assert units.KES_NUMBERS["wt_gf_cm_per_cm2"] == pytest.approx(0.980665, rel=1e-12)
    assert units.KES_NUMBERS["g_gf_per_cm_deg"] == pytest.approx(56.19, rel=1e-3)
    assert units.KES_NUMBERS["b_gf_cm2_per_cm"] == pytest.approx(9.80665e-5, rel=1e-12)
    assert units.KES_NUMBERS["full_2hb_gf_cm_per_cm"] == pytest.approx(9.80665e-3, rel=1e-12)
    moment, curvature = units.MOMENT_PER_WIDTH["gf cm/cm"], units.CURVATURE["1/cm"]
    assert moment.factor / curvature.factor == pytest.approx(9.80665e-5, rel=1e-12)
    assert units.PRESSURE["gf/cm2"].factor == pytest.approx(98.0665, rel=1e-12)
    assert units.ANGLE["deg"].factor == pytest.approx(np.pi / 180)


@pytest.mark.parametrize(
    ("head", "unit"),
    [("Load [N]", "N"), ("e (%)", "%"), ("B [gf·cm²/cm]", "gf cm2/cm"), ("F", None)],
)
def test_unit_of_a_head(head, unit):
    assert units.unit_in_head(head) == unit
