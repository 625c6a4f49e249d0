import tomllib

import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.io.material import (
    list_foam_materials,
    list_materials,
    material_path,
    materials_dir,
    read_foam_material,
    read_material,
)
from seatlook.io.parameter_text import write_material
from seatlook.model.colour import srgb_decode

LEATHER = (materials_dir() / "black-leather.toml").read_text()


@pytest.mark.parametrize("name", list_materials())
def test_supplied_material_reads_and_names_the_source_of_every_number(name):
    material = read_material(name)
    assert material.name == name
    data = tomllib.loads(material_path(name).read_text())
    keys = {*data["fabric"], *data["appearance"]}
    assert set(material.source) == keys
    assert np.linalg.eigvalsh(material.fabric.bending_matrix)[0] > 0


@pytest.mark.parametrize("name", list_foam_materials())
def test_supplied_foam_names_the_source_of_every_number(name):
    foam = read_foam_material(name)
    assert set(foam.source) == set(tomllib.loads(material_path(name).read_text())["foam"])


def test_the_materials_a_seat_needs_are_there():
    assert set(list_materials()) >= {
        "black-leather", "bright-leather", "suede", "pvc", "woven", "leather-laminate",
        "suede-laminate",
    }  # fmt: skip
    assert "foam-seat" in list_foam_materials()


def test_black_leather_gives_the_published_forces_back():
    curve = read_material("black-leather").fabric.warp
    for stretch, force in ((1.05, 16.9), (1.20, 58.9)):
        green = (stretch**2 - 1) / 2
        strain = np.linspace(0, green, 2001)
        second_piola = np.trapezoid(np.interp(strain, curve.strain, curve.stiffness), strain)
        assert second_piola * stretch * 0.050 == pytest.approx(force, rel=2e-3)


def test_leathers_differ_in_their_look_only():
    black, bright = read_material("black-leather"), read_material("bright-leather")
    assert black.fabric.warp.stiffness.tolist() == bright.fabric.warp.stiffness.tolist()
    assert black.fabric.bending_matrix.tolist() == bright.fabric.bending_matrix.tolist()
    assert bright.appearance.albedo.min() > 5 * black.appearance.albedo.max()


@pytest.mark.parametrize("name", ["leather-laminate", "suede-laminate"])
def test_laminates_wrinkle_wider_than_60_mm_on_the_seat_foam(name):
    foam, fabric = read_foam_material("foam-seat"), read_material(name).fabric
    plane_strain = foam.young / (1 - foam.poisson**2)
    wavelength = 2 * np.pi * (4 * fabric.bending_weft / plane_strain) ** (1 / 3)
    assert 0.060 < wavelength < 0.080


def test_units_and_hex_colour(write):
    text = LEATHER.replace("albedo = [0.025, 0.025, 0.026]", 'albedo = "#ff8000"')
    text = text.replace("[appearance]", "c_threshold_per_mm = 0.03\n[appearance]")
    material = read_material(write("x.toml", text))
    assert material.fabric.thickness == pytest.approx(1.2e-3)
    assert material.c_threshold == pytest.approx(30.0)
    assert material.appearance.albedo.round(4).tolist() == [1.0, 0.2159, 0.0]
    assert material.appearance.texture_scale == pytest.approx(1.2e-3)
    assert material.appearance.texture_depth == pytest.approx(6e-5)


def test_a_bending_radius_stands_for_the_threshold(write, problems):
    text = LEATHER.replace("[appearance]", "first_wrinkle_radius_mm = 25.0\n[appearance]")
    material = read_material(write("x.toml", text))
    assert material.first_wrinkle_radius == pytest.approx(0.025)
    assert material.c_threshold is None
    both = text.replace("[appearance]", "c_threshold_per_mm = 0.03\n[appearance]")
    (problem,) = problems(read_material, write("y.toml", both))
    assert "fabric.first_wrinkle_radius_mm: got c_threshold_per_mm as well" in problem


def test_constant_stiffness_is_a_curve_of_one_knot(write):
    fabric = read_material(write("x.toml", LEATHER)).fabric
    assert fabric.shear.strain.tolist() == [0.0]
    assert fabric.shear.stiffness.tolist() == [2400.0]


def test_srgb_against_the_published_break():
    assert srgb_decode(np.array([0.04045]))[0] == pytest.approx(0.0031308, rel=1e-4)


def test_albedo_above_one(write, problems):
    path = write("x.toml", LEATHER.replace("[0.025, 0.025, 0.026]", "[0.9, 1.2, 0.5]"))
    line = path.read_text().splitlines().index("albedo = [0.9, 1.2, 0.5]") + 1
    assert problems(read_material, path) == [
        f"x.toml:{line}: appearance.albedo: got [0.9, 1.2, 0.5], expected numbers from 0 to 1"
    ]


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("\npoisson = 0.35", "\npoisson = 1.4",
         "fabric.Fabric.membrane: got smallest eigenvalue -"),
        ("bending_poisson = 0.3", "bending_poisson = 1.2",
         "fabric.Fabric.bending: got smallest eigenvalue -"),
    ],
)  # fmt: skip
def test_stiffness_not_positive_definite(write, problems, old, new, message):
    (problem,) = problems(read_material, write("x.toml", LEATHER.replace(old, new)))
    assert problem.startswith(f"x.toml:3: {message}")
    assert problem.endswith("expected a positive definite stiffness matrix (lower the Poisson "
                            "ratio)")  # fmt: skip


def test_two_errors_are_reported_together(write, problems):
    text = LEATHER.replace("roughness = 0.40", "roughnes = 0.40").replace("0.90", '"heavy"')
    got = problems(read_material, write("x.toml", text))
    assert "x.toml:5: fabric.density_kg_per_m2: got 'heavy', expected a number" in got
    assert any("unknown key" in g and "did you mean 'roughness'?" in g for g in got)
    assert any("appearance.roughness: got nothing, expected a number" in g for g in got)


