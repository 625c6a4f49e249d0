"""Commands of the library: a folder of seats, patterns, foams, materials, rigs, limits, results."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

from cyclopts import App, Parameter

from seatlook.cli._options import Force, Out
from seatlook.cli._output import Json, note, say, show_json, table
from seatlook.errors import InputError

if TYPE_CHECKING:
    from seatlook.library.entry import Entry, Part
    from seatlook.library.library import Library

library = App(
    name="library",
    help="""Keep seats, patterns, foams, materials, rigs, limits and results, and find them again.

Example: seatlook library add seat/scene.toml --library parts --words horseshoe
""",
)
Root = Annotated[
    Path | None,
    Parameter(
        name="--library",
        help="Folder of the library; by default what SEATLOOK_LIBRARY in the environment names.",
    ),
]
KindOf = Annotated[
    str | None,
    Parameter(help="One of seat, pattern, foam, material, rig, limits, result."),
]


def library_root(given: Path | None) -> Path | None:
    """Folder of the library: the one given, or that of the environment."""
    named = os.environ.get("SEATLOOK_LIBRARY", "")
    return given if given is not None else Path(named) if named else None


@library.command(name="add")
def add_entry(
    files: Annotated[list[Path], Parameter(help="Main file first, or the folder of a run.")],
    /,
    *,
    root: Root = None,
    name: Annotated[str | None, Parameter(help="Any text; by default the file's name.")] = None,
    kind: KindOf = None,
    words: Annotated[
        list[str] | None, Parameter(help="Word to find it by; may be given more than once.")
    ] = None,
    remark: Annotated[str, Parameter(name="--note", help="A sentence about it.")] = "",
    picture: Annotated[
        Path | None, Parameter(help="PNG or JPEG to know it by, instead of a drawing.")
    ] = None,
    json: Json = False,
) -> None:
    """Copy a file, and all that it names, into the library.

    What it is, is seen from the file. [[rig]] and [accept] are also taken out of a scene, with
    --kind rig or limits. The library is made where there is none.

    Example: seatlook library add seat/scene.toml --library parts --name "Front seat"
    """
    from seatlook.library.adding import add

    where = _needed(root)
    entry = add(where, files, name=name, kind=kind, words=words or (), note=remark, picture=picture)
    _print([entry], json=json)


@library.command(name="list")
def list_entries(*, root: Root = None, kind: KindOf = None, json: Json = False) -> int:
    """List the entries of a library; ends with 2 if one cannot be read, and says why.

    Example: seatlook library list --library parts --kind material
    """
    return _found(root, (), kind, None, json=json)


@library.command(name="find")
def find_entries(
    *words: Annotated[str, Parameter(help="All of them must be in name, words, note or place.")],
    root: Root = None,
    kind: KindOf = None,
    digest: Annotated[
        str | None, Parameter(help="Of the content, or its first 8 letters or more.")
    ] = None,
    json: Json = False,
) -> int:
    """Find entries by words, or by content; prints nothing where there are none.

    Example: seatlook library find leather black --library parts
    """
    return _found(root, words, kind, digest, json=json)


@library.command(name="show")
def show_entry(
    name: Annotated[str, Parameter(help="Name of an entry, or its place.")],
    /,
    *,
    root: Root = None,
    kind: KindOf = None,
    json: Json = False,
) -> None:
    """Print all of one entry: its files, the digest of their content, and the parts it needs.

    Example: seatlook library show "Front seat" --library parts
    """
    opened = _opened(root)
    entry = opened.get(name, kind=kind)
    values = {**_values(entry), "note": entry.note, "main": entry.main}
    files, parts = list(entry.files), [_part(opened, part) for part in entry.parts]
    if json:
        show_json({**values, "words": list(entry.words), "files": files, "parts": parts})
        return
    rows = [*values.items(), ("words", ", ".join(entry.words)), ("files", ", ".join(files))]
    rows += [("part", f"{one['kind']} {one['name']}: {one['place']}") for one in parts]
    table(("what", "value"), rows, json=False)


@library.command(name="take")
def take_entry(
    name: Annotated[str, Parameter(help="Name of an entry, or its place.")],
    /,
    *,
    out: Out,
    root: Root = None,
    kind: KindOf = None,
    force: Force = False,
) -> None:
    """Copy an entry's files into a folder, to work on.

    Example: seatlook library take "Front seat" --library parts --out seat
    """
    from seatlook.library.taking import take

    opened = _opened(root)
    say(*(f"wrote {path}" for path in take(opened, opened.get(name, kind=kind), out, force=force)))


def _needed(root: Path | None) -> Path:
    where = library_root(root)
    if where is None:
        raise InputError.single(
            "--library", got="nothing", expected="the folder of a library",
            hint="or set SEATLOOK_LIBRARY to it",
        )  # fmt: skip
    return where


def _opened(root: Path | None) -> Library:
    from seatlook.library.library import open_library

    return open_library(_needed(root))


def _found(
    root: Path | None, words: Sequence[str], kind: str | None, digest: str | None, *, json: bool
) -> int:
    from seatlook.library.entry import KINDS

    if kind is not None and kind not in KINDS:
        raise InputError.single("--kind", got=repr(kind), expected=f"one of {', '.join(KINDS)}")
    opened = _opened(root)
    found = opened.find(words, kind=kind, digest=digest)
    _print(found, json=json)
    if not found:
        note("none found")
    say(*map(str, opened.problems))
    return 2 if opened.problems else 0


def _print(entries: Sequence[Entry], *, json: bool) -> None:
    heads = ("name", "kind", "place", "digest", "words")
    cut = 64 if json else 12
    cells = [
        (
            e.name, e.kind, e.place, e.digest[:cut],
            list(e.words) if json else ", ".join(e.words),
        )
        for e in entries
    ]  # fmt: skip
    table(heads, cells, json=json)


def _values(entry: Entry) -> dict[str, str]:
    return {
        "name": entry.name,
        "kind": entry.kind,
        "place": entry.place,
        "digest": entry.digest,
        "thumbnail": "" if entry.thumbnail is None else f"{entry.place}/{entry.thumbnail}",
    }


def _part(opened: Library, part: Part) -> dict[str, str]:
    from seatlook.library.library import is_supplied

    found = opened.part(part)
    place = "" if found is None else found.place
    if found is None:
        place = "comes with seatlook" if is_supplied(part) else "not here with this content"
    return {"kind": part.kind, "name": part.name, "digest": part.digest, "place": place}
