import re

import numpy as np
import pytest
import trimesh

from seatlook.errors import InputWarning
from seatlook.io.curves import read_curves, write_curves
from seatlook.io.material import read_foam_material
from seatlook.io.surface.axes import METRES
from seatlook.io.surface.design import GroupedMesh, read_surface, write_obj, write_surface
from seatlook.io.surface.foam import read_foam, read_foam_surface
from seatlook.io.surface.mended import mend_file
from seatlook.mesh import face_areas, face_vectors
from seatlook.mesh.mending.mend import Mending
from support.rough_surfaces import scan, without

FOAM = read_foam_material("foam-seat")


def tube():
    """A closed body with no symmetry, in metres."""
    mesh = trimesh.creation.box(extents=(0.5, 0.4, 0.1))
    mesh.vertices = mesh.vertices + np.array([0.01, 0.02, 0.03])
    return mesh


def volume(foam):
    a, b, c = foam.vertices[foam.faces].transpose(1, 0, 2)
    return np.einsum("ij,ij->", a, np.cross(b, c)) / 6


@pytest.mark.parametrize("suffix", [".obj", ".stl", ".ply", ".glb", ".gltf"])
@pytest.mark.parametrize(
    ("unit", "scale"), [("mm", 1000.0), ("cm", 100.0), ("m", 1.0), ("inch", 1 / 0.0254)]
)
def test_formats_and_units(tmp_path, suffix, unit, scale):
    mesh = tube()
    mesh.apply_scale(scale)
    path = tmp_path / f"foam{suffix}"
    _export(mesh, path)
    foam = read_foam(path, material=FOAM, unit=unit, up="z")
    assert foam.vertices.shape == (8, 3)
    assert len(foam.faces) == 12
    assert volume(foam) == pytest.approx(0.5 * 0.4 * 0.1, rel=1e-5)
    assert foam.vertices.max(axis=0) == pytest.approx([0.26, 0.22, 0.08], abs=1e-6)


def _export(mesh, path):
    if path.suffix == ".gltf":  # a file of numbers beside it
        for name, content in trimesh.Scene(mesh).export(file_type="gltf").items():
            (path if name.endswith("gltf") else path.parent / name).write_bytes(content)
    else:
        mesh.export(path)


def test_gltf_is_in_metres_and_y_up(tmp_path):
    upright = tube()
    upright.vertices = upright.vertices[:, [0, 2, 1]] * [1, 1, -1]
    upright.export(tmp_path / "foam.glb")
    surface = read_foam_surface(tmp_path / "foam.glb")
    assert surface.axes == ("m", "y")
    assert surface.vertices.max(axis=0) == pytest.approx([0.26, 0.22, 0.08], abs=1e-6)


def test_gltf_objects_stand_where_their_nodes_put_them(tmp_path):
    """Mirrored and moved nodes, as halves of a seat are; each is a panel of a design surface."""
    half = trimesh.creation.box(extents=(0.2, 0.1, 0.3))
    half.apply_translation([0.1, 0, 0])
    half.update_faces(np.arange(12) != 3)
    scene = trimesh.Scene()
    scene.add_geometry(half, node_name="LEFT", geom_name="half")
    mirrored = np.diag([-1.0, 1.0, 1.0, 1.0])
    scene.graph.update(frame_to="RIGHT", geometry="half", matrix=mirrored)
    scene.export(tmp_path / "halves.glb")
    drawn = read_surface(tmp_path / "halves.glb")
    assert sorted(drawn.panel_names) == ["LEFT", "RIGHT"]
    names = np.array(drawn.panel_names)[drawn.panel]
    for name, sign in (("LEFT", 1.0), ("RIGHT", -1.0)):
        faces = drawn.faces[names == name]
        assert len(faces) == 11
        assert (sign * drawn.vertices[faces][..., 0] > -1e-7).all()
        middle, half_way = drawn.vertices[faces].mean(axis=1), np.array([0.1 * sign, 0, 0])
        outward = ((middle - half_way) * face_vectors(drawn.vertices, faces)).sum(axis=1)
        assert (outward > 0).all()


