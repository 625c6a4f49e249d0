"""LS-DYNA's d3plot: nodes, shells, thickness and surface strains of all states.

Written from the word order of the database manual; NumPy memory maps, so a state costs only what
is read of it. Everything a wrong split would show in is checked: file sizes, node and part
indices, the words of a shell's row, rising times.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from seatlook.errors import InputError
from seatlook.io.lsdyna.d3plot_layout import (
    END_MARK,
    Layout,
    Words,
    read_layout,
    refuse,
    word_type,
)
from seatlook.io.lsdyna.element_tables import (
    ElementTable,
    Selection,
    finite,
    select,
    unit_in_metres,
)
from seatlook.model import FloatArray, IntArray, ShellResult, ShellState
from seatlook.model.shells import StrainAxes

_TITLE_BYTES = 72


def read_d3plot(
    path: Path,
    *,
    parts: Sequence[int | str] | None = None,
    thickness: float | None = None,
    length_unit: str = "mm",
    strain_axes: StrainAxes = "global",
) -> ShellResult:
    """Read the shells of a d3plot file and its followers (``d3plot01``, ``d3plot02``, ...).

    Parameters
    ----------
    path : the first file of the family
    parts : part numbers or titles; without it all shells
    thickness : float [m]          for files without thickness (ENGFLG=2)
    length_unit : "mm", "cm", "m" or "inch"   unit of the calculation
    strain_axes : "global", or "element" for a run with CMPFLG=1

    Returns
    -------
    ShellResult
        Strains on both surfaces where the run had STRFLG=1 (``*DATABASE_EXTENT_BINARY``);
        otherwise None, and ``notes`` says so. Rigid and deleted shells are left out.

    Raises
    ------
    InputError
        No d3plot, cut short, without shells or thickness, with nan, or with contents that this
        reader does not know and that would shift the rest.
    """
    file = Path(path)
    family = _family(file)
    word = word_type(file, _head(file))
    words = _map(file, word)
    layout = read_layout(file, words, word)
    scale = unit_in_metres(length_unit)
    titles, first = _titles(layout, words)
    chosen = _chosen(layout, words, titles, parts, scale)
    if layout.thickness < 0 and thickness is None:
        raise refuse(
            file, "thickness", "none in the file", "ENGFLG=1 in *DATABASE_EXTENT_BINARY",
            "or say the thickness",
        )  # fmt: skip
    states = _states(layout, family, words, first)
    if not states:
        raise refuse(file, "states", "none", "at least one state in the file or its followers")
    reader = _Reader(layout, chosen, states, scale, thickness, strain_axes)
    return ShellResult(
        shells=chosen.shells,
        times=np.array([s.time for s in states]),
        read=reader.read,
        notes=_notes(layout, chosen),
    )


@dataclass(frozen=True, slots=True)
class _Stored:
    """Where one state lies."""

    words: Words
    at: int
    time: float


@dataclass(frozen=True, slots=True)
class _Reader:
    layout: Layout
    chosen: Selection
    states: list[_Stored]
    scale: float
    thickness: float | None
    strain_axes: StrainAxes

    def read(self, index: int) -> ShellState:
        """Read state ``index``."""
        stored, lay, chosen = self.states[index], self.layout, self.chosen
        nodes = 1 + lay.control["nglbv"]
        n = lay.control["numnp"]
        positions = self._floats(stored, nodes, 3 * n).reshape(n, 3)[chosen.nodes] * self.scale
        rows = self._floats(stored, lay.row_start, lay.row_count * lay.control["nv2d"])
        rows = rows.reshape(lay.row_count, -1)
        row = (np.cumsum(lay.reported) - 1)[chosen.elements]
        alive = np.ones(len(row), dtype=bool)
        if lay.alive_start:
            flags = self._floats(stored, lay.alive_start, lay.control["nel4"])
            alive = flags[chosen.elements] != 0
        what = f"state {index}"
        inner = outer = None
        if lay.strain >= 0:
            both = rows[:, lay.strain : lay.strain + 12][row].astype(np.float64)
            both[~alive] = 0.0
            finite(lay.file, f"{what}: strains", both, chosen.shells.element_ids)
            inner, outer = _tensors(both[:, :6]), _tensors(both[:, 6:])
        if self.thickness is None:
            t = rows[:, lay.thickness][row].astype(np.float64) * self.scale
        else:
            t = np.full(len(row), self.thickness)
        finite(lay.file, f"{what}: thickness", t, chosen.shells.element_ids)
        finite(lay.file, f"{what}: node positions", positions, chosen.nodes + 1)
        return ShellState(
            time=stored.time,
            positions=positions,
            thickness=t,
            strain_inner=inner,
            strain_outer=outer,
            strain_axes=self.strain_axes,
            alive=alive,
        )

    def _floats(self, stored: _Stored, at: int, count: int) -> Any:
        start = stored.at + at
        return np.asarray(stored.words[start : start + count]).view(self.layout.real)


def _tensors(six: FloatArray) -> FloatArray:
    """(e, 3, 3) from xx, yy, zz, xy, yz, zx."""
    return six.take([[0, 3, 5], [3, 1, 4], [5, 4, 2]], axis=1)


def _notes(layout: Layout, chosen: Selection) -> tuple[str, ...]:
    notes = []
    if layout.strain < 0:
        notes.append("the file has no strains (STRFLG=0): curvature is taken from the geometry")
    if chosen.dropped:
        notes.append(f"{chosen.dropped} shells of rigid parts are left out")
    return tuple(notes)


def _chosen(
    layout: Layout,
    words: Words,
    titles: dict[int, str],
    parts: Sequence[int | str] | None,
    scale: float,
) -> Selection:
    """Select shells and check every index on the way."""
    control, file = layout.control, layout.file
    table = np.asarray(words[layout.shells : layout.shells + 5 * control["nel4"]])
    table = table.reshape(-1, 5).astype(np.int64)
    corners, internal = table[:, :4] - 1, table[:, 4]
    if corners.min() < 0 or corners.max() >= control["numnp"]:
        raise refuse(
            file, "shell nodes", f"{corners.min() + 1}..{corners.max() + 1}",
            f"1..{control['numnp']}", "the file is damaged",
        )  # fmt: skip
    element_ids, part_ids = _numbers(layout, words)
    if internal.min() < 1 or internal.max() > len(part_ids):
        raise refuse(
            file, "shell parts", f"{internal.min()}..{internal.max()}", f"1..{len(part_ids)}"
        )
    n = control["numnp"]
    reference = np.asarray(words[layout.nodes : layout.nodes + 3 * n]).view(layout.real)
    shells = ElementTable(
        file=file,
        corners=corners,
        element_ids=element_ids,
        part=part_ids[internal - 1],
        titles=titles,
        usable=layout.reported,
    )
    start = reference.reshape(n, 3).astype(np.float64) * scale
    return select(shells, parts, reference=start)


def _numbers(layout: Layout, words: Words) -> tuple[IntArray, IntArray]:
    """Return the user's numbers of shells and parts; counted from 1 where the file has none."""
    control, at = layout.control, layout.numbering
    plain = np.arange(1, control["nel4"] + 1), np.arange(1, control["nmmat"] + 1)
    wide = control["filetype"] > 1000 and layout.word.endswith("4")
    if control["narbs"] < 10 or wide:
        return plain
    head = words[at : at + 16].astype(np.int64)
    named = head[0] < 0
    counts = [int(c) for c in head[5:10]]
    expected = [control["numnp"], abs(control["nel8"]), control["nel2"], control["nel4"],
                control["nelth"]]  # fmt: skip
    part_count = control["nmmat"] if named else 0
    need = (16 if named else 10) + sum(counts) + part_count
    if counts != expected or (named and control["narbs"] < 16) or need > control["narbs"]:
        raise refuse(
            layout.file, "NARBS", f"{control['narbs']} words for {counts} numbers", f"{expected}"
        )
    shells = at + (16 if named else 10) + sum(counts[:3])
    ids = words[shells : shells + counts[3]].astype(np.int64)
    parts = shells + counts[3] + counts[4]
    return ids, words[parts : parts + part_count].astype(np.int64) if named else plain[1]


