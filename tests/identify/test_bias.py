import numpy as np
import pytest

from seatlook.identify.bias import Frame, identify_bias, shear_force, shear_modulus, strip_force
from seatlook.io.laboratory.types import LabTest, Specimen
from seatlook.model import Curve

LOCKING = np.radians(35.0)


def shear(angle):
    """Shear force [N/m] of a weave that locks at 35 degrees."""
    beyond = np.clip(angle - 0.8 * LOCKING, 0.0, None) / (0.2 * LOCKING)
    return 300.0 * np.tan(angle) + 150.0 * beyond**3


def strip(ratio, count=60, top=38.0):
    frame = Frame(0.1 * ratio, 0.1)
    angle = np.linspace(0.0, np.radians(top), count + 1)[1:]
    return frame, angle, frame.force(angle, shear(angle), shear(0.5 * angle))


def test_the_angle_is_that_of_the_published_formula():
    frame = Frame(0.25, 0.1)
    angle = np.radians([1.0, 10.0, 30.0])
    moved = frame.displacement(angle)
    H, W = 0.25, 0.1
    formula = np.pi / 2 - 2 * np.arccos((H - W + moved) / (np.sqrt(2) * (H - W)))
    np.testing.assert_allclose(formula, angle, rtol=1e-12)
    np.testing.assert_allclose(frame.angle(moved), angle, rtol=1e-12)


def test_jaws_do_the_work_that_the_cloth_takes_up():
    """Force times displacement against shear stress times area times shear, region by region."""
    frame, angle, force = strip(2.5, 4000)
    moved = frame.displacement(angle)
    jaws = np.trapezoid(np.append(0, force), np.append(0, moved))
    H, W = frame.length, frame.width
    full, half = W * (2 * H - 3 * W) / 2, W * W

    def density(g):
        fine = np.linspace(0, g, 20001)
        return np.trapezoid(shear(fine) * np.cos(fine), fine)

    cloth = full * density(angle[-1]) + half * density(0.5 * angle[-1])
    assert jaws == pytest.approx(cloth, rel=1e-6)


def test_one_curve_at_every_angle_from_any_strip():
    """Within 1 % without noise, locking included."""
    curves = []
    for ratio in (2.0, 2.5, 3.0):
        frame, angle, force = strip(ratio)
        curves.append(shear_force(frame, angle, force))
        np.testing.assert_allclose(curves[-1], shear(angle), rtol=0.01)
    assert np.ptp(curves, axis=0).max() < 0.005 * shear(angle).max()


@pytest.mark.parametrize("ratio", [2.0, 2.5, 3.0])
def test_with_noise_the_fitted_curve_is_within_three_percent(ratio):
    rng = np.random.default_rng(4)
    frame, angle, force = strip(ratio, 50)
    pieces = tuple(
        Specimen(
            x=frame.displacement(angle),
            y=force * (1.0 + 0.01 * rng.normal(size=len(force))),
            file=None,
            lines=np.arange(len(force)),
        )
        for _ in range(3)
    )
    test = LabTest(kind="bias-extension", name="t", length=frame.length, width=frame.width,
                   specimens=pieces)  # fmt: skip
    curve, _, residual, reach = identify_bias(test)
    assert reach == pytest.approx(np.sin(np.radians(38.0)), rel=1e-6)
    assert residual < 0.012
    at = np.radians(np.linspace(2.0, 38.0, 40))
    np.testing.assert_allclose(curve.tension(np.sin(at)), shear(at), rtol=0.03)


def test_force_of_a_curve_is_what_identifies_it():
    curve = Curve(strain=[0.0, 0.2, 0.6], stiffness=[300.0, 350.0, 2000.0])
    frame = Frame(0.25, 0.1)
    moved = frame.displacement(np.radians(np.linspace(1.0, 36.0, 40)))
    piece = Specimen(x=moved, y=strip_force(frame, curve, moved), file=None, lines=np.arange(40))
    test = LabTest(kind="bias-extension", name="t", length=0.25, width=0.1, specimens=(piece,),
                   knots=curve.strain)  # fmt: skip
    found, _, residual, _ = identify_bias(test)
    np.testing.assert_allclose(found.stiffness, curve.stiffness, rtol=1e-5)
    assert residual < 1e-8


def test_modulus_at_45_degrees_is_that_of_the_tensor():
    Ea, Eb, nu, G = 9000.0, 6000.0, 0.3, 2000.0
    S = np.array([[1 / Ea, -nu / Ea, 0], [-nu / Ea, 1 / Eb, 0], [0, 0, 1 / G]])
    n = np.array([0.5, 0.5, 0.5])  # stress of a unit pull at 45 degrees
    assert shear_modulus(1.0 / (n @ S @ n), Ea, Eb, nu) == pytest.approx(G, rel=1e-12)
