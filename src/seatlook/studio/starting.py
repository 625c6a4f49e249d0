"""How a seat begins: a demo shape, a design surface, or a pattern and its foam.

All is made in a folder of its own first, and put in place when it is whole, the scene last.
"""

from __future__ import annotations

import shutil
import tempfile
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any, cast

import numpy as np

from seatlook import io
from seatlook.assembly.seam_guess import propose_seams
from seatlook.chain.start import flatten_scene, init
from seatlook.chain.start.pattern import SEAMS, StartChoices
from seatlook.chain.start.scene_file import CURVES, SCENE
from seatlook.errors import InputError
from seatlook.flattening.files import FlattenChoices, read_design
from seatlook.io.pattern.dxf import Reading
from seatlook.seats.files import write_demo
from seatlook.studio.folder import OWN, Folder
from seatlook.studio.keeping.durable import put_in_place, sync_folder
from seatlook.studio.pattern_state import Values

UPLOADS = f"{OWN}/uploads"
_READING = ("size", "units", "encoding", "grain_deg", "allowance_mm", "layers")
_FOAM = ("unit", "up")
_DEMO = {"shape", "scale", "bolster", "material", "insert", "element_size_mm", "seed", "tension"}


def preview(folder: Folder, asked: Mapping[str, Any]) -> Values:
    """Say what would be read of the files of a start, and what not, with the reason.

    Raises
    ------
    InputError
        A file that cannot be read.
    """
    files = _files(folder, asked)
    notes: list[str] = []
    values: Values = {"notes": notes, "left_out": [], "pieces": []}
    if "pattern" in files:
        values |= _pattern_preview(files["pattern"], asked)
    if "surface" in files:
        form = read_design(
            files["surface"], unit=asked.get("surface_unit"), up=asked.get("surface_up"),
            seam_lines=files.get("lines"),
        )  # fmt: skip
        values["surface_mm"] = _extent(form.vertices)
        values["pieces"] = [{"name": name} for name in form.panel_names]
    if "foam" in files:
        surface = io.read_foam_surface(files["foam"], unit=asked.get("unit"), up=asked.get("up"))
        values["foam_mm"] = _extent(surface.vertices)
        values["foam_axes"] = {"unit": surface.axes.unit, "up": surface.axes.up}
        notes += [
            f"foam: {one.number} {one.what} at {surface.axes.place(one.place)}"
            for one in surface.mended
        ]
    if "wires" in files:
        values["wires"] = list(io.read_curves(files["wires"]))
    return values


def start(folder: Folder, asked: Mapping[str, Any]) -> Callable[[Path], list[str]]:
    """Make the files of a seat, and return what puts them into the folder.

    Parameters
    ----------
    asked : ``kind`` is "demo", "surface" or "pattern"; ``guesses`` "ask" leaves the seams of a
        pattern to be accepted one by one

    Raises
    ------
    InputError
        A scene is there already and ``force`` is not set; files that cannot be read.
    """
    if folder.scene is not None and not asked.get("force"):
        raise InputError.single(
            "start", got=f"a folder with {folder.scene}", expected="an empty one",
            hint="start in another folder, or replace this scene",
        )  # fmt: skip
    kinds = {"demo": _demo, "surface": _surface, "pattern": _pattern}
    kind = asked.get("kind")
    if not isinstance(kind, str) or kind not in kinds:
        raise InputError.single("kind", got=repr(kind), expected=f"one of {', '.join(kinds)}")
    own = folder.inside(OWN)
    own.mkdir(parents=True, exist_ok=True)
    made = Path(tempfile.mkdtemp(dir=own, prefix="start-"))
    try:
        kinds[kind](made, _files(folder, asked), asked)
    except BaseException:
        shutil.rmtree(made, ignore_errors=True)
        raise

    def put(root: Path) -> list[str]:
        try:
            return _move(made, root)
        finally:
            shutil.rmtree(made, ignore_errors=True)

    return put


def _demo(out: Path, files: Mapping[str, Path], asked: Mapping[str, Any]) -> None:
    choices = asked.get("choices", {})
    unknown = {*choices} - _DEMO
    if unknown:
        raise InputError.single(
            "choices", got=", ".join(sorted(unknown)), expected=f"of {', '.join(sorted(_DEMO))}"
        )
    write_demo(out, **choices)


