"""The folder of a run: one run at a time, nothing of the user's overwritten, the page last.

A hidden file in the folder lists what was written there, with digests: what is not in it, or has
changed since, is the user's.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any

from filelock import FileLock, Timeout

from seatlook.errors import InputError, Problem
from seatlook.files import write_text

PAGE = "index.html"
_LIST, _LOCK = ".seatlook.json", ".seatlook.lock"
_NAMED = 5  # files that a message names


@contextmanager
def run_folder(
    out: Path, *, writes: Iterable[str] = (), page: bool = False, force: bool = False
) -> Iterator[Path]:
    """Hold a folder for a run that writes into it.

    Parameters
    ----------
    writes : patterns of files below ``out``; one that is there and not of an earlier run, or was
        edited since, is refused
    page : whether the run ends with a page: an old one is taken away at once, so that it never
        stands beside files of another run
    force : overwrite whatever is there

    Raises
    ------
    InputError
        The folder cannot be made or written, another run holds it, or a file is the user's.
    """
    new = _made(out)
    lock = FileLock(out / _LOCK)
    try:
        lock.acquire(timeout=0)
    except Timeout:
        raise InputError.single(
            "out", got=f"{out}, which another run of seatlook writes to",
            expected="a folder of its own, or wait until that run has ended",
        ) from None  # fmt: skip
    except OSError as error:
        raise InputError.single(
            "out", got=f"{out}: {error.strerror or error}", expected="a folder that can be written"
        ) from None
    try:
        if not force:
            _refuse_users_files(out, writes)
        # A run that is killed leaves this mark: what it wrote until then is no user's file.
        _write_list(out, _listed(out), unfinished=True)
        if page:
            (out / PAGE).unlink(missing_ok=True)
        before = _files(out)
        try:
            yield out
        finally:
            _note(out, before)
    finally:
        lock.release()
        _take_back(out, new)


def _made(out: Path) -> tuple[Path, ...]:
    """Make the folder; return the folders that were not there, the innermost first."""
    new = tuple(path for path in (out, *out.parents) if not path.exists())
    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise InputError.single(
            "out", got=f"{out}: {error.strerror or error}", expected="a folder that can be made"
        ) from None
    return new


def _take_back(out: Path, new: tuple[Path, ...]) -> None:
    """Remove folders that were made for nothing: a run that was refused leaves no trace."""
    if out in new and not _files(out):
        for name in (_LIST, _LOCK):
            (out / name).unlink(missing_ok=True)
        with suppress(OSError):
            for folder in new:
                folder.rmdir()


def _refuse_users_files(out: Path, writes: Iterable[str]) -> None:
    """Refuse if the run would overwrite what it did not write, or what was edited since."""
    if _content(out).get("unfinished"):
        return
    known = _listed(out)
    there = sorted({path for pattern in writes for path in out.glob(pattern) if path.is_file()})
    own = [path for path in there if known.get(path.relative_to(out).as_posix()) != _digest(path)]
    if own:
        more = f" and {len(own) - _NAMED} more" if len(own) > _NAMED else ""
        raise InputError(
            Problem(
                key="out",
                got=f"{', '.join(p.relative_to(out).as_posix() for p in own[:_NAMED])}{more}, "
                "edited or not written by seatlook",
                expected="another folder, or --force to overwrite",
                file=out,
            )
        )


def _files(out: Path) -> dict[str, tuple[int, int]]:
    """Path -> time and size of every file below the folder that is not hidden."""
    files = {}
    for path in out.rglob("*"):
        name = path.relative_to(out)
        if path.is_file() and not any(part.startswith(".") for part in name.parts):
            status = path.stat()
            files[name.as_posix()] = (status.st_mtime_ns, status.st_size)
    return files


def _note(out: Path, before: dict[str, tuple[int, int]]) -> None:
    """Put what is new or changed into the folder's list."""
    after = _files(out)
    known = {name: digest for name, digest in _listed(out).items() if name in after}
    known |= {n: _digest(out / n) for n, status in after.items() if before.get(n) != status}
    _write_list(out, known, unfinished=False)


def _write_list(out: Path, files: dict[str, str], *, unfinished: bool) -> None:
    content = {"unfinished": unfinished, "files": files}
    write_text(out / _LIST, json.dumps(content, indent=1, sort_keys=True) + "\n")


def _listed(out: Path) -> dict[str, str]:
    """Path -> digest of what was written by seatlook, as it was then."""
    files = _content(out).get("files")
    return {str(k): str(v) for k, v in files.items()} if isinstance(files, dict) else {}


def _content(out: Path) -> dict[str, Any]:
    try:
        content = json.loads((out / _LIST).read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return {}
    return content if isinstance(content, dict) else {}


def _digest(path: Path) -> str:
    with path.open("rb") as stream:
        return hashlib.file_digest(stream, "sha256").hexdigest()
