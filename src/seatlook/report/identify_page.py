"""The page of an identified material: every test against the virtual rig, and what follows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import quote

import numpy as np
from markupsafe import Markup

from seatlook import files
from seatlook.identify.findings import Identified
from seatlook.identify.rig.retest import Retest
from seatlook.model.table import Table, number, spaced
from seatlook.report.page.write import content_policy, environment

_TEMPLATES = Path(__file__).parent / "templates"
_SIZE = (240.0, 150.0)  # of a chart in SVG units


@dataclass(frozen=True, slots=True, kw_only=True)
class Curves:
    """One chart: a line of the rig, dots of the test, ticks as (place, label)."""

    title: str
    x_name: str
    y_name: str
    line: str
    dots: tuple[tuple[float, float], ...]
    x_ticks: tuple[tuple[float, str], ...]
    y_ticks: tuple[tuple[float, str], ...]
    share: str


def write_identify_page(
    found: Identified,
    retested: Sequence[Retest],
    outlook: Sequence[tuple[str, float, float]],
    folder: Path,
    *,
    name: str,
    foam: str = "",
) -> Path:
    """Write ``folder/index.html`` and return its path.

    Parameters
    ----------
    retested : the tests in the virtual rig
    outlook : rows of what the numbers mean on the foam of this name
    name : of the material
    """
    style = (_TEMPLATES / "page.css").read_text(encoding="utf-8")
    templates = environment()
    templates.filters["url"] = quote  # of pictures that other pages have
    text = templates.get_template("identify.html.j2").render(
            name=name,
            laboratory=found.laboratory,
            policy=content_policy(style, ""),
            style=Markup(style),
            size=_SIZE,
            charts=[_curves(one) for one in retested],
            measured=Table(
                heads=("key", "value", "standard error", "where it comes from"),
                rows=tuple(
                    (one.key, spaced(one.numbers), spaced(one.errors), one.source)
                    for one in found.findings
                ),
            ),
            assumed=Table(heads=("key", "what would measure it"),
                          rows=tuple(found.assumed.items())),
            outlook=Table(heads=("on the foam", "along warp", "along weft"), rows=tuple(outlook)),
            foam=foam,
            notes=found.notes,
        )  # fmt: skip
    path = folder / "index.html"
    files.write_text(path, text)
    return path


def _curves(one: Retest) -> Curves:
    both = np.vstack([one.dots, one.line])
    low, high = both.min(axis=0), both.max(axis=0)
    span = np.where(high > low, high - low, 1.0)
    width, height = _SIZE

    def placed(points: np.ndarray) -> np.ndarray:
        share = (points - low) / span
        return np.column_stack([width * share[:, 0], height * (1.0 - share[:, 1])])

    line = " ".join(f"{x:.1f},{y:.1f}" for x, y in placed(one.line).tolist())
    marks = (0.0, 0.5, 1.0)
    return Curves(
        title=one.title, x_name=one.x_name, y_name=one.y_name, line=line,
        dots=tuple((round(x, 1), round(y, 1)) for x, y in placed(one.dots).tolist()),
        x_ticks=tuple((width * m, number(float(low[0] + m * span[0]))) for m in marks),
        y_ticks=tuple((height * (1 - m), number(float(low[1] + m * span[1]))) for m in marks),
        share=f"{100 * one.rms:.2g}",
    )  # fmt: skip
