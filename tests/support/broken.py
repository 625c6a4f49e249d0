"""Seats of the family, each spoiled in the seven ways that no solve can mend."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass, replace
from itertools import combinations, pairwise
from pathlib import Path
from types import MappingProxyType

import numpy as np

from seatlook import io, mesh, model
from seatlook.assembly import assemble
from seatlook.assembly.contradictions import contradictions, out_of_scale
from seatlook.chain.start.scene_file import write_scene
from seatlook.chain.start.surface import scene_from
from seatlook.flattening.lie import read_lie
from seatlook.seats import write_demo

APART = (0.032, 0.040)  # m, of frame curves where panels are sewn together
OFF = 0.002  # m, of two hooks at a junction
OTHER_SIDE = (0.100, 0.250)  # m, of a seam from a wire that is not its own
# Where exchanged partners lie beside each other, their ends no longer meet.
_EXCHANGED = ("exchanged seams", "ties apart")
_EXCHANGED_HOOKS = ("hook far", "ties apart")
_SAME = 0.001  # m, of the ends of two seams that meet
_LIKE = 0.1  # share by which the sides of exchanged seams may differ in length


@dataclass(frozen=True)
class Spoiled:
    """A scene with one contradiction: what was done to it, and names one of which refuses it."""

    what: str
    names: tuple[str, ...]
    scene: model.Scene


class GoodSeat:
    """A seat as its files say: its scene, and where its seams lie on the design."""

    def __init__(self, folder: Path, **choices) -> None:
        """Write a seat of the family into a folder."""
        self.folder, self.shape = folder, choices["shape"]
        write_demo(folder, **choices)
        self.scene = io.load_scene(folder / "scene.toml")
        self.seams: Mapping[str, np.ndarray] = read_lie(folder / "placement.toml").seams

    def write(self, scene: model.Scene, folder: Path) -> Path:
        """Write a spoiled scene of this seat as files of its own."""
        for file in self.folder.iterdir():
            if file.is_file():
                (folder / file.name).write_bytes(file.read_bytes())
        draft = scene_from(folder, force=True, name=self.scene.name).draft
        body = replace(draft.foam.body, curves=scene.foam.curves)
        if scene.pattern is not self.scene.pattern:
            io.write_dxf(scene.pattern, draft.pattern)
            io.write_seams(scene.pattern, draft.seams)
        return write_scene(
            replace(
                draft,
                foam=replace(draft.foam, body=body),
                curves={},
                hooks=scene.hooks,
                frames=scene.frames,
                element_size_mm=1e3 * scene.element_size,
            ),
            folder,
        )


def curves_apart(seat: GoodSeat) -> Iterator[Spoiled]:
    """The border parted at its junctions, one piece moved down, away or along its edge."""
    scene = seat.scene
    (frame,) = scene.frames
    for apart in APART:
        for k, edge in enumerate(frame.edges):
            for way, move in _MOVES.items():
                pieces = _pieces(scene.foam.curves[frame.curve], frame.junctions)
                pieces[k] = move(pieces[k], apart, alone=len(pieces) == 1)
                spoiled = _framed(scene, frame, pieces)
                yield Spoiled(f"{edge} {1e3 * apart:.0f} mm {way}", ("ties apart",), spoiled)


def hooks_that_contradict(seat: GoodSeat) -> Iterator[Spoiled]:
    """Two seams that meet, each hooked to a wire of its own, 2 mm apart where they meet."""
    for one, two in _meeting(seat.seams):
        for way, off in (("down", [0.0, 0.0, -OFF]), ("aside", [OFF, 0.0, 0.0])):
            wires = {one: seat.seams[one], two: seat.seams[two] + off}
            yield Spoiled(f"{one}, {two} 2 mm {way}", ("ties apart",), _hooked(seat.scene, wires))
    for hook in _crossing_hooks(seat):
        wire = seat.scene.foam.curves[hook.wire] - [0.0, 0.0, OFF]
        curves = {**seat.scene.foam.curves, hook.wire: wire}
        yield Spoiled(f"{hook.name} 2 mm down", ("ties apart",), _curved(seat.scene, curves))


def hooks_to_the_other_side(seat: GoodSeat) -> Iterator[Spoiled]:
    """A seam hooked to a wire that lies below another seam."""
    for one, two in combinations(seat.seams, 2):
        start, wire = seat.seams[one], seat.seams[two]
        if not OTHER_SIDE[0] <= _apart(start, wire) <= OTHER_SIDE[1]:
            continue
        # A line longer than its wire is refused where the scene is read.
        for hook, other in sorted(
            [(one, two), (two, one)], key=lambda p: mesh.length(seat.seams[p[0]])
        )[:1]:
            spoiled = _hooked(seat.scene, {hook: seat.seams[other]})
            yield Spoiled(f"{hook} to {other}", ("hook far",), spoiled)
    yield from _own_hooks_to_other_places(seat)


def twisted_seams(seat: GoodSeat) -> Iterator[Spoiled]:
    """Every seam, one of its sides the other way round."""
    seams = seat.scene.pattern.seams
    for k, seam in enumerate(seams):
        turned = replace(seam, reverse=not seam.reverse)
        yield Spoiled(seam.name, ("twisted seam",), _sewn(seat.scene, _put(seams, {k: turned})))


def exchanged_partners(seat: GoodSeat) -> Iterator[Spoiled]:
    """Every two seams, each of which is about as long as the other's partner."""
    pattern = seat.scene.pattern
    for (i, one), (j, two) in combinations(enumerate(pattern.seams), 2):
        swap = {i: replace(one, b=two.b), j: replace(two, b=one.b)}
        if {one.a, *one.b} & {two.a, *two.b} or not _as_long(pattern, swap.values()):
            continue
        spoiled = _sewn(seat.scene, _put(pattern.seams, swap))
        yield Spoiled(f"{one.name}, {two.name}", _EXCHANGED, spoiled)


