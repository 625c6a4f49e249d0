"""The finished shape against its design: hand-computed offsets, rims, sides, seam lines."""

import dataclasses
import itertools

import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.model import Design, Points, Stitching
from seatlook.results.deviation import deviation, seam_lines
from seatlook.results.gap import zone_gaps
from support.covers import cover, sheet, sphere
from support.io_samples import as_placed
from support.reference.lit_sheets import grid


def level(height=0.0, *, size=0.16, names=("L", "R"), **options):
    """A level design whose panels meet on x = 0."""
    flat, faces = grid((-size / 2, -size / 2), (size / 2, size / 2), (8, 8))
    x = np.column_stack([flat, np.full(len(flat), height)])
    panel = (flat[faces].mean(axis=1)[:, 0] > 0).astype(np.int64)
    return Design(vertices=x, faces=faces, panel=panel, panel_names=names, **options)


def finished(shape, *, shift=0.0):
    """Two panels, 1 mm thick, sewn on x = ``shift`` and lying as shape(x, y) says."""
    parts = []
    for left, width in ((-0.08, 0.08 + shift), (shift, 0.08 - shift)):
        X, T, x = sheet(width, 0.12, 0.01, at=(left, -0.06))
        x[:, 2] = shape(x[:, 0], x[:, 1])
        parts.append((X, T, x))
    c = cover(parts, h=0.01)
    rim = np.flatnonzero(np.abs(c.positions[:, 0] - shift) < 1e-9)
    n = len(parts[0][0])
    a, b = rim[rim < n], rim[rim >= n]
    seam = Stitching(
        name="middle", a=points(a), b=points(b), length=np.full(len(a), 0.12 / len(a)), stage="sew"
    )
    names = {"panel_names": ("L", "R"), "stitchings": (seam,)}
    return as_placed(dataclasses.replace(c, **names))


def points(vertices):
    pair = np.column_stack([vertices, vertices])
    return Points(vertices=pair, weights=np.tile([1.0, 0.0], (len(pair), 1)))


@pytest.mark.parametrize("height", [0.003, -0.002])
def test_level_cover_above_and_below(height):
    s = finished(lambda x, y: height + 0 * x)
    np.testing.assert_allclose(deviation(s, level()), height, atol=1e-12)
    np.testing.assert_allclose(deviation(s, level(visible=True)), height + 0.0005, atol=1e-12)
    rows = zone_gaps(s, deviation(s, level()))
    assert sum(row.area for row in rows) == pytest.approx(0.16 * 0.12)
    for row in rows:
        assert (row.mean, row.p95) == pytest.approx((height, abs(height)))


def test_ramp_has_its_share_in_the_tail():
    s = finished(lambda x, y: np.where(x > 0, 0.1 * x, 0.0))
    off = deviation(s, level())
    right = s.cover.panel == 1
    assert np.abs(off[~right]).max() < 1e-12
    one = dataclasses.replace(
        s, cover=dataclasses.replace(s.cover, zone=s.cover.panel.copy(), zone_names=("L", "R"))
    )
    left_row, right_row = zone_gaps(one, off)
    assert left_row.p95 < 1e-12
    # 0 to 8 mm, evenly: 95 % lie below 7.6 mm, to a face.
    assert right_row.p95 == pytest.approx(0.0076, abs=0.0006)
    assert right_row.highest == pytest.approx(0.008, abs=0.0007)


def test_inside_and_outside_of_a_sphere():
    """Its facets lie up to 0.1 mm inside."""
    vertices, faces = sphere(0.1, 5)
    design = Design(
        vertices=vertices, faces=faces, panel=np.zeros(len(faces), np.int64), panel_names=("L",)
    )
    X, T, x = sheet(0.1, 0.1, 0.01, at=(-0.05, -0.05))
    for r in (0.098, 0.103):
        y = np.column_stack([x[:, :2], np.full(len(x), 0.1)])
        y *= r / np.linalg.norm(y, axis=1)[:, None]
        off = deviation(as_placed(cover([(X, T, y)], h=0.01)), design)
        assert (off >= r - 0.1 - 1e-9).all()
        assert (off <= r - 0.1 + 1e-4).all()


def test_beside_the_rim_and_far_away_the_deviation_is_nan():
    s = finished(lambda x, y: 0.002 + 0 * x)
    off = deviation(s, level(size=0.08))
    middle = s.positions[s.cover.faces].mean(axis=1)
    inside = (np.abs(middle[:, :2]) < 0.034).all(axis=1)
    np.testing.assert_allclose(off[inside], 0.002, atol=1e-12)
    beside = (np.abs(middle[:, :2]) > 0.046).any(axis=1)
    assert np.isnan(off[beside]).all()
    far = finished(lambda x, y: 0.06 + 0 * x)
    assert np.isnan(deviation(far, level())).all()


def test_design_inside_out_is_refused():
    design = level()
    turned = dataclasses.replace(design, faces=np.ascontiguousarray(design.faces[:, ::-1]))
    with pytest.raises(InputError, match="design: got normals pointing inward"):
        deviation(finished(lambda x, y: 0.001 + 0 * x), turned)


def test_seam_line_is_off_by_its_shift():
    (row,) = seam_lines(finished(lambda x, y: 0 * x, shift=0.003), level())
    assert row.seam == "middle"
    assert (row.mean, row.largest) == pytest.approx((0.003, 0.003))
    (tilted,) = seam_lines(finished(lambda x, y: 0.05 * (y + 0.06)), level())
    assert tilted.mean == pytest.approx(0.003, rel=0.01)
    assert tilted.largest == pytest.approx(0.006)


def test_a_seam_of_a_panel_with_itself_is_compared_with_the_lines_in_it():
    """As a dart is: here both sheets are one panel, with a line drawn in its middle."""
    s = finished(lambda x, y: 0 * x, shift=0.003)
    names = ("P", "P")
    s = dataclasses.replace(s, cover=dataclasses.replace(s.cover, panel_names=names))
    whole = level(names=("P", "OTHER"))
    whole = dataclasses.replace(whole, panel=np.zeros_like(whole.panel))
    assert seam_lines(s, whole)[0].mean is None
    middle = np.flatnonzero(np.abs(whole.vertices[:, 0]) < 1e-9)
    middle = middle[np.argsort(whole.vertices[middle, 1])].tolist()
    lines = {tuple(sorted(pair)): "dart" for pair in itertools.pairwise(middle)}
    (row,) = seam_lines(s, dataclasses.replace(whole, seam_lines=lines))
    assert (row.mean, row.largest) == pytest.approx((0.003, 0.003))


def test_seam_without_a_line_on_the_design_is_named_without_a_figure():
    (row,) = seam_lines(finished(lambda x, y: 0 * x), level(names=("L", "OTHER")))
    assert (row.mean, row.largest) == (None, None)
    assert row.length == pytest.approx(0.12)
