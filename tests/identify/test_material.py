import json
import re
import tomllib
from dataclasses import replace

import numpy as np
import pytest

from seatlook.cli import run
from seatlook.identify.bending import assumed_twist
from seatlook.identify.bias import Frame, strip_force
from seatlook.identify.material import identify_file
from seatlook.identify.membrane import bounded_poisson
from seatlook.identify.tensile import force, force_back
from seatlook.io.material import read_foam_material, read_material
from seatlook.model import Curve
from support.lab_files import write_tests
from support.laboratory import Bench, bending_law, fabrics, whole_set
from support.other_laws import instrument_sets


@pytest.fixture(scope="module")
def measured(tmp_path_factory):
    """A fabric, its peak strain, and what six specimens of it say."""
    folder = tmp_path_factory.mktemp("lab")
    fabric, peak = fabrics(2)[1]
    path = whole_set(folder, fabric, peak, Bench(seed=3, specimens=6, noise=0.005, knots=True))
    return fabric, peak, identify_file(path)


def test_curves_are_those_of_the_fabric(measured):
    fabric, peak, found = measured
    made, e = found.material.fabric, np.linspace(0, peak, 100)
    for axis in ("warp", "weft"):
        true, given = getattr(fabric, axis), getattr(made, axis)
        back, returned = (getattr(f, f"{axis}_unloading") for f in (fabric, made))
        top = force(true, e).max()
        assert np.abs(force(given, e) - force(true, e)).max() < 0.01 * top
        out = force_back(true, back, e, peak)
        assert np.abs(force_back(given, returned, e, peak) - out).max() < 0.015 * top
        elastic, friction = bending_law(fabric, axis)
        stiffness, loss = bending_law(made, axis)
        assert stiffness.stiffness[0] == pytest.approx(elastic.stiffness[0], rel=0.01)
        assert loss.width == pytest.approx(friction.width, rel=0.05)
    shear = np.linspace(0, 0.14, 50)
    true = fabric.shear.tension(shear)
    assert np.abs(made.shear.tension(shear) - true).max() < 0.01 * true.max()
    for at in (0.0087, 0.0875):
        assert made.shear_hysteresis.width_at(at) == pytest.approx(
            fabric.shear_hysteresis.width_at(at), rel=0.05
        )


def test_what_was_not_measured_is_named_and_stays_judgement(measured):
    _, _, found = measured
    assert set(found.assumed) == {
        "poisson", "compression_ratio", "bending_twist_n_m", "bending_poisson"
    }  # fmt: skip
    source = found.material.source
    assert all(source[key].startswith("judgement: not measured") for key in found.assumed)
    assert "tensile-warp.csv, Synthetic laboratory, 2026-11-30" in source["warp_n_per_m"]
    assert "standard error" in source["warp_n_per_m"]
    base = read_material("woven")
    assert found.material.fabric.poisson == base.fabric.poisson
    assert found.material.appearance.roughness == base.appearance.roughness
    made = found.material.fabric
    twist = assumed_twist(made.bending_warp, made.bending_weft, made.bending_poisson)
    assert made.bending_twist == pytest.approx(twist)


@pytest.mark.parametrize("law", ["fung", "crimp", "creep"])
def test_records_of_another_law_are_followed_within_two_percent(tmp_path, law):
    path, leaves = instrument_sets()[law](tmp_path)
    found = identify_file(path)
    assert max(one.rms for one in found.residuals) <= 0.02
    # Where the law has no term for what the cloth does, the report says at which strain.
    assert any("leaves the record" in text for text in found.notes) == leaves


