"""Damage that gets past the front door: by the structure of a file, with its checksums mended."""

from __future__ import annotations

import io
import json
import random
import re
import struct
import zipfile
import zlib

NUMBER = re.compile(rb"-?\d+\.?\d*(?:[eE][-+]?\d+)?")
WORDS = (
    b"nan", b"inf", b"-1", b"0", b'"x"', b"[]", b"{}", b"true", b"1e400", b"[[1,2],[3]]", b"1e308",
    b"1e-320", b"9" * 400, b"9" * 5000, b"0x" + b"f" * 400, b"-0.0", b"1.5", b"2147483648",
    b"[" * 60 + b"]" * 60, b"'''", b'"""', "é🪡".encode(), b"\xff\xfe", b"\0", b"null",
)  # fmt: skip
INTEGERS = (0, 1, 2, 7, 127, 128, 255, 256, 65535, 2**31 - 1, 2**31, 2**32 - 1, 2**63 - 1)


def text(content: bytes, rng: random.Random) -> bytes:
    """Other bytes, lines in another order, odd words in the place of numbers."""
    damaged = bytearray(content)
    for _ in range(rng.choice((1, 1, 1, 2, 4))):
        kind = rng.randrange(7)
        if kind < 3:
            damaged = bytearray(_bytes(damaged, rng))
        elif kind == 3:
            lines = damaged.split(b"\n")
            a, b = rng.randrange(len(lines)), rng.randrange(len(lines))
            lines[a], lines[b] = lines[b], lines[rng.choice((a, b))]
            damaged = bytearray(b"\n".join(lines))
        else:
            numbers = list(NUMBER.finditer(bytes(damaged)))
            if numbers:
                start, stop = rng.choice(numbers).span()
                damaged[start:stop] = rng.choice(WORDS)
    return bytes(damaged)


def binary(content: bytes, rng: random.Random) -> bytes:
    """Other bytes, and odd numbers of 1 to 8 bytes, most of them near the head."""
    damaged = bytearray(content)
    for _ in range(rng.choice((1, 1, 1, 2, 4))):
        if rng.random() < 0.5:
            damaged = bytearray(_bytes(damaged, rng))
            continue
        size = rng.choice((1, 2, 4, 8))
        reach = len(damaged) if rng.random() < 0.5 else min(len(damaged), 512)
        at = rng.randrange(max(reach - size, 1)) // size * size
        number = rng.choice(INTEGERS) % 256**size
        damaged[at : at + size] = number.to_bytes(size, rng.choice(("little", "big")))
    return bytes(damaged)


def _bytes(content: bytes | bytearray, rng: random.Random) -> bytes:
    """Change, drop, repeat or cut off some bytes."""
    b = bytearray(content) or bytearray(b"0")
    at, kind = rng.randrange(len(b)), rng.randrange(5)
    if kind < 2:
        b[at] = rng.randrange(256)
    elif kind == 2:
        del b[at : at + rng.randrange(1, 80)]
    elif kind == 3:
        b[at:at] = b[max(0, at - rng.randrange(1, 80)) : at]
    elif rng.random() < 0.3:
        del b[at:]
    return bytes(b) or b"0"


def png(content: bytes, rng: random.Random) -> bytes:
    """Damage inside one chunk, or inside what its pixels unpack to."""
    chunks, at = [], 8
    while at + 12 <= len(content):
        (length,) = struct.unpack_from(">I", content, at)
        chunks.append((content[at + 4 : at + 8], content[at + 8 : at + 8 + length]))
        at += 12 + length
    if not chunks or rng.random() < 0.1:
        return binary(content, rng)
    k = rng.randrange(len(chunks))
    kind, data = chunks[k]
    if kind == b"IDAT" and rng.random() < 0.5:
        data = zlib.compress(binary(zlib.decompress(data), rng))
    else:
        data = binary(data or b"0", rng)
    chunks[k] = kind, data
    if rng.random() < 0.2:
        rng.shuffle(chunks)
    return content[:8] + b"".join(
        struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
        for kind, data in chunks
    )


def npz(content: bytes, rng: random.Random) -> bytes:
    """Damage inside one array, its head or the text of ``meta``; members dropped and renamed."""
    if rng.random() < 0.1:
        return binary(content, rng)
    with zipfile.ZipFile(io.BytesIO(content)) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    name = "meta.npy" if "meta.npy" in members and rng.random() < 0.6 else rng.choice([*members])
    data = members.pop(name)
    if name == "meta.npy":
        members[name] = _as_text_array(data, rng)
    elif rng.random() < 0.1:
        members[rng.choice([*members, "odd.npy"])] = data
    else:
        members[name] = binary(data, rng)
    out = io.BytesIO()
    with zipfile.ZipFile(out, "w", rng.choice((zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED))) as new:
        for name, data in members.items():
            new.writestr(name, data)
    return out.getvalue()


def _as_text_array(data: bytes, rng: random.Random) -> bytes:
    import numpy as np

    words = str(np.load(io.BytesIO(data)))
    changed = tree(words.encode(), rng) if rng.random() < 0.7 else text(words.encode(), rng)
    out = io.BytesIO()
    np.save(out, np.array(changed.decode(errors="replace").replace("\0", "")))
    return out.getvalue()


def tree(content: bytes, rng: random.Random) -> bytes:
    """JSON that stays JSON: values replaced, taken out, put elsewhere."""
    try:
        root = json.loads(content)
    except (ValueError, RecursionError):
        return text(content, rng)
    change_tree(root, rng)
    return json.dumps(root).encode()


def change_tree(root, rng: random.Random) -> None:
    """Replace, take out and move values in dictionaries and lists."""
    for _ in range(rng.randint(1, 3)):
        places = list(_places(root))
        if not places:
            break
        holder, key = rng.choice(places)
        kind = rng.randrange(4)
        if kind == 0 and isinstance(holder, dict):
            holder.pop(key, None)
        elif kind == 1:
            other, name = rng.choice(places)
            there = name in other if isinstance(other, dict) else name < len(other)
            holder[key] = json.loads(json.dumps(other[name])) if there else None
        else:
            holder[key] = rng.choice(
                (None, True, -1, 0.5, 1e300, 2**40, "", "x", [], {}, [[1]], "9" * 99, float("nan"))
            )


def _places(node):
    children = node.items() if isinstance(node, dict) else enumerate(node)
    for key, child in list(children):
        yield node, key
        if isinstance(child, dict | list):
            yield from _places(child)


def glb(content: bytes, rng: random.Random) -> bytes:
    """Damage in the tree or in the numbers, with the lengths of both mended."""
    if rng.random() < 0.1:
        return binary(content, rng)
    (length,) = struct.unpack_from("<I", content, 12)
    head, rest = content[20 : 20 + length], content[28 + length :]
    if rng.random() < 0.7:
        head = tree(head, rng) if rng.random() < 0.7 else text(head, rng)
    else:
        rest = binary(rest, rng)
    head += b" " * (-len(head) % 4)
    rest += b"\0" * (-len(rest) % 4)
    body = struct.pack("<I4s", len(head), b"JSON") + head + struct.pack("<I4s", len(rest), b"BIN\0")
    return struct.pack("<4sII", b"glTF", 2, 12 + len(body) + len(rest)) + body + rest
