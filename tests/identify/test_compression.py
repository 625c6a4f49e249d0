import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.identify.compression import foam_of, identify_foam, thickness_under
from seatlook.io.laboratory.types import LabTest, Specimen
from seatlook.io.material import read_foam_material

SEAT = read_foam_material("foam-seat")


def piece(x, y):
    return Specimen(x=np.asarray(x), y=np.asarray(y), file=None, lines=np.arange(len(x)) + 2)


def cycle(rng, noise=0.0, lost=0.3):
    e = np.concatenate([np.linspace(0, 0.8, 60), np.linspace(0.8, 0, 60)[1:]])
    out = np.interp(e, SEAT.strain, SEAT.stress)
    out[60:] *= 1.0 - lost * np.sin(np.pi * e[60:] / 0.8)
    return e, out + noise * SEAT.stress.max() * rng.normal(size=len(e))


def test_a_foam_comes_back():
    rng = np.random.default_rng(0)
    test = LabTest(kind="foam", name="t",
                   specimens=tuple(piece(*cycle(rng, 0.005)) for _ in range(3)))  # fmt: skip
    found = identify_foam(test)
    e = np.linspace(0, 0.8, 50)
    given = np.interp(e, SEAT.strain, SEAT.stress)
    assert np.abs(np.interp(e, found.strain, found.stress) - given).max() < 0.02 * given.max()
    assert found.cld40 == pytest.approx(5200.0, rel=0.02)
    out, back = cycle(rng)[1][:60], cycle(rng)[1][59:]
    true = 1.0 - np.trapezoid(back[::-1]) / np.trapezoid(out)
    assert found.hysteresis == pytest.approx(true, rel=0.05)
    foam = foam_of(found, SEAT, "mine")
    assert foam.friction == SEAT.friction
    assert (foam.unloading_stress <= foam.stress).all()


def test_the_last_cycle_counts():
    rng = np.random.default_rng(1)
    e, s = cycle(rng)
    first = s * 1.3  # cells that break only once
    both = piece(np.concatenate([e, e]), np.concatenate([first, s]))
    once = identify_foam(LabTest(kind="foam", name="t", specimens=(piece(e, s),)))
    twice = identify_foam(LabTest(kind="foam", name="t", specimens=(both,)))
    np.testing.assert_allclose(twice.stress, once.stress, rtol=1e-6, atol=1e-6)


def test_thickness_under_a_stated_pressure():
    p = np.geomspace(10.0, 5000.0, 40)
    test = LabTest(kind="compression", name="t", numbers={"at_pa": 49.0},
                   specimens=(piece(p, 1.2e-3 - 1e-4 * np.log(p / 10.0)),))  # fmt: skip
    assert thickness_under(test).values[0] == pytest.approx(1.2e-3 - 1e-4 * np.log(4.9), rel=1e-6)
    high = LabTest(kind="compression", name="t", numbers={"at_pa": 9e3}, specimens=test.specimens)
    with pytest.raises(InputError, match=r"t.at_pa: got 9000 Pa, expected 10 to 5000 Pa"):
        thickness_under(high)
