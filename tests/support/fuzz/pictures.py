"""Pictures in all their modes, and the folders of textures that hold them."""

from __future__ import annotations

import io
from collections.abc import Callable
from pathlib import Path

import numpy as np

from seatlook.exr import write_exr
from seatlook.io.texture_maps import read_texture_maps


def seeds(kind: str, **options: object) -> Callable[[Path], list[bytes]]:
    def made_in(folder: Path) -> list[bytes]:
        from PIL import Image

        ramp = (np.arange(24 * 20 * 3) % 251).astype(np.uint8).reshape(20, 24, 3)
        whole = Image.fromarray(ramp)
        pictures = [whole, whole.convert("L"), whole.convert("P"), whole.convert("RGBA")]
        pictures.append(Image.fromarray(ramp[..., 0].astype(np.uint16) * 257))
        pictures += [whole.convert("1"), Image.fromarray(ramp[..., 0].astype(np.float32))]
        made = []
        for picture in pictures:
            out = io.BytesIO()
            try:
                picture.save(out, kind, **options)
            except OSError:
                continue  # a mode that the format does not have
            made.append(out.getvalue())
        return made

    return made_in


def read_maps(path: Path) -> object:
    return read_texture_maps(path.parent, width=0.1)


def read_folder(path: Path) -> object:
    """The bytes are the names of the pictures in a folder."""
    names = path.read_text("utf-8", "replace").replace("\0", "").split("\n")
    folder = path.with_suffix("")
    for old in folder.glob("*"):
        old.unlink()
    folder.mkdir(exist_ok=True)
    picture = [*seeds("PNG")(folder), *exr(folder)]
    for number, name in enumerate(names):
        if name.strip("/. ") and "/" not in name and len(name.encode()) < 200:
            (folder / name).write_bytes(picture[number % len(picture)])
    return read_texture_maps(folder, width=0.1)


NAMES = (
    "a_Color.png\na_Roughness.jpg\na_Metalness.tif\na_NormalGL.png\na_NormalDX.png\na_arm.png",
    "a_Color.exr",
    "a_Color.png\na_Roughness.png\nb_Color.png",
    "a_NormalDX.png\na_arm.png",
)
_HDR = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 8 +X 16\n"


def hdr(folder: Path) -> list[bytes]:
    pixel = (32, 64, 128, 131)
    run = bytes([2, 2, 0, 16]) + b"".join(bytes([144, value]) for value in pixel)
    literal = bytes([2, 2, 0, 16]) + b"".join(bytes([16]) + bytes([v] * 16) for v in pixel)
    return [_HDR + 8 * run, _HDR + 8 * literal, _HDR + bytes(pixel) * 128]


def exr(folder: Path) -> list[bytes]:
    import OpenEXR

    write_exr(np.ones((8, 16, 3), np.float32), folder / "seed.exr")
    made = [(folder / "seed.exr").read_bytes()]
    halves = np.linspace(-0.1, 2.0, 128, dtype=np.float16).reshape(8, 16)
    for channels in ({"Y": halves}, {"Z": halves}, {"A": halves, "B": halves}):
        kinds = {"compression": OpenEXR.ZIPS_COMPRESSION, "type": OpenEXR.scanlineimage}
        OpenEXR.File(kinds, channels).write(str(folder / "seed.exr"))
        made.append((folder / "seed.exr").read_bytes())
    return made
