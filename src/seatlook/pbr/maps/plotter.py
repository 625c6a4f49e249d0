"""A value on the cover in three dimensions, to be turned by hand in a notebook."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from seatlook.errors import InputError
from seatlook.model import FloatArray, Solution
from seatlook.pbr.backend import offscreen_backend

if TYPE_CHECKING:
    from pyvista import Plotter as Plotter


def plotter(
    solution: Solution,
    values: FloatArray,
    *,
    title: str,
    value_range: tuple[float, float] | None = None,
    size: tuple[int, int] = (960, 540),
) -> Plotter:
    """Return a PyVista plotter with one value per face; ``plotter.show()`` shows it.

    Parameters
    ----------
    values : (m,) float64
    size : (width, height) in pixels

    Raises
    ------
    InputError
        Wrong number of values.
    NoOffscreenContext
    """
    faces = solution.cover.faces
    if values.shape != (len(faces),):
        raise InputError.single("values", got=f"shape {values.shape}", expected=f"({len(faces)},)")
    # PyVista loads VTK, which must find its GL library first.
    offscreen_backend()
    import pyvista

    cells = np.column_stack([np.full(len(faces), 3), faces])
    surface = pyvista.PolyData(solution.positions, cells)
    surface.cell_data[title] = values
    view = pyvista.Plotter(off_screen=True, window_size=list(size))
    view.add_mesh(surface, scalars=title, cmap="viridis", clim=value_range)
    view.camera_position = [(0.9, -1.2, 0.9), tuple(solution.positions.mean(axis=0)), (0, 0, 1)]
    return view