def curves_through_the_foam(seat: GoodSeat) -> Iterator[Spoiled]:
    """The border pulled in along each edge of it, 20 to 60 mm at the middle of the edge."""
    scene = seat.scene
    (frame,) = scene.frames
    middle = scene.foam.vertices.mean(axis=0)
    for deep in (0.02, 0.06):
        for k, edge in enumerate(frame.edges):
            pieces = _pieces(scene.foam.curves[frame.curve], frame.junctions)
            share = mesh.arc_length(pieces[k]) / mesh.length(pieces[k])
            inward = middle - pieces[k]
            inward /= np.linalg.norm(inward, axis=1, keepdims=True)
            pieces[k] = pieces[k] + deep * (np.sin(np.pi * share) ** 2)[:, None] * inward
            spoiled = _framed(scene, frame, pieces)
            yield Spoiled(f"{edge} {1e3 * deep:.0f} mm", ("curve inside",), spoiled)


def patterns_out_of_scale(seat: GoodSeat) -> Iterator[Spoiled]:
    """The pattern in another unit than the foam."""
    pattern = seat.scene.pattern
    for factor in (10.0, 0.1):
        panels = tuple(_scaled(panel, factor) for panel in pattern.panels)
        large = replace(pattern, panels=panels)
        yield Spoiled(f"{factor:g} times", ("scale",), replace(seat.scene, pattern=large))


SET_UPS: dict[str, Callable[[GoodSeat], Iterator[Spoiled]]] = {
    make.__name__: make
    for make in (
        curves_apart,
        hooks_that_contradict,
        hooks_to_the_other_side,
        twisted_seams,
        exchanged_partners,
        curves_through_the_foam,
        patterns_out_of_scale,
    )
}


def _crossing_hooks(seat):
    """Hooks of the scene that meet another one."""
    names = {line: hook.name for hook in seat.scene.hooks for line in hook.lines}
    met = [pair for pair in _meeting(seat.seams) if {*pair} <= {*names}]
    for hook in seat.scene.hooks:
        if any({names[a], names[b]} > {hook.name} for a, b in met):
            yield hook


def _own_hooks_to_other_places(seat):
    """Hooks of the scene with each other's wires, chains with two of their lines exchanged."""
    hooks = seat.scene.hooks
    for (i, one), (j, two) in combinations(enumerate(hooks), 2):
        if one.lines and len(one.lines) == len(two.lines) and _wires_apart(seat, one, two):
            swap = {
                i: replace(one, wire=two.wire, junctions=two.junctions),
                j: replace(two, wire=one.wire, junctions=one.junctions),
            }
            spoiled = replace(seat.scene, hooks=_put(hooks, swap))
            yield Spoiled(f"{one.name} and {two.name} exchanged", _EXCHANGED_HOOKS, spoiled)
    for k, hook in enumerate(hooks):
        for i, j in combinations(range(len(hook.chain)), 2):
            lines = [seat.seams[hook.chain[n]] for n in (i, j)]
            if not OTHER_SIDE[0] <= _apart(*lines):
                continue
            chain = list(hook.chain)
            chain[i], chain[j] = chain[j], chain[i]
            spoiled = _put(hooks, {k: replace(hook, chain=tuple(chain))})
            what = f"{hook.chain[i]} and {hook.chain[j]} exchanged"
            yield Spoiled(what, _EXCHANGED_HOOKS, replace(seat.scene, hooks=spoiled))


