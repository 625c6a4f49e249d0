"""A DXF file opened: its characters, the names of its blocks, what the library says of it."""

from __future__ import annotations

import io
import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import ezdxf.filemanagement
from ezdxf.lldxf.validator import is_valid_block_name

from seatlook.errors import InputError, Problem
from seatlook.files import read_file
from seatlook.io.pattern.drawing.encoding import decode, spelled_out
from seatlook.io.pattern.drawing.layers import LINE_LAYERS, MEANINGS, TURN, UNREAD, meaning
from seatlook.io.pattern.drawing.log import listening, loses_a_piece

_BINARY = b"AutoCAD Binary DXF"
_STAND_IN = "seatlook-block-"
_DECIMAL_COMMA = re.compile(rb"^[ \t]*[1-5]?\d[ \t]*\r?\n[ \t]*(-?\d+,\d+)[ \t]*\r?$", re.MULTILINE)
_ERROR_NAME = re.compile(r"^\w+Error: ")
_LONGEST_GOT = 200  # characters of what the library says


@dataclass(frozen=True, slots=True)
class Drawing:
    """An opened file.

    Parameters
    ----------
    document : of the DXF library
    names : stand-in -> name of a block that the library would refuse
    header : the variables that the file itself holds; the library adds its own
    notes : what is unusual
    """

    path: Path
    document: Any
    names: Mapping[str, str]
    header: Mapping[str, str]
    notes: tuple[str, ...]

    def name_of(self, block: str) -> str:
        """Return the name that the file gives to a block."""
        return spelled_out(self.names.get(block, block))


def open_drawing(path: Path, encoding: str | None = None) -> Drawing:
    """Open a DXF file of any encoding, whatever its blocks are called.

    Raises
    ------
    InputError
        When the file is no whole DXF file, or not written in ``encoding``.
    """
    content = read_file(path)
    names: dict[str, str] = {}
    header: dict[str, str] = {}
    notes: list[str] = []
    with listening() as messages:
        try:
            if content.startswith(_BINARY):
                document = ezdxf.filemanagement.readfile(path)
                header = {
                    key: str(document.header.get(key)) for key in ("$INSUNITS", "$MEASUREMENT")
                }
            else:
                text, guess = decode(content, path, encoding)
                if guess is not None:
                    notes.append(f"no code page is given: read as {guess}, a guess")
                text = _with_safe_names(_with_plain_ends(text), path, names, header, notes)
                document = ezdxf.filemanagement.read(io.StringIO(text))
        except InputError:
            raise
        except Exception as error:  # on damaged files it raises whatever it stumbles over
            comma = b"," in content and _DECIMAL_COMMA.search(content)
            hint = f"its numbers have a decimal comma, as {comma[1].decode()}" if comma else ""
            raise refusal(path, error, hint) from error
    lost = [message for message in messages if loses_a_piece(message)]
    if lost:
        raise InputError.single("file", got=lost[0], expected="a whole DXF file", file=path)
    return Drawing(path, document, names, header, (*notes, *dict.fromkeys(messages)))


def assign_layers(path: Path, document: Any, layers: Mapping[str, str]) -> None:
    """Put what is drawn on some layers on those of AAMA that they stand for.

    Raises
    ------
    InputError
        A layer on which nothing is drawn, or a meaning that there is none of.
    """
    if not layers:
        return
    wanted = {name.casefold(): meaning(what) for name, what in layers.items()}
    entities = [e for layout in (*document.blocks, document.modelspace()) for e in layout]
    drawn = sorted({e.dxf.layer for e in entities})
    problems = [
        Problem(key=f"layers.{name}", got=repr(what), expected=", ".join(MEANINGS), file=path)
        for name, what in layers.items()
        if meaning(what) not in (*LINE_LAYERS, TURN, *UNREAD)
    ]
    problems += [
        Problem(key="layers", got=repr(name), expected=f"one of {', '.join(drawn)}", file=path)
        for name in layers
        if name.casefold() not in {layer.casefold() for layer in drawn}
    ]
    if problems:
        raise InputError(problems)
    for entity in entities:
        entity.dxf.layer = wanted.get(entity.dxf.layer.casefold(), entity.dxf.layer)


def refusal(path: Path, error: Exception, hint: str = "") -> InputError:
    """Return what to raise for whatever the library stumbled over."""
    got = _ERROR_NAME.sub("", str(error)).rstrip(".") or type(error).__name__
    got = got if len(got) <= _LONGEST_GOT else got[:_LONGEST_GOT] + " ..."
    return InputError.single("file", got=got, expected="a whole DXF file", file=path, hint=hint)


def _with_plain_ends(text: str) -> str:
    """End lines as the library wants it, and the file without the mark that DOS put there."""
    plain = text.replace("\r\n", "\n").replace("\r", "\n").rstrip("\x1a\n ")
    return plain + "\n" if plain else plain


def _with_safe_names(
    text: str, path: Path, names: dict[str, str], header: dict[str, str], notes: list[str]
) -> str:
    """Put stand-ins for block names that the library refuses, and take the header's values.

    LH/RH is an everyday name of a piece; a drawing program would not allow it. Several blocks of
    one name are told apart by their order, which is that of the places where they are put.
    """
    lines = text.split("\n")
    places: dict[tuple[str, str], list[int]] = {}
    for k, entity, code in _tags(lines):
        value = lines[k].strip()
        if entity.startswith("$"):
            header.setdefault(entity, value)
        elif code in ("2", "3") and entity in ("BLOCK", "INSERT") and value:
            places.setdefault((entity + code, value.casefold()), []).append(k)
    doubled = _doubled(places, path)
    if doubled:
        shown = ", ".join(spelled_out(name) for name in doubled)
        notes.append(f"several blocks have one name, each is a piece: {shown}")
    stand_ins: dict[tuple[str, int], str] = {}
    for (_, name), rows in places.items():
        for number, k in enumerate(rows):
            value = lines[k].strip()
            if name in doubled or not is_valid_block_name(value):
                key = (name, number) if name in doubled else (value, 0)
                stand_in = stand_ins.setdefault(key, f"{_STAND_IN}{len(stand_ins)}")
                names[stand_in] = value
                lines[k] = stand_in
    return "\n".join(lines)


def _doubled(places: Mapping[tuple[str, str], list[int]], path: Path) -> list[str]:
    """Return the names that several blocks have; those that are not put once each are refused."""
    doubled = []
    for (kind, name), rows in places.items():
        if kind == "BLOCK2" and len(rows) > 1 and not name.startswith("*"):
            doubled.append(name)
            inserts = len(places.get(("INSERT2", name), ()))
            if inserts not in (0, len(rows)):
                raise InputError.single(
                    "blocks",
                    got=f"{len(rows)} blocks called {spelled_out(name)}, put in {inserts} places",
                    expected="a name for each",
                    file=path,
                )
    return doubled


def _tags(lines: list[str]) -> Iterator[tuple[int, str, str]]:
    """Return (line of the value, entity or variable, code) of blocks and header variables."""
    entity = ""
    for k in range(1, len(lines), 2):
        code = lines[k - 1].strip()
        if code in ("0", "9"):
            entity = lines[k].strip()
        elif code in ("2", "3", "70") and (entity in ("BLOCK", "INSERT") or entity[:1] == "$"):
            yield k, entity, code
