"""Wrinkle figures of a finite-element result, state by state."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any, NamedTuple, TypedDict, Unpack

import numpy as np

from seatlook.chain.assess import wrinkle_map
from seatlook.errors import InputError, Problem
from seatlook.io.lsdyna.shells import read_shells
from seatlook.mesh.statistics import quantile
from seatlook.model import (
    Criteria,
    CurvatureMode,
    FloatArray,
    IntArray,
    ShellResult,
    Shells,
    ShellState,
    StrainMeasure,
    WrinkleMap,
)
from seatlook.model.criteria import DEFAULT_THRESHOLD
from seatlook.model.shells import StrainAxes
from seatlook.shells.strains import ShellStrains, shell_strains
from seatlook.wrinkle import map_top

_PER_MM = 1e-3  # 1/m in 1/mm


class Reading(TypedDict, total=False):
    """How a file of shells is read, see ``seatlook.io.read_shells``."""

    parts: Sequence[int | str] | None
    thickness: float | None
    length_unit: str
    strain_axes: StrainAxes
    reference: Path | None


@dataclass(frozen=True, slots=True, kw_only=True)
class ShellCriteria:
    """How shells of another program are assessed.

    Parameters
    ----------
    curvature : "paper" (eq. 1 as printed) or "tensor"
    c_threshold : float [1/m]      None: 10 for "paper", 20 for "tensor"
    facing : (3,)                  the visible side, see ``shell_strains``
    strain_measure : "green" or "logarithmic"; without it as the file has them
    """

    curvature: CurvatureMode = "paper"
    c_threshold: float | None = None
    facing: FloatArray | None = None
    strain_measure: StrainMeasure | None = None

    @property
    def threshold(self) -> float:
        """C_threshold [1/m] that is used."""
        return DEFAULT_THRESHOLD[self.curvature] if self.c_threshold is None else self.c_threshold

    def words(self) -> str:
        """Mode and threshold as every table of W2 states them.

        Examples
        --------
        >>> ShellCriteria(curvature="tensor", strain_measure="logarithmic").words()
        'tensor of logarithmic strain, 0.02 per mm'
        """
        return Criteria(
            curvature=self.curvature,
            thresholds=(self.threshold,),
            strain_measure=self.strain_measure or "green",
        ).words()


@dataclass(frozen=True, slots=True, kw_only=True)
class ShellWrinkles(ShellStrains):
    """Strains of one state with its indices, whose fields are (k,)."""

    indices: WrinkleMap


def shell_indices(
    shells: Shells, state: ShellState, criteria: ShellCriteria | None = None
) -> ShellWrinkles:
    """Evaluate eqs. (1) to (6) on the shells of one state.

    Raises
    ------
    InputError
        As ``seatlook.shells.strains.shell_strains``.
    """
    chosen = criteria or ShellCriteria()
    strains = shell_strains(
        shells, state, facing=chosen.facing, strain_measure=chosen.strain_measure
    )
    # The strains are in the wanted measure already, and are taken as they are.
    of_all = Criteria(curvature=chosen.curvature, thresholds=(chosen.threshold,))
    return ShellWrinkles(
        **{f.name: getattr(strains, f.name) for f in fields(ShellStrains)},
        indices=wrinkle_map(of_all, strains.strains),
    )


def wrinkle_states(
    path: Path, criteria: ShellCriteria | None = None, **reading: Unpack[Reading]
) -> dict[str, Any]:
    """Evaluate all states of a d3plot or keyword deck; the result is fit for JSON.

    Parameters
    ----------
    reading : parts, thickness, length_unit, strain_axes, reference: as for ``io.read_shells``

    Returns
    -------
    dict
        ``file``, ``curvature``, ``c_threshold_per_mm``, ``criterion`` (both in words), ``shells``,
        ``notes``, ``states``. Each state has ``time``; ``c``, ``c_min``, ``c_max`` [1/mm], ``w1``
        and ``r_stretch``, of which ``c``, ``w1`` and ``r_stretch`` are means weighted by area;
        ``w2``, ``w_stretch``, ``w_compression`` (means), ``w2_p95`` and ``w2_area_share`` (share
        above 1); the element size ``h_mm``; ``source`` of the curvature; and the same figures per
        part in ``parts``.

    Raises
    ------
    InputError
        As ``seatlook.io.read_shells`` and ``shell_indices``.
    """
    chosen = criteria or ShellCriteria()
    result = read_shells(path, **reading)
    return {
        "file": str(path),
        "curvature": chosen.curvature,
        "c_threshold_per_mm": chosen.threshold * _PER_MM,
        "criterion": chosen.words(),
        "shells": len(result.shells),
        "notes": list(result.notes),
        "states": [state_figures(result, *pair) for pair in evaluated_states(path, result, chosen)],
    }


def evaluated_states(
    path: Path, result: ShellResult, criteria: ShellCriteria
) -> Iterator[tuple[ShellState, ShellWrinkles]]:
    """Evaluate one state after the other, so that only one needs to be in memory.

    Raises
    ------
    InputError
        As ``shell_indices``, with the file and the number of the state.
    """
    for index, state in enumerate(result):
        try:
            yield state, shell_indices(result.shells, state, criteria)
        except InputError as error:
            raise InputError(_placed(p, path, index) for p in error.problems) from error


class AssessedStates(NamedTuple):
    """What all states of a file give.

    Parameters
    ----------
    figures : per state, as in ``wrinkle_states``
    states : number -> state and its indices, of those to be drawn
    top : upper end of the range of W2 for maps of any state
    """

    figures: list[dict[str, Any]]
    states: dict[int, tuple[ShellState, ShellWrinkles]]
    top: float


def assess_states(
    path: Path, result: ShellResult, criteria: ShellCriteria, *, drawn: Collection[int]
) -> AssessedStates:
    """Evaluate all states; hold on to those to be drawn.

    Raises
    ------
    InputError
        A state to draw that is not there; else as ``evaluated_states``.
    """
    absent = sorted(set(drawn) - set(range(len(result))))
    if absent:
        raise InputError.single(
            "state", got=str(absent[0]), expected=f"0 to {len(result) - 1}", file=path
        )
    figures, states, top = [], {}, 1.0
    for number, (state, wrinkles) in enumerate(evaluated_states(path, result, criteria)):
        figures.append(state_figures(result, state, wrinkles))
        top = max(top, map_top(wrinkles.indices))
        if number in drawn:
            states[number] = state, wrinkles
    return AssessedStates(figures, states, top)


def _placed(problem: Problem, path: Path, index: int) -> Problem:
    return Problem(
        key=f"state {index}: {problem.key}", got=problem.got, expected=problem.expected,
        hint=problem.hint, file=path,
    )  # fmt: skip


def state_figures(
    result: ShellResult, state: ShellState, wrinkles: ShellWrinkles
) -> dict[str, Any]:
    """Return the figures of one state, whole and part by part; see ``wrinkle_states``."""
    part = result.shells.part[wrinkles.element]
    names = result.shells.part_names
    everyone = np.arange(len(wrinkles.element))
    return {
        "time": state.time,
        **_figures(wrinkles, everyone),
        "source": wrinkles.source,
        "shells_turned": wrinkles.turned,
        "shells_deleted": len(result.shells) - len(everyone),
        "pieces_one_sided": wrinkles.one_sided,
        "parts": [
            {"part": int(p), "name": names.get(int(p), ""), **_figures(wrinkles, rows)}
            for p in np.unique(part)
            for rows in [np.flatnonzero(part == p)]
        ],
    }


def _figures(wrinkles: ShellWrinkles, rows: IntArray) -> dict[str, float]:
    """Means weighted by area over some elements."""
    w: WrinkleMap = wrinkles.indices
    area = wrinkles.area[rows]

    def mean(values: FloatArray) -> float:
        return float(values[rows] @ area / area.sum())

    return {
        "c": mean(w.c) * _PER_MM,
        "c_min": float(w.c[rows].min()) * _PER_MM,
        "c_max": float(w.c[rows].max()) * _PER_MM,
        "w1": mean(w.w1),
        "w2": mean(w.w2),
        "w2_p95": quantile(w.w2[rows], area, 0.95),
        "w2_area_share": mean((w.w2 > 1).astype(float)),
        "r_stretch": mean(w.r_stretch),
        "w_stretch": mean(w.w_stretch),
        "w_compression": mean(w.w_compression),
        "area_mm2": float(area.sum()) * 1e6,
        "h_mm": float(wrinkles.size[rows].mean()) * 1e3,
    }