def _surface(out: Path, files: Mapping[str, Path], asked: Mapping[str, Any]) -> None:
    own = _taken_along(out, files, "surface", "foam")
    flattening = FlattenChoices(unit=asked.get("surface_unit"), up=asked.get("surface_up"))
    if "lines" in own:
        flattening["seam_lines"] = own["lines"]
    if "tension_percent" in asked:
        flattening["tension"] = float(asked["tension_percent"]) / 100
    flatten_scene(
        own["surface"], own["foam"], out, flattening=flattening, wires=own.get("wires"),
        foam_unit=asked.get("unit"), foam_up=asked.get("up"),
        name=str(asked.get("name") or "seat"), force=True,
    )  # fmt: skip


def _pattern(out: Path, files: Mapping[str, Path], asked: Mapping[str, Any]) -> None:
    own = _taken_along(out, files, "pattern", "foam")
    choices = {key: asked[key] for key in (*_READING, *_FOAM, "top", "turn_deg") if key in asked}
    if "seams" in own:
        choices["seams"] = own["seams"]
    elif asked.get("guesses") == "ask":
        found = propose_seams(io.read_panels(own["pattern"], **_reading(asked))).pattern
        io.write_seams(replace(found, seams=()), out / SEAMS)
        choices["seams"] = out / SEAMS
    taken = cast("StartChoices", {**choices, "wires": own.get("wires"), "force": True})
    init(own["pattern"], own["foam"], out, **taken)


def _reading(asked: Mapping[str, Any]) -> Reading:
    width = asked.get("allowance_mm")
    return Reading(
        size=asked.get("size"), units=asked.get("units"), encoding=asked.get("encoding"),
        grain_deg=asked.get("grain_deg"), allowance=None if width is None else width / 1e3,
        layers=asked.get("layers") or {},
    )  # fmt: skip


def _pattern_preview(path: Path, asked: Mapping[str, Any]) -> Values:
    values: Values = {}
    if path.suffix.lower() == ".dxf":
        report = io.report_dxf(
            path, size=asked.get("size"), units=asked.get("units"),
            encoding=asked.get("encoding"), layers=asked.get("layers") or {},
        )  # fmt: skip
        values["mm_per_unit"] = report.mm_per_unit
        values["notes"] = list(dict.fromkeys(report.notes))
        values["left_out"] = [
            {"what": f"{count} {left.kind} on layer {left.layer}", "reason": left.reason}
            for left, count in sorted(report.left.items(), key=lambda item: str(item[0]))
        ]
    panels = io.read_panels(path, **_reading(asked))
    values["pieces"] = [
        {"name": panel.name, "size_mm": _extent(panel.outline), "notches": len(panel.notches)}
        for panel in panels
    ]
    return values


def _files(folder: Folder, asked: Mapping[str, Any]) -> dict[str, Path]:
    """Files that a start names: uploaded ones, or of the folder."""
    named = asked.get("files", {})
    if not isinstance(named, dict) or not all(isinstance(one, str) for one in named.values()):
        raise InputError.single("files", got=repr(named)[:80], expected="names of files")
    return {what: folder.inside(name) for what, name in named.items()}


def _taken_along(out: Path, files: Mapping[str, Path], *needed: str) -> dict[str, Path]:
    """Copy files into the folder of the seat, which then stands alone."""
    missing = [what for what in needed if what not in files]
    if missing:
        raise InputError.single("files", got=f"no {' and no '.join(missing)}", expected="both")
    own: dict[str, Path] = {}
    for what, path in files.items():
        name = path.name
        if name in (SCENE, CURVES, SEAMS) or name in {one.name for one in own.values()}:
            name = f"{what}-{name}"
        own[what] = out / name
        if not path.is_file():
            raise InputError.single(f"files.{what}", got=path.name, expected="an uploaded file")
        shutil.copyfile(path, own[what])
    return own


def _move(made: Path, root: Path) -> list[str]:
    """Put files in place, each whole, the scene after all that it names."""
    names = sorted(path.relative_to(made) for path in made.rglob("*") if path.is_file())
    names.sort(key=lambda name: name == Path(SCENE))
    for name in names:
        put_in_place({root / name: b""}, {root / name: made / name})
    sync_folder(root)
    return [name.as_posix() for name in names]


def _extent(points: np.ndarray[Any, np.dtype[np.float64]]) -> list[float]:
    return [round(1e3 * float(size), 1) for size in np.ptp(points, axis=0)]
