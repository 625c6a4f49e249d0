"""Damaged files are read or refused with a message; nothing else may come out of a reader."""

import random
import re
import warnings
from pathlib import Path

import pytest
import trimesh

from seatlook.errors import InputError, InputWarning
from seatlook.io.curves import read_curves
from seatlook.io.material import materials_dir, read_foam_material, read_material
from seatlook.io.pattern.dxf import read_dxf
from seatlook.io.pattern.seams import read_seams
from seatlook.io.surface.design import read_surface
from seatlook.io.surface.foam import read_foam

DATA = Path(__file__).parents[1] / "data"
FOAM = read_foam_material("foam-seat")
NUMBER = re.compile(rb"\d+\.\d+")
WORDS = (b"nan", b"inf", b"-1", b"0", b'"x"', b"[]", b"{}", b"true", b"1e400", b"[[1,2],[3]]")


def box(suffix):
    content = trimesh.creation.box(extents=(0.5, 0.4, 0.1)).export(file_type=suffix)
    return content.encode() if isinstance(content, str) else content


def pattern():
    """One piece of the sample, to keep the file small."""
    whole = (DATA / "seat_cushion_demo_aama.dxf").read_bytes()
    start = whole.index(b"BLOCK\n", whole.index(b"CENTER_ONE"))
    stop = whole.index(b"FRONT_ONE") - 100
    stop = whole.index(b"BLOCK\n", whole.rindex(b"ENDBLK", 0, stop))
    return whole[:start] + whole[stop:]


CASES = {
    "material.toml": (read_material, (materials_dir() / "black-leather.toml").read_bytes()),
    "foam.toml": (read_foam_material, (materials_dir() / "foam-seat.toml").read_bytes()),
    "seams.toml": (None, (DATA / "seat_cushion_demo.seams.toml").read_bytes()),
    "curves.toml": (read_curves, b'[curve.a]\npoints_mm = [\n[1, 2, 3],\n[4, 5, 6.5],\n]\n'),
    "foam.obj": (lambda p: read_foam(p, material=FOAM, unit="m"), box("obj")),
    "foam.stl": (lambda p: read_foam(p, material=FOAM, unit="m"), box("stl")),
    "foam.ply": (lambda p: read_foam(p, material=FOAM, unit="m"), box("ply")),
    "surface.obj": (lambda p: read_surface(p, unit="m"), b"g A\n" + box("obj")),
    "pattern.dxf": (read_dxf, pattern()),
}  # fmt: skip


def damaged(content, rng):
    """Change, drop and repeat some bytes, and put odd words in the place of numbers."""
    b = bytearray(content)
    for _ in range(rng.randint(1, 4)):
        i = rng.randrange(len(b))
        kind = rng.randrange(4)
        if kind == 0:
            b[i] = rng.randrange(256)
        elif kind == 1:
            del b[i : i + rng.randrange(1, 80)]
        elif kind == 2:
            b[i:i] = b[max(0, i - rng.randrange(1, 80)) : i]
        else:
            numbers = list(NUMBER.finditer(bytes(b)))
            if numbers:
                start, stop = rng.choice(numbers).span()
                b[start:stop] = rng.choice(WORDS)
        b = b or bytearray(b"0")
    return bytes(b)


def outcome(read, path):
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", InputWarning)
            read(path)
    except InputError as error:
        named = error.problems and all(p.got and p.expected for p in error.problems)
        return "refused" if named else "refused without a word"
    return "read"


def outcomes(name, folder, count):
    read, content = CASES[name]
    if read is None:
        panels = read_dxf(DATA / "seat_cushion_demo_aama.dxf")

        def read(p):
            return read_seams(p, panels)

    path = folder / name
    path.write_bytes(content)
    assert outcome(read, path) == "read"
    rng = random.Random(name)
    results = set()
    for _ in range(count):
        path.write_bytes(damaged(content, rng))
        results.add(outcome(read, path))
    return results


@pytest.mark.parametrize("name", CASES)
def test_damage_is_refused_with_a_message(tmp_path, name):
    assert "refused" in (results := outcomes(name, tmp_path, 25))
    assert results <= {"refused", "read"}


@pytest.mark.validate
@pytest.mark.parametrize("name", CASES)
def test_much_damage_is_refused_with_a_message(tmp_path, name):
    assert outcomes(name, tmp_path, 10_000) == {"refused", "read"}
