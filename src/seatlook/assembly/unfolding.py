"""A first guess at where flat panels start.

The panels are laid out from the largest one, each turned about the middle of the seam that joins it
to one laid before, and folded down until it would come too near to the foam.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np

from seatlook.assembly.girth import lay_borders
from seatlook.assembly.panel_names import hand, words
from seatlook.errors import InputError, did_you_mean
from seatlook.mesh import arc_length, face_areas
from seatlook.mesh.overlap import lifts
from seatlook.model import Border, FloatArray, Foam, Pattern, Pose, Seam
from seatlook.solver.foam.distance import DistanceField, distance_field

LIFT = 0.020  # m above the foam's top, of the panel laid first
CLEAR = 0.012  # m from the foam, of the panels folded down
_APART = 0.05  # m between panels laid beside the foam
_AS_FLAT = 1.05  # a foam this high over its smaller width lies; higher, it stands
_FOR_SIDES = 0.4  # share of the largest panel's area that one of the middle needs to be laid first
_AS_LARGE = 0.97  # share of the largest panel's area
_BEHIND = {"rear", "back", "bottom", "under", "lower", "hinten", "unten"}
_LEANS = np.radians(8.0)  # from which a foam leans; less is its shape
_SLENDER = 1.5  # spread across it over which its direction is clear
_LIES = 0.7  # cosine of the steepest panel that lies
_STEEPEST = 85.0  # deg, of a fold
_STEP = 5.0  # deg
_SAMPLES = 31  # points of a seam; its middle fifth is the hinge
_WIDEST_GAP = 0.06  # m, by which a panel is moved off one that bulges towards it


@dataclass(frozen=True, slots=True, kw_only=True)
class Layout:
    """Poses of all panels, the one laid first, and curves for the free borders.

    Parameters
    ----------
    borders : of the panels that seams join to the first, with curves round the foam
    apart : panels that no seam joins to the others
    """

    first: str
    poses: MappingProxyType[str, Pose]
    borders: tuple[Border, ...]
    apart: tuple[str, ...] = ()


def lay_out(
    pattern: Pattern,
    foam: Foam,
    *,
    first: str | None = None,
    turn_deg: float = 0.0,
    partial: bool = False,
) -> Layout:
    """Place panels over the foam, joined at their seams and folded down around it.

    The first panel lies on the foam's broad side: on top of a cushion, in front of what stands.

    Parameters
    ----------
    first : panel on the broad side, by default the largest
    turn_deg : how far it is turned, counter-clockwise seen from outside; at 0 its v axis points
        back on a cushion, up on what stands
    partial : lay panels that no seam joins beside the foam

    Raises
    ------
    InputError
        No panel of this name; unless ``partial``, panels that no seam joins to the others.
    """
    names = [p.name for p in pattern.panels]
    if first is not None and first not in names:
        raise InputError.single(
            "--top",
            got=repr(first),
            expected=f"one of {', '.join(names)}",
            hint=did_you_mean(first, names),
        )
    # Laid out with the broad side up, then turned back with it.
    turn = broad_side_up(foam)
    body = replace(foam, vertices=np.ascontiguousarray(foam.vertices @ turn.T))
    top = first or _largest(pattern)
    middle = _middle_of(body)
    poses, _ = _joined_panels(pattern, body, top, turn_deg, middle)
    # What faces up is laid over the middle of the foam, not the first panel alone.
    poses, depth = _joined_panels(
        pattern, body, top, turn_deg, 2 * middle - _facing_up(pattern, poses)
    )
    unsewn = tuple(name for name in names if name not in poses)
    if unsewn and not partial:
        raise InputError.single(
            "seams",
            got=f"none that joins {', '.join(unsewn)} to {top}",
            expected="every panel sewn to another",
            hint="complete the seams file, then: seatlook init ... --seams FILE",
        )
    poses |= _beside(pattern, body, unsewn)
    turned = {name: _turned(poses[name], turn.T) for name in names}
    ways = lifts([turned[name].at(pattern.panel(name).outline) for name in names])
    turned = {name: turned[name].moved(way) for name, way in zip(names, ways, strict=True)}
    return Layout(
        first=top,
        poses=MappingProxyType(turned),
        borders=lay_borders(pattern, foam, _upright(foam), turned, depth),
        apart=unsewn,
    )


def broad_side_up(foam: Foam) -> FloatArray:
    """Rotation (3, 3) that turns up what is seen of a foam: its top, or the front if it stands."""
    own = _upright(foam)
    return np.asarray(_broad_side_up(foam.vertices @ own.T) @ own)


def _largest(pattern: Pattern) -> str:
    """Largest panel of the middle; of nearly equal ones the one not put behind by its name."""
    area = {panel.name: panel.area for panel in pattern.panels}
    amid = [
        name for name in area if not hand(name) and area[name] > _FOR_SIDES * max(area.values())
    ]
    largest = max(area[name] for name in amid or area)
    large = [name for name in amid or area if area[name] > _AS_LARGE * largest]
    return min(large, key=lambda name: (bool(set(words(name)) & _BEHIND), -area[name]))


def _upright(foam: Foam) -> FloatArray:
    """Rotation (3, 3) about x that stands a foam upright which leans, as backrests do."""
    areas = face_areas(foam.vertices, foam.faces)
    centres = foam.vertices[foam.faces].mean(axis=1)[:, 1:]
    away = centres - areas @ centres / areas.sum()
    spread, axes = np.linalg.eigh((areas[:, None] * away).T @ away)
    thin = axes[:, 0]  # across the foam, in y and z
    lean = float(np.arctan2(thin[1], thin[0]))
    lean -= np.pi / 2 * round(lean / (np.pi / 2))
    if spread[1] < _SLENDER * spread[0] or abs(lean) < _LEANS:
        return np.eye(3)
    c, s = np.cos(lean), np.sin(lean)
    return np.array([[1.0, 0.0, 0.0], [0.0, c, s], [0.0, -s, c]])


def _broad_side_up(vertices: FloatArray) -> FloatArray:
    """Rotation (3, 3) that turns the broad side of a foam up: its top, its front or its left."""
    width, depth, height = np.ptp(vertices, axis=0)
    if height <= _AS_FLAT * min(width, depth):
        return np.eye(3)
    if depth <= width:
        return np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
    return np.array([[0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]])


def _turned(pose: Pose, turn: FloatArray) -> Pose:
    return Pose(rotation=turn @ pose.rotation, translation=turn @ pose.translation)


def _joined_panels(
    pattern: Pattern, foam: Foam, top: str, turn_deg: float, middle: FloatArray
) -> tuple[dict[str, Pose], dict[str, int]]:
    """Poses of the panels that seams join to the first, and how many seams away each is."""
    field = distance_field(foam.vertices, foam.faces)
    poses = {top: _on_top(pattern.panel(top).outline, foam, turn_deg, middle)}
    depth = {top: 0}
    while hinges := [h for seam in pattern.seams for h in _hinges(pattern, seam, poses)]:
        hinge = min(hinges, key=lambda h: (depth[h.placed], -np.ptp(h.stretch, axis=0).max()))
        poses[hinge.hung] = _folded(pattern, hinge, poses[hinge.placed], field)
        depth[hinge.hung] = depth[hinge.placed] + 1
    return poses, depth


def _beside(pattern: Pattern, foam: Foam, names: Sequence[str]) -> dict[str, Pose]:
    """Lay panels flat in a row beside the foam, where they can be seen."""
    right = float(foam.vertices[:, 0].max())
    level = float(foam.vertices[:, 2].max()) + LIFT
    depth = float(foam.vertices[:, 1].mean())
    poses = {}
    for name in names:
        outline = pattern.panel(name).outline
        low, high = outline.min(axis=0), outline.max(axis=0)
        right += _APART
        place = np.array([right - low[0], depth - (low[1] + high[1]) / 2, level])
        poses[name] = Pose(rotation=np.eye(3), translation=place)
        right += float(high[0] - low[0])
    return poses


def _on_top(outline: FloatArray, foam: Foam, turn_deg: float, middle: FloatArray) -> Pose:
    """Lay a panel flat above the foam, its own middle over a place (2,)."""
    angle = np.radians(turn_deg)
    c, s = np.cos(angle), np.sin(angle)
    rotation = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    own = np.array([*((outline.min(axis=0) + outline.max(axis=0)) / 2), 0.0])
    over = np.array([*middle, foam.vertices[:, 2].max() + LIFT])
    return Pose(rotation=rotation, translation=over - rotation @ own)


def _middle_of(foam: Foam) -> FloatArray:
    """Middle (2,) [m] of a foam seen from above."""
    return np.asarray((foam.vertices.min(axis=0) + foam.vertices.max(axis=0))[:2] / 2)


def _facing_up(pattern: Pattern, poses: Mapping[str, Pose]) -> FloatArray:
    """Middle (2,) [m] of the panels that lie, not hang, seen from above."""
    points = np.concatenate(
        [
            pose.at(pattern.panel(name).outline)[:, :2]
            for name, pose in poses.items()
            if pose.rotation[2, 2] > _LIES
        ]
    )
    return np.asarray((points.min(axis=0) + points.max(axis=0)) / 2)


@dataclass(frozen=True, slots=True)
class _Hinge:
    """A placed panel, one to hang on it, and the seam between them on each.

    Parameters
    ----------
    stretch, edge : (_SAMPLES, 2) [m]
        Points that meet. Both run along the placed panel's outline, so the hung one's is turned
        round.
    """

    placed: str
    hung: str
    stretch: FloatArray
    edge: FloatArray


def _hinges(pattern: Pattern, seam: Seam, poses: Mapping[str, Pose]) -> Iterator[_Hinge]:
    """Ways to hang a panel that is not placed on one that is, along one seam."""
    near = pattern.edges[seam.a].panel
    length = np.array([pattern.edge_length(b) for b in seam.b])
    share = np.concatenate([[0.0], np.cumsum(length)]) / length.sum()
    for name, low, high in zip(seam.b, share, share[1:], strict=False):
        far = pattern.edges[name].panel
        if (near in poses) == (far in poses):
            continue
        stretch = _points(pattern.edge_points(seam.a), low, high)
        edge = _points(pattern.edge_points(name), *((1.0, 0.0) if seam.reverse else (0.0, 1.0)))
        if near in poses:
            yield _Hinge(near, far, stretch, edge)
        else:
            yield _Hinge(far, near, edge[::-1], stretch[::-1])


def _points(line: FloatArray, low: float, high: float) -> FloatArray:
    """Points (_SAMPLES, 2) of a line between two shares of its length."""
    arc = arc_length(line)
    at = np.linspace(low, high, _SAMPLES) * arc[-1]
    return np.column_stack([np.interp(at, arc, line[:, k]) for k in range(2)])


def _folded(pattern: Pattern, hinge: _Hinge, placed: Pose, field: DistanceField) -> Pose:
    """Fold a panel down about its seam as far as the foam lets it, up where it must."""
    sheet = _sheet(pattern.panel(hinge.hung).outline)
    steps = np.arange(0.0, _STEEPEST + _STEP, _STEP)
    pose = _hung(hinge, placed, 0.0)
    if _clearance(pose, sheet, field) < CLEAR:
        for angle in steps:
            pose = _hung(hinge, placed, -angle)
            if _clearance(pose, sheet, field) >= CLEAR:
                break
        return pose
    for angle in steps[1:]:
        lower = _hung(hinge, placed, angle)
        if _clearance(lower, sheet, field) < CLEAR:
            break
        pose = lower
    return pose


def _hung(hinge: _Hinge, placed: Pose, angle_deg: float) -> Pose:
    """Pose of a panel whose edge lies on its stretch, folded down by an angle.

    Of a curved seam the middle fifth counts: its ends may lie as near to each other as those of a
    horseshoe, or on each other.
    """
    (p0, p1), (e0, e1) = _middle(hinge.stretch), _middle(hinge.edge)
    world = placed.at(np.array([p0, p1]))
    along = (world[1] - world[0]) / np.linalg.norm(world[1] - world[0])
    up = placed.rotation[:, 2]
    outward = np.cross(along, up)
    c, s = np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))
    across, normal = c * outward - s * up, c * up + s * outward
    u, v = (e0 - e1) / np.linalg.norm(e0 - e1)
    # The hung panel's edge runs against the placed one's, with its inside on the left.
    own = np.array([[u, v, 0.0], [-v, u, 0.0], [0.0, 0.0, 1.0]])
    rotation = np.column_stack([-along, across, normal]) @ own
    middle = np.array([*((e0 + e1) / 2), 0.0])
    place = world.mean(axis=0) + _gap(hinge) * across
    return Pose(rotation=rotation, translation=place - rotation @ middle)


def _middle(line: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Ends of the middle fifth of a line (_SAMPLES, 2)."""
    first = 2 * _SAMPLES // 5
    return line[first], line[-1 - first]


def _gap(hinge: _Hinge) -> float:
    """How far [m] a panel is to be moved off for its edge not to lie over the placed one's."""
    rise = []
    for line in (hinge.stretch, hinge.edge):
        low, high = _middle(line)
        along = (high - low) / np.linalg.norm(high - low)
        rise.append((line - (low + high) / 2) @ np.array([along[1], -along[0]]))
    # Out of the placed panel, and into the hung one, whose edge runs the other way round.
    return float(np.clip((rise[0] - rise[1]).max(), 0.0, _WIDEST_GAP))


def _sheet(outline: FloatArray) -> FloatArray:
    """Points (k, 3) [m] all over a panel: its outline and smaller copies of it."""
    middle = outline.mean(axis=0)
    rings = [middle + share * (outline - middle) for share in (0.25, 0.5, 0.75, 1.0)]
    flat = np.concatenate([middle[None], *rings])
    return np.column_stack([flat, np.zeros(len(flat))])


def _clearance(pose: Pose, sheet: FloatArray, field: DistanceField) -> float:
    """Least distance [m] of a placed panel from the foam."""
    return float(field.at(sheet @ pose.rotation.T + pose.translation)[0].min())
