"""LS-DYNA's d3plot: nodes, shells, thickness and surface strains of all states.

Written from the word order of the database manual; NumPy memory maps, so a state costs only what
is read of it. Everything a wrong split would show in is checked: file sizes, node and part
indices, the words of a shell's row, rising times.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from seatlook.files import reader
from seatlook.io.lsdyna.d3plot.family import (
    Stored,
    family_of,
    find_states,
    head_of,
    last_mesh,
    map_words,
)
from seatlook.io.lsdyna.d3plot.layout import Layout, Words, read_layout, word_type
from seatlook.io.lsdyna.d3plot.parts import read_titles, user_numbers
from seatlook.io.lsdyna.d3plot.row import refuse
from seatlook.io.lsdyna.element_tables import (
    ElementTable,
    Selection,
    check_thickness_unit,
    finite,
    select,
    unit_in_metres,
)
from seatlook.model import FloatArray, ShellResult, ShellState
from seatlook.model.shells import StrainAxes


@reader("a d3plot file")
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
    file, remeshed = last_mesh(Path(path))
    family = family_of(file)
    word = word_type(file, head_of(file))
    words = map_words(file, word)
    layout = read_layout(file, words, word)
    scale = unit_in_metres(length_unit)
    if layout.thickness < 0 and thickness is None:
        raise refuse(
            file, "thickness", "none in the file", "ENGFLG=1 in *DATABASE_EXTENT_BINARY",
            "or say the thickness",
        )  # fmt: skip
    table, first, note = _shells(layout, words)
    states = find_states(layout, family, words, first)
    if not states:
        raise refuse(
            file, "states", f"none, only the geometry of {len(table.part)} shells",
            "at least one state in the file or its followers", f"is {file.name}01 missing?",
        )  # fmt: skip
    n = layout.control["numnp"]
    start = np.asarray(words[layout.nodes : layout.nodes + 3 * n]).view(layout.real)
    empty = _without_thickness(layout, states)
    table = replace(table, usable=layout.reported & ~empty)
    chosen = select(table, parts, reference=start.reshape(n, 3).astype(np.float64) * scale)
    states_read = _Reader(layout, chosen, states, scale, thickness, strain_axes)
    notes = (remeshed, note, *_notes(layout, table, chosen, empty))
    return ShellResult(
        shells=chosen.shells,
        times=np.array([s.time for s in states]),
        read=partial(_read_state, file, states_read),
        notes=tuple(text for text in notes if text),
    )


@reader("a d3plot file")
def _read_state(file: Path, states: _Reader, index: int) -> ShellState:
    return states.read(index)


@dataclass(frozen=True, slots=True)
class _Reader:
    layout: Layout
    chosen: Selection
    states: list[Stored]
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
            check_thickness_unit(lay.file, t[alive])
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

    def _floats(self, stored: Stored, at: int, count: int) -> Any:
        start = stored.at + at
        return np.asarray(stored.words[start : start + count]).view(self.layout.real)


def _tensors(six: FloatArray) -> FloatArray:
    """(e, 3, 3) from xx, yy, zz, xy, yz, zx."""
    return six.take([[0, 3, 5], [3, 1, 4], [5, 4, 2]], axis=1)


def _shells(layout: Layout, words: Words) -> tuple[ElementTable, int, str]:
    """Read all shells; return them, the first word behind their titles, and a note on those."""
    control, file = layout.control, layout.file
    rows = np.asarray(words[layout.shells : layout.shells + 5 * control["nel4"]])
    rows = rows.reshape(-1, 5).astype(np.int64)
    corners, internal = rows[:, :4] - 1, rows[:, 4]
    if corners.min() < 0 or corners.max() >= control["numnp"]:
        raise refuse(
            file, "shell nodes", f"{corners.min() + 1}..{corners.max() + 1}",
            f"1..{control['numnp']}", "the file is damaged",
        )  # fmt: skip
    element_ids, part_ids = user_numbers(layout, words)
    if internal.min() < 1 or internal.max() > len(part_ids):
        raise refuse(
            file, "shell parts", f"{internal.min()}..{internal.max()}", f"1..{len(part_ids)}"
        )
    titles = read_titles(layout, words, part_ids)
    table = ElementTable(
        file=file,
        corners=corners,
        element_ids=element_ids,
        part=part_ids[internal - 1],
        titles=titles.of_part,
        usable=layout.reported,
    )
    return table, titles.end, titles.note


def _without_thickness(layout: Layout, states: Sequence[Stored]) -> npt.NDArray[np.bool_]:
    """Tell which shells have thickness 0 in every state, as rigid parts are written."""
    empty = layout.reported.copy()
    if layout.thickness < 0:
        return np.zeros_like(empty)
    row = np.arange(layout.row_count)
    for stored in states:
        at = stored.at + layout.row_start + layout.thickness
        column = stored.words[at :: layout.control["nv2d"]][: layout.row_count]
        row = row[np.asarray(column[row]).view(layout.real) == 0]
        if not len(row):
            break
    empty[layout.reported] = np.isin(np.arange(layout.row_count), row)
    return empty


def _notes(
    layout: Layout, table: ElementTable, chosen: Selection, empty: npt.NDArray[np.bool_]
) -> tuple[str, ...]:
    notes = []
    if layout.strain < 0:
        notes.append("the file has no strains (STRFLG=0): curvature is taken from the geometry")
    for left_out, what in (
        (~layout.reported, "of rigid parts"),
        (empty, "with thickness 0 in every state, as rigid parts are written,"),
    ):
        shells = left_out & chosen.inside
        if shells.any():
            names = table.named(np.unique(table.part[shells]))
            notes.append(f"{int(shells.sum())} shells {what} are left out: part {names}")
    return tuple(notes)
