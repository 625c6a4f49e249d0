"""Covers that are at rest where they should not be: the verdict says so, and the exit code is 3."""

import re
from dataclasses import replace

import numpy as np
import pytest

from seatlook import io
from seatlook.chain.start.surface import flatten_scene
from seatlook.cli import run
from seatlook.flattening.files import write_panels
from seatlook.seats import design_surface, foam_mesh, write_demo
from seatlook.seats.headrest import Headrest

SIZE = 14.0  # mm

# A headrest has cloth to spare at its lower corners.
pytestmark = pytest.mark.filterwarnings("ignore::seatlook.errors.InputWarning")


def solved(scene, capsys):
    """Exit code, result and what was said of a solve from the command line."""
    result = scene.with_name("result.npz")
    code = run(["solve", str(scene), "--out", str(result), "--preview"])
    return code, io.read_result(result), capsys.readouterr().err


def write_pushed(folder):
    """The headrest with the front of its border pulled up and back, into the foam."""
    scene = write_demo(folder, shape="headrest", element_size_mm=SIZE, surface_size=0.012)
    curves = io.read_curves(folder / "curves.toml")
    (name,) = curves
    border = curves[name]
    front = np.clip(-border[:, 1] / 0.03, 0.0, 1.0)[:, None]
    io.write_curves({name: border + front * [0.0, 0.03, 0.04]}, folder / "curves.toml")
    return scene


def test_a_curve_through_the_foam_is_refused_by_check(tmp_path, capsys):
    assert run(["check", str(write_pushed(tmp_path)), "--quiet"]) == 2
    assert "curve inside" in capsys.readouterr().err


def test_a_headrest_in_its_foam_is_not_converged(tmp_path, capsys):
    scene = write_pushed(tmp_path)
    text = scene.read_text()
    allowed = '[check]\nallow = ["curve inside", "ties apart", "start inside"]\n\n[mesh]'
    scene.write_text(text.replace("[mesh]", allowed, 1))
    code, solution, said = solved(scene, capsys)
    assert code == 3
    assert solution.status == "not converged"
    assert re.search(
        r"\d+ cm2 of foam lie bare above the cover .*, most of it above panel FRONT",
        solution.reason,
    )
    assert solution.reason in said
    assert solution.figures["bare_foam"] > 0.05


def test_a_cover_that_hangs_below_its_pillow_is_not_converged(tmp_path, capsys):
    """A standing pillow of 275 x 200 x 407 mm, and its cover half a metre below."""
    form = replace(Headrest.sized(1.0), half=(0.1375, 0.1, 0.407 / 1.92))
    foam = foam_mesh(form, element_size=0.014)
    assert 1e3 * np.ptp(foam.vertices, axis=0) == pytest.approx([275, 200, 407], abs=2)
    surface = design_surface(form, element_size=0.014)
    below = replace(surface, vertices=surface.vertices - [0.0, 0.0, 0.5])
    io.write_obj(foam.vertices, foam.faces, tmp_path / "foam.obj")
    write_panels(below, tmp_path / "design.obj")
    _, made = flatten_scene(
        tmp_path / "design.obj", tmp_path / "foam.obj", tmp_path, element_size_mm=2 * SIZE
    )
    code, solution, said = solved(made.scene, capsys)
    assert code == 3
    assert solution.status == "not converged"
    assert "the cover does not touch the foam" in solution.reason
    assert solution.reason in said
    assert solution.figures["untouched"] == 1.0


@pytest.mark.parametrize(("larger", "shares"), [(1.10, (0.3, 0.0)), (1.16, (0.8, 0.15))])
def test_a_headrest_buried_in_balance_is_not_converged(tmp_path, capsys, larger, shares):
    """Its foam is too large: all forces in balance, seams shut, the border tied."""
    form = Headrest.sized(1.0)
    foam = foam_mesh(form, element_size=0.014)
    middle = foam.vertices.mean(axis=0)
    io.write_obj(middle + larger * (foam.vertices - middle), foam.faces, tmp_path / "foam.obj")
    write_panels(design_surface(form, element_size=0.014), tmp_path / "design.obj")
    _, made = flatten_scene(
        tmp_path / "design.obj", tmp_path / "foam.obj", tmp_path, element_size_mm=SIZE
    )
    text = made.scene.read_text()
    made.scene.write_text(
        text.replace("[mesh]", '[check]\nallow = ["curve inside", "start inside"]\n\n[mesh]', 1)
    )
    code, solution, said = solved(made.scene, capsys)
    assert code == 3
    assert solution.status == "not converged"
    figures = solution.figures
    assert figures["residual"] <= 1e-3
    assert figures["seam_gap_max"] < 1e-4
    assert figures["contact_compression_max"] < 0.6
    assert figures["buried_10mm"] > shares[0]
    assert figures["buried_20mm"] >= shares[1]
    assert re.match(r"\d\d.* % of the cover lies more than 10 mm deep in the foam", solution.reason)
    assert "frame" not in solution.reason
    assert "seam" not in solution.reason
    assert solution.reason in said
