"""The page of a correction: old and new seat side by side, what was changed, and the proof."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from urllib.parse import quote

from markupsafe import Markup

from seatlook import files, pbr
from seatlook.chain.assess import Assessment
from seatlook.chain.draw import Canvas, map_ends
from seatlook.improvement.corrected import LENGTHS, PATTERN, SEAMS
from seatlook.improvement.loop import Iteration
from seatlook.improvement.proof import Proof
from seatlook.model import Camera, Rig
from seatlook.model.table import Table, number
from seatlook.report.page.chart import HEIGHT, WIDTH, history_charts
from seatlook.report.page.write import content_policy, environment, page_style
from seatlook.report.pattern_drawing import CHANGES_PNG
from seatlook.wrinkle import INDICES

PAGE = "index.html"
_SIDES = ("old", "new")
_LIGHT, _MAP = "{}.png", "{}-w2-net.png"
PICTURES = tuple(name.format(side) for side in _SIDES for name in (_LIGHT, _MAP))
_DIFFERENT = 0.05  # mm, of a seam's two lengths, from which its row is shown
_Rows = Sequence[Mapping[str, object]]


@dataclass(frozen=True, slots=True, kw_only=True)
class Corrected:
    """What the page shows.

    Parameters
    ----------
    name : of the scene
    seats : old and new, solved cold with the scene's own seed
    steps, proof : of the loop
    corrections, lengths : rows of ``corrections.csv`` and ``lengths.csv``
    """

    name: str
    seats: tuple[Assessment, Assessment]
    steps: Sequence[Iteration]
    proof: Proof
    corrections: _Rows
    lengths: _Rows


def write_improvement_page(found: Corrected, folder: Path, *, camera: Camera, rig: Rig) -> Path:
    """Draw both seats into a folder that has the drawing of the changes; write its page.

    Parameters
    ----------
    camera, rig : the same for both seats

    Raises
    ------
    RenderError, NoOffscreenContext
    """
    _draw(found.seats, folder, camera, rig)
    style, templates = page_style(), environment()
    templates.filters["url"] = quote
    last = found.steps[-1]
    text = templates.get_template("improvement.html.j2").render(
        name=found.name,
        policy=content_policy(style, ""),
        style=Markup(style),
        sentences=[
            ("Proof", found.proof.sentence),
            *(("A limit is missed", one) for one in found.proof.missed),
            *((("What limits it", last.limit),) if last.limit else ()),
        ],
        pairs=[
            (f"{rig.name}, {camera.name}", _LIGHT),
            ("Net W2: wrinkles that the design does not ask for, one scale for both", _MAP),
        ],
        sides=_SIDES,
        size=camera.size,
        drawing=CHANGES_PNG,
        written=(PATTERN, SEAMS, LENGTHS),
        corrections=_corrections(found.corrections),
        lengths=_lengths(found.lengths),
        course=_course(found.steps),
        proof=_proof(found.proof),
        charts=history_charts(_history(found.steps)),
        chart_size=(WIDTH, HEIGHT),
    )
    path = folder / PAGE
    files.write_text(path, text)
    return path


def _draw(seats: tuple[Assessment, Assessment], folder: Path, camera: Camera, rig: Rig) -> None:
    index = INDICES["w2_net"]
    top = max(one.top for one in seats)
    for side, one in zip(_SIDES, seats, strict=True):
        canvas = Canvas(solution=one.solution, camera=camera, out=folder)
        pbr.render(one.solution, None, rig=rig, camera=camera).save(folder / _LIGHT.format(side))
        values = one.net
        title = f"{index.symbol}, {side}"
        ends = map_ends(index, values, top)
        canvas.draw(_MAP.format(side), values, title, unit=index.unit, ends=ends)


def _corrections(rows: _Rows) -> Table:
    return Table(
        heads=("correction", "amount [mm]", "why"),
        rows=tuple(
            (str(r["sentence"]), f"{float(str(r['amount_mm'])):.1f}", str(r["why"])) for r in rows
        ),
    )


def _lengths(rows: _Rows) -> Table:
    """Seams whose lines differ now, or did before."""
    names = ("near_mm", "far_mm", "ease_before_mm", "ease_mm")
    shown = [(str(row["seam"]), [float(str(row[name])) for name in names]) for row in rows]
    return Table(
        heads=("seam", "near line [mm]", "far line [mm]", "difference before [mm]",
               "difference now [mm]"),
        rows=tuple(
            (seam, *(f"{v:.1f}" for v in values[:2]), *(f"{v:z.2f}" for v in values[2:]))
            for seam, values in shown
            if max(abs(v) for v in values[2:]) > _DIFFERENT
        ),
    )  # fmt: skip


def _course(steps: Sequence[Iteration]) -> Table:
    heads = ("step", "what is wrong", "wrinkles", "strain", "gap", "what was done")
    return Table(
        heads=heads,
        rows=tuple(
            (
                str(one.number),
                *(number(v) for v in (one.value.total, one.value.w2, one.value.strain)),
                number(one.value.gap),
                one.ended or one.sentence,
            )
            for one in steps
        ),
    )


def _proof(proof: Proof) -> Table:
    return Table(
        heads=("seed", "old", "new"),
        rows=tuple(
            (str(seed), number(a.total), number(b.total))
            for seed, a, b in zip(proof.seeds, proof.before, proof.after, strict=True)
        ),
    )


def _history(steps: Sequence[Iteration]) -> dict[str, list[float]]:
    values = [one.value for one in steps if not one.ended]
    return {
        "what is wrong": [one.total for one in values],
        "wrinkles": [one.w2 for one in values],
        "strain": [one.strain for one in values],
        "gap": [one.gap for one in values],
    }
