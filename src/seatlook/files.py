"""Files from elsewhere are read with care, files of our own written whole.

An interrupted run leaves the old file or the new one, never half. And where what can be made again
is kept between runs.
"""

from __future__ import annotations

import codecs
import functools
import hashlib
import os
import stat
import sys
import tempfile
import threading
import traceback
from collections import OrderedDict
from collections.abc import Callable, Iterable, Iterator, Mapping
from contextlib import contextmanager
from contextvars import ContextVar
from io import BufferedReader, BytesIO, RawIOBase
from pathlib import Path
from types import MappingProxyType
from typing import ParamSpec, TypeVar, cast

from seatlook.errors import InputError, SeatlookError

P = ParamSpec("P")
T = TypeVar("T")

MIB = 2**20
# Bytes of a file that is read at once; docs/reference/bad-input.md lists all limits.
LARGEST_FILE = 512 * MIB
_KEPT = 8  # files of a reader whose content is kept
LARGEST_TEXT = 4 * MIB  # of scenes, seams, curves, materials, sweeps, votes
_STDERR = 2
_silence = threading.RLock()
_instead: ContextVar[Mapping[str, bytes]] = ContextVar("_instead", default=MappingProxyType({}))


def reader(expected: str) -> Callable[[Callable[P, T]], Callable[P, T]]:
    """Make a function of a file a reader: whatever it stumbles over is an InputError.

    Parameters
    ----------
    expected : what the file should be, for messages

    Notes
    -----
    Libraries raise whatever they stumble over in a damaged file, and so do NumPy and Python: of
    sizes that no memory holds, of things in things in things. Warnings that were made errors pass.

    Examples
    --------
    >>> @reader("a number")
    ... def read_number(path: Path) -> float:
    ...     return float("x")
    >>> read_number(Path("a.txt"))  # doctest: +ELLIPSIS
    Traceback (most recent call last):
    seatlook.errors.InputError: a.txt: file: got ValueError: could not convert string to float: \
'x', expected a number...
    """

    def wrap(read: Callable[P, T]) -> Callable[P, T]:
        @functools.wraps(read)
        def wrapped(*args: P.args, **kwargs: P.kwargs) -> T:
            try:
                return read(*args, **kwargs)
            except (SeatlookError, Warning):
                raise
            except Exception as error:
                file = Path(str(next(iter((*args, *kwargs.values())))))
                raise InputError.single(
                    "file", got=_stumbled(error), expected=expected, file=file, hint=_where(error)
                ) from error

        wrapped.is_reader = True  # type: ignore[attr-defined]
        return wrapped

    return wrap


def _stumbled(error: Exception) -> str:
    """What a reader stumbled over, in one line."""
    if isinstance(error, RecursionError):
        return "things in things in things, too deep to follow"
    if isinstance(error, MemoryError):
        return "more than there is memory for"
    if isinstance(error, OSError) and error.strerror:
        return error.strerror
    text = " ".join(str(error).split())
    return f"{type(error).__name__}: {text}"[:300]


def _where(error: Exception) -> str:
    """Place in seatlook where a reader stumbled; nothing where the message says all."""
    if isinstance(error, RecursionError | MemoryError | OSError):
        return ""
    frames = [f for f in traceback.extract_tb(error.__traceback__) if "seatlook" in f.filename]
    return f"in {frames[-1].name}, {Path(frames[-1].filename).name}" if frames[1:] else ""


@contextmanager
def silenced() -> Iterator[None]:
    """Keep the C libraries of picture formats from writing on stderr.

    They print what they stumble over, past Python and many times over, and offer no way to turn
    that off; the error that comes out says it once, with the file. What other threads write
    meanwhile is lost too, so that only the library's own call belongs in here.
    """
    with _silence:
        try:
            sys.stderr.flush()
            stderr = os.dup(_STDERR)
        except (OSError, ValueError, AttributeError):
            yield  # closed: nothing to keep quiet
            return
        try:
            with Path(os.devnull).open("wb") as nowhere:
                os.dup2(nowhere.fileno(), _STDERR)
            yield
        finally:
            os.dup2(stderr, _STDERR)
            os.close(stderr)


