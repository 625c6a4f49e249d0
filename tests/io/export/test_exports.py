import csv
import dataclasses
import json
import struct

import numpy as np
import pytest
import trimesh
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

from seatlook.io.export.writers import WRITERS, export_cover
from seatlook.model import TextureMaps
from support.io_samples import fields_of, solution, wrinkles

SIDES = ("top", "mid", "bottom")


def read_vtp(path):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def test_vtp_opens_in_vtk_with_every_array_exact(tmp_path):
    a, indices = solution(), wrinkles()
    export_cover(a, fields_of(indices), tmp_path / "c.vtp")
    data = read_vtp(tmp_path / "c.vtp")
    assert np.array_equal(vtk_to_numpy(data.GetPoints().GetData()), a.positions)
    faces = vtk_to_numpy(data.GetPolys().GetConnectivityArray()).reshape(-1, 3)
    assert np.array_equal(faces, a.cover.faces)
    cells = data.GetCellData()
    for name, values in {
        "_W2": indices.w2,
        "_W_STRETCH": indices.w_stretch,
        "_W_COMPRESSION": indices.w_compression,
        "_C_PER_MM": 1e-3 * indices.c,
        "_W1": indices.w1,
        "_R_STRETCH": indices.r_stretch,
        "thickness": a.cover.thickness,
        "panel": a.cover.panel,
        "zone": a.cover.zone,
        "strain_bottom": a.strain_bottom.reshape(-1, 4)[:, [0, 3, 1]],
    }.items():
        assert np.array_equal(vtk_to_numpy(cells.GetArray(name)), values), name
    assert np.array_equal(vtk_to_numpy(data.GetPointData().GetArray("uv")), a.cover.uv)
    names = data.GetFieldData().GetAbstractArray("panel_names")
    assert [names.GetValue(i) for i in range(2)] == ["insert", "Wange links"]


def test_csv_has_a_row_per_face_and_units_in_its_heads(tmp_path):
    a, indices = solution(), wrinkles()
    export_cover(a, fields_of(indices), tmp_path / "c.csv")
    with (tmp_path / "c.csv").open(newline="") as file:
        rows = list(csv.DictReader(file))
    assert [r["panel"] for r in rows] == ["insert", "insert", "Wange links"]
    assert [r["zone"] for r in rows] == ["insert", "insert", "seam"]
    assert float(rows[0]["rest_area_mm2"]) == pytest.approx(5000)
    assert float(rows[1]["_C_PER_MM"]) == pytest.approx(-0.004)
    assert float(rows[1]["_W2"]) == indices.w2[1]
    assert float(rows[2]["thickness_mm"]) == pytest.approx(1.2)
    assert float(rows[2]["e12_top"]) == a.strain_top[2, 0, 1]
    assert float(rows[0]["u_mm"]) == pytest.approx((0 + 100 + 100) / 3 + 10)
    assert float(rows[0]["z_mm"]) == pytest.approx(1e3 * a.positions[[0, 1, 2], 2].mean())


def gltf_tree(path):
    content = path.read_bytes()
    magic, version, _ = struct.unpack("<III", content[:12])
    assert (magic, version) == (0x46546C67, 2)
    (length,) = struct.unpack("<I", content[12:16])
    return json.loads(content[20 : 20 + length])


def test_glb_has_a_mesh_per_panel_with_its_material(tmp_path):
    a = solution()
    export_cover(a, fields_of(wrinkles()), tmp_path / "c.glb")
    tree = gltf_tree(tmp_path / "c.glb")
    materials = {m["name"]: m for m in tree["materials"]}
    assert set(materials) == {"suede", "black-leather"}
    suede, leather = materials["suede"], materials["black-leather"]
    look = a.cover.materials[0].appearance
    assert suede["pbrMetallicRoughness"] == {
        "baseColorFactor": [*look.albedo.tolist(), 1.0],
        "metallicFactor": 0.0,
        "roughnessFactor": 0.9,
    }
    assert suede["extensions"]["KHR_materials_sheen"] == {
        "sheenColorFactor": [0.3, 0.3, 0.3],
        "sheenRoughnessFactor": 0.5,
    }
    assert leather["extensions"]["KHR_materials_clearcoat"]["clearcoatFactor"] == 0.3
    assert tree["extensionsUsed"] == ["KHR_materials_clearcoat", "KHR_materials_sheen"]
    attributes = tree["meshes"][0]["primitives"][0]["attributes"]
    names = {field.name for field in fields_of(wrinkles())}
    assert {"POSITION", "NORMAL", "TEXCOORD_0"} | names == set(attributes)


