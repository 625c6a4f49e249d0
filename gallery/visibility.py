"""Tables after Fig. 17 and 18 of the paper: visibility by place of the bulb, and by texture.

Run it on a folder that "seatlook demo" left: python gallery/visibility.py out/eased
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from pathlib import Path

import numpy as np

from seatlook import io
from seatlook.model import Camera, Scene, Solution
from seatlook.visibility.heights import reference_rig
from seatlook.visibility.light_search import RigAt, bulb_rig, search_light, sun_rig
from seatlook.visibility.view import Sampling, View

BULBS = {"front": (0.0, 45.0), "left": (90.0, 45.0), "rear": (180.0, 45.0), "right": (270.0, 45.0)}
RAKING_DEG = 20.0
SEARCHED = Sampling("draft", 11.25)  # a sixteenth of the pixels of a score


def main(folder: Path) -> None:
    """Print the three tables."""
    scene = io.load_scene(folder / "scene.toml")
    solution = io.read_result(folder / "result.npz")
    camera = scene.cameras[0]
    view = View(solution, camera)
    by_bulb(view, scene)
    by_texture(view, scene)
    by_search(scene, solution, camera)


def by_bulb(view: View, scene: Scene) -> None:
    """Same power, other place (Fig. 17)."""
    at = bulb_rig(view.camera)
    row("bulb 800 lm at 0.8 m", *scene.textures)
    for name, angles in BULBS.items():
        row(name, *(view.vwi(looks, at(*angles)) for looks in scene.textures.values()))


def by_texture(view: View, scene: Scene) -> None:
    """Textures under a light with its highlight on the cover, and raking (Fig. 18)."""
    high = reference_rig(view.camera)
    sun = high.lights[0]
    low = sun_rig()(azimuth_of(view.camera) + 180.0, RAKING_DEG)
    row("sun", *scene.textures)
    for name, rig in ((f"{sun.name}, highlight", high), (f"raking, {RAKING_DEG:g} deg", low)):
        row(name, *(view.vwi(looks, rig) for looks in scene.textures.values()))


def by_search(scene: Scene, solution: Solution, camera: Camera) -> None:
    """Name the worst light of every texture."""
    view = View(solution, camera, sampling=SEARCHED)
    kinds: Mapping[str, RigAt] = {"sun": sun_rig(), "bulb": bulb_rig(camera)}
    row("worst light", "azimuth", "elevation", "VWI", "lights")
    for texture, looks in scene.textures.items():
        for kind, rig_at in kinds.items():
            found = search_light(view, looks, rig_at)
            row(
                f"{texture}, {kind}",
                found.azimuth_deg,
                found.elevation_deg,
                found.vwi,
                len(found.tried),
            )


def azimuth_of(camera: Camera) -> float:
    """Azimuth [deg] at which a camera stands."""
    eye = camera.position - camera.target
    return float(np.degrees(np.arctan2(eye[0], -eye[1])))


def row(*cells: str | float) -> None:
    """Print one row of a table."""
    words = (f"{c:.3g}" if isinstance(c, float) else str(c) for c in cells)
    print("| " + " | ".join(words) + " |", flush=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