@contextmanager
def opened(
    path: Path, *, key: str = "file", at_most: int | None = None, expected: str = "a file"
) -> Iterator[BufferedReader]:
    """Open a file for reading that may be anything.

    Parameters
    ----------
    key : who names the file, for messages
    at_most : bytes; None: any size
    expected : what the file should be, for messages

    Raises
    ------
    InputError
        There is no such file, it is a folder, a pipe or a device, may not be read, is too large, or
        was changed while it was open.
    """

    def refusal(got: object, expected: str, hint: str = "") -> InputError:
        return InputError.single(key, got=got, expected=expected, file=path, hint=hint)

    if (instead := _instead.get().get(os.path.abspath(path))) is not None:  # noqa: PTH100
        if at_most is not None and len(instead) > at_most:
            raise refusal(f"{len(instead) / MIB:,.0f} MiB", f"at most {at_most / MIB:,.0f} MiB")
        yield BufferedReader(cast("RawIOBase", BytesIO(instead)))
        return
    # Opening a pipe would wait for whoever writes to it.
    flags = os.O_RDONLY | getattr(os, "O_NONBLOCK", 0) | getattr(os, "O_BINARY", 0)
    try:
        _check_regular(path.stat(), refusal)
        stream = os.fdopen(os.open(path, flags), "rb")
    except FileNotFoundError as error:
        raise refusal("no such file", expected) from error
    except InputError:
        raise
    # ValueError: a name that no file can have, with a null character or half a pair.
    except (OSError, ValueError) as error:
        raise refusal(getattr(error, "strerror", error), expected) from error
    with stream:
        before = os.fstat(stream.fileno())
        state = state_of(path)
        _check_regular(before, refusal)
        if at_most is not None and before.st_size > at_most:
            got = f"{before.st_size / MIB:,.0f} MiB"
            raise refusal(got, f"at most {at_most / MIB:,.0f} MiB")
        yield stream
        if state_of(path) != state:
            raise refusal("a file that changes while it is read", "one that stays", "try again")


@contextmanager
def standing_in(contents: Mapping[Path, bytes]) -> Iterator[None]:
    """Let readers find these contents in the place of files, as if they were written.

    What would be wrong with a change is known before it is made. Holds in this thread only.

    Examples
    --------
    >>> with standing_in({Path("a.txt"): b"not on disk"}):
    ...     read_text(Path("a.txt"))
    'not on disk'
    """
    paths = {os.path.abspath(path): content for path, content in contents.items()}  # noqa: PTH100
    token = _instead.set({**_instead.get(), **paths})
    try:
        yield
    finally:
        _instead.reset(token)


def state_of(path: Path) -> tuple[int, int, int] | None:
    """What tells that a file is another one than before; None: it is gone."""
    try:
        status = path.stat()
    except OSError:
        return None
    return status.st_ino, status.st_size, status.st_mtime_ns


def _check_regular(status: os.stat_result, refusal: Callable[[object, str], InputError]) -> None:
    kinds = {
        stat.S_IFDIR: "a folder",
        stat.S_IFIFO: "a pipe",
        stat.S_IFSOCK: "a socket",
        stat.S_IFCHR: "a device",
        stat.S_IFBLK: "a device",
    }
    kind = stat.S_IFMT(status.st_mode)
    if kind != stat.S_IFREG:
        raise refusal(kinds.get(kind, "no file"), "a file")


def read_file(path: Path, *, key: str = "file", at_most: int = LARGEST_FILE) -> bytes:
    """Return the content of a file, see ``opened``."""
    with opened(path, key=key, at_most=at_most) as stream:
        return stream.read()


def kept(read: Callable[P, T]) -> Callable[P, T]:
    """Keep what the last files of a reader held: sweeps and comparisons read the same ones again.

    The file is told by its content, not by its time. What is kept may not be changed.
    """
    known: OrderedDict[object, T] = OrderedDict()

    @functools.wraps(read)
    def wrapped(*args: P.args, **kwargs: P.kwargs) -> T:
        path = Path(str(args[0]))
        state = state_of(path)
        content = hashlib.sha256(read_file(path)).digest()
        key = content, repr((args, sorted(kwargs.items())))
        result = known[key] if key in known else read(*args, **kwargs)
        # A file that changed in between was another one to ``read``.
        if state_of(path) == state:
            known[key] = result
            known.move_to_end(key)
        if len(known) > _KEPT:
            known.popitem(last=False)
        return result

    return wrapped


def read_text(path: Path, *, key: str = "file", at_most: int = LARGEST_TEXT) -> str:
    """Return the text of a UTF-8 file, without the mark of byte order that editors put before it.

    Raises
    ------
    InputError
        As ``opened``, and for another encoding, with the line.
    """
    return decoded(read_file(path, key=key, at_most=at_most), path)


def decoded(content: bytes, path: Path) -> str:
    """Return UTF-8 content as text; see ``read_text``."""
    try:
        return content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        wide = content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE))
        raise InputError.single(
            "encoding",
            got="UTF-16" if wide else f"byte {content[error.start]:#x}",
            expected="UTF-8",
            file=path,
            line=content[: error.start].count(b"\n") + 1,
            hint="save it as UTF-8",
        ) from error


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
