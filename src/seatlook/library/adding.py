"""Put an entry into a library: whole, or not at all."""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path

from seatlook.errors import InputError
from seatlook.files import file_names, opened, write_text
from seatlook.io.schema import shown
from seatlook.library.entry import FILES, FORMAT, KINDS, SHEET, Entry, content_digest, sheet_text
from seatlook.library.gathering import Gathered, gather
from seatlook.library.library import MARK, open_library
from seatlook.library.thumbnail import thumbnail

_FOLDERS = {kind: f"{kind}s" for kind in KINDS} | {"limits": "limits"}
_LARGEST_PICTURE = 4 * 2**20  # bytes
_PICTURES = (".png", ".jpg", ".jpeg")


def add(
    root: Path,
    paths: Sequence[Path],
    *,
    name: str | None = None,
    kind: str | None = None,
    words: Sequence[str] = (),
    note: str = "",
    picture: Path | None = None,
) -> Entry:
    """Copy files into a library as one entry, with all that they name.

    Parameters
    ----------
    root : folder of the library; made if it is empty or not there
    paths : the main file first, or the folder of a run
    name : any text; by default that of the main file or its folder
    kind : one of ``KINDS``; seen from the main file if not given
    words, note : what it is found by
    picture : PNG or JPEG to know it by; drawn from the files if not given

    Returns
    -------
    entry
        One of the same kind, name and content that is there already is returned as it is.

    Raises
    ------
    InputError
        The files cannot be read as that kind; the folder holds other things than a library.
    """
    if not paths:
        raise InputError.single("FILE", got="none", expected="the main file first")
    if kind is not None and kind not in KINDS:
        raise InputError.single("kind", got=shown(kind), expected=f"one of {', '.join(KINDS)}")
    kind, gathered = gather(paths, kind)
    name = _default_name(kind, gathered) if name is None else name.strip()
    if not name or not name.isprintable():
        raise InputError.single("--name", got=shown(name), expected="a name in printable letters")
    _make_library(root)
    files = gathered.named
    digest = content_digest(files)
    for one in open_library(root).entries:
        if (one.kind, one.name, one.digest) == (kind, name, digest):
            return one
    made = Path(tempfile.mkdtemp(dir=root, prefix=".adding-"))
    try:
        _copy(files, made / FILES)
        entry = Entry(
            place="", kind=kind, name=name, main=gathered.main_name, files=tuple(sorted(files)),
            digest=digest, words=tuple(words), note=note, parts=gathered.parts,
            thumbnail=_picture(made, kind, gathered.main_name, picture),
        )  # fmt: skip
        write_text(made / SHEET, sheet_text(entry))
        made.chmod(root.stat().st_mode & 0o777)
        place = _put(made, root / _FOLDERS[kind], name, digest).relative_to(root).as_posix()
    finally:
        shutil.rmtree(made, ignore_errors=True)
    return next(one for one in open_library(root).entries if one.place == place)


def _default_name(kind: str, gathered: Gathered) -> str:
    folder = gathered.main.parent.name
    named_by_folder = kind in ("seat", "result") and gathered.main.stem in ("scene", "result")
    return folder if named_by_folder and folder else gathered.main.stem


def _make_library(root: Path) -> None:
    """Mark an empty folder as a library."""
    if (root / MARK).exists():
        return
    if root.exists() and (not root.is_dir() or any(root.iterdir())):
        raise InputError.single(
            "library", got=f"files, and no {MARK}" if root.is_dir() else "a file",
            expected="a library, or an empty folder to make one in", file=root,
        )  # fmt: skip
    write_text(root / MARK, f"# A library of seatlook.\nformat = {FORMAT}\n")


def _copy(files: Mapping[str, Path | bytes], folder: Path) -> None:
    for name, source in files.items():
        target = folder / name
        target.parent.mkdir(parents=True, exist_ok=True)
        if isinstance(source, bytes):
            target.write_bytes(source)
            continue
        with opened(source) as stream, target.open("wb") as copy:
            shutil.copyfileobj(stream, copy)


def _picture(made: Path, kind: str, main: str, picture: Path | None) -> str | None:
    """Put the picture of an entry beside it: the one given, that of a run, or a drawing."""
    pictures = sorted((made / FILES / main).parent.glob("images/*.png"))
    if picture is None and kind == "result" and pictures:
        picture = pictures[0]
    if picture is not None:
        if picture.suffix.lower() not in _PICTURES:
            expected = f"one of {', '.join(_PICTURES)}"
            raise InputError.single("--picture", got=shown(picture.suffix), expected=expected)
        target = made / f"thumbnail{picture.suffix.lower()}"
        with (
            opened(picture, key="--picture", at_most=_LARGEST_PICTURE) as stream,
            target.open("wb") as copy,
        ):
            shutil.copyfileobj(stream, copy)
        return target.name
    drawing = thumbnail(kind, made / FILES / main)
    if drawing is None:
        return None
    write_text(made / "thumbnail.svg", drawing)
    return "thumbnail.svg"


def _put(made: Path, folder: Path, name: str, digest: str) -> Path:
    """Rename a finished entry to its place; another one of its name keeps its own."""
    plain = file_names([name])[name]
    folder.mkdir(exist_ok=True)
    for place in (plain, *(f"{plain}-{digest[:length]}" for length in (8, 16, 64))):
        if (folder / place).exists():
            continue
        try:
            made.rename(folder / place)
        except OSError:
            # Somebody else took the place in this moment.
            if (folder / place).exists():
                continue
            raise
        return folder / place
    raise InputError.single("--name", got=shown(name), expected="one that is not there yet")
