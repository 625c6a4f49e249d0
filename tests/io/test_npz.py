"""Files of arrays: exact, and whatever is wrong with one is refused before it takes memory."""

import io
import random
import tracemalloc
import zipfile

import numpy as np
import pytest

from seatlook.errors import InputError
from seatlook.io import npz

ARRAYS = {
    "plain": np.arange(24.0).reshape(2, 3, 4),
    "fortran": np.asfortranarray(np.arange(6).reshape(2, 3)),
    "empty": np.zeros((0, 3)),
    "scalar": np.array(3.5),
    "text": np.array("naïve"),
    "flags": np.array([True, False]),
}


def entry(array=None, header=None):
    """Bytes of one .npy: of an array, or a header with 8 bytes behind it."""
    buffer = io.BytesIO()
    if header is None:
        np.save(buffer, array, allow_pickle=True)
    else:
        np.lib.format.write_array_header_1_0(buffer, header)
        buffer.write(bytes(8))
    return buffer.getvalue()


def packed(path, name="a.npy", content=b"", **options):
    with zipfile.ZipFile(path, "w", **options) as archive:
        archive.writestr(name, content)
    return path


def test_arrays_come_back_to_the_last_bit(tmp_path):
    npz.write_npz(ARRAYS, tmp_path / "a.npz")
    again = npz.read_npz(tmp_path / "a.npz", expected="arrays")
    assert list(again) == list(ARRAYS)
    for name, array in ARRAYS.items():
        assert (again[name].dtype, again[name].shape) == (array.dtype, array.shape)
        assert again[name].tobytes() == array.tobytes()
        assert again[name].flags.f_contiguous == array.flags.f_contiguous
    with np.load(tmp_path / "a.npz") as archive:
        assert archive.files == list(ARRAYS)


@pytest.mark.parametrize(
    ("shape", "descr"), [((10**15,), "<f8"), ((2**40, 2**40), "<f8"), ((3,), "<f8"), ((), "<U9")]
)
def test_a_shape_that_its_bytes_cannot_fill(tmp_path, problems, shape, descr):
    header = {"descr": descr, "fortran_order": False, "shape": shape}
    path = packed(tmp_path / "a.npz", content=entry(header=header))
    (got,) = problems(npz.read_npz, path, expected="arrays")
    assert got.startswith("a.npz: file: got ValueError: a.npy: ")
    assert got.endswith(" in 8 bytes, expected arrays")


def test_a_size_that_its_content_cannot_have(tmp_path, problems):
    """The directory says 3 GB of 200 bytes: refused without room for them."""
    path = packed(tmp_path / "a.npz", content=entry(np.zeros(9)))
    content = bytearray(path.read_bytes())
    at = content.index(b"PK\x01\x02") + 24
    content[at : at + 4] = (3 * 10**9).to_bytes(4, "little")
    path.write_bytes(content)
    tracemalloc.start()
    (got,) = problems(npz.read_npz, path, expected="arrays")
    assert tracemalloc.get_traced_memory()[1] < 1e6
    tracemalloc.stop()
    assert "a.npy: 3000000000 bytes out of 200 at most" in got


def test_more_than_all_arrays_may_have(tmp_path, problems, monkeypatch):
    monkeypatch.setattr(npz, "LARGEST", 1000)
    npz.write_npz({"a": np.zeros(80), "b": np.zeros(80)}, tmp_path / "a.npz")
    (got,) = problems(npz.read_npz, tmp_path / "a.npz", expected="arrays")
    assert "got ValueError: arrays of 1536 bytes, expected arrays" in got


@pytest.mark.parametrize(
    ("content", "options", "message"),
    [
        (entry(np.array([{}], dtype=object)), {}, "ValueError: a.npy: object"),
        (b"\x93NUMPY\x07\x00", {}, "KeyError"),
        (b"PNG", {}, "ValueError"),
        (entry(np.zeros(3)), {"compression": zipfile.ZIP_LZMA}, "ValueError: a.npy: compression"),
        (entry(np.zeros(3)) + b"more", {}, r"ValueError: a.npy: float64 \(3,\) in 28 bytes"),
    ],
)  # fmt: skip
def test_entries_of_another_kind(tmp_path, content, options, message):
    path = packed(tmp_path / "a.npz", content=content, **options)
    with pytest.raises(InputError, match=rf"a\.npz: file: got {message}"):
        npz.read_npz(path, expected="arrays")


def test_an_encrypted_entry(tmp_path, problems):
    path = packed(tmp_path / "a.npz", content=entry(np.zeros(3)))
    content = bytearray(path.read_bytes())
    content[6] |= 1
    content[content.index(b"PK\x01\x02") + 8] |= 1
    path.write_bytes(content)
    (got,) = problems(npz.read_npz, path, expected="arrays")
    assert "is encrypted" in got


def test_no_damage_ends_in_anything_but_a_refusal(tmp_path):
    """Bytes turned over, taken out and doubled: the same arrays, or InputError."""
    path = tmp_path / "a.npz"
    npz.write_npz(ARRAYS, path)
    whole, rng = path.read_bytes(), random.Random(1)
    refused = 0
    for k in range(len(whole)):
        damaged = bytearray(whole)
        kind = k % 3
        if kind == 0:
            damaged[k] ^= 1 << rng.randrange(8)
        elif kind == 1:
            del damaged[k : k + rng.randrange(1, 40)]
        else:
            damaged[k:k] = damaged[max(k - rng.randrange(1, 40), 0) : k]
        path.write_bytes(damaged)
        try:
            again = npz.read_npz(path, expected="arrays")
        except InputError:
            refused += 1
        else:
            assert all(again[name].tobytes() == ARRAYS[name].tobytes() for name in again)
    assert refused > 0.5 * len(whole)
