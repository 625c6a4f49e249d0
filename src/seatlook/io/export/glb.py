"""The solved cover as binary glTF, for viewers, Blender and game engines."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import trimesh
from PIL import Image
from trimesh.exchange.gltf import export_glb
from trimesh.visual import TextureVisuals
from trimesh.visual.material import PBRMaterial

from seatlook.files import write_bytes
from seatlook.model import Appearance, Field, FloatArray, IntArray, Solution, TextureMaps

# The library is typed, but these three are not.
_surface: Any = TextureVisuals
_pbr: Any = PBRMaterial
_export_glb: Any = export_glb


def write_glb(solution: Solution, fields: Sequence[Field], path: Path) -> None:
    """Write one mesh per panel with its material, y up, in metres.

    Fields are custom attributes of the vertices:
    means over the faces around them in their own panel, weighted by rest area. Texture coordinates
    are those of the flat panel in metres, u along the warp, v upwards once read;
    KHR_texture_transform scales them to the maps. Sheen and coat are written as
    KHR_materials_sheen and KHR_materials_clearcoat; a grain by formula only where it has been
    baked into maps.
    """
    cover = solution.cover
    looks = {material.name: material.appearance for material in cover.materials}
    surfaces = {name: _textured(name, look.maps) for name, look in looks.items()}
    scene = trimesh.Scene()
    for number, (name, material) in enumerate(zip(cover.panel_names, cover.materials, strict=True)):
        rows = np.flatnonzero(cover.panel == number)
        used, faces = np.unique(cover.faces[rows], return_inverse=True)
        faces = faces.reshape(-1, 3)
        area = cover.rest_area[rows]
        mesh = trimesh.Trimesh(
            # z up to y up
            vertices=solution.positions[used][:, [0, 2, 1]] * [1.0, 1.0, -1.0],
            faces=faces,
            process=False,
            visual=_surface(uv=cover.rest[used], material=surfaces[material.name]),
        )
        for field in fields:
            mean = vertex_means(field.values[rows], faces, area, len(used))
            mesh.vertex_attributes[field.name] = mean.astype(np.float32)
        scene.add_geometry(mesh, geom_name=name, node_name=name)

    def write_materials(tree: dict[str, Any]) -> None:
        for entry in tree["materials"]:
            _complete(entry, looks[entry["name"]])
        used = {key for entry in tree["materials"] for key in entry.get("extensions", ())}
        if "textures" in tree:
            used.add("KHR_texture_transform")
        if used:
            tree["extensionsUsed"] = sorted(used)

    # The exporter rounds colours to 8 bits, so the materials are completed in its tree.
    content = _export_glb(scene, include_normals=True, tree_postprocessor=write_materials)
    write_bytes(path, content)


def vertex_means(values: FloatArray, faces: IntArray, area: FloatArray, count: int) -> FloatArray:
    """Return the area-weighted means (count,) of face values (m,) at the vertices.

    Examples
    --------
    >>> faces = np.array([[0, 1, 2], [0, 2, 3]])
    >>> vertex_means(np.array([1.0, 4.0]), faces, np.array([2.0, 1.0]), 4).tolist()
    [2.0, 1.0, 2.0, 4.0]
    """
    total, weight = np.zeros(count), np.zeros(count)
    np.add.at(total, faces, (values * area)[:, None])
    np.add.at(weight, faces, area[:, None])
    return total / weight


def _textured(name: str, maps: TextureMaps | None) -> Any:
    """Material of the exporter with its pictures; numbers are written later."""
    if maps is None:
        return _pbr(name=name)
    pictures = {"baseColorTexture": maps.albedo, "normalTexture": maps.normal}
    given = [m for m in (maps.roughness, maps.metalness) if m is not None]
    if given:
        # Green and blue; what there is no map of is left to its factor.
        size = max((m.shape[::-1] for m in given), key=max)
        packed = np.full((size[1], size[0], 3), 255, dtype=np.uint8)
        for channel, pixels in ((1, maps.roughness), (2, maps.metalness)):
            if pixels is not None:
                packed[..., channel] = np.asarray(Image.fromarray(pixels).resize(size))
        pictures["metallicRoughnessTexture"] = packed
    images = {key: Image.fromarray(p) for key, p in pictures.items() if p is not None}
    return _pbr(name=name, **images)


def _complete(entry: dict[str, Any], look: Appearance) -> None:
    """Add the numbers, sheen, coat and scale of the pictures to a material of the tree."""
    extensions: dict[str, Any] = {}
    if look.sheen.any():
        extensions["KHR_materials_sheen"] = {
            "sheenColorFactor": look.sheen.tolist(),
            "sheenRoughnessFactor": look.sheen_roughness,
        }
    if look.coat > 0:
        extensions["KHR_materials_clearcoat"] = {
            "clearcoatFactor": look.coat,
            "clearcoatRoughnessFactor": look.coat_roughness,
        }
    numbers = entry.setdefault("pbrMetallicRoughness", {})
    numbers["baseColorFactor"] = [*look.albedo.tolist(), 1.0]
    numbers["metallicFactor"] = look.metalness
    numbers["roughnessFactor"] = look.roughness
    # The wrong side shows where a cover gapes; culling it would leave a hole.
    entry["doubleSided"] = True
    if extensions:
        entry["extensions"] = extensions
    if look.maps is None:
        return
    # A file's v runs down from 1 - v [m]; a picture stands with its foot on v = 0.
    scale = [1 / look.maps.width, 1 / look.maps.height]
    transform = {"offset": [0.0, -scale[1] % 1.0], "scale": scale}
    infos = [value for value in (*numbers.values(), *entry.values()) if _is_texture(value)]
    for info in infos:
        info["extensions"] = {"KHR_texture_transform": transform}


def _is_texture(value: Any) -> bool:
    return isinstance(value, dict) and "index" in value