def test_strips_with_contraction_give_poissons_ratio(tmp_path):
    fabric = replace(read_material("woven").fabric, poisson=0.3, compression_ratio=0.25)
    e = np.linspace(0, 0.06, 30)
    E = e + 0.5 * e**2
    lost = 0.25 * 0.3**2 * fabric.weft.stiffness[0]
    F = (1 + e) * (fabric.warp.tension(E) - lost * E)
    across = 1.0 - np.sqrt(1.0 - 2.0 * 0.3 * E)
    rows = "\n".join(f"{a:.6f},{b:.4f},{c:.6f}" for a, b, c in zip(e, F, across, strict=True))
    (tmp_path / "a.csv").write_text(f"e,F,narrower\n{rows}\n")
    (tmp_path / "t.toml").write_text(
        'base = "woven"\nlaboratory = "A"\ndate = "2026"\n[[test]]\nkind = "tensile"\n'
        'direction = "warp"\nsides = "free"\nfiles = "a.csv"\n'
        'strain = { column = 1, unit = "1" }\nforce = { column = 2, unit = "N/m" }\n'
        'contraction = { column = "narrower", unit = "1" }\nknots = [0.0, 0.02, 0.0618]\n'
    )
    made = identify_file(tmp_path / "t.toml").material.fabric
    assert made.poisson == pytest.approx(0.3, rel=1e-3)
    np.testing.assert_allclose(force(made.warp, e), force(fabric.warp, e), rtol=0.01, atol=5.0)


def test_bending_at_45_degrees_gives_the_twist(tmp_path):
    D11, D22, D66, nu = 2e-4, 1.5e-4, 5e-5, 0.1
    B45 = (D11 + D22 + 2 * nu * D22 + 4 * D66) / 4
    bench = Bench(noise=0.0, drift=0.0, offset=0.0, scatter=0.0, specimens=1, variants=False)
    fabric = fabrics(1)[0][0]
    values = {"bending_warp_hysteresis": 0.004, "bending_weft_hysteresis": 0.004}
    for axis, B in (("warp", D11), ("weft", D22)):
        fabric = replace(fabric, **values, **{f"bending_{axis}": B})
        bench.bending(tmp_path, fabric, axis)
    bench.bending(tmp_path, replace(fabric, bending_warp=B45), "warp")
    text = bench.finish(tmp_path, fabric).read_text()
    # The first file of the warp was overwritten by that at 45 degrees.
    first = '[[test]]\nkind = "cantilever"\ndirection = "warp"\n'
    B1 = D11 - nu**2 * D22
    l = (8.0042 * B1 / (9.80665 * fabric.density)) ** (1 / 3)
    parts = text.split("\n[[test]]")
    bias = parts[-1].replace('direction = "warp"', 'direction = "bias"')
    path = tmp_path / "tests.toml"
    path.write_text(
        "\n[[test]]".join([parts[0], parts[2], bias])
        + f"{first}overhang_mm = [{1e3 * l:.6f}]\nangle_deg = [41.5]\n"
    )
    made = identify_file(path).material.fabric
    assert made.bending_warp == pytest.approx(D11, rel=1e-3)
    assert made.bending_weft == pytest.approx(D22, rel=1e-3)
    assert made.bending_twist == pytest.approx(D66, rel=5e-3)


def test_single_numbers_of_a_table_make_a_curve_and_are_named_so(tmp_path):
    found = identify_file(write_tests(tmp_path))
    made, source = found.material.fabric, found.material.source
    assert "LT, WT and RT only" in source["weft_n_per_m"]
    # The strips that were hung over an edge go before a printed number.
    assert source["bending_weft_n_m"].startswith("cantilever weft, exact elastica")
    assert made.bending_weft_hysteresis == pytest.approx(0.4 * 9.80665e-3, rel=1e-6)
    assert "2HB at 1 per cm" in source["bending_weft_hysteresis_n"]
    # 2HG is the full width: what the friction of the law has between out and back.
    assert made.shear_hysteresis.width_at(np.radians(0.5)) == pytest.approx(
        1.2 * 0.980665, rel=0.01
    )


