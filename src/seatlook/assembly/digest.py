"""A digest of everything a value holds: two scenes of one digest give one result."""

from __future__ import annotations

import dataclasses
import hashlib
from collections.abc import Iterator, Mapping
from pathlib import PurePath
from typing import Any

import numpy as np


def content_digest(value: Any) -> str:
    """SHA-256 of a value: core types, arrays, texts, numbers, and sequences and mappings of them.

    Where files lie does not count: paths are left out, and so are fields that say they change no
    result.

    Raises
    ------
    TypeError
        Something of another type, which could change without being seen.

    Examples
    --------
    >>> content_digest((1, 2.0)) == content_digest((1, 2.0)) != content_digest((1, 2))
    True
    """
    digest = hashlib.sha256()
    for part in _parts(value):
        digest.update(len(part).to_bytes(8, "little"))
        digest.update(part)
    return digest.hexdigest()


def _parts(value: Any) -> Iterator[bytes]:
    if isinstance(value, np.ndarray):
        yield f"{value.dtype.str} {value.shape}".encode()
        yield value.tobytes()
    elif dataclasses.is_dataclass(value) and not isinstance(value, type):
        yield type(value).__name__.encode()
        for field in dataclasses.fields(value):
            if not field.metadata.get("digest", True):
                continue
            yield field.name.encode()
            yield from _parts(getattr(value, field.name))
    elif isinstance(value, Mapping):
        yield f"{len(value)} keys".encode()
        for key, entry in value.items():
            yield from _parts(key)
            yield from _parts(entry)
    elif isinstance(value, tuple | list):
        yield f"{len(value)} in order".encode()
        for entry in value:
            yield from _parts(entry)
    else:
        yield _leaf(value)


def _leaf(value: Any) -> bytes:
    if isinstance(value, PurePath):
        return b"path"
    if isinstance(value, np.generic):
        value = value.item()
    if value is None or isinstance(value, str | bool | int | float):
        return f"{type(value).__name__} {value!r}".encode()
    raise TypeError(f"{type(value).__name__} has no place in a digest")
