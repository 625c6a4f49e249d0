"""A solved cover in two measured map sets: a print over a weave, and a brown leather, sewn in red.

Run it with: python gallery/measured_maps.py SCENE.toml RESULT.npz [PICTURE.png]
"""

from __future__ import annotations

import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image

from seatlook.io import load_scene, read_material, read_result
from seatlook.io.texture_maps import read_texture_maps
from seatlook.model import Appearance, Thread, named_view
from seatlook.pbr.reflectance.relief import baked
from seatlook.pbr.shading.studio import Studio

PICTURE = Path(__file__).parents[1] / "docs" / "pictures" / "measured-maps.png"
WEAVE = Appearance(
    albedo=np.ones(3), texture="weave", texture_scale=0.001, texture_depth=2.5e-4, roughness=0.8
)


def save(path: Path, pixels: np.ndarray) -> None:
    path.parent.mkdir(exist_ok=True)
    Image.fromarray(np.clip(np.rint(pixels), 0, 255).astype(np.uint8)).save(path)


def houndstooth(folder: Path) -> Appearance:
    """Threads of 1 mm, four dark and four light, in a twill: named as ambientCG does."""
    size = 1024
    x, y = np.meshgrid(np.arange(size) // 16, np.arange(size) // 16)
    dark = np.where((x + y) // 2 % 2 == 0, x % 8 < 4, y % 8 < 4)
    colour = np.where(dark[..., None], [28.0, 30.0, 34.0], [205.0, 198.0, 182.0])
    uneven = np.random.default_rng(0).standard_normal((size, size, 1))
    save(folder / "Fabric_1K_Color.png", colour * (1 + 0.06 * uneven))
    save(folder / "Fabric_1K_NormalGL.png", baked(WEAVE).maps.normal)
    maps = read_texture_maps(folder, width=0.064)
    return Appearance(albedo=np.ones(3), roughness=0.8, f0=0.03, maps=maps)


def hide(folder: Path) -> Appearance:
    """Leather with polished pebbles, named as Poly Haven does."""
    grain = baked(read_material("black-leather").appearance).maps
    high = grain.albedo[..., :1] / 255.0
    rough = 255 * np.clip(0.62 - 0.8 * (high - 0.7), 0.25, 0.8)
    save(folder / "hide_diff_1k.png", grain.albedo * np.array([0.62, 0.36, 0.2]))
    save(folder / "hide_arm_1k.png", np.dstack([0 * high + 255, rough, 0 * high]))
    save(folder / "hide_nor_gl_1k.png", grain.normal)
    maps = read_texture_maps(folder, width=grain.width)
    return Appearance(albedo=np.ones(3), roughness=1.0, coat=0.2, maps=maps)


def main(scene_file: Path, result_file: Path, picture: Path = PICTURE) -> None:
    """Draw the insert in the print, all other panels in the leather."""
    scene, solution = load_scene(scene_file), read_result(result_file)
    with tempfile.TemporaryDirectory() as folder:
        looks = dict.fromkeys(solution.cover.panel_names, hide(Path(folder) / "hide"))
        looks["INSERT"] = houndstooth(Path(folder) / "fabric")
    studio = Studio(solution, thread=Thread(colour=np.array([0.6, 0.05, 0.03])))
    target = scene.cameras[0].target
    views = (named_view(name, target=target, size=(640, 360)) for name in ("front_34", "detail"))
    columns = [studio.render(looks, rig=scene.rigs[0], camera=view).to_srgb() for view in views]
    Image.fromarray(np.hstack(columns)).save(picture, optimize=True)


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:4]))
