"""Arrays by name in one ``.npz`` file; from elsewhere it is read with care."""

from __future__ import annotations

import io
import math
import zipfile
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from seatlook.errors import InputError
from seatlook.files import MIB, read_file, write_bytes

Arrays = dict[str, npt.NDArray[Any]]

# No content makes more of a byte (RFC 1951: 258 bytes of two codes of one bit each).
_DEFLATE = 1032
LARGEST = 640 * MIB  # of all arrays


def write_npz(arrays: Mapping[str, npt.NDArray[Any]], path: Path) -> None:
    """Write arrays, compressed; the same ones, the same bytes."""
    buffer = io.BytesIO()
    np.savez_compressed(buffer, **dict(arrays))  # type: ignore[arg-type]
    write_bytes(path, buffer.getvalue())


def read_npz(path: Path, *, expected: str) -> Arrays:
    """Read all arrays of a file, each compared with the size it claims before it gets memory.

    Parameters
    ----------
    expected : what the file should be, for messages

    Raises
    ------
    InputError
        The file is absent, cut short, damaged, encrypted, another format, holds objects, or would
        take more than 640 MiB.
    """
    content = read_file(path)
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            entries = archive.infolist()
            _check_sizes(entries)
            return {
                entry.filename.removesuffix(".npy"): _array(archive, entry) for entry in entries
            }
    # On damaged files zipfile, zlib and NumPy raise whatever they stumble over.
    except Exception as error:
        got = f"{type(error).__name__}: {error}"
        raise InputError.single("file", got=got, expected=expected, file=path) from error


def _check_sizes(entries: list[zipfile.ZipInfo]) -> None:
    for entry in entries:
        most = entry.compress_size * (_DEFLATE if entry.compress_type else 1)
        if entry.compress_type not in (zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED):
            raise ValueError(f"{entry.filename}: compression {entry.compress_type}")
        if entry.file_size > most:
            raise ValueError(f"{entry.filename}: {entry.file_size} bytes out of {most} at most")
    size = sum(entry.file_size for entry in entries)
    if size > LARGEST:
        raise ValueError(f"arrays of {size} bytes")


def _array(archive: zipfile.ZipFile, entry: zipfile.ZipInfo) -> npt.NDArray[Any]:
    """Read one array whose shape and type fit the bytes there are."""
    with archive.open(entry) as stream:
        version = np.lib.format.read_magic(stream)
        heads: dict[Any, Any] = {
            (1, 0): np.lib.format.read_array_header_1_0,
            (2, 0): np.lib.format.read_array_header_2_0,
        }
        shape, _, dtype = heads[version](stream)
        size = math.prod(shape) * dtype.itemsize
        there = entry.file_size - stream.tell()
        if dtype.hasobject or min(shape, default=0) < 0 or size != there:
            raise ValueError(f"{entry.filename}: {dtype} {shape} in {there} bytes")
    with archive.open(entry) as stream:
        array: npt.NDArray[Any] = np.lib.format.read_array(stream, allow_pickle=False)
        return array
