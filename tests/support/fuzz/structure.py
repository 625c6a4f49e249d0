"""Damage that keeps the structure of a format: whole rows, tags, cards, words and segments."""

from __future__ import annotations

import random
import re
import struct
import tomllib

from seatlook.io.toml import quoted, toml_key
from support.fuzz.mutate import WORDS, binary, change_tree, text

LAYERS = (b"0", b"1", b"2", b"4", b"6", b"7", b"8", b"11", b"14", b"80", b"84", b"Sew", b"x")
CODES = (b"0", b"2", b"8", b"10", b"20", b"41", b"42", b"50", b"62", b"70", b"71", b"999")
SMALL = (-10003, -1, 0, 1, 2, 3, 4, 5, 6, 7, 10, 11, 20, 64, 1000, 10011, 2**30)


def toml(content: bytes, rng: random.Random) -> bytes:
    """TOML that stays TOML: values replaced, taken out, put elsewhere; else plain damage."""
    if rng.random() < 0.5:
        return text(content, rng)
    try:
        root = tomllib.loads(content.decode("utf-8-sig"))
    except (UnicodeDecodeError, tomllib.TOMLDecodeError, RecursionError):
        return text(content, rng)
    change_tree(root, rng)
    return "".join(f"{toml_key(k)} = {_written(v)}\n" for k, v in root.items()).encode()


def _written(value: object) -> str:
    if isinstance(value, dict):
        return "{" + ", ".join(f"{toml_key(k)} = {_written(v)}" for k, v in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(_written, value)) + "]"
    if isinstance(value, str):
        return quoted(value)
    # TOML knows no null.
    return {True: "true", False: "false", None: "''"}.get(value) or repr(value)


def dxf(content: bytes, rng: random.Random) -> bytes:
    """Whole entities dropped, repeated and exchanged; other layers, codes and numbers."""
    if rng.random() < 0.3:
        return text(content, rng)
    lines = content.split(b"\n")
    tags = [[lines[k].strip(), lines[k + 1]] for k in range(0, len(lines) - 1, 2)]
    for _ in range(rng.choice((1, 1, 2, 4))):
        starts = [k for k, tag in enumerate(tags) if tag[0] == b"0"]
        if len(starts) < 3:
            break
        kind, n = rng.randrange(6), rng.randrange(len(starts) - 1)
        at, end = starts[n], starts[n + 1]
        if kind == 0:
            del tags[at:end]
        elif kind == 1:
            other = rng.choice(starts)
            tags[other:other] = [list(tag) for tag in tags[at:end]]
        elif kind == 2:
            layers = [tag for tag in tags if tag[0] == b"8"]
            if layers:
                rng.choice(layers)[1] = rng.choice(LAYERS)
        elif kind == 3:
            rng.choice(tags)[0] = rng.choice(CODES)
        else:
            numbers = [tag for tag in tags if tag[0] not in (b"0", b"1", b"2", b"8")]
            if numbers:
                rng.choice(numbers)[1] = _number(rng)
    return b"\n".join(part for tag in tags for part in tag) + b"\n"


def _number(rng: random.Random) -> bytes:
    odd = rng.random() < 0.3
    return rng.choice(WORDS) if odd else f"{rng.uniform(-500, 500):.{rng.randrange(4)}f}".encode()


def deck(content: bytes, rng: random.Random) -> bytes:
    """Fields of cards replaced within their columns; cards and whole keywords moved and dropped."""
    if rng.random() < 0.3:
        return text(content, rng)
    lines = content.split(b"\n")
    for _ in range(rng.choice((1, 1, 2, 4))):
        heads = [k for k, line in enumerate(lines) if line.startswith(b"*")] or [0]
        kind, at = rng.randrange(5), rng.randrange(len(lines))
        if kind == 0:
            first = rng.randrange(len(heads))
            end = heads[first + 1] if first + 1 < len(heads) else len(lines)
            whole = lines[heads[first] : end]
            if rng.random() < 0.5:
                del lines[heads[first] : end]
            lines[(to := rng.choice(heads)) : to] = whole
        elif kind == 1:
            del lines[at : at + 1]
        elif kind == 2:
            lines[at:at] = [rng.choice(lines)]
        else:
            width = rng.choice((8, 10, 10, 16, 20))
            column = width * rng.randrange(8)
            card = lines[at].ljust(column)
            word = rng.choice((b"0", b"1", b"2", b"-1", b"7", b"99", *WORDS))[:width]
            lines[at] = card[:column] + word.rjust(width) + card[column + width :]
        if not lines:
            lines = [b""]
    return b"\n".join(lines)


