"""Where things lie in a d3plot file: control words, geometry section, one state.

The word order is that of the LS-DYNA database manual. Only what is needed to find nodes and
shells is followed; what would move them in a way not followed here is refused by name.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from seatlook.errors import InputError, Problem
from seatlook.io.lsdyna.d3plot.particles import particles
from seatlook.io.lsdyna.d3plot.row import refuse, shell_row

END_MARK = -999999.0
RIGID = 20  # material type of rigid bodies, whose shells have no state data

_CONTROL = {
    "filetype": 11, "ndim": 15, "numnp": 16, "nglbv": 18, "it": 19, "iu": 20, "iv": 21, "ia": 22,
    "nel8": 23, "numds": 25, "nv3d": 27, "nel2": 28, "nv1d": 30, "nel4": 31, "nv2d": 33,
    "neips": 35, "maxint": 36, "nmsph": 37, "narbs": 39, "nelth": 40, "nv3dt": 42, "ioshl1": 43,
    "ioshl2": 44, "ioshl3": 45, "ioshl4": 46, "ialemat": 47, "ncfdv1": 48, "nadapt": 50,
    "nmmat": 51, "npefg": 54, "nel48": 55, "idtdt": 56, "extra": 57,
}  # fmt: skip
_EXTRA = {
    "nel20": 64, "nt3d": 65, "nel27": 66, "nel21p": 68, "nel15t": 69, "nel20t": 71, "nel40p": 72,
    "nel64": 73, "quadr": 74, "cubic": 75,
}  # fmt: skip
_COUNTS = (
    "numnp", "nglbv", "nv3d", "nel2", "nv1d", "nel4", "nv2d", "neips", "nmsph", "narbs", "nelth",
    "nv3dt", "ialemat", "nadapt", "nmmat", "npefg", "nel48", "idtdt", "it", "extra", "nel20",
    "nt3d", "nel27", "nel21p", "nel15t", "nel20t", "nel40p", "nel64",
)  # fmt: skip
_FEMZIP = 76_893_465
_OTHER_TYPES = {4: "intfor", 11: "eigenvalue"}

Words = npt.NDArray[Any]


@dataclass(frozen=True, slots=True)
class Layout:
    """Word positions of one file family.

    Parameters
    ----------
    word : "<i4", ">i4", "<i8" or ">i8"; floats have the same size and byte order
    control : name of the manual -> value
    nodes, shells, numbering : first word of that part of the geometry section
    geometry_end : first word behind the geometry section
    reported : (e,) bool      shells that have a row in every state
    row_count : e of these; row_start : their first word in a state; state_words : words of a state
    alive_start : word of the deletion flags of the shells in a state, 0 without
    """

    file: Path
    word: str
    control: dict[str, int]
    nodes: int
    shells: int
    numbering: int
    geometry_end: int
    reported: npt.NDArray[np.bool_]
    row_count: int
    row_start: int
    state_words: int
    alive_start: int
    thickness: int
    strain: int

    @property
    def real(self) -> str:
        """Type of the floats."""
        return self.word.replace("i", "f")


def word_type(file: Path, head: bytes) -> str:
    """Find the size and byte order of the words from the file type, word 11."""
    others = []
    for word in ("<i4", "<i8", ">i4", ">i8"):
        at = 11 * int(word[2])
        if len(head) < at + int(word[2]):
            continue
        kind = int(np.frombuffer(head, word, 1, at)[0])
        if kind in (1, 5, 1001, 1005):
            return word
        others.append(_OTHER_TYPES.get(kind))
    other = next((name for name in others if name), None)
    got = f"an {other} file" if other else "no file type 1 or 5 in word 11"
    raise refuse(file, "file", got, "a d3plot or d3part file")


def read_layout(file: Path, words: Words, word: str) -> Layout:
    """Read the control words and locate everything; ``words`` is the whole first file."""
    control = _control(file, words)
    _refuse_without_shells(file, control)
    material_types, rigid_shells, at = _material_types(file, words, control)
    flags = at + control["ialemat"]
    grains = particles(file, words, flags, control)
    nodes = flags + grains.flags
    shells = (
        nodes + 3 * control["numnp"] + 9 * abs(control["nel8"])
        + (2 * abs(control["nel8"]) if control["nel8"] < 0 else 0)
        + 9 * control["nelth"] + 6 * control["nel2"]
    )  # fmt: skip
    numbering = shells + 5 * control["nel4"]
    rigid_start = numbering + control["narbs"]
    table = _part(file, words, shells, 5 * control["nel4"], "shells").reshape(-1, 5)
    rigid, rigid_words = _rigid_bodies(file, words, rigid_start, control)
    end = rigid_start + rigid_words + 2 * control["nadapt"] + grains.lists + _extra_nodes(control)
    _part(file, words, 0, end, "geometry")
    reported = _reported(file, control, table[:, 4], material_types, rigid_shells)
    row_start = 1 + control["nglbv"] + _node_words(control) + _before_shells(control)
    rows_end = row_start + int(reported.sum()) * control["nv2d"]
    deleted = _deletion_words(control)
    thickness, strain = shell_row(file, control)
    return Layout(
        file=file,
        word=word,
        control=control,
        nodes=nodes,
        shells=shells,
        numbering=numbering,
        geometry_end=end,
        reported=reported,
        row_count=int(reported.sum()),
        row_start=row_start,
        state_words=rows_end + deleted + grains.state + rigid,
        alive_start=rows_end + abs(control["nel8"]) + control["nelth"]
        if control["maxint"] <= -10000
        else 0,
        thickness=thickness,
        strain=strain,
    )


def _material_types(file: Path, words: Words, control: dict[str, int]) -> tuple[Words, int, int]:
    """Return the material type of each part, the number of rigid shells, the first word behind."""
    at = 64 + control["extra"]
    if control["ndim"] != 5:
        return np.zeros(0, dtype=np.int64), 0, at
    head = _part(file, words, at, 2, "material types")
    types = _part(file, words, at + 2, control["nmmat"], "material types")
    return types, int(head[0]), at + 2 + control["nmmat"]


def _control(file: Path, words: Words) -> dict[str, int]:
    """Read the control words and refuse what no file can hold."""
    head = _part(file, words, 0, 64, "control words")
    control = {name: int(head[at]) for name, at in _CONTROL.items()}
    if control["nmmat"] == _FEMZIP:
        raise refuse(file, "file", "a femzip archive", "a plain d3plot", "unpack it first")
    size = len(words)
    if control["nmmat"] > size:
        raise refuse(file, "NMMAT", control["nmmat"], f"at most {size} parts", "truncated?")
    if not 0 <= control["extra"] <= size - 64:
        raise refuse(file, "EXTRA", control["extra"], f"0 to {size - 64} words", "truncated?")
    more = words[64 : 64 + control["extra"]]
    control |= {n: int(more[a - 64]) if a - 64 < len(more) else 0 for n, a in _EXTRA.items()}
    problems = [
        Problem(key=name.upper(), got=str(control[name]), expected="0 or more", file=file)
        for name in _COUNTS
        if control[name] < 0
    ]
    if control["ndim"] not in (3, 4, 5, 8):
        problems.append(
            Problem(key="NDIM", got=str(control["ndim"]), expected="3, 4, 5 or 8", file=file)
        )
    if problems:
        raise InputError(problems)
    return control


def _refuse_without_shells(file: Path, control: dict[str, int]) -> None:
    """Refuse a file without what is asked of it."""
    if not control["nel4"]:
        raise refuse(file, "shells", "none", "a result with shell elements")
    if not control["numnp"]:
        raise refuse(file, "nodes", "none", "a result with nodes")
    if not control["iu"]:
        raise refuse(file, "IU", "no node positions in the states", "positions in every state")


def _part(file: Path, words: Words, at: int, count: int, what: str) -> Words:
    """Return ``count`` words from ``at``, or say that the file ends before."""
    if at + count > len(words):
        raise refuse(
            file, what, f"{len(words)} words", f"at least {at + count}", "the file is truncated"
        )
    return words[at : at + count]


def _rigid_bodies(file: Path, words: Words, at: int, control: dict[str, int]) -> tuple[int, int]:
    """Return the words of all rigid bodies in a state and in the geometry section."""
    if control["ndim"] != 8:
        return 0, 0
    start = at
    count = int(_part(file, words, at, 1, "rigid bodies")[0])
    at += 1
    for _ in range(count):
        for skip in (2, 1):  # part number and nodes; active nodes
            length = int(_part(file, words, at, skip, "rigid bodies")[-1])
            if length < 0:
                raise refuse(file, "rigid bodies", f"{length} nodes", "0 or more")
            at += skip + length
    return 24 * max(count, 0), at - start


def _extra_nodes(control: dict[str, int]) -> int:
    """Words of the further nodes of higher elements."""
    full, cubic = control["quadr"] > 0, control["cubic"] > 0
    return (
        5 * control["nel48"] + 13 * control["nel20"]
        + full * (28 * control["nel27"] + 22 * control["nel21p"] + 8 * control["nel15t"])
        + cubic * (21 * control["nel20t"] + 41 * control["nel40p"] + 65 * control["nel64"])
    )  # fmt: skip


def _reported(
    file: Path, control: dict[str, int], part: Words, material_types: Words, rigid_shells: int
) -> npt.NDArray[np.bool_]:
    """Tell which shells have a row in the states; those of rigid parts have none in a d3plot."""
    everyone = np.ones(len(part), dtype=bool)
    if not len(material_types):
        return everyone
    if part.min() < 1 or part.max() > len(material_types):
        raise refuse(
            file, "shell parts", f"{part.min()}..{part.max()}", f"1..{len(material_types)}"
        )
    if control["filetype"] % 1000 == 5:
        return everyone
    soft = np.asarray(material_types[part - 1] != RIGID)
    if int((~soft).sum()) != rigid_shells:
        raise refuse(file, "rigid shells", int((~soft).sum()), f"{rigid_shells}, as NUMRBE says")
    return soft


def _node_words(control: dict[str, int]) -> int:
    """Words of all nodes in a state."""
    it, idtdt = control["it"], control["idtdt"]
    temperature = {0: 0, 1: 1, 2: 4, 3: 6}.get(it % 10, 0)
    mass_scaling = it // 10 % 10 == 1
    rate, residual = idtdt % 10 == 1, idtdt // 10 % 10 == 1
    vectors = 3 * sum(control[name] != 0 for name in ("iu", "iv", "ia"))
    return control["numnp"] * (temperature + mass_scaling + rate + 6 * residual + vectors)


def _before_shells(control: dict[str, int]) -> int:
    solids = abs(control["nel8"])
    return (
        solids * (control["nt3d"] + control["nv3d"])
        + control["nelth"] * control["nv3dt"] + control["nel2"] * control["nv1d"]
    )  # fmt: skip


def _deletion_words(control: dict[str, int]) -> int:
    if control["maxint"] <= -10000:
        return control["nel4"] + abs(control["nel8"]) + control["nelth"] + control["nel2"]
    return control["numnp"] if control["maxint"] < 0 else 0


def is_end(layout: Layout, words: Words, at: int) -> bool:
    """Tell whether a mark of the end stands at word ``at``."""
    return at < len(words) and float(words[at : at + 1].view(layout.real)[0]) == END_MARK