def test_compressed_gltf_is_refused_with_a_way_on(tmp_path, problems):
    header = b'{"asset":{"version":"2.0"},"extensionsRequired":["KHR_draco_mesh_compression"]}'
    (tmp_path / "a.gltf").write_bytes(header)
    assert problems(read_foam, tmp_path / "a.gltf", material=FOAM) == [
        "a.gltf: file: got KHR_draco_mesh_compression, expected vertices that are not compressed "
        "(export it again without compression)"
    ]


@pytest.mark.parametrize(("scale", "unit"), [(1000.0, "mm"), (1.0, "m"), (5.0, "m")])
def test_the_size_tells_mm_from_m(tmp_path, scale, unit):
    mesh = tube()
    mesh.apply_scale(scale)
    mesh.export(tmp_path / "foam.ply")
    assert read_foam_surface(tmp_path / "foam.ply").axes == (unit, "z")


def test_a_size_that_tells_no_unit_is_named_in_each(tmp_path, problems):
    mesh = tube()
    mesh.apply_scale(1 / 0.0254)
    mesh.export(tmp_path / "foam.ply")
    assert problems(read_foam_surface, tmp_path / "foam.ply") == [
        'foam.ply: unit: got nothing, and a file 19.69 wide; it is 0.1969 m in "cm" or 0.5 m in '
        '"inch", expected one of mm, cm, m, inch'
    ]


def test_inward_faces_are_turned(tmp_path):
    mesh = tube()
    mesh.invert()
    mesh.export(tmp_path / "foam.ply")
    assert volume(read_foam(tmp_path / "foam.ply", material=FOAM, unit="m")) > 0


def test_y_up_is_turned_to_z(tmp_path):
    vertices = np.asarray(tube().vertices)
    write_obj(vertices[:, [0, 2, 1]] * [1, 1, -1], tube().faces, tmp_path / "foam.obj")
    foam = read_foam(tmp_path / "foam.obj", material=FOAM, unit="mm", up="y")
    assert volume(foam) > 0
    assert np.allclose(np.sort(foam.vertices, axis=0), np.sort(vertices, axis=0))


def test_a_closed_surface_with_nothing_inside(tmp_path, problems):
    folded = np.array([[0, 0, 0], [0.3, 0, 0], [0, 0.3, 0]], dtype=float)
    write_obj(folded, np.array([[0, 1, 2], [0, 2, 1]]), tmp_path / "foam.obj")
    (message,) = problems(read_foam, tmp_path / "foam.obj", material=FOAM, unit="mm")
    assert message == "foam.obj: surface: got nothing inside, expected a body with a volume"


def test_surface_not_closed(tmp_path, problems):
    mesh = tube()
    write_obj(mesh.vertices, mesh.faces[1:], tmp_path / "foam.obj")
    (message,) = problems(read_foam, tmp_path / "foam.obj", material=FOAM, unit="mm")
    assert message == (
        "foam.obj: surface: got 3 open edges round 1 holes, the largest 912 mm round at "
        "(-240, -46.6667, 46.6667) mm, expected a closed surface "
        "(close fills the holes, thicken_mm gives an open shell a thickness)"
    )


def test_one_face_turned(tmp_path):
    mesh = tube()
    faces = np.array(mesh.faces)
    faces[3] = faces[3, ::-1]
    write_obj(mesh.vertices, faces, tmp_path / "foam.obj")
    with pytest.warns(InputWarning, match=r"1 faces turned to the side of .* at \(.*\) mm"):
        foam = read_foam(tmp_path / "foam.obj", material=FOAM, unit="mm")
    assert volume(foam) == pytest.approx(0.5 * 0.4 * 0.1)