def d3plot(content: bytes, rng: random.Random) -> bytes:
    """Control words replaced by others that count something; words dropped and added anywhere."""
    if rng.random() < 0.4 or len(content) < 256:
        return binary(content, rng)
    size, order = rng.choice(((4, "<"), (4, "<"), (4, ">"), (8, "<")))
    letter = "i" if size == 4 else "q"
    damaged = bytearray(content)
    for _ in range(rng.choice((1, 1, 2))):
        at = size * rng.randrange(64)
        (old,) = struct.unpack_from(order + letter, damaged, at)
        new = rng.choice((*SMALL, old + 1, old - 1, 10 * old, -old))
        struct.pack_into(order + letter, damaged, at, max(-(2**30), min(new, 2**30)))
    if rng.random() < 0.3:
        at = size * rng.randrange(len(damaged) // size)
        count = size * rng.randrange(1, 20)
        if rng.random() < 0.5:
            del damaged[at : at + count]
        else:
            damaged[at:at] = damaged[max(at - count, 0) : at]
    return bytes(damaged)


def jpeg(content: bytes, rng: random.Random) -> bytes:
    """Damage inside one segment before the pixels, with its length mended; or in the pixels."""
    segments, at = [], 2
    while at + 4 <= len(content) and content[at] == 0xFF and content[at + 1] != 0xDA:
        (length,) = struct.unpack_from(">H", content, at + 2)
        segments.append((content[at : at + 2], content[at + 4 : at + 2 + length]))
        at += 2 + length
    if not segments or rng.random() < 0.3:
        return binary(content, rng)
    pixels = content[at:]
    k = rng.randrange(len(segments) + 1)
    if k == len(segments):
        pixels = binary(pixels, rng)
    else:
        segments[k] = segments[k][0], binary(segments[k][1] or b"0", rng)[:60_000]
    head = b"".join(m + struct.pack(">H", len(d) + 2) + d for m, d in segments)
    return content[:2] + head + pixels


def tiff(content: bytes, rng: random.Random) -> bytes:
    """One entry of the directory changed: its tag, type, count or value."""
    order = {b"II": "<", b"MM": ">"}.get(content[:2])
    if order is None or rng.random() < 0.3:
        return binary(content, rng)
    (at,) = struct.unpack_from(order + "I", content, 4)
    damaged = bytearray(content)
    if at + 2 > len(damaged):
        return binary(content, rng)
    (count,) = struct.unpack_from(order + "H", damaged, at)
    for _ in range(rng.choice((1, 1, 2))):
        entry = at + 2 + 12 * rng.randrange(max(count, 1))
        if entry + 12 > len(damaged):
            break
        if rng.random() < 0.3:
            struct.pack_into(order + "H", damaged, entry + rng.choice((0, 2)), rng.randrange(18))
        else:
            (old,) = struct.unpack_from(order + "I", damaged, entry + (place := rng.choice((4, 8))))
            new = rng.choice((0, 1, 2, 3, 5, 8, 16, 32, old + 1, 2 * old, 2**31, 2**32 - 1))
            struct.pack_into(order + "I", damaged, entry + place, new % 2**32)
    return bytes(damaged)


_EXR_VALUES = rb"(compression\0compression\0\x01\0\0\0|lineOrder\0lineOrder\0\x01\0\0\0)"


def exr(content: bytes, rng: random.Random) -> bytes:
    """Names and values of the head changed, the pixels behind damaged."""
    end = content.find(b"\0\0", content.find(b"screenWindowWidth")) + 2
    kind = rng.randrange(5)
    if kind == 0:
        return binary(content, rng)
    if kind == 1:
        return content[:end] + binary(content[end:], rng)
    damaged = bytearray(content)
    if kind == 2:
        for found in re.finditer(_EXR_VALUES, content):
            damaged[found.end()] = rng.randrange(12)
    elif kind == 3:
        found = re.search(rb"dataWindow\0box2i\0\x10\0\0\0", content)
        if found:
            at = found.end() + 4 * rng.randrange(4)
            new = rng.choice((-1, 0, 1, 5, 7, 8, 15, 16, 2**20, 2**31 - 1))
            struct.pack_into("<i", damaged, at, new)
    else:
        head = bytearray(binary(content[:end], rng))
        damaged[:end] = head
    return bytes(damaged)
