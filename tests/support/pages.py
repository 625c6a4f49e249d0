"""A small page with real images, for the tests of the report."""

from __future__ import annotations

import struct
import zlib
from pathlib import Path
from types import MappingProxyType

import numpy as np

from seatlook.report import Check, MapView, PageData, RigHead, Table
from seatlook.report.page.types import ScoreSection, Spot

SIZE = (64, 36)
TEXTURES = ("black leather", "suede <insert>")
RIGS = (
    RigHead(
        name="sun",
        ev100=14.6,
        illuminance=97000.0,
        lights=("sun, 97 klx, elevation 70 deg",),
        places=(("sun", 200.0, 70.0, False),),
    ),
    RigHead(
        name="bulb_left",
        ev100=6.53,
        illuminance=64.0,
        lights=("bulb, 800 lm", "sky, 2 cd/m2"),
        places=(("bulb", 115.0, 40.0, True),),
    ),
)


def write_png(path: Path, image: np.ndarray) -> None:
    """Write (h, w, 3) uint8 as PNG: 20 lines that owe nothing to the code under test."""

    def chunk(kind: bytes, body: bytes) -> bytes:
        return (
            struct.pack(">I", len(body))
            + kind
            + body
            + struct.pack(">I", zlib.crc32(kind + body) & 0xFFFFFFFF)
        )

    height, width, _ = image.shape
    rows = np.concatenate([np.zeros((height, 1), np.uint8), image.reshape(height, -1)], axis=1)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(
        b"\x89PNG\r\n\x1a\n"
        + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
        + chunk(b"IDAT", zlib.compress(rows.tobytes()))
        + chunk(b"IEND", b"")
    )


def picture(seed: int) -> np.ndarray:
    """A shaded ball, another colour for each seed."""
    u, v = np.meshgrid(np.linspace(-1.8, 1.8, SIZE[0]), np.linspace(-1, 1, SIZE[1]))
    height = np.sqrt(np.clip(1 - u**2 - v**2, 0, 1))
    colour = np.random.default_rng(seed).uniform(0.2, 1.0, 3)
    return (255 * height[..., None] * colour).astype(np.uint8)


def page_data(folder: Path, **changes: object) -> PageData:
    """Write the images of a page into ``folder`` and return its data."""
    pictures = {}
    for i, texture in enumerate(TEXTURES):
        for k, rig in enumerate(RIGS):
            name = f"images/{rig.name}/texture {i}.png"
            write_png(folder / name, picture(10 * i + k))
            pictures[texture, rig.name] = name
    maps = []
    for k, name in enumerate(("W1", "W2", "W_stretch", "W_compression")):
        write_png(folder / f"maps/{name}.png", picture(100 + k))
        alone = f"maps/{name}-own.png" if name.startswith("W_") else None
        if alone:
            write_png(folder / alone, picture(200 + k))
        maps.append(
            MapView(
                name=name,
                image=f"maps/{name}.png",
                low=-1.5 if name == "W1" else 0.0,
                high=1.5,
                meaning="curvature over its threshold",
                alone=alone,
                alone_high=0.4,
            )
        )
    (folder / "zones.csv").write_text("zone,W2\n")
    values = {
        "title": "demo & <script>alert(1)</script>",
        "camera": "driver_door",
        "size": SIZE,
        "pixels_per_degree": 45.04,
        "textures": TEXTURES,
        "rigs": RIGS,
        "pictures": MappingProxyType(pictures),
        "maps": tuple(maps),
        "zones": Table(
            heads=("zone", "area [cm2]", "W2 mean [1]"),
            rows=(("insert", 812.4, 0.0312), ("bolster_left seam", 40.25, None)),
        ),
        "parameters": MappingProxyType(
            {
                "scene": Table(heads=("key", "value", "source"), rows=(("seed", "0", None),)),
                "cover pvc": Table(
                    heads=("key", "value", "source"), rows=(("thickness_mm", "1.20", "judgement"),)
                ),
            }
        ),
        "toml": MappingProxyType({"scene": "[mesh]\nseed = 0\n"}),
        "spots": (Spot(label="wrinkle 1", x=50.0, y=20.0),),
        "score": ScoreSection(
            cells=MappingProxyType({cell: float(k) for k, cell in enumerate(pictures, 1)}),
            **{
                name: Table(heads=("texture", "VWI"), rows=(("suede <insert>", 3.0),))
                for name in ("grid", "causes", "zones")
            },
        ),
        "provenance": MappingProxyType({"seatlook": "0.1.0", "scene": "sha256 abc"}),
        "status": "converged",
        "summary": ("W2 is above 1 on 5 % of the cover, most in <insert>.",),
        "checks": (
            Check(name="seam gap", value="0.08 mm", limit="0.1 mm", kept=True),
            Check(name="W2 area, class A", value="12 %", limit="5 %", kept=False),
        ),
        "warnings": ("Mesh coarser than lambda/8: the indices are not converged.",),
        "history": MappingProxyType(
            {
                "time": tuple(float(k) for k in range(40)),
                "residual": tuple(10.0 ** (-k / 8) for k in range(40)),
                "energy": tuple(1.0 + 0.1 * np.sin(k) for k in range(40)),
                "flat": (1.0,) * 40,
            }
        ),
        "files": ("zones.csv",),
    }
    return PageData(**{**values, **changes})
