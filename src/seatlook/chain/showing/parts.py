"""Pictures that are parts of a larger one: drawn once, so that a stopped run goes on."""

from __future__ import annotations

import shutil
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import replace
from pathlib import Path

import numpy as np
import numpy.typing as npt
from PIL import Image as Pillow

from seatlook._version import __version__
from seatlook.assembly.digest import content_digest
from seatlook.model import Camera, Solution
from seatlook.pbr import Image
from seatlook.pbr.picture import RUN_KEY

Pixels = npt.NDArray[np.uint8]


@contextmanager
def parts_folder(folder: Path, *, keep: bool = False) -> Iterator[Path]:
    """Give a folder for parts; it goes when the block ends well, and stays for the next run if not.

    Parameters
    ----------
    keep : leave it in any case
    """
    folder.mkdir(parents=True, exist_ok=True)
    yield folder
    if not keep:
        shutil.rmtree(folder)
        with suppress(OSError):
            folder.parent.rmdir()


def digest_of(solution: Solution, *what: object) -> str:
    """Digest of a cover's shape, of what is to be drawn of it, and of this version."""
    shape = (solution.cover.scene_digest, solution.positions, solution.cover.faces)
    return content_digest((__version__, shape, what))


def drawn(path: Path, digest: str, draw: Callable[[], Image]) -> Pixels:
    """Pixels (h, w, 3 or 4) of a part: those of the file if it is of this digest, or drawn now."""
    known = _read(path, digest)
    if known is None:
        draw().save(path, run=digest)
        known = _read(path, digest)
    if known is None:
        raise OSError(5, "what was written is not there any more", str(path))
    return known


def _read(path: Path, digest: str) -> Pixels | None:
    """Pixels of a whole file of this digest, or None."""
    try:
        with Pillow.open(path) as image:
            if image.info.get(RUN_KEY) != digest:
                return None
            return np.asarray(image)
    except (OSError, SyntaxError, ValueError):
        return None


def of_width(camera: Camera, width: int) -> Camera:
    """Camera whose picture is so many pixels wide, of the same form."""
    height = max(1, round(width * camera.size[1] / camera.size[0]))
    return replace(camera, size=(width, height))
