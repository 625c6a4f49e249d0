"""Files that are on the disk when it is said that they are, and never half."""

from __future__ import annotations

import os
import sys
import tempfile
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def prepared(contents: Mapping[Path, bytes | None], beside: Path) -> Iterator[dict[Path, Path]]:
    """Write contents to temporary files, all on the disk before the block begins.

    Parameters
    ----------
    contents : path -> what it is to hold; None: it is to be taken away
    beside : folder of the temporary files, on the same disk

    Raises
    ------
    OSError
        The disk is full, or may not be written; then nothing is left of them.
    """
    beside.mkdir(parents=True, exist_ok=True)
    ready: dict[Path, Path] = {}
    try:
        for path, content in contents.items():
            if content is None:
                continue
            handle, name = tempfile.mkstemp(dir=beside, suffix=path.suffix)
            ready[path] = Path(name)
            with os.fdopen(handle, "wb") as stream:
                stream.write(content)
                stream.flush()
                os.fsync(stream.fileno())
            umask = os.umask(0)
            os.umask(umask)
            mode = path.stat().st_mode & 0o777 if path.exists() else 0o666 & ~umask
            ready[path].chmod(mode)
        yield ready
    finally:
        for temporary in ready.values():
            temporary.unlink(missing_ok=True)


def put_in_place(contents: Mapping[Path, bytes | None], ready: Mapping[Path, Path]) -> None:
    """Rename temporary files to what they are to be; the folders know it when this returns."""
    folders = set()
    for path in contents:
        if path in ready:
            path.parent.mkdir(parents=True, exist_ok=True)
            ready[path].replace(path)
        else:
            path.unlink(missing_ok=True)
        folders.add(path.parent)
    for folder in folders:
        sync_folder(folder)


def sync_folder(folder: Path) -> None:
    """Put the names in a folder on the disk, where the system can."""
    if sys.platform == "win32":
        return
    handle = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(handle)
    finally:
        os.close(handle)
