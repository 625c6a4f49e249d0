"""Wrinkle figures of a finite-element result, state by state."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from seatlook.errors import InputError, Problem
from seatlook.io.shells import read_shells
from seatlook.model import FloatArray, IntArray, ShellResult, ShellState, WrinkleMap
from seatlook.model.scene import CurvatureMode
from seatlook.model.shells import StrainAxes
from seatlook.wrinkle import quantile
from seatlook.wrinkle.shells import DEFAULT_THRESHOLD, ShellWrinkles, shell_indices

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
) -> dict[str, Any]:
    """Evaluate all states of a d3plot or keyword deck; the result is fit for JSON.

    Parameters
    ----------
    parts : part numbers or titles; without it all shells
    curvature : "paper" (eq. 1 as printed) or "tensor"
    c_threshold : float [1/m]      default 10 for "paper", 20 for "tensor"
    thickness : float [m]          for files that do not hold it
    facing : (3,)                  the visible side, see ``shell_indices``

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
        See ``seatlook.io.shells.read_shells`` and ``seatlook.wrinkle.shells.shell_indices``.
    """
    result = read_shells(
        path, parts=parts, thickness=thickness, length_unit=length_unit,
        strain_axes=strain_axes, reference=reference,
    )  # fmt: skip
    threshold = DEFAULT_THRESHOLD[curvature] if c_threshold is None else c_threshold
    states = []
    for index, state in enumerate(result):
        try:
            wrinkles = shell_indices(
                result.shells, state, curvature=curvature, c_threshold=threshold, facing=facing
            )
        except InputError as error:
            raise InputError(_placed(p, path, index) for p in error.problems) from error
        states.append(_state(result, state, wrinkles))
    return {
        "file": str(path),
        "curvature": curvature,
        "c_threshold_per_mm": threshold * _PER_MM,
        "shells": len(result.shells),
        "notes": list(result.notes),
        "states": states,
    }


def _placed(problem: Problem, path: Path, index: int) -> Problem:
    return Problem(
        key=f"state {index}: {problem.key}", got=problem.got, expected=problem.expected,
        hint=problem.hint, file=path,
    )  # fmt: skip


def _state(result: ShellResult, state: ShellState, wrinkles: ShellWrinkles) -> dict[str, Any]:
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
