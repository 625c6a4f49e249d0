"""The files of one d3plot calculation, and where each state lies in them.

``d3plot01``, ``d3plot02``, ... go on where ``d3plot`` is full. A calculation that remeshes begins a
family of its own with every new mesh: ``d3plotaa``, ``d3plotab``, ...
"""

from __future__ import annotations

import os
import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from seatlook.errors import InputError
from seatlook.files import opened
from seatlook.io.lsdyna.d3plot.layout import Layout, Words, is_end
from seatlook.io.lsdyna.d3plot.row import refuse


@dataclass(frozen=True, slots=True)
class Stored:
    """Where one state lies."""

    words: Words
    at: int
    time: float


def last_mesh(file: Path) -> tuple[Path, str]:
    """Return the first file of the last mesh, and a note where the calculation remeshed."""
    names = _names(file)
    later = re.compile(re.escape(file.name) + r"[a-z]{2}")
    meshes = sorted(name for name in names if later.fullmatch(name))
    if f"{file.name}aa" not in meshes:
        return file, ""
    note = f"the calculation remeshed: {meshes[-1]} is read, the last of {len(meshes) + 1} meshes"
    return file.with_name(meshes[-1]), note


def find_states(layout: Layout, family: Sequence[Path], words: Words, first: int) -> list[Stored]:
    """Find all states; each file holds whole states and then an end mark, padding or nothing."""
    states: list[Stored] = []
    for number, file in enumerate(family):
        here = words if number == 0 else map_words(file, layout.word)
        at = first if number == 0 else 0
        while at < len(here) and not is_end(layout, here, at):
            rest = here[at : at + layout.state_words]
            if not rest.any():
                break
            if len(rest) < layout.state_words:
                raise refuse(
                    file, f"state {len(states)}", f"{len(rest)} words",
                    f"{layout.state_words}", "the file is truncated",
                )  # fmt: skip
            time = float(rest[:1].view(layout.real)[0])
            if not np.isfinite(time) or (states and time < states[-1].time):
                raise refuse(
                    file, f"state {len(states)}: time", f"{time:g}",
                    "rising times", "the states hold something this reader does not know",
                )  # fmt: skip
            states.append(Stored(here, at, time))
            at += layout.state_words
    return states


def family_of(file: Path) -> list[Path]:
    """Return the first file and its followers in order."""
    follower = re.compile(re.escape(file.name) + r"(\d{2,})")
    followers = sorted((int(m[1]), n) for n in _names(file) if (m := follower.fullmatch(n)))
    numbers = [n for n, _ in followers]
    if numbers != list(range(1, len(numbers) + 1)):
        absent = next(i for i, n in enumerate([*numbers, -1], 1) if n != i)
        raise refuse(
            file, "followers", f"no {file.name}{absent:02d}", f"all up to {followers[-1][1]}"
        )
    return [file, *(file.with_name(name) for _, name in followers)]


def _names(file: Path) -> list[str]:
    """Return the names of all files beside it."""
    try:
        return [path.name for path in file.parent.iterdir()]
    except OSError:
        return []


def head_of(file: Path) -> bytes:
    """Return the first bytes, which tell the size of a word."""
    with opened(file) as stream:
        return stream.read(512)


def map_words(file: Path, word: str) -> Words:
    """Map a file as words, of which only what is used is read."""
    with opened(file) as stream:
        size = os.fstat(stream.fileno()).st_size
    if size < int(word[2]):
        raise InputError.single("file", got=f"{size} bytes", expected="a d3plot file", file=file)
    return np.memmap(file, dtype=word, mode="r", shape=(size // int(word[2]),))
