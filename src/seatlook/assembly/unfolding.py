"""A first guess at where flat panels start and which way their free edges are pulled.

The panels are laid out from the largest one, each turned about the seam that joins it to one laid
before, and folded down until it would come too near to the foam.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from types import MappingProxyType

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from seatlook.errors import InputError, did_you_mean
from seatlook.mesh import arc_length
from seatlook.model import FloatArray, Foam, Pattern, Pose, Seam
from seatlook.solver.foam.distance import DistanceField, distance_field

LIFT = 0.020  # m above the foam's top, of the panel laid first
CLEAR = 0.012  # m from the foam, of the panels folded down
_CLOSED = 1e-6  # m; ends of an edge nearer than that are one
_APART = 0.05  # m between panels laid beside the foam
_AS_FLAT = 1.05  # a foam this high over its smaller width lies; higher, it stands
_STEEPEST = 85.0  # deg, of a fold
_STEP = 5.0  # deg
_NEAR = 0.03  # m; the foam's height is looked for within it
_MEET = 0.08  # m; ends of free edges that near each other are sewn together
_SAMPLES = 25  # points of a free edge and of its curve


@dataclass(frozen=True, slots=True, kw_only=True)
class Layout:
    """Poses of all panels, the one laid first, and curves for the free edges.

    Parameters
    ----------
    curves : name of a free edge -> (k, 3) [m] round the foam, where the edge comes to lie
    apart : panels that no seam joins to the others
    """

    first: str
    poses: MappingProxyType[str, Pose]
    curves: MappingProxyType[str, FloatArray]
    apart: tuple[str, ...] = ()


def lay_out(
    pattern: Pattern,
    foam: Foam,
    *,
    first: str | None = None,
    turn_deg: float = 0.0,
    free: Sequence[str] = (),
    partial: bool = False,
) -> Layout:
    """Place panels over the foam, joined at their seams and folded down around it.

    The first panel lies on the foam's broad side: on top of a cushion, in front of what stands.

    Parameters
    ----------
    first : panel on the broad side, by default the largest
    turn_deg : how far it is turned, counter-clockwise seen from outside; at 0 its v axis points
        back on a cushion, up on what stands
    free : names of edges that are sewn to nothing, for which curves are made
    partial : lay panels that no seam joins beside the foam, and leave out curves that find no place

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
    turn = _broad_side_up(foam.vertices)
    body = replace(foam, vertices=np.ascontiguousarray(foam.vertices @ turn.T))
    top = first or max(names, key=lambda n: outline_area(pattern.panel(n).outline))
    poses, fall = _joined_panels(pattern, body, top, turn_deg)
    unsewn = tuple(name for name in names if name not in poses)
    if unsewn and not partial:
        raise InputError.single(
            "seams",
            got=f"none that joins {', '.join(unsewn)} to {top}",
            expected="every panel sewn to another",
            hint="complete the seams file, then: seatlook init ... --seams FILE",
        )
    hanging = [name for name in free if pattern.edges[name].panel in poses]
    curves = _curves(pattern, body, poses, fall, hanging, partial=partial)
    poses |= _beside(pattern, body, unsewn)
    return Layout(
        first=top,
        poses=MappingProxyType({name: _turned(poses[name], turn.T) for name in names}),
        curves=MappingProxyType({name: line @ turn for name, line in curves.items()}),
        apart=unsewn,
    )


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
    pattern: Pattern, foam: Foam, top: str, turn_deg: float
) -> tuple[dict[str, Pose], dict[str, float]]:
    """Poses of the panels that seams join to the first, and the height at which each hangs."""
    field = distance_field(foam.vertices, foam.faces)
    poses = {top: _on_top(pattern.panel(top).outline, foam, turn_deg)}
    depth, fall = {top: 0}, {top: foam.vertices[:, 2].max()}
    while hinges := [h for seam in pattern.seams for h in _hinges(pattern, seam, poses)]:
        hinge = min(hinges, key=lambda h: (depth[h.placed], -np.ptp(h.stretch, axis=0).max()))
        poses[hinge.hung] = _folded(pattern, hinge, poses[hinge.placed], field)
        depth[hinge.hung] = depth[hinge.placed] + 1
        fall[hinge.hung] = _height(foam, _seam_middle(hinge, poses[hinge.placed]))
    return poses, fall


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


