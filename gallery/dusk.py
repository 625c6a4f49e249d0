"""How much less of a wrinkle is seen by dusk, by VWI with several gains of masking.

Run it on a folder that "seatlook demo" left: python gallery/dusk.py out/eased [PICTURES.npz]

Models of the eye compress differently, so they are compared by the height that, seen by day, would
look as the wrinkles do by dusk. Given a second name, the pictures are kept; the script
tests/sensory/record_cvvdp.py says what ColorVideoVDP makes of them.
"""

from __future__ import annotations

import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

from seatlook import io
from seatlook.model import Appearance, FloatArray
from seatlook.sensory.observer import OBSERVER
from seatlook.sensory.vwi import score
from seatlook.study.amplitude import amplified, reference_rig
from seatlook.study.view import View, luminance

HEIGHTS = (0.0, 0.2, 0.4, 0.6, 0.8, 1.0)  # of the wrinkles as solved
GAINS = (1.0, 0.5, 0.25, 0.1, 0.0)
DUSK, DUSK_MEDIAN = 1e-3, 0.24  # of the daylight; cd/m2


def looks() -> dict[str, Appearance]:
    """Supplied textures, and both leathers without their grain."""
    black, bright, suede = (
        io.read_material(name).appearance for name in ("black-leather", "bright-leather", "suede")
    )
    smooth = replace(bright, texture="none")
    return {
        "black": black,
        "bright": bright,
        "suede": suede,
        "smooth black": replace(black, texture="none"),
        "smooth bright": smooth,
        "bright rough": replace(smooth, roughness=0.85, coat=0.0),
    }


def draw(view: View) -> dict[str, FloatArray]:
    """Luminance (6, h, w) of every look at every height, in the highlight of a high sun."""
    rig = reference_rig(view.camera)
    drawn: dict[str, list[FloatArray]] = {name: [] for name in looks()}
    for height in HEIGHTS:
        studio = view.studio_of(amplified(view, height))
        for name, look in looks().items():
            picture = studio.render(look, rig=rig, camera=view.camera, quality=view.quality)
            drawn[name].append(luminance(picture))
    return {name: np.stack(pictures) for name, pictures in drawn.items()}


def left_by_dusk(view: View, pictures: FloatArray, gain: float) -> list[float]:
    """VWI by day, its share left by dusk and the share of the height, at both kinds of dusk."""
    mask, ppd = view.region.mask, view.camera.pixels_per_degree
    observer = replace(OBSERVER, masking_gain=gain)

    def vwi(k: int, power: float) -> float:
        pair = power * pictures[k], power * pictures[0]
        return score(*pair, pixels_per_degree=ppd, mask=mask, observer=observer).vwi

    day = [vwi(k, 1.0) for k in range(len(HEIGHTS))]
    found = [day[-1]]
    for power in (DUSK, DUSK_MEDIAN / float(np.median(pictures[0][mask]))):
        dusk = vwi(-1, power)
        found += [dusk / day[-1], float(np.interp(dusk, day, HEIGHTS))]
    return found


def main(folder: Path, kept: str | None = None) -> None:
    """Print the table; keep the pictures where asked."""
    solution = io.read_result(folder / "result.npz")
    view = View(solution, io.load_scene(folder / "scene.toml").cameras[0])
    pictures = draw(view)
    if kept is not None:
        ppd = view.camera.pixels_per_degree
        np.savez(kept, mask=view.region.mask, pixels_per_degree=ppd, heights=HEIGHTS, **pictures)
    print(f"| look | gain | day | {DUSK:g}: VWI | height | {DUSK_MEDIAN:g} cd/m2: VWI | height |")
    for name, drawn in pictures.items():
        for gain in GAINS:
            cells = " | ".join(f"{x:.2f}" for x in left_by_dusk(view, drawn, gain))
            print(f"| {name} | {gain:g} | {cells} |", flush=True)


if __name__ == "__main__":
    main(Path(sys.argv[1]), *sys.argv[2:3])
