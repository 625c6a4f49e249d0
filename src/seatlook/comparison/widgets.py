"""Sliders over the cells of a comparison, for notebooks with ipywidgets."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from seatlook.comparison.compare import Comparison
from seatlook.errors import InputError

if TYPE_CHECKING:
    from ipywidgets import Widget


def sliders(comparison: Comparison) -> Widget:
    """One slider per axis with more than one name, and the picture they choose.

    Raises
    ------
    InputError
        ipywidgets is not installed.
    """
    try:
        import ipywidgets
    except ImportError as error:
        raise InputError.single(
            "sliders",
            got="no ipywidgets",
            expected='pip install "seatlook[notebook]"; show() and indexing need none',
        ) from error
    axes = {
        "variant": tuple(comparison.variants),
        "texture": comparison.textures,
        "rig": comparison.rigs,
    }
    choose = {
        name: ipywidgets.SelectionSlider(
            options=options, description=name, continuous_update=False, disabled=len(options) < 2
        )
        for name, options in axes.items()
    }
    picture = ipywidgets.Image(format="png")
    caption = ipywidgets.Label()

    def draw(_change: Any = None) -> None:
        names = (choose["variant"].value, choose["texture"].value, choose["rig"].value)
        cell = comparison[names]
        picture.value, caption.value = cell.png, f"{cell.name}, EV {cell.ev100:.2f}"

    for slider in choose.values():
        slider.observe(draw, names="value")
    draw()
    return ipywidgets.VBox([*choose.values(), caption, picture])
