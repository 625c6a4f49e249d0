"""Loose cushions: covers without a border, of a few panels that are sewn all round."""

import re

import numpy as np
import pytest
import trimesh

from seatlook import io
from seatlook.chain.start.surface import flatten_scene
from seatlook.cli import run
from seatlook.mesh.closest import closest_places

SIZE = 14.0  # mm

# Two panels over a thick cushion are strained more than leather takes.
pytestmark = pytest.mark.filterwarnings("ignore::seatlook.errors.InputWarning")


def write_cover(folder, body, rings):
    """Write a body and rings drawn round it, (k, 2) [m] at z = 0, and the scene of its cover."""
    vertices, faces = np.array(body.vertices), np.array(body.faces)
    curves = {}
    for name, ring in rings.items():
        line = np.column_stack([ring, np.zeros(len(ring))])
        line = line - closest_places(line, vertices, faces, reach=np.inf).offset
        curves[name] = np.vstack([line, line[:1]])
    body.export(folder / "body.obj")
    io.write_curves(curves, folder / "lines.toml")
    files = folder / "body.obj", folder / "body.obj", folder / "cover"
    lines = {"seam_lines": folder / "lines.toml"}
    made, scene = flatten_scene(*files, flattening=lines, element_size_mm=SIZE)
    return made.flat, scene.scene


def round_ring(width, depth, count=48):
    angle = np.linspace(0, 2 * np.pi, count, endpoint=False)
    return np.column_stack([width * np.cos(angle), depth * np.sin(angle)])


@pytest.mark.parametrize(("half", "power"), [((0.25, 0.18, 0.07), 2.6), ((0.21, 0.2, 0.06), 2.2)])
def test_a_pillow_of_two_panels_converges(tmp_path, capsys, half, power):
    """Both panels want their seam a tenth longer than it lies on the body, and get it."""
    body = trimesh.creation.icosphere(4)
    way = np.array(body.vertices)
    body.vertices = way * (np.abs(way) ** power).sum(axis=1)[:, None] ** (-1 / power) * half
    flat, scene = write_cover(tmp_path, body, {"zip": round_ring(*half[:2])})
    (seam,) = flat.seams
    assert abs(seam.difference) < 5e-5
    assert seam.a > 1.05 * seam.design
    assert max(panel.rms for panel in flat.panels) < 0.035
    assert run(["check", str(scene), "--quiet"]) == 0
    result = tmp_path / "result.npz"
    assert run(["solve", str(scene), "--out", str(result), "--preview"]) == 0
    solution = io.read_result(result)
    assert solution.status == "converged"
    assert solution.figures["buried_10mm"] < 0.1
    assert solution.figures["seam_gap_max"] < 1e-4
    capsys.readouterr()


def test_a_ring_cushion_may_have_the_handle_of_its_foam(tmp_path, capsys):
    body = trimesh.creation.torus(0.15, 0.055, major_sections=48, minor_sections=24)
    rings = {"outer": round_ring(0.205, 0.205), "inner": round_ring(0.095, 0.095)}
    _, scene = write_cover(tmp_path, body, rings)
    assert run(["check", str(scene), "--quiet"]) == 0
    # The same on a body without a hole cannot be a cover.
    block = trimesh.creation.cylinder(0.205, 0.11, sections=48)
    block.export(tmp_path / "block.obj")
    text = scene.read_text()
    assert "body.obj" in text
    scene.write_text(re.sub(r"body\.obj", "block.obj", text))
    assert run(["check", str(scene), "--quiet"]) == 2
    assert "panels that make a surface with 1 handle" in capsys.readouterr().err
