"""Notches cut into the outline: closed below a size, left alone above it."""

import dataclasses
from types import MappingProxyType

import numpy as np
import pytest

from seatlook import io
from seatlook.assembly import assemble
from seatlook.io.pattern.dxf import read_dxf
from seatlook.io.pattern.dxf_write import write_dxf
from seatlook.io.pattern.pieces.cuts import close_cuts
from seatlook.model import Notch, Pattern
from support import scenes

SQUARE = np.array([[0.0, 0.0], [100.0, 0.0], [100.0, 80.0], [0.0, 80.0]])
ARC = [[50 - 1.5 * np.cos(t), 1.5 + 1.5 * np.sin(t)] for t in np.linspace(0, np.pi, 7)]
CUTS = {
    "v": [[48.5, 0], [50, 3], [51.5, 0]],
    "check": [[48.5, 0], [48.5, 3], [51.5, 0]],
    "castle": [[48.5, 0], [48.5, 3], [51.5, 3], [51.5, 0]],
    "u": [[48.5, 0], *ARC, [51.5, 0]],
    "t": [[49.5, 0], [49.5, 2], [48.5, 2], [48.5, 3], [51.5, 3], [51.5, 2], [50.5, 2], [50.5, 0]],
}
SLIT = [[50, 0], [50, 3], [50, 0]]


def cut_into(outline, cut, after=0):
    """Outline with a cut between its vertices ``after`` and the next."""
    return np.insert(np.asarray(outline, float), after + 1, cut, axis=0)


@pytest.mark.parametrize("kind", CUTS)
def test_small_cut_is_closed_and_named(kind):
    outline, (notch,) = close_cuts(cut_into(SQUARE, CUTS[kind]), 5.0)
    assert outline.tobytes() == SQUARE.tobytes()
    assert notch.kind == kind
    assert notch.depth == pytest.approx(0.003)
    assert notch.position == pytest.approx([0.05, 0.0])


def test_slit_without_width_is_closed():
    outline, (notch,) = close_cuts(cut_into(SQUARE, SLIT), 5.0)
    assert outline.tobytes() == SQUARE.tobytes()
    assert notch.depth == pytest.approx(0.003)


@pytest.mark.parametrize("kind", CUTS)
@pytest.mark.parametrize("below", [0.0, 2.9])
def test_larger_cut_stays(kind, below):
    points = cut_into(SQUARE, CUTS[kind])
    outline, notches = close_cuts(points, below)
    assert outline.tobytes() == points.tobytes()
    assert notches == ()


def test_wide_or_deep_is_enough_to_stay():
    for cut in ([[46, 0], [50, 3], [54, 0]], [[49, 0], [50, 6], [51, 0]]):
        assert close_cuts(cut_into(SQUARE, cut), 5.0)[1] == ()


@pytest.mark.parametrize("turn", range(0, 360, 37))
def test_cuts_on_slanted_edges_several_on_one(turn):
    points = cut_into(cut_into(SQUARE, CUTS["v"]), np.add(CUTS["castle"], [8.0, 0.0]), 3)
    angle = np.radians(turn)
    rotation = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    outline, notches = close_cuts(points @ rotation, 5.0)
    np.testing.assert_allclose(outline, SQUARE @ rotation, atol=1e-12)
    assert [n.kind for n in notches] == ["v", "castle"]


@pytest.mark.parametrize("start", range(7))
def test_cut_over_the_first_vertex(start):
    points = np.roll(cut_into(SQUARE, CUTS["v"]), -start, axis=0)
    outline, notches = close_cuts(points, 5.0)
    assert len(notches) == 1
    assert {tuple(p) for p in outline} == {tuple(p) for p in SQUARE}


def test_chamfers_corners_steps_tabs_and_curves_are_no_cuts():
    t = np.linspace(0, 2 * np.pi, 200, endpoint=False)
    wave = np.column_stack(
        [(60 + 3 * np.cos(8 * t)) * np.cos(t), (60 + 3 * np.cos(8 * t)) * np.sin(t)]
    )
    chamfer = np.array([[0, 0], [97, 0], [100, 3], [100, 80], [0, 80]])
    step = np.array([[0, 0], [50, 0], [50, 3], [100, 3], [100, 80], [0, 80]])
    inner = np.array([[0, 0], [96, 0], [96, 4], [100, 4], [100, 80], [0, 80]])
    tab = cut_into(SQUARE, np.array(CUTS["v"]) * [1, -1])
    for shape in (wave, chamfer, step, inner, tab):
        outline, notches = close_cuts(np.asarray(shape, float), 5.0)
        assert notches == ()
        assert len(outline) == len(shape)


def test_cut_on_a_curve_keeps_its_mouth_on_the_curve():
    t = np.linspace(0, 2 * np.pi, 314, endpoint=False)
    circle = 100 * np.column_stack([np.cos(t), np.sin(t)])
    cut = [[100, -1.5], [97, 0], [100, 1.5]]
    points = np.vstack([cut[1:], circle[2:-1], cut[:1]])
    outline, notches = close_cuts(points, 5.0)
    assert len(notches) == 1
    assert abs(np.hypot(*outline.T) - 100).max() < 0.02


@pytest.fixture
def meshed(tmp_path):
    """Write the two panels, LEFT with a cut in its sewn edge; read and mesh them."""

    def meshed(cut, smallest_notch):
        scene = scenes.two_panels()
        left, right = scene.pattern.panels
        edge = np.array(CUTS[cut]) if cut else np.zeros((0, 2))
        # The sewn edge runs up at 100 mm; inward is to the left.
        turned = 1e-3 * np.column_stack([100 - edge[:, 1], edge[:, 0]])
        outline = np.insert(left.outline, 2, turned, axis=0)
        panel = dataclasses.replace(
            left, outline=outline, cut_outline=outline, corners=np.arange(len(outline))
        )
        flat = Pattern(panels=(panel, right), edges=MappingProxyType({}), seams=())
        write_dxf(flat, tmp_path / "p.dxf")
        io.write_seams(scene.pattern, tmp_path / "s.toml")
        read = io.read_pattern(
            tmp_path / "p.dxf", tmp_path / "s.toml", smallest_notch=smallest_notch
        )
        return assemble(dataclasses.replace(scene, pattern=read))

    return meshed


@pytest.mark.parametrize("cut", ["v", "castle", "u", "t"])
def test_mesh_is_that_of_the_uncut_pattern_to_the_bit(meshed, cut):
    plain, closed = meshed("", 0.005), meshed(cut, 0.005)
    for name in ("rest", "uv", "positions", "faces", "zone"):
        assert getattr(closed, name).tobytes() == getattr(plain, name).tobytes(), name
    assert closed.stitchings[0].length.tobytes() == plain.stitchings[0].length.tobytes()


def test_point_and_cut_at_one_place_are_one_notch(tmp_path):
    scene = scenes.two_panels()
    left = scene.pattern.panels[0]
    outline = 1e-3 * cut_into(1e3 * left.outline, CUTS["castle"])
    drawn = Notch(position=np.array([0.05, 0.0]), kind="t", depth=0.003)
    panel = dataclasses.replace(
        left, outline=outline, cut_outline=outline, corners=np.arange(4), notches=(drawn,)
    )
    flat = Pattern(panels=(panel,), edges=MappingProxyType({}), seams=())
    write_dxf(flat, tmp_path / "p.dxf")
    (read,) = read_dxf(tmp_path / "p.dxf")
    assert [n.kind for n in read.notches] == ["t"]
    assert len(read.outline) == 4
