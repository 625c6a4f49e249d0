"""Pictures: scene-linear radiance with its exposure, and display-ready maps."""

from __future__ import annotations

import base64
import io
from collections.abc import Mapping
from dataclasses import dataclass, field
from html import escape
from pathlib import Path
from types import MappingProxyType

import numpy as np
import numpy.typing as npt
from PIL import Image as Pillow
from PIL.PngImagePlugin import PngInfo

from seatlook.errors import InputError
from seatlook.exr import write_exr
from seatlook.files import write_bytes
from seatlook.model import Camera, FloatArray
from seatlook.model._check import in_range
from seatlook.pbr.light.exposure import Radiance, exposure_of, to_display
from seatlook.pbr.light.rig import LUMINANCE

RUN_KEY = "seatlook run"  # of the text in a PNG that names the run
SURROUNDINGS_KEY = "seatlook surroundings"  # of the one that names what is around the seat


@dataclass(frozen=True, slots=True, kw_only=True)
class Image:
    """A rendered picture.

    Parameters
    ----------
    radiance : (h, w, 3) float32 [cd/m2]   scene-linear sRGB primaries, first row at the top
    ev100 : exposure value of the rig
    lux : light name -> lux on the grey card at the seat, with ``total``
    white : (3,) float64, luminance 1      colour that the display shows neutral
    tone : name of the tone curve
    card : (3,) float64 [cd/m2] or None     radiance of a white card at the seat facing the light
    review : whether that card is shown as white, 255: a facing colour shows what was typed
    adaptation : how far the eye has adapted to the colour of the light, 0 to 1 (von Kries)
    cover : (h, w) float32 in [0, 1]       share of the pixel that shows the cover
    alpha : (h, w) float32 in [0, 1]       share of the pixel that is not transparent; None: all
    surroundings : name of what is around the seat; the file says it unless it is ``plain``
    """

    radiance: Radiance
    ev100: float
    lux: MappingProxyType[str, float] = field(default_factory=lambda: MappingProxyType({}))
    white: FloatArray = field(default_factory=lambda: np.ones(3))
    tone: str = "clamp"
    card: FloatArray | None = None
    review: bool = False
    adaptation: float = 1.0
    camera: Camera | None = None
    cover: npt.NDArray[np.float32] | None = None
    alpha: npt.NDArray[np.float32] | None = None
    surroundings: str = "plain"

    def to_srgb(self) -> npt.NDArray[np.uint8]:
        """Eight-bit sRGB (h, w, 3) at this exposure.

        Raises
        ------
        InputError
            A review of a picture whose card is not known, or an adaptation that is no share.
        """
        in_range(self, "adaptation", 0.0, 1.0)
        ev, white = self.ev100, self.white
        if self.review:
            if self.card is None:
                raise InputError.single("Image.card", got="None", expected="a card, to review by")
            luminance = float(self.card @ LUMINANCE)
            ev, white = exposure_of(luminance), self.card / luminance
        white = self.adaptation * white + (1.0 - self.adaptation)
        radiance: Radiance = self.radiance
        if self.alpha is not None:
            # A pixel at an outline has its own colour, and shows less of it.
            share = np.maximum(self.alpha, np.float32(1e-6))
            radiance = (self.radiance / share[..., None]).astype(np.float32)
        return to_display(radiance, ev, white=white, tone=self.tone)

    def to_png(self, run: str = "") -> bytes:
        """PNG file content; ``run`` names the run that it belongs to, in a text of the file.

        Of a picture with transparent parts it has a fourth channel.
        """
        pixels = self.to_srgb()
        if self.alpha is not None:
            share = np.rint(255.0 * self.alpha).astype(np.uint8)
            pixels = np.dstack([pixels, share])
        around = {} if self.surroundings == "plain" else {SURROUNDINGS_KEY: self.surroundings}
        return png(pixels, run, around)

    def save(self, path: Path, *, run: str = "") -> None:
        """Write ``.png`` (display), ``.npy`` or, with the extra ``[exr]``, ``.exr`` (radiance).

        Raises
        ------
        InputError
            Another file ending, or no extra.
        """
        if path.suffix == ".png":
            write_bytes(path, self.to_png(run))
        elif path.suffix == ".npy":
            buffer = io.BytesIO()
            np.save(buffer, self.radiance, allow_pickle=False)
            write_bytes(path, buffer.getvalue())
        elif path.suffix == ".exr":
            write_exr(self.radiance, path)
        else:
            expected = "a .png, .npy or .exr name"
            raise InputError.single("image file", got=path.name, expected=expected)

    def _repr_png_(self) -> bytes:
        return self.to_png()


@dataclass(frozen=True, slots=True, kw_only=True)
class Picture:
    """A display-ready picture: ``pixels`` (h, w, 3) uint8 sRGB, and the range of its colours."""

    pixels: npt.NDArray[np.uint8]
    value_range: tuple[float, float]

    def to_png(self, run: str = "") -> bytes:
        """PNG file content; ``run`` names the run that it belongs to, in a text of the file."""
        return png(self.pixels, run)

    def save(self, path: Path, *, run: str = "") -> None:
        """Write a ``.png`` file.

        Raises
        ------
        InputError
            Another file ending.
        """
        if path.suffix != ".png":
            raise InputError.single("picture file", got=path.name, expected="a .png name")
        write_bytes(path, self.to_png(run))

    def _repr_png_(self) -> bytes:
        return self.to_png()


def png(
    pixels: npt.NDArray[np.uint8], run: str = "", texts: Mapping[str, str] | None = None
) -> bytes:
    """PNG content of (h, w, 3 or 4) uint8 sRGB pixels, the same bytes for the same arguments.

    ``texts``: what else the file says of itself. It says that it is sRGB, perceptual: without that,
    a wide display shows other colours.
    """
    buffer = io.BytesIO()
    about = PngInfo()
    about.add(b"sRGB", b"\0")
    if run:
        about.add_text(RUN_KEY, run)
    for key, text in (texts or {}).items():
        about.add_text(key, text)
    Pillow.fromarray(pixels).save(buffer, format="PNG", compress_level=6, pnginfo=about)
    return buffer.getvalue()


def img(content: bytes, name: str, style: str = "width:100%") -> str:
    """HTML of a PNG picture, with its name for those who cannot see it."""
    data = base64.b64encode(content).decode()
    return (
        f'<img alt="{escape(name, quote=True)}" style="{style}" src="data:image/png;base64,{data}">'
    )
