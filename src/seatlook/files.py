"""Writing files so that an interrupted run leaves the old file or the new one, never half.

And where what can be made again is kept between runs.
"""

from __future__ import annotations

import hashlib
import os
import tempfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def replacing(path: Path) -> Iterator[Path]:
    """Give a temporary path beside ``path``; rename it to ``path`` when the block ends well.

    Examples
    --------
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     with replacing(Path(folder) / "a.txt") as temporary:
    ...         _ = temporary.write_text("done")
    ...     (Path(folder) / "a.txt").read_text()
    'done'
    """
    path.parent.mkdir(parents=True, exist_ok=True)
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.stem}-", suffix=path.suffix)
    os.close(handle)
    temporary = Path(name)
    try:
        yield temporary
        # mkstemp makes the file private; a result is for everyone the folder is for.
        umask = os.umask(0)
        os.umask(umask)
        temporary.chmod(0o666 & ~umask)
        temporary.replace(path)
    finally:
        temporary.unlink(missing_ok=True)


def write_bytes(path: Path, content: bytes) -> None:
    """Write ``content`` to ``path`` in one step."""
    with replacing(path) as temporary:
        temporary.write_bytes(content)


def write_text(path: Path, content: str) -> None:
    """Write UTF-8 ``content`` to ``path`` in one step."""
    write_bytes(path, content.encode())


def cache_folder() -> Path | None:
    """Folder of what is kept between runs and can be made again; None where there is no home.

    ``SEATLOOK_CACHE_DIR``, else ``seatlook`` below ``XDG_CACHE_HOME`` or ``~/.cache``.
    """
    named = os.environ.get("SEATLOOK_CACHE_DIR", "")
    if named:
        return Path(named)
    shared = Path(os.environ.get("XDG_CACHE_HOME", ""))
    # The XDG specification has relative paths ignored.
    if shared.is_absolute():
        return shared / "seatlook"
    try:
        return Path.home() / ".cache" / "seatlook"
    except RuntimeError:
        return None


_LONGEST_NAME = 80  # characters; file systems take 255 bytes, and endings come behind


def file_names(names: Iterable[str]) -> dict[str, str]:
    """Name of a file or folder for each of some names, no two alike on any file system.

    Small letters, digits and hyphens; a name that this does not tell from another one, or that
    has no letters, or is very long, ends in a digest of itself.

    Examples
    --------
    >>> file_names(["Bulb left", "suede"])
    {'Bulb left': 'bulb-left', 'suede': 'suede'}
    >>> sorted(file_names(["a b", "a-b"]).values())
    ['a-b-c8687a08', 'a-b-d44362d6']
    """
    known = tuple(dict.fromkeys(names))
    plain = {name: _plain(name) for name in known}
    counts: dict[str, int] = {}
    for text in plain.values():
        counts[text] = counts.get(text, 0) + 1
    clear = {n: t for n, t in plain.items() if t and counts[t] == 1 and len(t) <= _LONGEST_NAME}
    taken = set(clear.values())
    out = dict(clear)
    for name in known:
        if name not in out:
            digest = hashlib.sha256(name.encode("utf-8", "surrogatepass")).hexdigest()
            head = plain[name][:_LONGEST_NAME]
            length = next(k for k in range(8, 65) if f"{head}-{digest[:k]}" not in taken)
            out[name] = f"{head}-{digest[:length]}".strip("-")
            taken.add(out[name])
    return {name: out[name] for name in known}


def _plain(name: str) -> str:
    """Small letters and digits of a name, with hyphens for all else."""
    return "".join(c if c.isalnum() and c.isascii() else "-" for c in name.lower()).strip("-")
