"""Arrays as text come back as they were."""

from __future__ import annotations

import base64
import zlib

import numpy as np
import pytest

from seatlook.report.viewer.pack import Buffers, octahedral, quantised

TYPES = {
    "i8": "i1",
    "u8": "u1",
    "i16": "<i2",
    "i32": "<i4",
    "u16": "<u2",
    "u32": "<u4",
    "f32": "<f4",
}


def unpacked(packed, name):
    content = zlib.decompress(base64.b64decode(packed["content"]))
    place = packed["places"][name]
    kind = np.dtype(TYPES[place["type"]])
    assert place["start"] % kind.itemsize == 0
    count = place["rows"] * place["columns"]
    values = np.frombuffer(content, kind, count, place["start"]).reshape(place["columns"], -1)
    return values.T if kind.kind == "f" else np.cumsum(values, axis=1, dtype=kind).T


def test_every_type_comes_back():
    rng = np.random.default_rng(0)
    buffers = Buffers()
    given = {}
    for name, kind in TYPES.items():
        if kind.endswith("f4"):
            given[name] = rng.normal(size=(7, 3)).astype(np.float32)
        else:
            info = np.iinfo(kind)
            given[name] = rng.integers(info.min, info.max, (7, 3), dtype=kind, endpoint=True)
        buffers.add(name, given[name])
    packed = buffers.packed()
    for name, values in given.items():
        assert np.array_equal(unpacked(packed, name), values)


@pytest.mark.parametrize("bits", [8, 16])
def test_quantised_values_are_off_by_half_a_step_at_most(bits):
    values = np.random.default_rng(1).uniform(-3, 5, (100, 2)) * [1.0, 1e-3]
    steps, low, step = quantised(values, bits)
    assert (np.abs(low + steps * np.array(step) - values) <= 0.501 * np.array(step)).all()
    assert steps.min() == 0
    assert steps.max() == 2**bits - 1


def test_a_column_of_one_value_stays_that_value():
    steps, low, step = quantised(np.full((3, 1), 7.0))
    assert (low[0] + steps * step[0] == 7.0).all()


def test_normals_come_back_within_a_ten_thousandth():
    n = np.random.default_rng(2).normal(size=(2000, 3))
    n /= np.linalg.norm(n, axis=1, keepdims=True)
    flat = octahedral(n) / 32767
    z = 1 - np.abs(flat).sum(axis=1)
    folded = (1 - np.abs(flat[:, ::-1])) * np.where(flat >= 0, 1, -1)
    back = np.column_stack([np.where(z[:, None] < 0, folded, flat), z])
    back /= np.linalg.norm(back, axis=1, keepdims=True)
    assert np.abs(back - n).max() < 1e-4
