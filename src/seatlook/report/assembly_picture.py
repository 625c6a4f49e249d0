"""The drawing of a cover as it starts, over its foam: what is sewn, hooked and framed to what."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import numpy.typing as npt
from PIL import Image as Pillow
from PIL import ImageDraw

from seatlook.assembly.contradictions import Contradiction
from seatlook.assembly.start_lines import StartLine, start_lines
from seatlook.files import write_bytes
from seatlook.mesh import boundary_loops
from seatlook.model import Camera, Cover, FloatArray, Foam, Scene, framed_view
from seatlook.pbr.maps.labels import Colour, Label, draw_label, draw_labels, font, width_of
from seatlook.pbr.maps.line_view import PAPER, Body, LineView, Stroke, tight
from seatlook.pbr.picture import png

VIEWS = ("front_34", "rear_34")
_WIDTH = 1400  # px of the whole picture
_EDGE, _GAP = 20, 16  # px around it, and between views
_TITLE, _TEXT = 22, 15  # px, size of letters
_ROW = 28  # px of a line of the legend
_LOWEST, _HIGHEST = 440, 880  # px of a view

# Dark enough for white numbers, and told apart by people who see no red or no green.
SEAM_COLOURS: tuple[Colour, ...] = (
    (0, 92, 171),
    (200, 82, 0),
    (0, 122, 94),
    (139, 60, 148),
    (112, 88, 24),
    (0, 130, 158),
    (178, 36, 110),
    (72, 72, 160),
)
_HOOK: Colour = (20, 20, 20)
_FRAME: Colour = (96, 104, 112)
_WRONG: Colour = (214, 0, 0)
_OUTLINE: Colour = (110, 100, 92)
_NAME: Colour = (120, 110, 100)
_FOAM = (0.90, 0.85, 0.70)
_PANELS = np.array(
    [
        [0.70, 0.78, 0.86],
        [0.86, 0.78, 0.70],
        [0.76, 0.84, 0.74],
        [0.84, 0.74, 0.80],
        [0.82, 0.82, 0.66],
        [0.70, 0.84, 0.84],
    ]
)
_FEWEST, _MOST, _APART = 9, 40, 0.06  # ties that are drawn of a line, and m between them


def draw_assembly(
    scene: Scene, cover: Cover, wrong: Sequence[Contradiction], path: Path
) -> tuple[StartLine, ...]:
    """Draw a cover as it starts into a PNG file; return the lines that are numbered in it.

    Parameters
    ----------
    wrong : what cannot be, which is marked and written below

    Raises
    ------
    OSError
        The file cannot be written.
    NoOffscreenContext, RenderError
    """
    lines = start_lines(scene, cover)
    shown = _shown(cover, lines)
    cameras, corners = _cameras(shown)
    views = [_view(camera, cover, lines, wrong) for camera in cameras]
    labels = _labels(cover, lines, wrong)
    places = np.array([place for place, _ in labels])
    hidden = np.array([view.hidden(places) for view in views])
    # A label stands where its place is seen; one that no view shows stands in all of them.
    hidden[:, hidden.all(axis=0)] = False
    bottom = max(y + c.size[1] for (_, y), c in zip(corners, cameras, strict=True))
    legend = _legend(lines, wrong)
    page = Pillow.new("RGB", (_WIDTH, bottom + _GAP + legend.height + _EDGE), PAPER)
    for view, corner, own in zip(views, corners, hidden, strict=True):
        page.paste(_labelled(view, labels, own), corner)
    draw = ImageDraw.Draw(page)
    title = f"{scene.name}: as it starts; seams with number and mean gap in mm"
    draw.text((_EDGE, _EDGE), title, font=font(_TITLE), fill=_HOOK)
    page.paste(legend, (_EDGE, bottom + _GAP))
    write_bytes(path, png(np.asarray(page)))
    return lines


def _shown(cover: Cover, lines: Sequence[StartLine]) -> FloatArray:
    """All places (k, 3) that a view has to show."""
    used = cover.positions[np.unique(cover.faces)]
    foam = () if cover.foam is None else (cover.foam.vertices,)
    return np.concatenate([used, *foam, *(line.end for line in lines)])


def _cameras(shown: FloatArray) -> tuple[list[Camera], list[tuple[int, int]]]:
    """Views one below the other, or side by side where the seat is tall, and their corners."""
    square = [framed_view(name, shown, size=(1000, 1000)) for name in VIEWS]
    shares = []
    for camera in square:
        pixels, _ = camera.pixels(shown)
        across, along = np.ptp(pixels, axis=0)
        shares.append(float(across / along))
    share, top = max(shares), 2 * _EDGE + _TITLE
    full = _WIDTH - 2 * _EDGE
    beside = share < 1.0
    width = (full - _GAP) // 2 if beside else full
    height = int(np.clip(width / share, _LOWEST, 1.2 * _HIGHEST if beside else _HIGHEST))
    step = (width + _GAP, 0) if beside else (0, height + _GAP)
    cameras = [tight(replace(camera, size=(width, height)), shown) for camera in square]
    return cameras, [(_EDGE + k * step[0], top + k * step[1]) for k in range(len(VIEWS))]


def _view(
    camera: Camera, cover: Cover, lines: Sequence[StartLine], wrong: Sequence[Contradiction]
) -> LineView:
    """Foam, panels and lines of one view, without labels."""
    tints = _PANELS[np.arange(len(cover.panel_names)) % len(_PANELS)]
    thin = Body(vertices=cover.positions, faces=cover.faces, colour=tints[cover.panel])
    view = LineView(camera, None if cover.foam is None else _solid(cover.foam), thin)
    borders = [
        Stroke(points=cover.positions[np.append(loop, loop[0])], colour=_OUTLINE, width=1.0)
        for loop in boundary_loops(cover.faces)
    ]
    # Seams last: they are what is looked at.
    ordered = sorted(lines, key=lambda line: line.kind == "seam")
    view.draw([*borders, *(stroke for line in ordered for stroke in _strokes(line))])
    for one in wrong:
        for place in one.places:
            view.ring(place, _WRONG)
    return view


def _solid(foam: Foam) -> Body:
    colour = np.tile(_FOAM, (len(foam.faces), 1))
    return Body(vertices=foam.vertices, faces=foam.faces, colour=colour)


def _strokes(line: StartLine) -> list[Stroke]:
    """Both sides of a line, and some of its ties."""
    colour = _colour(line)
    count = int(np.clip(line.length.sum() / _APART, _FEWEST, _MOST))
    chosen = np.unique(np.linspace(0, len(line.start) - 1, count).astype(np.int64))
    ties = [
        Stroke(points=np.stack([line.start[k], line.end[k]]), colour=colour, width=1.0)
        for k in chosen
    ]
    own = 3.0 if line.kind == "seam" else 2.0
    other = 3.0 if line.kind == "seam" else 4.0
    return [
        *ties,
        Stroke(points=line.start, colour=colour, width=own),
        Stroke(points=line.end, colour=colour, width=other),
    ]


def _colour(line: StartLine) -> Colour:
    if line.kind == "seam":
        return SEAM_COLOURS[(int(line.number) - 1) % len(SEAM_COLOURS)]
    return _HOOK if line.kind == "hook" else _FRAME


def _labels(
    cover: Cover, lines: Sequence[StartLine], wrong: Sequence[Contradiction]
) -> list[tuple[FloatArray, Label]]:
    """Labels with the places (3,) that they belong to: first what is wrong, last the panels."""
    labels = [
        (place, Label(head=f"!{number}", colour=_WRONG))
        for number, one in enumerate(wrong, start=1)
        for place in one.places[:1]
    ]
    labels += [
        (ln.middle, Label(head=ln.number, text=f"{1e3 * ln.gap:.0f}", colour=_colour(ln)))
        for ln in lines
    ]
    for number, name in enumerate(cover.panel_names):
        middle = cover.positions[cover.faces[cover.panel == number]].mean(axis=(0, 1))
        labels.append((middle, Label(text=name, colour=_NAME)))
    return labels


def _labelled(
    view: LineView, labels: Sequence[tuple[FloatArray, Label]], hidden: npt.NDArray[np.bool_]
) -> Pillow.Image:
    """The finished view, with the labels that it does not hide."""
    picture = view.picture()
    seen = [
        replace(label, at=view.camera.pixel(place))
        for (place, label), behind in zip(labels, hidden, strict=True)
        if not behind
    ]
    draw_labels(picture, seen, np.asarray(view.lines) > 0, size=_TEXT)
    text = view.camera.name.replace("_34", " three-quarter").replace("_", " ")
    ImageDraw.Draw(picture).text((4, 4), text, font=font(_TEXT), fill=_FRAME)
    return picture


def _legend(lines: Sequence[StartLine], wrong: Sequence[Contradiction]) -> Pillow.Image:
    """Every number with name, mean and largest gap, in columns; below it what is wrong."""
    width = _WIDTH - 2 * _EDGE
    rows = [Label(head=ln.number, text=_entry(ln), colour=_colour(ln)) for ln in lines]
    longest = max(
        (width_of(r.head, _TEXT, bold=True) + width_of(r.text, _TEXT) for r in rows), default=1.0
    )
    columns = max(1, min(4, int(width // (longest + 40))))
    per_column = -(-len(rows) // columns)
    letters = int(width / width_of("n", _TEXT)) - 6
    notes = [
        (f"!{number}" if k == 0 else "", text)
        for number, one in enumerate(wrong, start=1)
        for k, text in enumerate(
            textwrap.wrap(
                f"{one.name}: {one.problem.got}; expected {one.problem.expected}", letters
            )
        )
    ]
    picture = Pillow.new("RGB", (width, _ROW * (per_column + len(notes)) + 4), PAPER)
    draw = ImageDraw.Draw(picture)
    for k, row in enumerate(rows):
        column, line = divmod(k, per_column)
        draw_label(draw, row, (column * (width // columns), _ROW * line + 2), _TEXT)
    for k, (head, text) in enumerate(notes):
        corner = (0.0, float(_ROW * (per_column + k) + 2))
        draw_label(draw, Label(head=head, text=text, colour=_WRONG), corner, _TEXT)
    return picture


def _entry(line: StartLine) -> str:
    name = line.name if line.target in ("", line.name) else f"{line.name} to {line.target}"
    return f"{name}: {1e3 * line.gap:.0f} mm, up to {1e3 * line.gaps.max():.0f}"