def _wires_apart(seat, one, two):
    curves = seat.scene.foam.curves
    return _apart(curves[one.wire], curves[two.wire]) >= OTHER_SIDE[0]


def refused_names(scene: model.Scene) -> set[str]:
    """Names of what a check refuses."""
    scale = out_of_scale(scene)
    return {one.name for one in scale or contradictions(scene, assemble(scene))}


def _down(piece, apart, *, alone):
    # Both ends of a ring are one point of the cover: only a slope parts them.
    share = mesh.arc_length(piece) / mesh.length(piece) if alone else np.ones(len(piece))
    return piece - apart * share[:, None] * [0.0, 0.0, 1.0]


def _away(piece, apart, *, alone):
    share = mesh.arc_length(piece) / mesh.length(piece) if alone else np.ones(len(piece))
    way = piece.mean(axis=0) * [1, 1, 0] if not alone else piece[0] * [1, 1, 0]
    return piece + apart * share[:, None] * way / np.linalg.norm(way)


def _along(piece, apart, *, alone):
    arc = mesh.arc_length(piece)
    at = np.linspace(apart, arc[-1], len(piece))
    return np.column_stack([np.interp(at, arc, column) for column in piece.T])


_MOVES = {"down": _down, "away": _away, "along": _along}


def _pieces(curve, junctions):
    """The pieces of a curve between junctions, with these at their ends."""
    arc = mesh.arc_length(curve)
    pieces = []
    for low, high in pairwise(junctions):
        at = np.concatenate([[low], arc[(arc > low + 1e-6) & (arc < high - 1e-6)], [high]])
        pieces.append(np.column_stack([np.interp(at, arc, column) for column in curve.T]))
    return pieces


def _framed(scene, frame, pieces):
    """Each edge of the frame with a curve and a frame of its own."""
    names = [f"frame {edge}" for edge in frame.edges]
    curves = {name: c for name, c in scene.foam.curves.items() if name != frame.curve}
    frames = tuple(
        replace(frame, name=name, edges=(edge,), curve=name, junctions=())
        for name, edge in zip(names, frame.edges, strict=True)
    )
    return _curved(
        replace(scene, frames=frames), {**curves, **dict(zip(names, pieces, strict=True))}
    )


def _hooked(scene, wires):
    """Seams hooked to wires of their own, whatever was hooked before."""
    hooks = tuple(
        model.Hook(name=f"hook {k}", line=seam, wire=f"wire {k}", stage="hook")
        for k, seam in enumerate(wires, start=1)
    )
    named = {f"wire {k}": points for k, points in enumerate(wires.values(), start=1)}
    frames = {f.curve: scene.foam.curves[f.curve] for f in scene.frames}
    return _curved(replace(scene, hooks=hooks), {**frames, **named})


def _curved(scene, curves):
    return replace(scene, foam=replace(scene.foam, curves=MappingProxyType(curves)))


def _sewn(scene, seams):
    return replace(scene, pattern=replace(scene.pattern, seams=seams))


def _put(seams, changes):
    return tuple(changes.get(k, seam) for k, seam in enumerate(seams))


def _meeting(seams):
    """Pairs of seams that have an end in common."""
    for one, two in combinations(seams, 2):
        ends = seams[one][[0, -1]][:, None] - seams[two][[0, -1]]
        if np.linalg.norm(ends, axis=2).min() < _SAME:
            yield one, two


def _apart(line, wire):
    """Mean distance of two lines, run through from the nearer ends."""
    one, two = (_sampled(points) for points in (line, wire))
    return min(float(np.linalg.norm(one - other, axis=1).mean()) for other in (two, two[::-1]))


def _sampled(points):
    arc = mesh.arc_length(points)
    at = np.linspace(0.0, arc[-1], 25)
    return np.column_stack([np.interp(at, arc, column) for column in points.T])


def _as_long(pattern, seams):
    """Whether the sides of seams are equally long, to a tenth."""
    for seam in seams:
        a = pattern.edge_length(seam.a)
        b = sum(pattern.edge_length(edge) for edge in seam.b)
        if abs(a - b) > _LIKE * max(a, b):
            return False
    return True


def _scaled(panel, factor):
    lines = {name: factor * line for name, line in panel.internal_lines.items()}
    return replace(
        panel,
        outline=factor * panel.outline,
        cut_outline=factor * panel.cut_outline,
        holes=tuple(factor * hole for hole in panel.holes),
        notches=tuple(replace(n, position=factor * n.position) for n in panel.notches),
        internal_lines=MappingProxyType(lines),
    )
