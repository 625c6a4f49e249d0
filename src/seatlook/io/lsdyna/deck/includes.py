"""``*INCLUDE`` and its kin: a deck as one list of keywords, whatever files it stands in."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path, PurePosixPath

from seatlook.errors import InputError
from seatlook.files import read_file
from seatlook.io.lsdyna.deck.cards import Block, blocks, refuse
from seatlook.io.lsdyna.deck.placement import DECK, Move, Placement

_MAX_INCLUDES = 100
_GOES_ON = b" +"


def deck_blocks(file: Path, content: bytes) -> Iterator[Block]:
    """Return the keywords of a deck and of all that it includes, each with its placement.

    Raises
    ------
    InputError
        A file that is not found, or again; a kind of *INCLUDE that is not read.
    """
    yield from _Includes(file).within(file, content, DECK, (file.resolve(),))


@dataclass(slots=True)
class _Includes:
    """The way through the files of a deck."""

    main: Path
    folders: list[Path] = field(default_factory=list)
    opened: set[Path] = field(default_factory=set)
    count: int = 0

    def within(
        self, file: Path, content: bytes, place: Placement, around: tuple[Path, ...]
    ) -> Iterator[Block]:
        """Return the keywords of one file; ``around`` are the files that it is included from."""
        for block in blocks(file, content):
            if not block.name.startswith("INCLUDE"):
                yield block if place is DECK else replace(block, place=place)
            elif block.name in ("INCLUDE_PATH", "INCLUDE_PATH_RELATIVE"):
                self.folders += [self.main.parent / name for name, _ in _names(block)]
            elif block.name == "INCLUDE":
                for name, last in _names(block):
                    yield from self._follow(block, last, name, place, around)
            elif block.name == "INCLUDE_TRANSFORM":
                name, last = next(_names(block), ("", -1))
                if name:
                    inner = _placement(block, last + 1, place)
                    yield from self._follow(block, last, name, inner, around)
            else:
                raise refuse(
                    block, "a kind of include that is not read",
                    "*INCLUDE, *INCLUDE_TRANSFORM or *INCLUDE_PATH",
                )  # fmt: skip

    def _follow(
        self, block: Block, card: int, name: str, place: Placement, around: tuple[Path, ...]
    ) -> Iterator[Block]:
        """Return the keywords of one included file."""
        file = self._found(block, name)
        target = file.resolve()
        again = target in around or (block.name == "INCLUDE" and target in self.opened)
        self.count += 1
        if again or self.count > _MAX_INCLUDES:
            raise refuse(block, f"{name!r} again", "each file once", card)
        self.opened.add(target)
        try:
            content = read_file(file)
        except (InputError, ValueError) as error:
            raise InputError.single(
                f"*{block.name}", got=repr(name), expected="a readable file", file=block.file,
                line=block.lines[card],
                hint="sought beside the decks and in *INCLUDE_PATH",
            ) from error  # fmt: skip
        yield from self.within(file, content, place, (*around, target))

    def _found(self, block: Block, name: str) -> Path:
        """Return the file of this name, the first of all folders; capitals do not count."""
        folders = [block.file.parent, self.main.parent, *self.folders]
        exact = (folder / name for folder in folders)
        alike = (_ignoring_case(folder, name) for folder in folders)
        try:
            return next(
                (path for path in (*exact, *alike) if path is not None and path.is_file()),
                block.file.parent / name,
            )
        except (OSError, ValueError):
            return block.file.parent / name


def _ignoring_case(folder: Path, name: str) -> Path | None:
    """Find a file whose name differs in capitals only, None where there is not exactly one."""
    path = folder
    for part in PurePosixPath(name).parts:
        if part in ("/", ".."):
            path = path / part
            continue
        names = path.iterdir() if path.is_dir() else iter(())
        fitting = [entry for entry in names if entry.name.casefold() == part.casefold()]
        if len(fitting) != 1:
            return None
        path = fitting[0]
    return path


def _names(block: Block) -> Iterator[tuple[str, int]]:
    """Return each file name with its last card: " +" goes on, a backslash is a slash."""
    parts = b""
    for card, text in enumerate(block.cards):
        parts += text.strip() if parts else text.rstrip()
        if parts.endswith(_GOES_ON):
            parts = parts.removesuffix(_GOES_ON).rstrip()
            if card + 1 < len(block.cards):
                continue
        name = _decoded(parts.strip()).replace("\\", "/")
        parts = b""
        if name:
            yield name, card


def _decoded(name: bytes) -> str:
    try:
        return name.decode()
    except UnicodeDecodeError:
        return name.decode("latin-1")


def _placement(block: Block, at: int, around: Placement) -> Placement:
    """Read the cards behind the name of *INCLUDE_TRANSFORM."""
    cards = slice(at, at + 4)
    if any(card.strip() for card in block.cards[at + 4 :]):
        raise refuse(block, "more than five cards", "one file, offsets, factors and TRANID", at + 4)
    # The first two cards hold offsets, the third factors, the last the transformation.
    present = len(block.cards[cards])
    offset = block.table([10] * 7, slice(at, at + 1)).ints(*range(7))
    other = block.table([10], slice(at + 1, at + 2)).ints(0)
    factor = block.table([10] * 3, slice(at + 2, at + 3)).floats(2)
    number = block.table([10], slice(at + 3, at + 4)).ints(0)
    node, element, part, _, sets, _, define = offset[0].tolist() if present > 0 else [0] * 7
    length = float(factor[0, 0]) if present > 2 else 1.0
    transformation = int(number[0, 0]) if present > 3 else 0
    move = Move(
        length=length or 1.0,
        transformation=transformation + around.define if transformation else 0,
        file=block.file,
        line=block.line,
    )
    return Placement(
        node=around.node + node,
        element=around.element + element,
        part=around.part + part,
        sets=around.sets + sets,
        define=around.define + define,
        other=around.other + (int(other[0, 0]) if present > 1 else 0),
        moves=(move, *around.moves),
    )
