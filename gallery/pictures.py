"""Make the pictures of README and docs: the demo seat as it fits, and one sewn line 4 % too long.

Run it with: python gallery/pictures.py [FOLDER]
"""

from __future__ import annotations

import shutil
import sys
from pathlib import Path

from PIL import Image

from seatlook.cli import run

PICTURES = Path(__file__).parents[1] / "docs" / "pictures"
LEATHER = ["--material", "black-leather", "--element-size-mm", "6", "--tension-percent", "0.5"]
SEATS = {"fits": LEATHER, "eased": [*LEATHER, "--ease", "INSERT-BOLSTER_L=4%"]}
VIEWS = {
    "black": "images/bulb-right/black-leather.png",
    "w1": "maps/w1.png",
    "w2": "maps/w2.png",
    "w_stretch": "maps/w_stretch.png",
    "w_compression": "maps/w_compression.png",
}


def main(folder: Path = Path("out"), *, width: int = 800) -> None:
    """Evaluate both seats below ``folder`` and keep their pictures at ``width`` pixels.

    The drawing of the start is kept as it is: its numbers are to be read.
    """
    for seat, options in SEATS.items():
        out = folder / seat
        code = run(["demo", "--out", str(out), "--resume", "--no-score", *options])
        if code:
            sys.exit(code)
        for view, path in VIEWS.items():
            with Image.open(out / path) as picture:
                size = width, round(width * picture.height / picture.width)
                picture.resize(size, Image.Resampling.LANCZOS).save(
                    PICTURES / f"{seat}-{view}.png", optimize=True
                )
    run(["check", str(folder / "fits" / "scene.toml")])
    drawing = folder / "fits" / "check" / "assembly.png"
    shutil.copyfile(drawing, PICTURES / "assembly.png")


if __name__ == "__main__":
    main(*map(Path, sys.argv[1:2]))