def test_two_bodies(tmp_path, problems):
    a, b = tube(), tube()
    b.apply_translation([0.6, 0, 0])
    write_obj(*_joined(a, b), tmp_path / "foam.obj")
    assert problems(read_foam, tmp_path / "foam.obj", material=FOAM, unit="mm") == [
        "foam.obj: surface: got 2 bodies (1: 20 l at (10, 20, 30) mm; 2: 20 l at (610, 20, 30) mm),"
        " expected one body (unite makes one of them, body = 1 takes the first)"
    ]


@pytest.mark.parametrize(("unit", "up"), [("inch", "y"), ("cm", "z")])
def test_places_are_those_of_the_file(tmp_path, problems, unit, up):
    mesh = tube()
    vertices = mesh.vertices / METRES[unit]
    if up == "y":
        vertices = vertices[:, [0, 2, 1]] * [1, 1, -1]
    trimesh.Trimesh(vertices, mesh.faces[1:], process=False).export(tmp_path / "foam.ply")
    (message,) = problems(read_foam_surface, tmp_path / "foam.ply", unit=unit, up=up)
    x, y, z = (float(v) for v in re.search(r"at \((.*)\) " + unit, message)[1].split(","))
    rim = np.unique(mesh.faces[0])
    assert np.array([x, y, z]) == pytest.approx(vertices[rim].mean(axis=0), abs=1e-3)


@pytest.mark.parametrize("suffix", [".obj", ".ply", ".glb", ".stl"])
def test_a_scan_becomes_a_foam_file_that_reads_as_it_is(tmp_path, suffix):
    vertices, faces = scan(5)
    trimesh.Trimesh(vertices, faces, process=False).export(tmp_path / f"scan{suffix}")
    choices = Mending(close=True, smooth=0.015)
    kept = {"unit": "m", "up": "z"}
    mended = mend_file(tmp_path / f"scan{suffix}", tmp_path / "foam.obj", mending=choices, **kept)
    assert len(mended.mended) >= 5
    again = read_foam_surface(tmp_path / "foam.obj", unit="mm")
    assert again.mended == ()
    assert len(again.faces) == len(mended.faces)
    with pytest.warns(InputWarning, match="loose specks dropped"):
        foam = read_foam(tmp_path / f"scan{suffix}", material=FOAM, mending=choices, **kept)
    assert np.array_equal(foam.faces, mended.faces)


def test_a_design_surface_keeps_its_panels_when_it_is_mended(tmp_path):
    x, y = (a.ravel() for a in np.meshgrid(np.linspace(0, 400, 41), np.linspace(0, 300, 31)))
    i = np.arange(30)[:, None] * 41 + np.arange(40)
    faces = np.concatenate(
        [np.stack([i, i + 1, i + 42], -1), np.stack([i, i + 42, i + 41], -1)]
    ).reshape(-1, 3)
    vertices = 1e-3 * np.column_stack([x, y, 0 * x])
    faces = without(vertices, faces, np.array([0.1, 0.15, 0]), 0.03)
    panel = (vertices[faces].mean(axis=1)[:, 0] > 0.2).astype(np.int64)
    write_surface(GroupedMesh(vertices, faces, panel, ("LEFT", "RIGHT")), tmp_path / "holed.obj")
    mend_file(tmp_path / "holed.obj", tmp_path / "d.obj", sheet=True, mending=Mending(close=True))
    drawn = read_surface(tmp_path / "d.obj")
    areas = np.bincount(drawn.panel, face_areas(drawn.vertices, drawn.faces))
    assert dict(zip(drawn.panel_names, areas, strict=True)) == pytest.approx(
        {"LEFT": 0.06, "RIGHT": 0.06}
    )


def _joined(a, b):
    return np.vstack([a.vertices, b.vertices]), np.vstack([a.faces, b.faces + len(a.vertices)])


def test_nan_vertex(tmp_path, problems):
    vertices = np.array(tube().vertices)
    vertices[2, 1] = np.nan
    write_obj(vertices, tube().faces, tmp_path / "foam.obj")
    (message,) = problems(read_foam, tmp_path / "foam.obj", material=FOAM, unit="mm")
    assert message.startswith("foam.obj: vertex 3: got [")
    assert message.endswith("(1 such vertices), expected finite coordinates")


