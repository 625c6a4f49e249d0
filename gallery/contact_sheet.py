"""Contact sheet: one solved cover in every supplied texture under every rig of its scene.

Run it with: python gallery/contact_sheet.py SCENE.toml RESULT.npz [PICTURE.png]
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from PIL import Image

from seatlook.io import load_scene, read_material, read_result
from seatlook.pbr.shading.studio import Studio

LOOKS = ("black-leather", "bright-leather", "pvc", "suede", "woven")
SHEET = Path(__file__).parents[1] / "docs" / "pictures" / "contact-sheet.png"


def main(scene_file: Path, result_file: Path, picture: Path = SHEET) -> None:
    """Draw rows of textures and columns of rigs."""
    scene = load_scene(scene_file)
    studio = Studio(read_result(result_file))
    camera = replace(scene.cameras[0], size=(480, 270))
    rows = [
        np.hstack(
            [
                studio.render(read_material(name).appearance, rig=rig, camera=camera).to_srgb()
                for rig in scene.rigs
            ]
        )
        for name in LOOKS
    ]
    Image.fromarray(np.vstack(rows)).save(picture, optimize=True)


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:4]))