@pytest.mark.parametrize(
    ("curve", "message"),
    [
        ("{ strain = [0, 0.1], stiffness = [1] }",
         "fabric.warp_n_per_m.Curve.stiffness: got shape (1,), expected shape (2,)"),
        ("{ strain = [0.1, 0.2], stiffness = [1, 2] }",
         "fabric.warp_n_per_m.Curve.strain: got [0.1, 0.2], expected rising knots from 0"),
        ("{ strain = [0, 0.2], stiffness = [1, 0] }",
         "fabric.warp_n_per_m.stiffness: got [1, 0], expected numbers from 0.001 to 1e+09"),
        ("-5", "fabric.warp_n_per_m: got -5, expected 0.001 to 1e+09"),
    ],
)  # fmt: skip
def test_bad_stiffness_curve(write, problems, curve, message):
    old = next(row for row in LEATHER.splitlines() if row.startswith("warp_n_per_m"))
    path = write("x.toml", LEATHER.replace(old, f"warp_n_per_m = {curve}", 1))
    assert problems(read_material, path) == [f"x.toml:6: {message}"]


def test_bad_colour(write, problems):
    path = write("x.toml", LEATHER.replace("[0.025, 0.025, 0.026]", '"#12345"'))
    (message,) = problems(read_material, path)
    assert message.endswith(
        "appearance.albedo: got '#12345', "
        'expected "#rrggbb", "lab(L, a, b)" or three linear numbers from 0 to 1'
    )


def test_unknown_name_suggests_one():
    with pytest.raises(InputError, match=r"did you mean 'black-leather'\?"):
        read_material("black-lether")


def test_foam_curve_must_rise(write, problems):
    text = (materials_dir() / "foam-seat.toml").read_text()
    path = write("f.toml", text.replace("5.2", "3.5"))
    (message,) = problems(read_foam_material, path)
    assert message.startswith("f.toml:3: foam.FoamMaterial.stress: got [[0.0, 0.0]")
    path = write("f.toml", text.replace("5.2, ", ""))
    assert problems(read_foam_material, path) == [
        "f.toml:5: foam.stress_kpa: got 8 numbers, expected 9, one for each strain"
    ]


def test_measured_colour_of_the_lab(tmp_path):
    """CIE L*a*b* as a spectrophotometer gives it; a colour outside sRGB is refused."""
    file = tmp_path / "red.toml"
    text = material_path("suede").read_text()
    albedo = "albedo = [0.16, 0.15, 0.15]"
    assert albedo in text
    file.write_text(text.replace(albedo, 'albedo = "lab(53.24, 80.09, 67.20)"'))
    assert read_material(file).appearance.albedo == pytest.approx([1.0, 0.0, 0.0], abs=2e-3)
    for bad in ("lab(60, 90, -120)", "lab(60, 90)", "rgb(1, 2, 3)"):
        file.write_text(text.replace(albedo, f'albedo = "{bad}"'))
        with pytest.raises(InputError, match=r"appearance\.albedo: got"):
            read_material(file)


BACK = "warp_unloading_n_per_m = {}\nweft_n_per_m"


def test_unloading_curves_are_read_and_may_be_left_out(write):
    curve = "{ strain = [0, 0.1], stiffness = [90000, 99000] }"
    text = LEATHER.replace("weft_n_per_m", BACK.format(curve), 1)
    fabric = read_material(write("x.toml", text)).fabric
    assert fabric.warp_unloading.stiffness.tolist() == [90000.0, 99000.0]
    assert fabric.weft_unloading is None


def test_unloading_below_loading_is_named(write, problems):
    (problem,) = problems(
        read_material, write("x.toml", LEATHER.replace("weft_n_per_m", BACK.format("100"), 1))
    )
    assert problem.startswith("x.toml:3: fabric.Fabric.warp_unloading: got ")
    assert "expected at least the" in problem
    (problem,) = problems(
        read_material, write("y.toml", LEATHER.replace("weft_n_per_m", BACK.format("-1"), 1))
    )
    assert "fabric.warp_unloading_n_per_m: got -1, expected 0.001 to 1e+09" in problem


MEASURED = LEATHER.replace("roughness = 0.40\n", 'gloss_60_gu = 2.0\nmeasured = "d/8 SCI"\n')


def test_a_colour_and_a_gloss_that_were_measured(tmp_path):
    (tmp_path / "own.toml").write_text(MEASURED)
    look = read_material(tmp_path / "own.toml").appearance
    assert (look.measured, look.gloss_60) == ("d/8 SCI", 2.0)
    write_material(tmp_path / "again.toml", read_material(tmp_path / "own.toml"))
    again = read_material(tmp_path / "again.toml").appearance
    assert (again.measured, again.gloss_60) == ("d/8 SCI", 2.0)
    np.testing.assert_array_equal(again.albedo, look.albedo)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("gloss_60_gu = 2.0", "gloss_60_gu = 120", "gloss_60_gu: got 120, expected"),
        (
            "gloss_60_gu = 2.0",
            "gloss_60_gu = 2.0\nroughness = 0.5",
            "gloss_60_gu: got roughness as",
        ),
        ("gloss_60_gu = 2.0", "", "roughness: got nothing"),
        ("d/8 SCI", "8/d", "measured: got '8/d', expected one of"),
    ],
)
def test_measured_values_that_cannot_be(tmp_path, problems, old, new, message):
    assert old in MEASURED
    (tmp_path / "own.toml").write_text(MEASURED.replace(old, new))
    got = problems(read_material, tmp_path / "own.toml")
    assert any(message in one for one in got), got