@pytest.mark.parametrize(("unit", "other", "size"), [("m", "mm", "500 m"), ("mm", "m", "0.0005 m")])
def test_size_that_cannot_be_a_seat(tmp_path, problems, unit, other, size):
    mesh = tube()
    mesh.apply_scale(1000.0 if unit == "m" else 1.0)
    mesh.export(tmp_path / "foam.ply")
    assert problems(read_foam, tmp_path / "foam.ply", material=FOAM, unit=unit) == [
        f'foam.ply: size: got {size}, expected 0.05 to 3 m (unit = "{unit}" is taken; '
        f'it is 0.5 m in "{other}")'
    ]


@pytest.mark.parametrize("name", ["a.obj", "a.stl", "a.ply"])
@pytest.mark.parametrize("content", ["", "hello\n", "ply\nformat ascii 1.0\nend_header\n"])
def test_file_without_faces(write, problems, name, content):
    (message,) = problems(read_foam, write(name, content), material=FOAM, unit="mm")
    assert message.startswith(f"{name}: file: got ")
    assert message.endswith("expected a surface of triangles (.obj, .stl, .ply, .glb, .gltf)")


@pytest.mark.parametrize(
    ("name", "content"),
    [
        ("a.obj", "v 0\nv 1\nv 2\nf 1 2 3\n"),
        ("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"),
        ("a.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
         "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
         "0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n"),
    ],
)  # fmt: skip
def test_faces_that_fit_no_vertices(write, problems, name, content):
    (message,) = problems(read_foam, write(name, content), material=FOAM, unit="mm")
    assert message.startswith(f"{name}: file: got ")


def test_unknown_format(write, problems):
    assert problems(read_foam, write("a.step", "x"), material=FOAM, unit="mm") == [
        "a.step: file: got '.step', expected one of .obj, .stl, .ply, .glb, .gltf"
    ]


def test_written_surface_reads_back(tmp_path):
    mesh = tube()
    panel = np.array([0, 0, 1, 1, 2, 2, 0, 1, 2, 0, 1, 2])
    order = np.argsort(panel, kind="stable")
    surface = GroupedMesh(
        np.asarray(mesh.vertices), np.asarray(mesh.faces), panel, ("INSERT", "LH side", "REAR"),
        {tuple(sorted(mesh.faces[0][:2].tolist())): "piping top"},
    )  # fmt: skip
    write_surface(surface, tmp_path / "s.obj")
    again = read_surface(tmp_path / "s.obj", unit="mm")
    assert again.panel_names == surface.panel_names
    assert np.array_equal(again.faces, surface.faces[order])
    assert np.array_equal(again.panel, panel[order])
    assert again.seam_lines == surface.seam_lines
    assert np.abs(again.vertices - surface.vertices).max() < 1e-15


def test_obj_dialects(write):
    text = (
        "# comment\nmtllib a.mtl\nv 0 0 0 1 1 1\nv 100 0 0\nv 100 100 0 # corner\nv 0 100 0\n"
        "g empty\ng A\nf 1/1/1 2//2 3 4\ng B\nf -4 -2 -1\n"
    )
    surface = read_surface(write("s.obj", text), unit="mm")
    assert surface.panel_names == ("A", "B")
    assert surface.faces.tolist() == [[0, 1, 2], [0, 2, 3], [0, 2, 3]]
    assert surface.panel.tolist() == [0, 0, 1]
    assert surface.vertices[2].tolist() == [0.1, 0.1, 0.0]
    assert surface.seam_lines == {}


