"""The scene that docs/reference/scene.md shows, and the files that it names."""

from __future__ import annotations

import re
import shutil
from pathlib import Path

import numpy as np

from seatlook.io.curves import write_curves
from seatlook.io.surface.design import write_obj
from support.io_samples import box

_ROOT = Path(__file__).parents[2]
BLOCKS = re.findall(
    r"```toml\n(.*?)```", (_ROOT / "docs" / "reference" / "scene.md").read_text(), re.DOTALL
)
EXAMPLE = BLOCKS[0]


def write_example_files(folder: Path) -> Path:
    """Write what the example names, without the scene itself, and return the folder."""
    data = _ROOT / "tests" / "data"
    shutil.copy(data / "seat_cushion_demo_aama.dxf", folder / "cover.dxf")
    shutil.copy(data / "seat_cushion_demo.seams.toml", folder / "cover.seams.toml")
    write_obj(*box(), folder / "foam.obj")
    wire = np.array([[0.15, -0.23, 0.08], [0.15, 0.23, 0.08]])
    names = ("wire left", "wire across", "frame front")
    write_curves(dict.fromkeys(names, wire), folder / "curves.toml")
    return folder
