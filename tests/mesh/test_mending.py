"""Surfaces of every kind of fault become closed, oriented and of the right volume, and say how."""

import numpy as np
import pytest
import shapely
import trimesh
from scipy.spatial import cKDTree

from seatlook.errors import InputError
from seatlook.mesh.mending import cleaning
from seatlook.mesh.mending.mend import Mending, is_clean, mend_body, mend_sheet
from seatlook.mesh.mending.skin import Skin
from support.rough_surfaces import cushion, scan, volume, whole_seat, without


def mended(vertices, faces, **choices):
    skin = Skin(np.array(vertices, dtype=float), np.array(faces), np.arange(len(faces)))
    mend_body(skin, Mending(**choices), lambda point: f"{point}")
    return skin


def said(skin):
    return {row.what.split(",")[0]: row.number for row in skin.report}


def box(extents=(0.4, 0.3, 0.1), at=(0.0, 0.0, 0.0)):
    mesh = trimesh.creation.box(extents=extents)
    return np.asarray(mesh.vertices) + at, np.array(mesh.faces)


def joined(*parts):
    first = np.cumsum([0, *(len(v) for v, _ in parts)])
    return (
        np.concatenate([v for v, _ in parts]),
        np.concatenate([f + k for (_, f), k in zip(parts, first, strict=False)]),
    )


def test_a_clean_surface_stays_as_it_is():
    vertices, faces = cushion(3)
    assert is_clean(vertices, faces)
    skin = mended(vertices, faces)
    assert skin.report == []
    assert volume(skin.vertices, skin.faces) == pytest.approx(volume(vertices, faces), rel=1e-12)


def spoiled_by_duplicates(v, f):
    return v, np.concatenate([f, f[7:10], np.roll(f[20:22], 1, axis=1)]), "faces that lay"


def spoiled_by_turned_faces(v, f):
    f[[3, 50, 51, 200]] = f[[3, 50, 51, 200], ::-1]
    return v, f, "faces turned"


def spoiled_by_a_crack(v, f):
    upper = v[f].mean(axis=1)[:, 2] > 0.02
    moved = v + np.array([0.0, 0.0, 1e-4])
    return np.concatenate([v, moved]), np.where(upper[:, None], f + len(v), f), "vertices along"


def spoiled_by_a_fin(v, f):
    tip = np.array([[0.0, 0.0, 0.2]])
    return np.concatenate([v, tip]), np.concatenate([f, [[*f[11, :2], len(v)]]]), "edges of more"


def spoiled_by_a_needle(v, f):
    a, b, c = f[30]
    near = v[a] + 2e-6 * (v[b] - v[a]) / np.linalg.norm(v[b] - v[a])
    neighbour = next(i for i, row in enumerate(f) if i != 30 and {a, b} <= set(row))
    far = next(k for k in f[neighbour] if k not in (a, b))
    new = len(v)
    f = np.delete(f, [30, neighbour], axis=0)
    f = np.concatenate([f, [[a, new, c], [new, b, c], [new, a, far], [b, new, far]]])
    return np.concatenate([v, near[None]]), f, "slivers"


def spoiled_by_a_flat_face(v, f):
    """A vertex on a side of one face that the neighbour does not know, closed by a flat face."""
    a, b, c = f[30]
    new = len(v)
    f = np.delete(f, 30, axis=0)
    f = np.concatenate([f, [[a, new, c], [new, b, c], [a, b, new]]])
    return np.concatenate([v, [(v[a] + v[b]) / 2]]), f, "slivers"


def spoiled_by_specks(v, f):
    loose = np.array([[0.3, 0, 0], [0.301, 0, 0], [0.3, 0.001, 0]])
    return np.concatenate([v, loose]), np.concatenate([f, [len(v) + np.arange(3)]]), "loose specks"


