"""The characters of a pattern file: by its code page, or guessed where it names none."""

from __future__ import annotations

import codecs
import re
import unicodedata
from pathlib import Path

from ezdxf.lldxf.encoding import decode_dxf_unicode
from ezdxf.tools.codepage import toencoding

from seatlook.errors import InputError

_CODE_PAGE = re.compile(rb"\$DWGCODEPAGE\s+3\s+(\S+)", re.IGNORECASE)
_VERSION = re.compile(rb"\$ACADVER\s+1\s+AC(\d+)")
_ALWAYS_UTF8 = 1021  # AutoCAD 2007 and later
_BOMS = (
    (codecs.BOM_UTF8, "utf-8-sig"),
    (codecs.BOM_UTF16_LE, "utf-16"),
    (codecs.BOM_UTF16_BE, "utf-16"),
)
_GUESSED = ("gb18030", "cp932", "cp1252")


def decode(content: bytes, path: Path, encoding: str | None) -> tuple[str, str | None]:
    """Return the text of a file, and its encoding where that is a guess.

    Raises
    ------
    InputError
        When ``encoding`` is unknown, or the file is not written in it.
    """
    if encoding is not None:
        return _decode_as(content, path, encoding), None
    if content.isascii():
        return content.decode("ascii"), None
    for mark, name in _BOMS:
        if content.startswith(mark):
            return content.decode(name, "replace"), None
    stated = _stated(content)
    if stated is not None:
        return content.decode(stated, "surrogateescape"), None
    try:
        return content.decode("utf-8"), None
    except UnicodeDecodeError:
        guess = guess_encoding(content)
        return content.decode(guess, "replace"), guess


def guess_encoding(content: bytes) -> str:
    """Return the encoding in which the words of a file are most like words.

    Examples
    --------
    >>> [guess_encoding(w.encode(e)) for w, e in (("座垫", "gbk"), ("シート", "cp932"))]
    ['gb18030', 'cp932']
    >>> guess_encoding("Rückenlehne".encode("cp1252"))
    'cp1252'
    """
    return max(_GUESSED, key=lambda name: _likeness(content, name))


def spelled_out(text: str) -> str:
    r"""Return a text in which characters may be spelled as AutoCAD does, wide ones by halves.

    Examples
    --------
    >>> spelled_out(r"N\U+00E4ht \U+D83E\U+DEA1")
    'Näht 🪡'
    """
    decoded = decode_dxf_unicode(text)
    return decoded.encode("utf-16-le", "surrogatepass").decode("utf-16-le", "replace")


def _decode_as(content: bytes, path: Path, encoding: str) -> str:
    try:
        return content.decode(encoding)
    except (LookupError, UnicodeError) as error:
        known = not isinstance(error, LookupError)
        got = f"{encoding!r}, in which byte {error.start} has no meaning" if isinstance(
            error, UnicodeDecodeError
        ) else repr(encoding)  # fmt: skip
        expected = "the encoding of this file" if known else "an encoding, as gb18030 or cp932"
        raise InputError.single("encoding", got=got, expected=expected, file=path) from error


def _stated(content: bytes) -> str | None:
    """Return the encoding that the header names, None where it names none."""
    version = _VERSION.search(content)
    if version is not None and int(version[1]) >= _ALWAYS_UTF8:
        return "utf-8"
    page = _CODE_PAGE.search(content)
    if page is None:
        return None
    name = page[1].decode("ascii", "replace").lower()
    # The library takes what it does not know for cp1252.
    return toencoding(name) if name.removeprefix("ansi_") in toencoding(name) else None


def _likeness(content: bytes, encoding: str) -> float:
    """Return how much the characters beyond ASCII look like words, 0 to 1."""
    try:
        text = content.decode(encoding)
    except UnicodeDecodeError:
        return 0.0 if encoding != "cp1252" else 0.01
    weigh = {"gb18030": _like_chinese, "cp932": _like_japanese, "cp1252": _like_latin}[encoding]
    # Latin letters stand between other letters; the others need no neighbour.
    weights = [
        weigh(text[k - 1 : k + 2] if k else f" {text[:2]}")
        for k, character in enumerate(text)
        if not character.isascii()
    ]
    return sum(weights) / len(weights) if weights else 0.0


def _like_chinese(three: str) -> float:
    """Weigh the middle character: the first level of GB 2312 holds the common ones."""
    try:
        lead = three[1].encode("gb2312")[0]
    except UnicodeEncodeError:
        return 0.1
    return 0.95 if 0xB0 <= lead <= 0xD7 else 0.5


def _like_japanese(three: str) -> float:
    character = three[1]
    name = unicodedata.name(character, "")
    if name.startswith("HALFWIDTH"):
        return 0.4
    if name.startswith(("HIRAGANA", "KATAKANA")):
        return 1.0
    lead = character.encode("cp932", "replace")[0]
    return 0.9 if 0x88 <= lead <= 0x97 else 0.4 if name.startswith("CJK") else 0.2


def _like_latin(three: str) -> float:
    beside = three[0] + three[2:]
    if not three[1].isalpha():
        return 0.3 if three[1] in "°²³½ø±µ" else 0.1
    return 0.8 if any(c.isascii() and c.isalpha() for c in beside) else 0.3