def _titles(layout: Layout, words: Words) -> tuple[dict[int, str], int]:
    """Read part titles behind the geometry; return them and the word behind."""
    at = layout.geometry_end
    size = int(layout.word[2])
    title_words = _TITLE_BYTES // size
    titles: dict[int, str] = {}
    if not _is_end(layout, words, at):
        return titles, at
    at += 1
    while at + 1 < len(words):
        kind, count = int(words[at]), int(words[at + 1])
        if kind == 90000:
            at += 1 + title_words
        elif kind in (90001, 90002, 90020):
            end = at + 2 + count * (1 + title_words)
            if count < 0 or end > len(words):
                raise refuse(layout.file, "titles", f"{count} of them", "a whole file")
            if kind == 90001:
                block = np.asarray(words[at + 2 : end]).reshape(count, -1)
                titles = {int(row[0]): _text(row[1:]) for row in block}
            at = end
        elif kind == 90100:
            at += 2 + max(count, 0) * 80 // size
        else:
            break
    return titles, at + 1 if _is_end(layout, words, at) else at


def _text(words: Words) -> str:
    return words.tobytes().split(b"\0")[0].decode("latin-1").strip()


def _is_end(layout: Layout, words: Words, at: int) -> bool:
    return at < len(words) and float(words[at : at + 1].view(layout.real)[0]) == END_MARK


def _states(layout: Layout, family: list[Path], words: Words, first: int) -> list[_Stored]:
    """Find all states; each file holds whole states and then an end mark, padding or nothing."""
    states: list[_Stored] = []
    for number, file in enumerate(family):
        here = words if number == 0 else _map(file, layout.word)
        at = first if number == 0 else 0
        while at < len(here) and not _is_end(layout, here, at):
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
            states.append(_Stored(here, at, time))
            at += layout.state_words
    return states


def _family(file: Path) -> list[Path]:
    """Return the first file and its followers in order."""
    try:
        names = [p.name for p in file.parent.iterdir()]
    except OSError:
        names = []
    follower = re.compile(re.escape(file.name) + r"(\d{2,})")
    followers = sorted((int(m[1]), n) for n in names if (m := follower.fullmatch(n)))
    numbers = [n for n, _ in followers]
    if numbers != list(range(1, len(numbers) + 1)):
        absent = next(i for i, n in enumerate([*numbers, -1], 1) if n != i)
        raise refuse(
            file, "followers", f"no {file.name}{absent:02d}", f"all up to {followers[-1][1]}"
        )
    return [file, *(file.with_name(name) for _, name in followers)]


def _head(file: Path) -> bytes:
    try:
        with file.open("rb") as stream:
            return stream.read(512)
    except FileNotFoundError as error:
        raise refuse(file, "file", "no such file", "a d3plot file") from error
    except OSError as error:
        raise refuse(file, "file", error.strerror, "a readable file") from error


def _map(file: Path, word: str) -> Words:
    size = file.stat().st_size
    if size < int(word[2]):
        raise InputError.single("file", got=f"{size} bytes", expected="a d3plot file", file=file)
    return np.memmap(file, dtype=word, mode="r", shape=(size // int(word[2]),))
