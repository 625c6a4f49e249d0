from dataclasses import replace

import numpy as np
import pytest

from seatlook.cli import run
from seatlook.errors import InputError
from seatlook.identify.look import fit_lobes, identify_look
from seatlook.io.laboratory.types import Look
from seatlook.io.material import read_material
from seatlook.pbr.reflectance import brdf
from seatlook.pbr.reflectance.instrument import gloss, lab
from support.lab_files import write_tests

LEATHER = read_material("black-leather").appearance
TRUE = replace(LEATHER, albedo=[0.12, 0.05, 0.03], roughness=0.35, f0=0.05)


def table(appearance, noise=0.0):
    """What a goniometer reads in the plane of incidence and across it."""
    rows = []
    for incident in np.radians([10.0, 35.0, 60.0]):
        for phi in np.radians([0.0, 90.0, 180.0]):
            rows += [(incident, phi, seen) for seen in np.radians(np.arange(0.0, 76.0, 5.0))]
    angles = np.array(rows)
    light = np.column_stack([np.sin(angles[:, 0]), 0 * angles[:, 0], np.cos(angles[:, 0])])
    seen, phi = angles[:, 2], angles[:, 1]
    eye = np.column_stack([np.sin(seen) * np.cos(phi), np.sin(seen) * np.sin(phi), np.cos(seen)])
    value = np.pi * brdf.evaluate(appearance, eye, light)
    value *= 1.0 + noise * np.random.default_rng(0).normal(size=value.shape)
    return np.column_stack([angles, value])


def test_a_goniometer_gives_the_lobes_back():
    found, residual = fit_lobes(table(TRUE), LEATHER)
    np.testing.assert_allclose(found.albedo, TRUE.albedo, rtol=0.01)
    assert found.roughness == pytest.approx(TRUE.roughness, rel=0.01)
    assert found.f0 == pytest.approx(TRUE.f0, rel=0.02)
    assert residual < 1e-3


def test_noise_is_said_as_residual():
    found, residual = fit_lobes(table(TRUE, 0.03), LEATHER)
    assert 0.01 < residual < 0.06
    assert found.roughness == pytest.approx(TRUE.roughness, rel=0.05)


def test_below_the_surface_is_refused():
    rows = table(TRUE)
    rows[0, 2] = np.radians(95.0)
    with pytest.raises(InputError, match="light and eye above the surface"):
        fit_lobes(rows, LEATHER)


def test_meters_would_measure_what_was_entered(tmp_path):
    look = Look(lab=np.array([30.0, 4.0, 6.0]), gloss_60=8.0, file=tmp_path)
    made, residual = identify_look(look, replace(LEATHER, texture="none"))
    np.testing.assert_allclose(lab(made), look.lab, atol=0.1)
    assert gloss(made) == pytest.approx(8.0, abs=0.2)
    assert residual is None


def test_a_goniometer_in_a_file_of_tests(tmp_path):
    path, out = write_tests(tmp_path), tmp_path / "m.toml"
    rows = table(TRUE)
    rows[:, :3] = np.degrees(rows[:, :3])
    lines = (",".join(f"{v:.8g}" for v in row) for row in rows)
    (tmp_path / "g.csv").write_text("theta_i,phi,theta_o,R,G,B\n" + "\n".join(lines) + "\n")
    text = path.read_text().replace('base = "woven"', 'base = "black-leather"')
    path.write_text(text.replace("[sheet]", '[look]\ngoniometer = "g.csv"\n\n[sheet]'))
    assert run(["identify", str(path), "--out", str(out)]) == 0
    made = read_material(out)
    assert made.appearance.roughness == pytest.approx(TRUE.roughness, rel=0.02)
    assert "goniometer, residual" in made.source["f0"]


def test_half_a_look_is_refused(tmp_path, capsys):
    path = write_tests(tmp_path)
    path.write_text(path.read_text().replace("[sheet]", "[look]\ngloss_60_gu = 3.0\n\n[sheet]"))
    assert run(["identify", str(path), "--out", str(tmp_path / "m.toml")]) == 2
    assert "look: got too little or too much" in capsys.readouterr().err
