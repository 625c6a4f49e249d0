"""Edits of the seams file: sewn by picking, turned, renamed, eased, taken out."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from seatlook.errors import InputError
from seatlook.io.toml_edit import add_row, add_table, drop, put
from seatlook.model import Panel, Pattern
from seatlook.studio.edits.draft import Draft, Edit, Gone, wanted
from seatlook.studio.pattern_state import millimetres, steps_of
from seatlook.studio.picking import nearest_corner, panel_of, place_of, stretch_between

_SNAP = 0.002  # m, as far as the seams file is read


def add(draft: Draft, edit: Edit) -> None:
    """Sew a side to another one: ``first`` and ``second`` name edges, or a panel and two ends."""
    sides = [_edges(draft, wanted(edit, side, dict), side) for side in ("first", "second")]
    first, second = sides if len(sides[0]) == 1 else sides[::-1]
    if len(first) != 1:
        raise InputError.single(
            "seam", got="several edges on both sides", expected="one edge on one of them",
            hint="split it where the corners meet, into two seams",
        )  # fmt: skip
    if len(sides[0]) > 1 and edit.get("reverse", True):
        second = second[::-1]  # seen from the other side a chain is met from its other end
    pattern = draft.pattern
    _refuse_sewn(pattern, [*first, *second])
    lengths = [1e3 * sum(pattern.edge_length(e) for e in side) for side in (first, second)]
    row = {
        "name": edit.get("name") or _seam_name(pattern, first[0], second),
        "a": first[0],
        "b": list(second),
        "reverse": bool(edit.get("reverse", True)),
        "length_mm": round(lengths[0], 3),
        "length_b_mm": round(lengths[1], 3),
    }
    comment = edit.get("comment", "")
    draft.change(draft.named("pattern", "seams"), lambda text: add_row(text, "seam", row, comment))


def remove(draft: Draft, edit: Edit) -> None:
    """Take a seam out, and what hooks or stages do with it; its edges stay."""
    name = wanted(edit, "name", str)
    number = _number(draft.pattern, name)
    draft.change(draft.named("pattern", "seams"), lambda text: drop(text, ("seam", number)))
    for k, stage in enumerate(draft.data.get("stage", [])):
        own = stage.get("seams", [])
        if name in ([own] if isinstance(own, str) else own):
            draft.put(("stage", k, "seams"), [one for one in own if one != name] or None)
    for k, hook in reversed([*enumerate(draft.data.get("hook", []))]):
        chain = [one for one in hook.get("chain", []) if one != name]
        if hook.get("line") == name or ("chain" in hook and not chain):
            draft.put(("hook", k), None)
        elif chain != hook.get("chain", []):
            draft.put(("hook", k, "chain"), chain)
            if "junctions_mm" in hook:
                draft.put(("hook", k, "junctions_mm"), None)


def turn(draft: Draft, edit: Edit) -> None:
    """Sew a seam the other way round."""
    number = _number(draft.pattern, wanted(edit, "name", str))
    reverse = not draft.pattern.seams[number].reverse
    far = list(draft.pattern.seams[number].b)[::-1]

    def turned(text: str) -> str:
        text = put(text, ("seam", number, "reverse"), reverse)
        return text if len(far) == 1 else put(text, ("seam", number, "b"), far)

    draft.change(draft.named("pattern", "seams"), turned)


def rename(draft: Draft, edit: Edit) -> None:
    """Give a seam another name, in the hooks and stages that name it as well."""
    old, new = wanted(edit, "name", str), wanted(edit, "to", str).strip()
    number = _number(draft.pattern, old)
    if not new or new in {seam.name for seam in draft.pattern.seams} - {old}:
        raise InputError.single("seam.rename", got=repr(new), expected="a name that no seam has")
    draft.change(
        draft.named("pattern", "seams"), lambda text: put(text, ("seam", number, "name"), new)
    )
    for table, key in (("stage", "seams"), ("hook", "line"), ("hook", "chain")):
        for k, row in enumerate(draft.data.get(table, [])):
            value = row.get(key)
            if value == old:
                draft.put((table, k, key), new)
            elif isinstance(value, list) and old in value:
                draft.put((table, k, key), [new if one == old else one for one in value])


def change(draft: Draft, edit: Edit) -> None:
    """Set a key of a seam, such as ``pitch_mm``."""
    number = _number(draft.pattern, wanted(edit, "name", str))
    key, value = wanted(edit, "key", str), edit.get("value")

    def changed(text: str) -> str:
        at = ("seam", number, key)
        return drop(text, at) if value is None else put(text, at, value)

    draft.change(draft.named("pattern", "seams"), changed)


def accept(draft: Draft, edit: Edit) -> None:
    """Sew what was guessed."""
    guess = draft.guesses.get(wanted(edit, "id", str))
    if guess is None:
        raise Gone(f"there is no guess {edit['id']} any more")
    comment = f"probability {guess['probability']:.2f}: {guess['reason']}"
    add(draft, {**edit, **{k: guess[k] for k in ("first", "second")}, "comment": comment})


def _edges(draft: Draft, side: Mapping[str, Any], name: str) -> list[str]:
    """Edges of one side; those that have no name yet get one in the seams file."""
    pattern = draft.pattern
    given = [side["edge"]] if isinstance(side.get("edge"), str) else side.get("edges")
    points = side.get("points_mm")
    if isinstance(given, list) and given and all(edge in pattern.edges for edge in given):
        return [str(edge) for edge in given]
    if isinstance(points, list) and len(points) > 1:
        parts = [{"panel": side.get("panel"), **_ends(part)} for part in points]
        return [edge for part in parts for edge in _edges(draft, part, name)]
    if isinstance(points, list) and len(points) == 1:
        side = {**side, **_ends(points[0])}
    panel = panel_of(pattern, side.get("panel"))
    ends = [_corner(panel, side, key) for key in ("from_mm", "to_mm")]
    if ends[0] == ends[1]:
        raise InputError.single(f"{name}.to_mm", got="the place of from_mm", expected="another")
    via = place_of(side, "via_mm") if "via_mm" in side else None
    stretch = stretch_between(panel, ends, via).along
    for edge in pattern.edges.values():
        if edge.panel == panel.name and (edge.start, edge.end) == stretch:
            return [edge.name]
    return [_new_edge(draft, panel, stretch)]


def _ends(points: Any) -> dict[str, Any]:
    return {"from_mm": points[0], "to_mm": points[-1], "via_mm": points[len(points) // 2]}


def _corner(panel: Panel, side: Mapping[str, Any], key: str) -> int:
    """Corner of a panel at a place [mm]."""
    corner, away = nearest_corner(panel, place_of(side, key))
    if away > _SNAP:
        raise InputError.single(
            key, got=repr(side[key]), expected=f"a corner or turn point of {panel.name}"
        )
    return corner


def _new_edge(draft: Draft, panel: Panel, ends: tuple[int, int]) -> str:
    """Name a stretch of a panel that has no name yet."""
    places = millimetres(panel.outline[list(ends)])
    name = _edge_name(draft.pattern, panel, ends)
    row = {"panel": panel.name, "from_mm": places[0], "to_mm": places[1]}
    draft.change(draft.named("pattern", "seams"), lambda text: add_table(text, ("edge", name), row))
    return name


_SIDES = ("right", "top-right", "top", "top-left", "left", "bottom-left", "bottom", "bottom-right")


def _edge_name(pattern: Pattern, panel: Panel, ends: tuple[int, int]) -> str:
    """Panel and the way its edge faces, and the corner it starts at where that is taken."""
    chord = panel.outline[ends[1]] - panel.outline[ends[0]]
    outward = np.arctan2(chord[1], chord[0]) - np.pi / 2
    name = f"{panel.name}.{_SIDES[round(outward / (np.pi / 4)) % 8]}"
    if name in pattern.edges:
        x, y = np.round(1e3 * panel.outline[ends[0]]).astype(int)
        name = f"{name} from {x} {y}"
    return name


def _seam_name(pattern: Pattern, first: str, second: Sequence[str]) -> str:
    """Panels of a seam, and the edge it begins at where another seam has the same."""
    panels = dict.fromkeys(pattern.edges[name].panel for name in (first, *second))
    name = "-".join(panels)
    if any(seam.name == name for seam in pattern.seams):
        name = f"{name}.{first}"
    return name


def _number(pattern: Pattern, name: str) -> int:
    for number, seam in enumerate(pattern.seams):
        if seam.name == name:
            return number
    raise Gone(f"there is no seam {name!r} any more")


def _refuse_sewn(pattern: Pattern, edges: Sequence[str]) -> None:
    """Refuse stretches that are sewn already, and one that is sewn to itself."""
    steps = [step for name in edges for step in steps_of(pattern, name)]
    if len(set(steps)) < len(steps):
        raise InputError.single("seam", got="a line sewn to itself", expected="two lines")
    for seam in pattern.seams:
        for name in (seam.a, *seam.b):
            if {*steps} & {*steps_of(pattern, name)}:
                raise InputError.single(
                    "seam", got=f"{' + '.join(edges)}", expected="lines that are not sewn yet",
                    hint=f"{name} is sewn in {seam.name!r}: take that seam out first",
                )  # fmt: skip
