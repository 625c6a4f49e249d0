"""What the surface is made of, as the viewer takes it: records, tables and relief maps."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from seatlook.model import Scene
from seatlook.pbr.kernels.grain import LEATHER, SUEDE, WEAVE
from seatlook.pbr.kernels.stitch import Thread
from seatlook.pbr.reflectance.relief import CELLS, SIZE, load_textures
from seatlook.pbr.reflectance.tables import load_tables
from seatlook.pbr.shading.look import look_of
from seatlook.pbr.shading.studio import Studio
from seatlook.report.viewer.pack import Buffers

RELIEFS = {LEATHER: "leather", SUEDE: "suede", WEAVE: "weave"}
# A relief is sent at this level of its map, a weave as the two cells that it repeats.
_LEVEL, _WEAVE_CELLS = 1, 2
_STRETCHED = 1e-5  # to which the table of anisotropy is rounded


def looks_of(scene: Scene, stage: Studio) -> tuple[list[np.ndarray], dict[str, Any]]:
    """Return packed materials; and these, looks (a material per part) and thread, by names.

    ``measured`` names the looks with measured maps, of which the viewer shows the mean.
    """
    records: list[np.ndarray] = []
    looks, measured = [], []
    for name, appearance in scene.textures.items():
        packed = look_of(stage.solution.cover, appearance, stage.thread).materials
        looks.append({"name": name, "materials": [_row(record, records) for record in packed]})
        if (packed["maps"] >= 0).any():
            measured.append(name)
    return records, {
        "materials": [record_of(record) for record in records],
        "looks": looks,
        "thread": _thread(stage.thread),
        "measured": measured,
    }


def add_details(records: Iterable[np.ndarray], buffers: Buffers) -> dict[str, Any]:
    """Add the tables and reliefs that packed materials need; return how they are coded."""
    kept = list(records)
    stretched = any(record["anisotropy"] != 0 for record in kept)
    add_tables(buffers, stretched=stretched)
    used = sorted({int(record["texture"]) for record in kept} - {-1})
    return {
        "stretched": stretched,
        "reliefs": {RELIEFS[which]: _relief(which, buffers) for which in used},
    }


def add_tables(buffers: Buffers, *, stretched: bool) -> None:
    """Add the directional albedos of the lobes, see ``pbr.kernels.brdf.Tables``."""
    t = load_tables()
    buffers.add("albedos", np.dstack([t.scale, t.bias, t.sheen]).reshape(-1, 3).astype(np.float32))
    means = np.column_stack([t.scale_mean + t.bias_mean, t.sheen_norm])
    buffers.add("means", means.astype(np.float32))
    if stretched:
        buffers.add("stretched", _rounded(t.stretched).reshape(-1, 2))
        buffers.add("stretched means", t.stretched_mean.ravel().astype(np.float32))


def _rounded(values: np.ndarray) -> np.ndarray:
    return np.rint(values / _STRETCHED).astype(np.int32)


def record_of(record: np.ndarray) -> dict[str, Any]:
    """A packed material by the names of its fields."""
    out = {name: record[name].tolist() for name in record.dtype.names or ()}
    return {**out, "texture": RELIEFS.get(out["texture"], "none")}


def _row(record: np.ndarray, records: list[np.ndarray]) -> int:
    """Number of a record among those there are; a new one is added."""
    for number, other in enumerate(records):
        if other.tobytes() == record.tobytes():
            return number
    records.append(record)
    return len(records) - 1


def _relief(which: int, buffers: Buffers) -> dict[str, Any]:
    """Add slopes, their variance and the colour share; return how they are coded.

    A weave is the same every second cell; of it that much is sent.
    """
    textures = load_textures(which)
    weave = which == WEAVE
    level = 0 if weave else _LEVEL
    size = SIZE >> level
    first = textures.start[level]
    texels = textures.texels[which, first : first + size * size].reshape(size, size, 4)
    cells = CELLS
    if weave:
        cells, size = _WEAVE_CELLS, size * _WEAVE_CELLS // CELLS
        texels = texels[:size, :size]
    steep = float(np.abs(texels[..., :2]).max())
    wide = float(texels[..., 2].max()) or 1.0
    name = RELIEFS[which]
    slopes = np.rint(texels[..., :2] / steep * 127).reshape(-1, 2).astype(np.int8)
    buffers.add(f"slopes {name}", slopes)
    rest = np.dstack([np.sqrt(texels[..., 2] / wide), texels[..., 3]])
    buffers.add(f"rest {name}", np.rint(255 * rest).reshape(-1, 2).astype(np.uint8))
    return {"cells": cells, "size": size, "steep": steep, "variance": wide}


def _thread(thread: Thread) -> dict[str, Any]:
    return {
        "offset": thread.offset,
        "pitch": thread.pitch,
        "length": thread.length,
        "width": thread.width,
        "colour": list(thread.colour),
        "own": thread.own,
        "gauge": thread.gauge,
    }