@pytest.mark.parametrize(
    "spoil",
    [
        spoiled_by_duplicates,
        spoiled_by_turned_faces,
        spoiled_by_a_crack,
        spoiled_by_a_fin,
        spoiled_by_a_needle,
        spoiled_by_a_flat_face,
        spoiled_by_specks,
    ],
    ids=lambda spoil: spoil.__name__.removeprefix("spoiled_by_"),
)
@pytest.mark.parametrize("shape", [cushion, lambda n: box_mesh(n)], ids=["cushion", "box"])
def test_each_fault_is_mended_and_reported(spoil, shape):
    whole = shape(3)
    vertices, faces, what = spoil(np.array(whole[0]), np.array(whole[1]))
    assert not is_clean(vertices, faces)
    skin = mended(vertices, faces)
    assert is_clean(skin.vertices, skin.faces)
    assert volume(skin.vertices, skin.faces) == pytest.approx(volume(*whole), rel=2e-3)
    assert any(row.what.startswith(what) for row in skin.report), skin.report


def box_mesh(_):
    mesh = trimesh.creation.box(extents=(0.4, 0.3, 0.16)).subdivide().subdivide().subdivide()
    return np.asarray(mesh.vertices), np.array(mesh.faces)


def test_an_inner_wall_goes():
    vertices, faces = trimesh.creation.box(extents=(0.4, 0.3, 0.1)).subdivide().split()[0], None
    vertices, faces = np.asarray(vertices.vertices), np.array(vertices.faces)
    ring = np.flatnonzero(np.abs(vertices[:, 0]) < 1e-9)
    angle = np.arctan2(vertices[ring, 2], vertices[ring, 1])
    ring = ring[np.argsort(angle)]
    middle = len(vertices)
    wall = np.column_stack([ring, np.roll(ring, -1), np.full(len(ring), middle)])
    skin = mended(np.concatenate([vertices, [[0.0, 0.0, 0.0]]]), np.concatenate([faces, wall]))
    assert is_clean(skin.vertices, skin.faces)
    assert volume(skin.vertices, skin.faces) == pytest.approx(0.4 * 0.3 * 0.1)
    assert "inner walls" in skin.report[0].what


def test_bodies_that_touch_along_an_edge_are_two():
    one, two = box((0.2, 0.2, 0.2)), box((0.2, 0.2, 0.2), (0.2, 0.2, 0.0))
    vertices, faces = joined(one, two)
    _, first, index = np.unique(vertices.round(6), axis=0, return_index=True, return_inverse=True)
    vertices, faces = vertices[first], index.reshape(-1)[faces]
    with pytest.raises(InputError, match="2 bodies"):
        mended(vertices, faces)
    skin = mended(vertices, faces, body=2)
    assert volume(skin.vertices, skin.faces) == pytest.approx(0.008)
    assert is_clean(skin.vertices, skin.faces)


def test_bodies_are_united_or_chosen_by_size():
    one, two = box((0.4, 0.3, 0.2)), box((0.4, 0.1, 0.3), (0.0, 0.1, 0.2))
    united = mended(*joined(two, one), unite=True)
    overlap = 0.4 * (0.15 - 0.05) * (0.1 - 0.05)
    assert volume(united.vertices, united.faces) == pytest.approx(
        0.4 * 0.3 * 0.2 + 0.4 * 0.1 * 0.3 - overlap
    )
    assert is_clean(united.vertices, united.faces)
    largest = mended(*joined(two, one), body=1)
    assert volume(largest.vertices, largest.faces) == pytest.approx(0.4 * 0.3 * 0.2)
    with pytest.raises(InputError, match="body: got 3, expected 1 to 2"):
        mended(*joined(two, one), body=3)


def test_bodies_apart_are_united_and_said_to_be_apart():
    skin = mended(*joined(box(), box(at=(0.5, 0.0, 0.0))), unite=True)
    assert volume(skin.vertices, skin.faces) == pytest.approx(2 * 0.4 * 0.3 * 0.1)
    assert skin.report[-1].what == "bodies united, in 2 parts that do not touch"


