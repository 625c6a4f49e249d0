"""Arrays as one text: their bytes one after the other, deflated, in base64."""

from __future__ import annotations

import base64
import zlib
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from seatlook.model import FloatArray

# Types of the page's typed arrays, by their names there.
_TYPES = {"i1": "i8", "u1": "u8", "i2": "i16", "i4": "i32", "u2": "u16", "u4": "u32", "f4": "f32"}
_ALIGNED = 4  # bytes; a typed array begins at a whole number of its elements


@dataclass(slots=True)
class Buffers:
    """Arrays to be sent, by their names."""

    arrays: dict[str, np.ndarray] = field(default_factory=dict)

    def add(self, name: str, values: np.ndarray) -> None:
        """Add an array (n, ...); its columns are sent one after the other, which packs better."""
        self.arrays[name] = np.asarray(values)

    def packed(self) -> dict[str, Any]:
        """Return where each array is, and the text that holds all.

        Integers are sent as differences from row to row, wrapped to their type.
        """
        places, parts, start = {}, [], 0
        for name, values in self.arrays.items():
            columns = values.reshape(len(values), -1).T
            if values.dtype.kind in "iu":
                columns = np.diff(columns, axis=1, prepend=columns[:, :1] * 0)
            content = np.ascontiguousarray(columns, values.dtype.newbyteorder("<")).tobytes()
            places[name] = {
                "type": _TYPES[values.dtype.str[1:]],
                "start": start,
                "rows": len(values),
                "columns": len(columns),
            }
            parts.append(content + b"\0" * (-len(content) % _ALIGNED))
            start += len(parts[-1])
        content = zlib.compress(b"".join(parts), 9)
        return {"places": places, "content": base64.b64encode(content).decode()}


def quantised(values: FloatArray, bits: int = 16) -> tuple[np.ndarray, list[float], list[float]]:
    """Columns of (n, d) as whole numbers from 0 on; the value of 0 and of one step, per column.

    Examples
    --------
    >>> steps, low, step = quantised(np.array([[1.0], [2.0]]), bits=8)
    >>> steps.ravel().tolist(), low, round(step[0] * 255, 6)
    ([0, 255], [1.0], 1.0)
    """
    low, high = values.min(axis=0), values.max(axis=0)
    step = np.where(high > low, (high - low) / (2**bits - 1), 1.0)
    steps = np.rint((values - low) / step).astype(np.uint8 if bits == 8 else np.uint16)
    return steps, low.tolist(), step.tolist()


def octahedral(normals: FloatArray) -> np.ndarray:
    """Unit vectors (n, 3) as two int16 on an unfolded octahedron; Meyer et al. 2010.

    Examples
    --------
    >>> octahedral(np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])).tolist()
    [[0, 0], [32767, 0]]
    """
    n = normals / np.abs(normals).sum(axis=1, keepdims=True)
    side = np.where(n[:, :2] >= 0, 1.0, -1.0)
    folded = (1.0 - np.abs(n[:, 1::-1])) * side
    flat = np.where(n[:, 2:] < 0, folded, n[:, :2])
    return np.asarray(np.rint(32767 * flat), dtype=np.int16)
