"""Wrinkle figures of a finite-element result, state by state."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from seatlook.errors import InputError, Problem
from seatlook.io.lsdyna.shells import read_shells
from seatlook.model import FloatArray, IntArray, ShellResult, ShellState, WrinkleMap
from seatlook.model.scene import CurvatureMode
from seatlook.model.shells import StrainAxes
from seatlook.shells.strains import DEFAULT_THRESHOLD, ShellWrinkles, shell_indices
from seatlook.wrinkle import map_top, quantile
from seatlook.wrinkle.equations import StrainMeasure

_PER_MM = 1e-3  # 1/m in 1/mm


def wrinkle_states(
    path: Path,
    *,
    parts: Sequence[int | str] | None = None,
    curvature: CurvatureMode = "paper",
    c_threshold: float | None = None,
    thickness: float | None = None,
    length_unit: str = "mm",
    strain_axes: StrainAxes = "global",
    reference: Path | None = None,
    facing: FloatArray | None = None,
    strain_measure: StrainMeasure | None = None,
) -> dict[str, Any]:
    """Evaluate all states of a d3plot or keyword deck; the result is fit for JSON.

    Parameters
    ----------
    parts : part numbers or titles; without it all shells
    curvature : "paper" (eq. 1 as printed) or "tensor"
    c_threshold : float [1/m]      default 10 for "paper", 20 for "tensor"
    thickness : float [m]          for files that do not hold it
    facing : (3,)                  the visible side, see ``shell_indices``
    strain_measure : "green" or "logarithmic"; without it as the file has them

    Returns
    -------
    dict
        ``file``, ``curvature``, ``c_threshold_per_mm``, ``shells``, ``notes``, ``states``. Each
        state has ``time``; ``c``, ``c_min``, ``c_max`` [1/mm], ``w1`` and ``r_stretch``, of which
        ``c``, ``w1`` and ``r_stretch`` are means weighted by area; ``w2``, ``w_stretch``,
        ``w_compression`` (means), ``w2_p95`` and ``w2_area_share`` (share above 1); the element
        size ``h_mm``; ``source`` of the curvature; and the same figures per part in ``parts``.

    Raises
    ------
    InputError
        See ``seatlook.io.lsdyna.shells.read_shells`` and ``seatlook.shells.strains.shell_indices``.
    """
    result = read_shells(
        path, parts=parts, thickness=thickness, length_unit=length_unit,
        strain_axes=strain_axes, reference=reference,
    )  # fmt: skip
    threshold = DEFAULT_THRESHOLD[curvature] if c_threshold is None else c_threshold
    evaluated = evaluated_states(
        path, result, curvature=curvature, c_threshold=threshold, facing=facing,
        strain_measure=strain_measure,
    )  # fmt: skip
    return {
        "file": str(path),
        "curvature": curvature,
        "c_threshold_per_mm": threshold * _PER_MM,
        "shells": len(result.shells),
        "notes": list(result.notes),
        "states": [state_figures(result, *pair) for pair in evaluated],
    }


def evaluated_states(
    path: Path,
    result: ShellResult,
    *,
    curvature: CurvatureMode,
    c_threshold: float,
    facing: FloatArray | None = None,
    strain_measure: StrainMeasure | None = None,
) -> Iterator[tuple[ShellState, ShellWrinkles]]:
    """Evaluate one state after the other, so that only one needs to be in memory.

    Raises
    ------
    InputError
        As ``seatlook.shells.strains.shell_indices``, with the file and the number of the state.
    """
    for index, state in enumerate(result):
        try:
            yield state, shell_indices(
                result.shells, state, curvature=curvature, c_threshold=c_threshold, facing=facing,
                strain_measure=strain_measure,
            )  # fmt: skip
        except InputError as error:
            raise InputError(_placed(p, path, index) for p in error.problems) from error


class JudgedStates(NamedTuple):
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


def judged_states(
    path: Path,
    result: ShellResult,
    *,
    kept: Collection[int],
    curvature: CurvatureMode,
    c_threshold: float,
    facing: FloatArray | None = None,
    strain_measure: StrainMeasure | None = None,
) -> JudgedStates:
    """Evaluate all states, keep those to be drawn.

    Raises
    ------
    InputError
        A state to keep that is not there; else as ``evaluated_states``.
    """
    absent = sorted(set(kept) - set(range(len(result))))
    if absent:
        raise InputError.single(
            "state", got=str(absent[0]), expected=f"0 to {len(result) - 1}", file=path
        )
    evaluated = evaluated_states(
        path, result, curvature=curvature, c_threshold=c_threshold, facing=facing,
        strain_measure=strain_measure,
    )  # fmt: skip
    figures, states, top = [], {}, 1.0
    for number, (state, wrinkles) in enumerate(evaluated):
        figures.append(state_figures(result, state, wrinkles))
        top = max(top, map_top(wrinkles.indices))
        if number in kept:
            states[number] = state, wrinkles
    return JudgedStates(figures, states, top)


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
