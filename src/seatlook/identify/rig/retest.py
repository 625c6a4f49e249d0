"""Every test once more, in the virtual rig, with the material that was identified from it."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from seatlook.identify.bias import Frame, strip_force
from seatlook.identify.fit import Unknowns, drift_rows, drifted, fit
from seatlook.identify.rig import sheets
from seatlook.identify.tensile import record
from seatlook.io.laboratory.types import LabTest, Specimen
from seatlook.mesh import arc_length
from seatlook.model import Fabric, FloatArray

_STATIONS = 9  # of the rig on every way out and back
_TIGHTEST = 150.0  # 1/m: B is read up to here, and beyond a cloth is thick for its radius
_AXES = ("warp", "weft")


@dataclass(frozen=True, slots=True, kw_only=True)
class Retest:
    """A test, measured and in the rig.

    Parameters
    ----------
    dots : (k, 2) float64   what was measured, each specimen without its own slack, zero and drift
    line : (m, 2) float64   what the rig reads
    rms : of the dots from the line, over the peak
    """

    title: str
    x_name: str
    y_name: str
    dots: FloatArray
    line: FloatArray
    rms: float


def retest(test: LabTest, fabric: Fabric) -> Retest | None:
    """Run one test in the virtual rig; None for a kind that has no curve of the cloth."""
    run = _RUNS.get(test.kind)
    if run is None or (test.direction == "bias" and test.kind != "bias-extension"):
        return None
    return run(test, fabric)


def _tension(test: LabTest, fabric: Fabric) -> Retest:
    records = [record(one) for one in test.specimens]
    top = min(float(one.e.max()) for one in records)
    out = np.linspace(0.0, top, _STATIONS)
    back = np.linspace(top, 0.0, _STATIONS)[1:] if records[0].returns else np.zeros(0)
    path = np.concatenate([out, back])
    axis = _AXES.index(str(test.direction))
    F = sheets.pull(fabric, axis, path[1:], held=test.sides == "held")
    F = np.maximum(np.append(0.0, F), 0.0)
    dots, rests = [], []
    for one in records:

        def read(own: FloatArray, e: FloatArray = one.e, turn: int = one.turn) -> FloatArray:
            return _along(e - own[0], turn, path, F, _STATIONS - 1) + drifted(own[1:], len(e))

        limit = max(0.3 * float(one.e.max()), 1e-9)
        rows = Unknowns.rows((0.0, 0.0, limit, 0.002, np.inf), *drift_rows(float(np.ptp(one.F))))
        own = fit(read, one.F, rows).values
        clean = one.F - drifted(own[1:], len(one.F))
        dots.append(np.column_stack([one.e - own[0], clean]))
        rests.append((one.F - read(own)) / np.ptp(one.F))
    return _made(test, ("strain", "force [N/m]"), dots, np.column_stack([path, F]), rests)


def _shear(test: LabTest, fabric: Fabric) -> Retest:
    pull = test.numbers["pretension_n_per_m"]
    return _loops(test, ("shear, 2 E12", "force [N/m]"), lambda path: sheets.shear(fabric, path),
                  lambda one: (np.tan(one.x), one.y), pull)  # fmt: skip


def _bending(test: LabTest, fabric: Fabric) -> Retest:
    """The solver bends elastically: the mean of both ways is compared."""
    axis = _AXES.index(str(test.direction))
    top = min(_TIGHTEST, *(float(np.abs(one.x).max()) for one in test.specimens))
    out = np.linspace(0.0, top, 5)[1:]
    moment = sheets.bend(fabric, axis, out)
    line = np.column_stack([np.concatenate([-out[::-1], [0.0], out]),
                            np.concatenate([-moment[::-1], [0.0], moment])])  # fmt: skip
    dots, rests = [], []
    for one in test.specimens:
        x, y = one.x, one.y * np.sign(np.polyfit(one.x, one.y, 1)[0])
        # Near 0 the first way out is that of a piece whose friction has not built up.
        side = np.linspace(0.25 * top, top, 8)
        grid = np.concatenate([-side[::-1], side])
        ways = [np.interp(grid, x[way][order], y[way][order])
                for way in _ways(x) for order in [np.argsort(x[way])]]  # fmt: skip
        mean = np.mean(ways, axis=0)
        mean = mean - mean.mean()
        dots.append(np.column_stack([grid, mean]))
        rests.append((mean - np.interp(grid, *line.T)) / np.ptp(mean) * 2.0)
    return _made(test, ("curvature [1/m]", "mean moment [N]"), dots, line, rests)


def _ways(x: FloatArray) -> list[np.ndarray]:
    """The way from the largest to the smallest value, and what is longest of the rest."""
    high, low = int(x.argmax()), int(x.argmin())
    first, last = min(high, low), max(high, low)
    down = np.arange(first, last + 1)
    after, before = np.arange(last, len(x)), np.arange(0, first + 1)
    return [down, np.concatenate([after, before])]


def _cantilever(test: LabTest, fabric: Fabric) -> Retest:
    axis = _AXES.index(str(test.direction))
    pairs = np.array([(x, y) for one in test.specimens for x, y in zip(one.x, one.y, strict=True)])
    angles = []
    for length in pairs[:, 0]:
        tip = sheets.hang(fabric, axis, float(length))[-1]
        angles.append(np.arctan2(tip[1], tip[0]))
    line = np.column_stack([pairs[:, 0], angles])
    line = line[np.argsort(line[:, 0])]
    rest = (pairs[:, 1] - np.array(angles)) / pairs[:, 1].max()
    return _made(test, ("overhang [m]", "angle [rad]"), [pairs], line, [rest])


def _outline(test: LabTest, fabric: Fabric) -> Retest:
    axis = _AXES.index(str(test.direction))
    dots, rests, line = [], [], np.zeros((0, 2))
    for one in test.specimens:
        points = np.column_stack([np.abs(one.x - one.x[0]), np.abs(one.y - one.y[0])])
        at = arc_length(points)
        line = sheets.hang(fabric, axis, float(at[-1]))
        share = arc_length(line)
        hung = np.column_stack([np.interp(at, share, line[:, i]) for i in range(2)])
        dots.append(points)
        rests.append(np.linalg.norm(points - hung, axis=1) / points[:, 1].max())
    return _made(test, ("along [m]", "down [m]"), dots, line, rests)


def _bias(test: LabTest, fabric: Fabric) -> Retest:
    """By the energy that the jaws put in: the rig's meshes do not turn as far as yarns do."""
    assert test.length is not None
    assert test.width is not None
    top = max(float(np.abs(one.x).max()) for one in test.specimens)
    x = np.linspace(0.0, top, 60)
    line = np.column_stack([x, strip_force(Frame(test.length, test.width), fabric.shear, x)])
    dots = [np.column_stack([np.abs(one.x), np.abs(one.y)]) for one in test.specimens]
    rests = [(d[:, 1] - np.interp(d[:, 0], *line.T)) / d[:, 1].max() for d in dots]
    return _made(test, ("displacement [m]", "force [N]"), dots, line, rests)