def _on_top(outline: FloatArray, foam: Foam, turn_deg: float) -> Pose:
    """Lay a panel flat over the middle of the foam."""
    angle = np.radians(turn_deg)
    c, s = np.cos(angle), np.sin(angle)
    rotation = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    low, high = foam.vertices.min(axis=0), foam.vertices.max(axis=0)
    middle = np.array([*((outline.min(axis=0) + outline.max(axis=0)) / 2), 0.0])
    over = np.array([*((low + high) / 2)[:2], high[2] + LIFT])
    return Pose(rotation=rotation, translation=over - rotation @ middle)


@dataclass(frozen=True, slots=True)
class _Hinge:
    """A placed panel, one to hang on it, and the two ends (2, 2) [m] of each one's stretch.

    Both stretches run along the placed panel's outline, so the hung one's is turned round.
    """

    placed: str
    hung: str
    stretch: FloatArray
    edge: FloatArray


def _hinges(pattern: Pattern, seam: Seam, poses: Mapping[str, Pose]) -> Iterator[_Hinge]:
    """Ways to hang a panel that is not placed on one that is, along one seam."""
    line = pattern.edge_points(seam.a)
    arc = arc_length(line) / arc_length(line)[-1]
    length = np.array([pattern.edge_length(b) for b in seam.b])
    share = np.concatenate([[0.0], np.cumsum(length)]) / length.sum()
    place = np.column_stack([np.interp(share, arc, line[:, k]) for k in range(2)])
    near = pattern.edges[seam.a].panel
    for number, name in enumerate(seam.b):
        far, ends = pattern.edges[name].panel, pattern.edge_points(name)[[-1, 0]]
        ends = ends if seam.reverse else ends[::-1]
        stretch = place[number : number + 2]
        if near in poses and far not in poses:
            yield _Hinge(near, far, stretch, ends)
        elif far in poses and near not in poses:
            yield _Hinge(far, near, ends[::-1], stretch[::-1])


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
    """Pose of a panel whose edge lies on its stretch, folded down by an angle."""
    world = hinge.stretch @ placed.rotation[:, :2].T + placed.translation
    along = (world[1] - world[0]) / np.linalg.norm(world[1] - world[0])
    up = placed.rotation[:, 2]
    outward = np.cross(along, up)
    c, s = np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))
    across, normal = c * outward - s * up, c * up + s * outward
    u, v = (hinge.edge[0] - hinge.edge[1]) / np.linalg.norm(hinge.edge[0] - hinge.edge[1])
    # The hung panel's edge runs against the placed one's, with its inside on the left.
    own = np.array([[u, v, 0.0], [-v, u, 0.0], [0.0, 0.0, 1.0]])
    rotation = np.column_stack([-along, across, normal]) @ own
    middle = np.array([*hinge.edge.mean(axis=0), 0.0])
    return Pose(rotation=rotation, translation=world.mean(axis=0) - rotation @ middle)


def _sheet(outline: FloatArray) -> FloatArray:
    """Points (k, 3) [m] all over a panel: its outline and smaller copies of it."""
    middle = outline.mean(axis=0)
    rings = [middle + share * (outline - middle) for share in (0.25, 0.5, 0.75, 1.0)]
    flat = np.concatenate([middle[None], *rings])
    return np.column_stack([flat, np.zeros(len(flat))])


def _clearance(pose: Pose, sheet: FloatArray, field: DistanceField) -> float:
    """Least distance [m] of a placed panel from the foam."""
    return float(field.at(sheet @ pose.rotation.T + pose.translation)[0].min())


def _placed(pattern: Pattern, edge: str, poses: Mapping[str, Pose]) -> FloatArray:
    """Points (k, 3) [m] of a placed edge, evenly spread."""
    line = pattern.edge_points(edge)
    arc = arc_length(line)
    at = np.linspace(0.0, arc[-1], _SAMPLES)
    pose = poses[pattern.edges[edge].panel]
    flat = np.column_stack([np.interp(at, arc, line[:, k]) for k in range(2)])
    return np.asarray(flat @ pose.rotation[:, :2].T + pose.translation)


def _seam_middle(hinge: _Hinge, placed: Pose) -> FloatArray:
    middle = np.array([*hinge.stretch.mean(axis=0), 0.0])
    return np.asarray(placed.rotation @ middle + placed.translation)


def _height(foam: Foam, point: FloatArray) -> float:
    """Height [m] of the foam's surface below a point."""
    away = np.hypot(*(foam.vertices[:, :2] - point[:2]).T)
    near = foam.vertices[away <= max(_NEAR, float(away.min()))]
    return float(near[:, 2].max())