def test_an_open_box_is_refused_with_place_and_closed_flat():
    vertices, faces = box_mesh(0)
    faces = faces[vertices[faces].mean(axis=1)[:, 2] > -0.079]
    with pytest.raises(InputError, match="open edges round 1 holes") as refused:
        mended(vertices, faces)
    assert "1400 mm round" in str(refused.value)
    skin = mended(vertices, faces, close=True)
    assert volume(skin.vertices, skin.faces) == pytest.approx(0.4 * 0.3 * 0.16)
    assert is_clean(skin.vertices, skin.faces)


@pytest.mark.parametrize("radius", [0.02, 0.03])
def test_a_hole_in_a_crown_is_filled_as_the_crown_goes_on(radius):
    vertices, faces = cushion(5)
    open_faces = without(vertices, faces, np.array([0.05, 0.02, 0.07]), radius)
    skin = mended(vertices, open_faces, close=True)
    new = skin.source < 0
    assert new.any()
    filled = skin.vertices[np.unique(skin.faces[new])]
    off = cKDTree(vertices).query(filled)[0]
    truth = trimesh.Trimesh(vertices, faces, process=False)
    _, distance, _ = trimesh.proximity.closest_point_naive(truth, filled[off > 1e-9])
    sagitta = radius**2 / (2 * 0.25)
    assert distance.max() < 0.35 * sagitta


def test_a_long_ragged_border_is_closed():
    """Of more corners than are triangulated as a whole, some of them pointing inward."""
    t = np.linspace(0, 2 * np.pi, 700, endpoint=False)
    radius = 0.2 + 0.004 * np.cos(70 * t)
    rim = np.column_stack([radius * np.cos(t), radius * np.sin(t), np.zeros(700)])
    vertices = np.concatenate([rim, [[0.0, 0.0, 0.1]]])
    faces = np.column_stack([np.arange(700), np.roll(np.arange(700), -1), np.full(700, 700)])
    skin = mended(vertices, faces, close=True)
    area = 0.5 * np.cross(rim, np.roll(rim, -1, axis=0))[:, 2].sum()
    assert volume(skin.vertices, skin.faces) == pytest.approx(area * 0.1 / 3, rel=1e-9)
    assert is_clean(skin.vertices, skin.faces)


def test_a_shell_is_thickened_downward():
    x, y = (a.ravel() for a in np.meshgrid(np.linspace(0, 0.4, 21), np.linspace(0, 0.3, 16)))
    vertices = np.column_stack([x, y, 0.02 * np.sin(12 * x)])
    i = np.arange(15)[:, None] * 21 + np.arange(20)
    faces = np.concatenate(
        [np.stack([i, i + 1, i + 22], -1), np.stack([i, i + 22, i + 21], -1)]
    ).reshape(-1, 3)
    skin = mended(vertices, faces, thicken=0.04)
    assert is_clean(skin.vertices, skin.faces)
    area = trimesh.Trimesh(vertices, faces, process=False).area
    assert volume(skin.vertices, skin.faces) == pytest.approx(0.04 * area, rel=0.02)
    assert cKDTree(skin.vertices).query(vertices)[0].max() < 2e-5
    assert skin.vertices[:, 2].min() < vertices[:, 2].min() - 0.035
    with pytest.raises(InputError, match="a closed surface"):
        mended(*cushion(2), thicken=0.04)


@pytest.mark.parametrize("width", [0.008, 0.02])
def test_thin_welts_keep_all_their_vertices(width):
    """A welt much thinner than the body: its walls would come out on each other's outside."""
    x = np.linspace(0, 0.2, 101)
    y = np.linspace(0, 0.01, 3)
    ridge = 0.015 * np.exp(-(((x - 0.1) / (0.5 * width)) ** 4))
    xx, yy = (a.ravel() for a in np.meshgrid(x, y))
    vertices = np.column_stack([xx, yy, np.tile(ridge, len(y))])
    i = np.arange(2)[:, None] * 101 + np.arange(100)
    faces = np.concatenate(
        [np.stack([i, i + 1, i + 102], -1), np.stack([i, i + 102, i + 101], -1)]
    ).reshape(-1, 3)
    skin = mended(vertices, faces, thicken=0.03)
    assert is_clean(skin.vertices, skin.faces)
    assert cKDTree(skin.vertices).query(vertices)[0].max() < 2e-5
    assert "vertices lost" not in said(skin)
    assert skin.vertices[:, 2].min() == pytest.approx(-0.03, abs=1e-3)