def test_lines_along_edges_of_faces_are_seam_lines(write):
    """They are called after their group; what is no edge of a face is no seam."""
    text = (
        "v 0 0 0\nv 100 0 0\nv 100 100 0\nv 0 100 0\nv 0 0 0\nl 1 2\n"
        "g A\nf 1 2 3\nf 5 3 4\ng a dart\nl 3/1 -1\ng else\nl 2 4\nl 1 2 3\n"
    )
    surface = read_surface(write("s.obj", text), unit="mm")
    assert surface.panel_names == ("A",)
    assert surface.seam_lines == {(0, 2): "a dart", (0, 1): "else", (1, 2): "else"}


def test_objects_are_panels_where_an_obj_has_no_groups(write):
    text = "o A\nv 0 0 0\nv 100 0 0\nv 100 100 0\nv 0 100 0\nf 1 2 3\no B\nf 1 3 \\\n4\n"
    surface = read_surface(write("s.obj", text), unit="mm")
    assert surface.panel_names == ("A", "B")
    assert surface.faces.tolist() == [[0, 1, 2], [0, 2, 3]]


@pytest.mark.parametrize("suffix", [".stl", ".ply"])
def test_a_format_without_names_is_one_panel_or_refused(tmp_path, problems, suffix):
    tube().export(tmp_path / f"s{suffix}")
    drawn = read_surface(tmp_path / f"s{suffix}", ungrouped="PANEL")
    assert drawn.panel_names == ("PANEL",)
    assert drawn.faces.shape == (12, 3)
    assert len(drawn.vertices) == 8
    (message,) = problems(read_surface, tmp_path / f"s{suffix}")
    assert message.startswith(f"s{suffix}: panels: got a {suffix} file, which knows no names")


def test_a_design_surface_of_any_unit_and_axis(tmp_path):
    mesh = tube()
    for unit, scale in (("cm", 100.0), ("inch", 1 / 0.0254)):
        upright = mesh.copy()
        upright.vertices = mesh.vertices[:, [0, 2, 1]] * [scale, scale, -scale]
        upright.export(tmp_path / "s.obj")
        drawn = read_surface(tmp_path / "s.obj", unit=unit, up="y", ungrouped="P")
        assert np.sort(drawn.vertices, axis=0) == pytest.approx(
            np.sort(mesh.vertices, axis=0), abs=2e-6
        )


def test_bad_obj_names_every_line(write, problems):
    text = "v 0 0 0\nv 1 nan 0\nv 1 x 0\nf 1 2 3\ng A\nf 1 2\nf 1 2 9\nf a b c\nl 1\nl 1 9\n"
    assert problems(read_surface, write("s.obj", text), unit="mm") == [
        "s.obj:2: v: got '1 nan 0', expected three finite numbers",
        "s.obj:3: v: got '1 x 0', expected three finite numbers",
        "s.obj:4: f: got '1 2 3', expected a group (g PANEL) before the first face",
        "s.obj:6: f: got '1 2', expected three or more vertices from 1 to 3",
        "s.obj:7: f: got '1 2 9', expected three or more vertices from 1 to 3",
        "s.obj:8: f: got 'a b c', expected vertex numbers",
        "s.obj:9: l: got '1', expected two or more vertices from 1 to 3",
        "s.obj:10: l: got '1 9', expected two or more vertices from 1 to 3",
    ]


def test_curves_read_back(tmp_path):
    random = np.random.default_rng(0)
    curves = {"wire left": random.normal(size=(5, 3)), 'a "b".c': random.normal(size=(2, 3))}
    write_curves(curves, tmp_path / "c.toml")
    again = read_curves(tmp_path / "c.toml")
    assert list(again) == list(curves)
    for name, points in curves.items():
        assert np.abs(again[name] - points).max() < 1e-15


def test_bad_curves(write, problems):
    text = "[curve.a]\npoints_mm = [[1, 2, 3]]\n[curve.b]\npoints_mm = [[1, 2], [3, 4]]\n"
    assert problems(read_curves, write("c.toml", text)) == [
        "c.toml:2: curve.a.points_mm: got 1 points at one place, expected a curve",
        "c.toml:4: curve.b.points_mm: got [[1, 2], [3, 4]], expected an array of n x 3 numbers",
    ]