def _curves(
    pattern: Pattern,
    foam: Foam,
    poses: Mapping[str, Pose],
    fall: Mapping[str, float],
    free: Sequence[str],
    *,
    partial: bool,
) -> dict[str, FloatArray]:
    """For each free edge, the stretch of the foam's girth that it comes to lie on.

    An edge without one is left out if ``partial``.
    """
    placed = {name: _placed(pattern, name, poses) for name in free}
    ends = {(name, k): line[k, :2] for name, line in placed.items() for k in (0, -1)}
    meet = {
        end: [other for other, e in ends.items() if np.hypot(*(e - at)) < _MEET]
        for end, at in ends.items()
    }
    curves = {}
    for name in placed:
        panel = pattern.edges[name].panel
        reach = _reach(pattern.edge_points(name), pattern.panel(panel).outline)
        # Ends of neighbours are sewn together: both go where they meet half way.
        first, last = (np.mean([ends[e] for e in meet[name, k]], axis=0) for k in (0, -1))
        try:
            rim = _girth(foam, max(fall[panel] - reach, float(foam.vertices[:, 2].min())))
            curves[name] = _along(rim, first, last)
        except InputError:
            if not partial:
                raise
    meet = {end: [e for e in others if e[0] in curves] for end, others in meet.items()}
    return {name: _joined(name, curves, meet) for name in curves}


def _joined(
    name: str,
    curves: Mapping[str, FloatArray],
    meet: Mapping[tuple[str, int], Sequence[tuple[str, int]]],
) -> FloatArray:
    """The curve with its ends at the very points where its neighbours' are.

    Two targets for one sewn corner would pull its seam open.
    """
    curve = curves[name]
    shift = [
        np.mean([curves[other][k] for other, k in meet[name, end]], axis=0) - curve[end]
        for end in (0, -1)
    ]
    share = np.linspace(0.0, 1.0, len(curve))[:, None]
    return np.asarray(curve + (1 - share) * shift[0] + share * shift[1])


def _reach(edge: FloatArray, outline: FloatArray) -> float:
    """How far [m] an edge lies from the opposite side of its panel."""
    chord = edge[-1] - edge[0]
    if np.linalg.norm(chord) < _CLOSED:
        return float(np.ptp(outline, axis=0).min()) / 2
    along = chord / np.linalg.norm(chord)
    across = (outline - edge[0]) @ np.array([-along[1], along[0]])
    return float(across.max())


def _girth(foam: Foam, height: float) -> FloatArray:
    """Closed curve (k, 3) [m] round the foam at a height, the first point repeated."""
    side = foam.vertices[foam.faces[:, [0, 1, 1, 2, 2, 0]]].reshape(-1, 2, 3)
    start, end = side[:, 0], side[:, 1]
    rise = end[:, 2] - start[:, 2]
    crosses = ((start[:, 2] - height) * (end[:, 2] - height) <= 0.0) & (rise != 0.0)
    share = (height - start[crosses, 2:]) / rise[crosses, None]
    section = (start[crosses] + share * (end[crosses] - start[crosses]))[:, :2]
    try:
        hull = section[ConvexHull(section).vertices]
    except (QhullError, ValueError) as error:
        raise _no_girth() from error
    hull = np.concatenate([hull, hull[:1]])
    arc = arc_length(hull)
    at = np.linspace(0.0, arc[-1], 401)
    flat = np.column_stack([np.interp(at, arc, hull[:, k]) for k in range(2)])
    return np.column_stack([flat, np.full(len(flat), height)])


def _along(rim: FloatArray, start: FloatArray, end: FloatArray) -> FloatArray:
    """Stretch of the rim from the place nearest to ``start`` to that of ``end``, the short way."""
    points = rim[:-1]
    first, last = (int(np.hypot(*(points[:, :2] - e).T).argmin()) for e in (start, end))
    n = len(points)
    ahead = (first + np.arange((last - first) % n + 1)) % n
    back = (first - np.arange((first - last) % n + 1)) % n
    line = points[min(ahead, back, key=len)]
    if np.hypot(*(start - end)) < _CLOSED:
        line = np.roll(points, -first, axis=0)[[*range(n), 0]]
    if len(line) < 2:
        raise _no_girth()
    arc = arc_length(line)
    at = np.linspace(0.0, arc[-1], _SAMPLES)
    return np.column_stack([np.interp(at, arc, line[:, k]) for k in range(3)])


def _no_girth() -> InputError:
    return InputError.single(
        "foam",
        got="no girth below a free edge of the cover",
        expected="a foam as wide as the cover (is --unit right?)",
    )


def outline_area(outline: FloatArray) -> float:
    """Area [m2] inside a closed outline (k, 2) [m]."""
    x, y = outline.T
    return 0.5 * float(abs(x @ np.roll(y, -1) - y @ np.roll(x, -1)))