def test_one_bias_strip_gives_the_shear_curve_and_no_error(tmp_path):
    shear = read_material("woven").fabric.shear
    frame, moved = Frame(0.25, 0.1), np.linspace(0.0, 0.04, 60)
    rows = zip(1e3 * moved, strip_force(frame, shear, moved), strict=True)
    (tmp_path / "b.csv").write_text("d,F\n" + "".join(f"{d:.5f},{F:.6f}\n" for d, F in rows))
    (tmp_path / "t.toml").write_text(
        'base = "woven"\nlaboratory = "A"\ndate = "2026"\n[[test]]\nkind = "bias-extension"\n'
        'files = "b.csv"\nlength_mm = 250\nwidth_mm = 100\n'
        'displacement = { column = "d", unit = "mm" }\nforce = { column = "F", unit = "N" }\n'
    )
    found = identify_file(tmp_path / "t.toml")
    (shear_found,) = found.findings
    assert shear_found.sigma is None
    assert "standard error" not in shear_found.sources
    e = np.linspace(0.0, 0.6, 60)
    tension = shear.tension(e)
    assert np.abs(shear_found.value.tension(e) - tension).max() < 0.01 * tension.max()


def test_poisson_is_bounded_where_the_curves_are_soft():
    values = {"warp": Curve.linear(900.0), "poisson": 1.4,
              "weft": Curve(strain=[0.0, 0.1], stiffness=[1600.0, 400.0])}  # fmt: skip
    poisson, cut = bounded_poisson(values)
    assert cut
    assert poisson == pytest.approx(0.95 * 600.0 / 1600.0)


def test_a_foam_from_its_curve(tmp_path):
    seat = read_foam_material("foam-seat")
    e = np.concatenate([np.linspace(0, 0.8, 50), np.linspace(0.8, 0, 50)[1:]])
    s = np.interp(e, seat.strain, seat.stress)
    s[50:] *= 0.7
    rows = "\n".join(f"{100 * a:.3f};{b / 1e3:.4f}" for a, b in zip(e, s, strict=True))
    (tmp_path / "f.csv").write_text(f"strain [%];stress [kPa]\n{rows}\n")
    (tmp_path / "f.toml").write_text(
        'base = "foam-seat"\nlaboratory = "A"\ndate = "2026"\n[[test]]\nkind = "foam"\n'
        'files = ["f.csv"]\nstrain = { column = "strain", unit = "%" }\n'
        'pressure = { column = "stress", unit = "kPa" }\n'
        '[[test]]\nkind = "incline"\nangle_deg = [30.0, 31.0]\n'
    )
    out = tmp_path / "foam-mine.toml"
    assert run(["identify", str(tmp_path / "f.toml"), "--out", str(out)]) == 0
    foam = read_foam_material(out)
    assert np.interp(0.4, foam.strain, foam.stress) == pytest.approx(5200.0, rel=0.01)
    assert foam.unloading_stress is not None
    assert foam.friction == pytest.approx(np.tan(np.radians([30, 31])).mean(), rel=1e-6)
    assert foam.source["poisson"].startswith("judgement: not measured")


def test_the_command_writes_a_material_that_reads_and_prints_what_it_found(tmp_path, capsys):
    path, out = write_tests(tmp_path), tmp_path / "cloth.toml"
    assert run(["identify", str(path), "--out", str(out), "--json"]) == 0
    said = json.loads(capsys.readouterr().out)
    made = read_material(out)
    data = tomllib.loads(out.read_text())
    assert set(made.source) == {*data["fabric"], *data["appearance"]} & set(made.source)
    assert {*data["fabric"]} <= set(made.source)
    assert {row["key"] for row in said["findings"]} >= {"warp_n_per_m", "shear_n_per_m"}
    assert "poisson" in said["not_measured"]
    assert run(["identify", str(path), "--out", str(out)]) == 2
    assert re.search("got a file that is there", capsys.readouterr().err)
    assert run(["identify", str(path), "--out", str(out), "--force"]) == 0
