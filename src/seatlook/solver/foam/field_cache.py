"""Distance fields kept on disk between runs, under the content they were made from.

A file is the SHA-256 of the rest and an uncompressed ``.npz``. One that does not agree with its
own digest is made again, with a warning; one that cannot be written costs the time to make it.
"""

from __future__ import annotations

import functools
import hashlib
import io
import os
import warnings
from contextlib import suppress
from pathlib import Path

import numpy as np
import scipy

from seatlook.files import cache_folder, write_bytes
from seatlook.model import FloatArray
from seatlook.solver.kernels import distance as kernel

_MAX_FILES = 32  # some 300 MB for single cushions; the file unused longest goes first
_MAX_BYTES = 600_000_000  # three fields of whole seats
_DIGEST = hashlib.sha256().digest_size


def folder() -> Path | None:
    """Where fields are kept; None if nowhere."""
    base = cache_folder()
    return None if base is None else base / "fields"


def read(key: str) -> dict[str, FloatArray] | None:
    """Return the arrays that were written under ``key``, if they are there and whole."""
    path = _path(key)
    if path is None or not path.is_file():
        return None
    try:
        content = path.read_bytes()
    except OSError as error:
        warnings.warn(f"{path} cannot be read ({error}); made again", RuntimeWarning, stacklevel=4)
        return None
    if hashlib.sha256(content[_DIGEST:]).digest() != content[:_DIGEST]:
        warnings.warn(f"{path} is damaged; made again", RuntimeWarning, stacklevel=4)
        return None
    with suppress(OSError):
        os.utime(path)
    with np.load(io.BytesIO(content[_DIGEST:]), allow_pickle=False) as archive:
        return {name: archive[name] for name in archive.files}


def write(key: str, **arrays: FloatArray) -> None:
    """Keep arrays under ``key``, whole or not at all; a folder that refuses is left alone."""
    path = _path(key)
    if path is None:
        return
    buffer = io.BytesIO()
    np.savez(buffer, allow_pickle=False, **arrays)
    content = buffer.getvalue()
    with suppress(OSError):
        write_bytes(path, hashlib.sha256(content).digest() + content)
        _forget(path.parent)


def _path(key: str) -> Path | None:
    """File of a key and of the code that makes what is in it."""
    base = folder()
    if base is None:
        return None
    return base / f"{hashlib.sha256((key + _code()).encode()).hexdigest()}.field"


@functools.cache
def _code() -> str:
    """Digest of the code that makes fields: changed, it must not find what it made before."""
    sources = (Path(kernel.__file__), Path(__file__).with_name("distance.py"))
    content = b"".join(source.read_bytes() for source in sources)
    return f"{hashlib.sha256(content).hexdigest()} scipy {scipy.__version__}"


def _forget(base: Path) -> None:
    """Remove the files that were not used for longest."""
    latest = sorted(base.glob("*.field"), key=lambda p: p.stat().st_mtime, reverse=True)
    total = 0
    for number, path in enumerate(latest):
        total += path.stat().st_size
        if number and (number >= _MAX_FILES or total > _MAX_BYTES):
            path.unlink(missing_ok=True)
