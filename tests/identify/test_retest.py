"""What was identified, in the virtual rig: within 3 % of the tests it came from."""

from dataclasses import replace

import numpy as np
import pytest

from seatlook.cli import run
from seatlook.identify.elastica import load_of_angle
from seatlook.identify.material import identify_file
from seatlook.identify.outlook import outlook
from seatlook.identify.rig import sheets
from seatlook.identify.rig.retest import retests
from seatlook.identify.tensile import force, force_back
from seatlook.io.material import read_foam_material, read_material
from seatlook.model import Hysteresis
from support.lab_files import write_tests
from support.laboratory import Bench, fabrics, whole_set

WOVEN = read_material("woven").fabric


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    folder = tmp_path_factory.mktemp("lab")
    fabric, peak = fabrics(1)[0]
    bench = Bench(seed=1, specimens=3, knots=True)
    length = (6.0 * fabric.bending_warp / (9.80665 * fabric.density)) ** (1 / 3)
    bench.hanging(folder, "warp", 6.0, length)
    return identify_file(whole_set(folder, fabric, peak, bench))


def test_every_test_again_within_three_percent(found):
    again = {one.title: one.rms for one in retests(found.laboratory.tests, found.material.fabric)}
    assert set(again) == {
        "hanging-strip warp", "tensile warp", "tensile weft", "bending warp", "bending weft",
        "shear",
    }  # fmt: skip
    assert max(again.values()) < 0.03


def test_a_held_strip_reads_its_curve_out_and_back():
    fabric, peak = fabrics(1)[0]
    fabric = replace(fabric, shear_hysteresis=None)
    path = np.array([0.02, 0.05, peak, 0.06, 0.04])
    read = sheets.pull(fabric, 0, path, held=True)
    np.testing.assert_allclose(read[:3], force(fabric.warp, path[:3]), rtol=1e-6)
    back = force_back(fabric.warp, fabric.warp_unloading, path[3:], peak)
    np.testing.assert_allclose(read[3:], back, rtol=1e-6)


def test_a_free_strip_contracts_and_reads_less():
    path = np.array([0.03])
    free, held = (sheets.pull(WOVEN, 1, path, held=side)[0] for side in (False, True))
    assert 0.9 < free / held < 1.0


def test_a_square_reads_the_shear_curve_and_its_friction():
    fabric = replace(WOVEN, shear_hysteresis=Hysteresis(width=12.0, strain=0.01))
    path = np.array([0.05, 0.1, 0.05])
    read = sheets.shear(fabric, path)
    expected = fabric.shear.tension(path) + np.array([6.0, 6.0, -6.0])
    np.testing.assert_allclose(read, expected, rtol=1e-6)


@pytest.mark.parametrize("axis", [0, 1])
def test_a_wide_strip_reads_its_bending_stiffness(axis):
    B = (WOVEN.bending_warp, WOVEN.bending_weft)[axis]
    assert sheets.bend(WOVEN, axis, np.array([60.0]))[0] == pytest.approx(60.0 * B, rel=0.02)


@pytest.mark.parametrize("axis", [0, 1])
def test_a_strip_hangs_as_the_elastica_does(axis):
    """Narrow: its stiffness is what anticlastic bending leaves."""
    D = WOVEN.bending_matrix
    B = D[axis, axis] - D[0, 1] ** 2 / D[1 - axis, 1 - axis]
    angle = np.radians(41.5)
    length = (load_of_angle(np.array([angle]))[0] * B / (9.80665 * WOVEN.density)) ** (1 / 3)
    along, down = sheets.hang(WOVEN, axis, float(length))[-1]
    assert np.arctan2(down, along) == pytest.approx(angle, rel=0.01)


def test_the_outlook_is_that_of_a_sheet_on_a_half_space():
    foam = read_foam_material("foam-seat")
    rows = {what: (warp, weft) for what, warp, weft in outlook(WOVEN, foam)}
    E = foam.young / (1 - foam.poisson**2)
    k = np.linspace(50, 2000, 200001)
    load = WOVEN.bending_warp * k**2 + E / (2 * k)
    best = int(load.argmin())
    assert rows["wavelength on the foam [mm]"][0] == pytest.approx(2e3 * np.pi / k[best], rel=1e-3)
    assert rows["line load at which it wrinkles [N/m]"][0] == pytest.approx(load[best], rel=1e-6)


def test_the_page_shows_every_test_and_what_follows(tmp_path):
    page = tmp_path / "page"
    words = ["identify", str(write_tests(tmp_path)), "--out", str(tmp_path / "m.toml")]
    assert run([*words, "--report", str(page)]) == 0
    text = (page / "index.html").read_text(encoding="utf-8")
    assert text.count("<figure>") == 3  # tensile, shear, cantilever
    for part in ("tensile warp", "cantilever weft", "wavelength on the foam", "standard error",
                 "compression_ratio", "Laboratory A"):  # fmt: skip
        assert part in text
    assert "http" not in text.replace("http-equiv", "")