def test_glb_is_y_up_and_carries_the_indices(tmp_path):
    a, indices = solution(), wrinkles()
    export_cover(a, fields_of(indices), tmp_path / "c.glb")
    scene = trimesh.load(tmp_path / "c.glb")
    insert = scene.geometry["insert"]
    x, y, z = a.positions[:4].T
    assert np.allclose(insert.vertices, np.column_stack([x, z, -y]), atol=1e-7)
    # Vertices 0 and 2 touch both faces of the panel, which are of the same size.
    both = indices.w2[:2].mean()
    assert insert.vertex_attributes["_W2"].ravel() == pytest.approx([both, 0.0, both, 0.2])
    assert len(scene.geometry["Wange links"].faces) == 1


def with_maps(maps, **look):
    """The sample with maps on its second panel."""
    a = solution()
    first, second = a.cover.materials
    appearance = dataclasses.replace(second.appearance, coat=0.0, maps=maps, **look)
    second = dataclasses.replace(second, appearance=appearance)
    return dataclasses.replace(a, cover=dataclasses.replace(a.cover, materials=(first, second)))


def test_glb_carries_maps_to_the_millimetre(tmp_path):
    random = np.random.default_rng(0)
    pixels = {
        name: random.integers(0, 255, shape).astype(np.uint8)
        for name, shape in {
            "albedo": (4, 8, 3), "roughness": (4, 8), "metalness": (2, 4), "normal": (4, 8, 3)
        }.items()
    }  # fmt: skip
    a = with_maps(TextureMaps(folder="made", width=0.12, height=0.06, **pixels), metalness=0.7)
    export_cover(a, fields_of(wrinkles()), tmp_path / "c.glb")
    tree = gltf_tree(tmp_path / "c.glb")
    suede, leather = tree["materials"]
    assert "baseColorTexture" not in suede["pbrMetallicRoughness"]
    numbers = leather["pbrMetallicRoughness"]
    assert (numbers["metallicFactor"], numbers["roughnessFactor"]) == (0.7, 0.40)
    assert tree["extensionsUsed"] == ["KHR_materials_sheen", "KHR_texture_transform"]

    mesh = trimesh.load(tmp_path / "c.glb").geometry["Wange links"]
    material = mesh.visual.material
    assert (np.asarray(material.baseColorTexture)[..., :3] == pixels["albedo"]).all()
    assert (np.asarray(material.normalTexture)[..., :3] == pixels["normal"]).all()
    packed = np.asarray(material.metallicRoughnessTexture)
    assert (packed[..., 1] == pixels["roughness"]).all()
    assert packed.shape[:2] == (4, 8)
    assert mesh.visual.uv == pytest.approx(a.cover.rest[4:], abs=1e-7)

    # Where a pattern point lies in a picture, from the top left, by the extension's formula.
    infos = (numbers["baseColorTexture"], numbers["metallicRoughnessTexture"])
    for info in (*infos, leather["normalTexture"]):
        transform = info["extensions"]["KHR_texture_transform"]
        u, v = 0.03, 0.05
        x = transform["offset"][0] + transform["scale"][0] * u
        y = transform["offset"][1] + transform["scale"][1] * (1 - v)
        assert x % 1 == pytest.approx(0.03 / 0.12)
        assert y % 1 == pytest.approx(1 - 0.05 / 0.06)


def test_glb_of_one_material_holds_its_maps_once(tmp_path):
    pixels = np.full((64, 64, 3), 90, dtype=np.uint8)
    a = with_maps(TextureMaps(folder="made", width=0.1, height=0.1, albedo=pixels))
    second = a.cover.materials[1]
    a = dataclasses.replace(a, cover=dataclasses.replace(a.cover, materials=(second, second)))
    export_cover(a, fields_of(wrinkles()), tmp_path / "c.glb")
    tree = gltf_tree(tmp_path / "c.glb")
    assert (len(tree["materials"]), len(tree["images"])) == (1, 1)


@pytest.mark.parametrize("suffix", WRITERS)
def test_same_solution_gives_the_same_bytes(tmp_path, suffix):
    strains = {f"strain_{side}": 0.01 * getattr(solution(), f"strain_{side}") for side in SIDES}
    small = dataclasses.replace(solution(), **strains)
    for name in ("a", "b"):
        export_cover(small, fields_of(wrinkles()), tmp_path / f"{name}{suffix}")
    assert (tmp_path / f"a{suffix}").read_bytes() == (tmp_path / f"b{suffix}").read_bytes()


def test_unknown_format(tmp_path, problems):
    assert problems(export_cover, solution(), fields_of(wrinkles()), tmp_path / "c.step") == [
        "c.step: file: got '.step', expected one of .vtp, .csv, .glb, .k, .radioss.k, .npz"
    ]


def test_fields_of_another_cover(tmp_path, problems):
    (first, *_) = fields_of(wrinkles())
    short = [dataclasses.replace(first, values=first.values[:2])]
    assert problems(export_cover, solution(), short, tmp_path / "c.csv") == [
        f"field {first.name}: got 2 faces, expected 3"
    ]
    assert not (tmp_path / "c.csv").exists()
