"""Files that are sent by the browser: written piece by piece, never held whole."""

from __future__ import annotations

import os
import tempfile
from collections.abc import AsyncIterator
from pathlib import Path, PurePosixPath, PureWindowsPath

from starlette.concurrency import run_in_threadpool

from seatlook.errors import InputError
from seatlook.files import LARGEST_FILE

LARGEST_TOGETHER = 4 * LARGEST_FILE  # bytes of all that was sent and is there


async def receive(folder: Path, name: str, parts: AsyncIterator[bytes]) -> tuple[Path, int]:
    """Write what is sent into a file, which is there once it is whole.

    Returns
    -------
    path, bytes

    Raises
    ------
    InputError
        A name that is no plain one, or more than readers take.
    OSError
        The disk is full; nothing is left.
    """
    target = folder / plain_name(name)
    folder.mkdir(parents=True, exist_ok=True)
    room = LARGEST_TOGETHER - sum(one.stat().st_size for one in folder.iterdir() if one.is_file())
    limit, count = min(LARGEST_FILE, room), 0
    handle, temporary = tempfile.mkstemp(dir=folder, prefix=".")
    try:
        with os.fdopen(handle, "wb") as stream:
            async for part in parts:
                count += len(part)
                if count > limit:
                    raise InputError.single(
                        "upload", got="a larger file", expected=f"at most {limit} bytes"
                    )
                await run_in_threadpool(stream.write, part)
        Path(temporary).replace(target)
    finally:
        Path(temporary).unlink(missing_ok=True)
    return target, count


def plain_name(name: str) -> str:
    """The name, if it is that of a file in a folder and of no other place.

    Raises
    ------
    InputError
        It is not.

    Examples
    --------
    >>> plain_name("cover 2.dxf")
    'cover 2.dxf'
    """
    parts = {PurePosixPath(name).name, PureWindowsPath(name).name}
    wrong = (
        not name
        or parts != {name}
        or name.startswith(".")
        or not name.isprintable()
        or len(name) > 120
    )
    if wrong or name.endswith((".", " ")):
        raise InputError.single("name", got=repr(name)[:80], expected="a plain name of a file")
    return name
