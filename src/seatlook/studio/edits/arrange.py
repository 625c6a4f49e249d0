"""The edit that lays the panels out anew from their seams, hooks them and frames their borders."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from seatlook.chain.start.pattern import Arrangement
from seatlook.chain.start.pattern import arrange as arranged
from seatlook.chain.start.scene_file import COVER, CURVES, HOOK
from seatlook.errors import InputError
from seatlook.io.toml_edit import add_row, drop, put
from seatlook.model import FloatArray, Foam, Frame, Hook
from seatlook.studio.edits.draft import Draft, Edit
from seatlook.studio.folder import parsed

_PULLED = {"start_s": 0.36, "end_s": 0.84, "group": "hook and cover"}  # as a first scene has it


def arrange(draft: Draft, edit: Edit) -> None:
    """Write poses, hooks and frames as a first scene of these seams has them.

    ``top`` names the panel on top, ``turn_deg`` turns it; ``keep`` lists what stays as it is, of
    "hook", "frame" and "placement".
    """
    pattern, foam = draft.pattern, _foam(draft)
    own = {frame.get("curve") for frame in draft.data.get("frame", [])}
    wires = {name: curve for name, curve in foam.curves.items() if name not in own}
    body = Foam(
        vertices=foam.vertices,
        faces=foam.faces,
        material=foam.material,
        curves=MappingProxyType(wires),
    )
    found = arranged(pattern, body, top=edit.get("top"), turn_deg=float(edit.get("turn_deg", 0)))
    keep = edit.get("keep", [])
    for table in ("hook", "frame"):
        if table not in keep and draft.data.get(table):
            draft.change(draft.scene, lambda text, t=table: drop(text, (t,)))  # type: ignore[misc]
    if "placement" not in keep:
        _write_poses(draft, found)
    if "frame" not in keep:
        _write_curves(draft, found.curves, own)
        _write_rows(draft, "frame", [_frame_row(frame) for frame in found.frames], COVER)
    if "hook" not in keep:
        _write_rows(draft, "hook", [_hook_row(hook) for hook in found.hooks], HOOK)


def _foam(draft: Draft) -> Foam:
    """The foam of the scene, which has to be readable as a whole."""
    if draft.reading.scene is None:
        raise InputError(draft.reading.problems)
    return draft.reading.scene.foam


def _write_poses(draft: Draft, found: Arrangement) -> None:
    for name, pose in found.layout.poses.items():
        row = {
            "rotation": pose.rotation.tolist(),
            "translation_mm": (1e3 * pose.translation).tolist(),
        }
        for key, value in row.items():
            draft.put(("placement", name, key), value)
        if "axes" in draft.data["placement"][name]:
            draft.put(("placement", name, "axes"), None)


def _write_curves(draft: Draft, curves: Mapping[str, FloatArray], old: set[Any]) -> None:
    """Put the curves of the borders beside the wires."""
    name = draft.data.get("foam", {}).get("curves")
    if name is None:
        if not curves:
            return
        name = CURVES
        draft.put(("foam", "curves"), name)
    else:
        name = draft.named("foam", "curves")
    there = parsed(draft.contents.get(name, b"")).get("curve", {})
    for gone in old & {*there} - {*curves}:
        draft.change(name, lambda text, g=gone: drop(text, ("curve", g)))  # type: ignore[misc]
    for curve, points in curves.items():
        key, value = ("curve", curve, "points_mm"), (1e3 * points).tolist()
        draft.change(name, lambda text, k=key, v=value: put(text, k, v))  # type: ignore[misc]


def _write_rows(draft: Draft, table: str, rows: list[dict[str, Any]], stage: str) -> None:
    """Add rows, and the stage that they are pulled in where there is none of its name."""
    names = [row.get("name") for row in draft.data.get("stage", [])]
    if rows and stage not in names:
        values = {"name": stage, **_PULLED}
        draft.change(draft.scene, lambda text: add_row(text, "stage", values))
    for row in rows:
        draft.change(draft.scene, lambda text, r=row: add_row(text, table, r))  # type: ignore[misc]


def _hook_row(hook: Hook) -> dict[str, Any]:
    row: dict[str, Any] = {"name": hook.name}
    row |= {"chain": list(hook.chain)} if hook.chain else {"line": hook.line}
    row |= {"wire": hook.wire, "stage": hook.stage}
    if hook.junctions:
        row["junctions_mm"] = [1e3 * at for at in hook.junctions]
    if hook.slides:
        row["slides"] = True
    return row


def _frame_row(frame: Frame) -> dict[str, Any]:
    row: dict[str, Any] = {"name": frame.name, "edges": list(frame.edges), "curve": frame.curve}
    if frame.junctions:
        row["junctions_mm"] = [1e3 * at for at in frame.junctions]
    return {**row, "stage": frame.stage}