@pytest.mark.parametrize("seed", range(4))
def test_a_raw_scan_becomes_a_foam(seed):
    """Holes, noise of 0.3 mm, specks, fins, faces turned and drawn twice; open below."""
    skin = mended(*scan(seed), close=True, smooth=0.02)
    assert is_clean(skin.vertices, skin.faces)
    words = said(skin)
    assert {"faces turned to the side of their neighbours", "loose specks dropped"} <= set(words)
    assert words["holes filled smoothly"] == 4
    assert words["openings closed flat"] == 1
    vertices, faces = cushion()
    above = skin.vertices[skin.vertices[:, 2] > -0.03]
    truth = trimesh.Trimesh(vertices, faces, process=False)
    _, distance, _ = trimesh.proximity.closest_point_naive(truth, above[::7])
    assert np.sqrt((distance**2).mean()) < 0.0003


def test_smoothing_takes_noise_and_leaves_the_shape():
    """A wave of the stated length is halved, one of a third of it gone."""
    n = 121
    x, y = (a.ravel() for a in np.meshgrid(np.linspace(0, 0.3, n), np.linspace(0, 0.1, 41)))
    i = np.arange(40)[:, None] * n + np.arange(n - 1)
    faces = np.concatenate(
        [np.stack([i, i + 1, i + n + 1], -1), np.stack([i, i + n + 1, i + n], -1)]
    ).reshape(-1, 3)
    inside = (np.abs(x - 0.15) < 0.08) & (np.abs(y - 0.05) < 0.02)
    for length, left in ((0.03, 0.5), (0.01, 1 / 82), (0.09, 81 / 82)):
        z = 1e-4 * np.sin(2 * np.pi * x / length)
        skin = Skin(np.column_stack([x, y, z]), faces, np.arange(len(faces)))
        mend_sheet(skin, Mending(smooth=0.03))
        ratio = (skin.vertices[inside, 2] @ z[inside]) / (z[inside] @ z[inside])
        assert ratio == pytest.approx(left, abs=0.04)


def test_a_sheet_keeps_its_longest_border_and_fills_the_others():
    x, y = (a.ravel() for a in np.meshgrid(np.linspace(0, 0.4, 41), np.linspace(0, 0.3, 31)))
    i = np.arange(30)[:, None] * 41 + np.arange(40)
    faces = np.concatenate(
        [np.stack([i, i + 1, i + 42], -1), np.stack([i, i + 42, i + 41], -1)]
    ).reshape(-1, 3)
    vertices = np.column_stack([x, y, 0.0 * x])
    skin = Skin(vertices, without(vertices, faces, np.array([0.2, 0.15, 0]), 0.03), np.arange(2400))
    skin.source = np.arange(len(skin.faces))
    mend_sheet(skin, Mending(close=True))
    area = trimesh.Trimesh(skin.vertices, skin.faces, process=False).area
    assert area == pytest.approx(0.4 * 0.3)
    assert (skin.source < 0).any()