_RUNS: dict[str, Callable[[LabTest, Fabric], Retest]] = {
    "tensile": _tension,
    "shear": _shear,
    "bending": _bending,
    "cantilever": _cantilever,
    "hanging-strip": _outline,
    "bias-extension": _bias,
}


def _loops(
    test: LabTest,
    names: tuple[str, str],
    run: Callable[[FloatArray], FloatArray],
    read: Callable[[Specimen], tuple[FloatArray, FloatArray]],
    pull: float,
) -> Retest:
    """Run the path of the first specimen, and compare all along their own order."""
    pairs = [read(one) for one in test.specimens]
    pairs = [(x * np.sign(x[int(np.abs(x).argmax())]), y) for x, y in pairs]
    path = pairs[0][0]
    y = run(path) + pull * path
    dots, rests = [], []
    for x, reading in pairs:
        reading = reading * np.sign(np.polyfit(x, reading, 1)[0])
        if len(x) != len(path):
            continue
        peak = float(np.abs(reading).max())
        rows = Unknowns.rows(*drift_rows(peak))
        own = fit(lambda values: y + drifted(values, len(y)), reading, rows).values
        clean = reading - drifted(own, len(x))
        dots.append(np.column_stack([x, clean]))
        rests.append((clean - y) / peak)
    return _made(test, names, dots, np.column_stack([path, y]), rests)


def _along(e: FloatArray, turn: int, path: FloatArray, F: FloatArray, top: int) -> FloatArray:
    """Rig's force at the strains of a record: out up to ``turn``, then on the way back."""
    out = np.interp(e, path[: top + 1], F[: top + 1])
    if len(path) > top + 1:
        back = np.interp(e, path[top:][::-1], F[top:][::-1])
        out = np.where(np.arange(len(e)) > turn, back, out)
    return np.asarray(out)


def _made(
    test: LabTest, names: tuple[str, str], dots: list[FloatArray], line: FloatArray,
    rests: list[FloatArray],
) -> Retest:  # fmt: skip
    rms = float(np.sqrt(np.mean(np.concatenate(rests) ** 2)))
    return Retest(title=test.title, x_name=names[0], y_name=names[1],
                  dots=np.concatenate(dots), line=line, rms=rms)  # fmt: skip


def retests(tests: tuple[LabTest, ...], fabric: Fabric) -> Iterator[Retest]:
    """Run all tests that have a curve of the cloth."""
    for test in tests:
        made = retest(test, fabric)
        if made is not None:
            yield made
