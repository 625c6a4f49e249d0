"""How much less of a wrinkle is seen by dusk, by VWI with several gains of masking.

Run it on a folder that "seatlook demo" left: python gallery/dusk.py out/eased [PICTURES.npz]

Models of the eye compress differently, so they are compared by the height that, seen by day, would
look as the wrinkles do by dusk. Given a second name, the pictures are kept; the script
tests/support/seen/record_cvvdp.py says what ColorVideoVDP makes of them.
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

from seatlook import io
from seatlook.visibility.view import View

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT / "tests"))

from support.seen.dusk import DUSK, DUSK_MEDIAN, GAINS, HEIGHTS, draw, left_by_dusk  # noqa: E402


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
