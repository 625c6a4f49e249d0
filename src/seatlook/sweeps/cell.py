"""One cell of a sweep: a pure function of a JSON text to files named by its content."""

from __future__ import annotations

import hashlib
import io as streams
import json
from collections.abc import Iterator
from dataclasses import asdict, dataclass
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from seatlook import files, io
from seatlook._version import __version__
from seatlook.assembly import assemble
from seatlook.assembly.digest import content_digest
from seatlook.chain.case import Case
from seatlook.chain.draw import Canvas, draw_pictures
from seatlook.chain.files import picture_paths
from seatlook.errors import InputError, did_you_mean
from seatlook.io.sweep import Sweep, Tolerance
from seatlook.model import Cover, FloatArray
from seatlook.model.progress import silent
from seatlook.solver import SETTINGS
from seatlook.sweeps.irregularity import draw, irregular

_SAYS = 2  # raised when what a cell says of its cover changes


@dataclass(frozen=True, slots=True, kw_only=True)
class Cell:
    """One cell: its name (a digest of everything it depends on) and its JSON text."""

    name: str
    spec: str

    @property
    def settings(self) -> dict[str, Any]:
        """What the cell is of: variant, changes, values of the irregular inputs."""
        return {k: v for k, v in json.loads(self.spec).items() if k != "scene"}

    @property
    def group(self) -> str:
        """Variant and changes in words: what irregular covers have in common."""
        return " ".join(self._words) or "the scene"

    @property
    def label(self) -> str:
        """What the cell is of in words: variant, changes, values of the irregular inputs."""
        settings = self.settings
        pairs = zip(settings["inputs"], settings["values"] or (), strict=False)
        values = [f"{tolerance['name']}={value:.3g}" for tolerance, value in pairs]
        return " ".join([*self._words, *values]) or "the scene"

    @property
    def _words(self) -> list[str]:
        settings = self.settings
        return [word for word in (settings["variant"], *settings["set"]) if word]


def plan(sweep: Sweep) -> tuple[Cell, ...]:
    """List all cells of a sweep, every scene read and checked.

    Raises
    ------
    InputError
        The first scene that cannot be read with its changes, with all of its problems.
    """
    return tuple(_cells(sweep))


def _cells(sweep: Sweep) -> Iterator[Cell]:
    drawn = draw(sweep.inputs, sweep.draws, sweep.seed) if sweep.draws else None
    for variant, (path, changes) in sweep.variants.items():
        for values in product(*sweep.axes.values()):
            words = (*changes, *(f"{k}={v}" for k, v in zip(sweep.axes, values, strict=True)))
            scene = io.load_scene(path, changes=words)
            for chosen, known in ((sweep.textures, scene.textures), (sweep.rigs, scene.rigs)):
                _check(chosen, known, sweep.path)
            irregular(scene, sweep.inputs, [0.0] * len(sweep.inputs))
            base: dict[str, Any] = {
                "variant": variant, "scene": str(path.resolve()), "set": list(words),
                "textures": list(sweep.textures), "rigs": list(sweep.rigs),
                "inputs": [asdict(i) for i in sweep.inputs],
            }  # fmt: skip
            digest = content_digest(scene)
            for row in [None] if drawn is None else drawn.tolist():
                yield _named({**base, "values": row}, digest)


def _check(chosen: tuple[str, ...], known: Any, path: Path) -> None:
    names = tuple(getattr(k, "name", k) for k in known)
    for name in chosen:
        if name not in names:
            raise InputError.single(
                "draw", got=repr(name), expected=f"one of {', '.join(names)}", file=path,
                hint=did_you_mean(name, names),
            )  # fmt: skip


def _named(spec: dict[str, Any], digest: str) -> Cell:
    # The digest stands for the contents of all files; where they lie does not matter.
    content = {k: v for k, v in spec.items() if k != "scene"} | {
        "digest": digest, "solver": SETTINGS, "version": __version__, "says": _SAYS,
    }  # fmt: skip
    text = json.dumps(content, sort_keys=True)
    return Cell(
        name=hashlib.sha256(text.encode()).hexdigest()[:20], spec=json.dumps(spec, sort_keys=True)
    )


def finished(cell: Cell, folder: Path) -> bool:
    """Whether a cell is done; its JSON file is written last, in one step."""
    return (folder / f"{cell.name}.json").exists()


def failed(cell: Cell, folder: Path) -> bool:
    """Whether the last try of a cell ended in an error."""
    return not finished(cell, folder) and _failure(folder, cell.name).exists()


def _failure(folder: Path, name: str) -> Path:
    return folder / f"{name}.failed.json"


def run_cell(name: str, spec: str, folder: str) -> str:
    """Solve, judge and draw one cell; return "" or what went wrong.

    Leaves ``NAME.npy`` (W2 of the cover as drawn, face by face), pictures in ``NAME/`` and, last,
    ``NAME.json``; or ``NAME.failed.json``. The same text gives the same bytes, wherever it runs.
    """
    out = Path(folder)
    for half in out.glob(f".{name}*"):
        half.unlink()  # of an earlier run that was killed while it wrote
    failure = _failure(out, name)
    try:
        _run(name, json.loads(spec), out)
    except Exception as error:  # one bad cell must not stop the others
        what = f"{type(error).__name__}: {error}"
        files.write_text(failure, json.dumps({"cell": name, "error": what}, indent=1) + "\n")
        return what
    failure.unlink(missing_ok=True)
    return ""


def _run(name: str, spec: dict[str, Any], out: Path) -> None:
    drawn = io.load_scene(spec["scene"], changes=spec["set"])
    inputs = [Tolerance(**i) for i in spec["inputs"]]
    values = spec["values"]
    made = drawn if values is None else irregular(drawn, inputs, values)
    case = Case(made)
    solution = case.solve()
    nominal = case.cover if values is None else assemble(drawn)
    w2 = carried(case.assessment.indices.w2, case.cover, nominal)
    _write_array(out / f"{name}.npy", w2)
    if spec["textures"] and spec["rigs"]:
        canvas = Canvas(solution=solution, camera=case.camera(None), out=out / name, run=name)
        part = case.narrowed(spec["textures"], spec["rigs"])
        draw_pictures(part, canvas, silent, paths=picture_paths(made))
    result = {
        "cell": name,
        **{k: v for k, v in spec.items() if k != "scene"},
        "status": case.resolution.status,
        "reason": case.resolution.reason,
        "zones": [row.values() for row in case.assessment.zones],
    }
    files.write_text(out / f"{name}.json", json.dumps(result, indent=1, sort_keys=True) + "\n")


def carried(values: FloatArray, cover: Cover, onto: Cover) -> FloatArray:
    """Values (m,) of a cover's faces at those of another mesh of the same panels.

    The nearest face of the same panel in pattern coordinates.
    """
    out = np.empty(len(onto.faces))
    for number in range(len(onto.panel_names)):
        here, there = cover.panel == number, onto.panel == number
        tree = cKDTree(cover.uv[cover.faces[here]].mean(axis=1))
        out[there] = values[here][tree.query(onto.uv[onto.faces[there]].mean(axis=1))[1]]
    return out


def _write_array(path: Path, values: FloatArray) -> None:
    buffer = streams.BytesIO()
    np.save(buffer, values.astype(np.float32), allow_pickle=False)
    files.write_bytes(path, buffer.getvalue())