def test_a_one_sided_strip_is_refused():
    k = np.arange(12)
    a, b = 2 * k, 2 * k + 1
    na, nb = np.roll(a, -1), np.roll(b, -1)
    na[-1], nb[-1] = b[0], a[0]
    t = 2 * np.pi * k / 12
    middle = np.column_stack([np.cos(t), np.sin(t), 0 * t])
    across = np.column_stack([np.cos(t / 2) * np.cos(t), np.cos(t / 2) * np.sin(t), np.sin(t / 2)])
    vertices = np.empty((24, 3))
    vertices[a], vertices[b] = middle - 0.2 * across, middle + 0.2 * across
    faces = np.concatenate([np.column_stack([a, na, b]), np.column_stack([na, nb, b])])
    with pytest.raises(InputError, match="one side only"):
        mended(vertices, faces, close=True)


def test_choices_that_contradict_each_other():
    with pytest.raises(InputError, match="close: got with thicken"):
        Mending(close=True, thicken=0.04)
    with pytest.raises(InputError, match="unite: got with body"):
        Mending(unite=True, body=1)


def test_a_whole_seat_of_two_bodies_is_one_foam():
    vertices, faces = whole_seat()
    assert np.ptp(vertices, axis=0) == pytest.approx([0.9, 1.2, 1.0])
    skin = mended(vertices, faces, unite=True)
    assert is_clean(skin.vertices, skin.faces)
    assert np.ptp(skin.vertices, axis=0) == pytest.approx([0.9, 1.2, 1.0])


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.parametrize(
    "choices",
    [
        {},
        {"close": True},
        {"close": True, "body": 1, "smooth": 0.02},
        {"close": True, "unite": True},
    ],
    ids=["as-it-is", "close", "body", "unite"],
)
def test_whatever_comes_is_a_solid_or_refused(seed, choices):
    """Heaps of triangles, wrong corners, coarse digits, and parts of a noisy surface."""
    rng = np.random.default_rng(seed)
    vertices, faces = cushion(2)
    kind = seed % 4
    if kind == 0:
        vertices = rng.uniform(-0.3, 0.3, (15, 3))
        faces = rng.integers(0, 15, (40, 3))
    elif kind == 1:
        faces[rng.integers(len(faces), size=9), rng.integers(3, size=9)] = rng.integers(99, size=9)
    elif kind == 2:
        vertices = vertices.round(2)
    else:
        faces = faces[rng.uniform(size=len(faces)) < 0.8]
        vertices = vertices + rng.normal(0, 0.01, vertices.shape)
    a, b, c = faces.T
    faces = faces[(a != b) & (b != c) & (c != a)]
    try:
        skin = mended(vertices, faces, **choices)
    except InputError:
        return
    edges = np.sort(np.stack([skin.faces, np.roll(skin.faces, -1, 1)], 2).reshape(-1, 2), axis=1)
    assert (np.unique(edges, axis=0, return_counts=True)[1] == 2).all()
    assert volume(skin.vertices, skin.faces) > 0


def test_flat_faces_beside_flat_faces_are_not_turned_back_and_forth(monkeypatch):
    """Rows of slivers, as CAD systems leave them along rounded corners."""
    corners = [(-0.3, -0.25), (0.3, -0.25), (0.3, 0.05), (0.05, 0.05), (0.05, 0.25), (-0.3, 0.25)]
    outline = shapely.Polygon(corners).buffer(-0.04).buffer(0.08).buffer(-0.04)
    block = trimesh.creation.extrude_polygon(outline, 0.1)
    block = trimesh.Trimesh(*trimesh.remesh.subdivide_to_size(block.vertices, block.faces, 0.025))
    block.merge_vertices()
    trimesh.smoothing.filter_humphrey(block, iterations=3)
    skin = Skin(np.array(block.vertices), np.array(block.faces), np.arange(len(block.faces)))
    flat, rounds, flip = len(cleaning.slivers(skin)), [], cleaning._flip
    monkeypatch.setattr(cleaning, "_flip", lambda *args: rounds.append(0) or flip(*args))
    cleaning.mend_slivers(skin)
    assert flat > 20
    assert len(rounds) < 10
    assert len(cleaning.slivers(skin)) < flat / 4
    assert volume(skin.vertices, skin.faces) == pytest.approx(block.volume, rel=1e-4)
