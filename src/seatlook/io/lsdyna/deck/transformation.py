"""``*DEFINE_TRANSFORMATION``: rotations, translations and scales, as matrices of places."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np

from seatlook.errors import InputError
from seatlook.io.lsdyna.deck.cards import Block, Table, refuse
from seatlook.io.lsdyna.deck.placement import Move, Placement
from seatlook.model import FloatArray

_KNOWN = "SCALE, ROTATE, TRANSL, POINT or POS6P"
_SAME = 1e-6  # difference of scales along the axes that counts as none


@dataclass(frozen=True, slots=True)
class Frame:
    """Where a file goes: ``x -> scale * rotation @ x + shift``, in the unit of the deck."""

    scale: float
    rotation: FloatArray
    shift: FloatArray

    def moved(self, points: FloatArray) -> FloatArray:
        """Move points (k, 3)."""
        return np.asarray(self.scale * points @ self.rotation.T + self.shift)

    def turned(self, tensors: FloatArray) -> FloatArray:
        """Turn symmetric tensors (k, 6) in the order xx, yy, zz, xy, yz, zx."""
        full = tensors[:, [[0, 3, 5], [3, 1, 4], [5, 4, 2]]]
        full = self.rotation @ full @ self.rotation.T
        return np.asarray(full[:, [0, 1, 2, 0, 1, 2], [0, 1, 2, 1, 2, 0]])


@dataclass(slots=True)
class Transformations:
    """All *DEFINE_TRANSFORMATION of a deck: number -> (4, 4) matrix, and the names of its rows."""

    matrices: dict[int, FloatArray] = field(default_factory=dict)
    rows: dict[int, tuple[str, ...]] = field(default_factory=dict)

    def frame(self, place: Placement) -> Frame:
        """Return where a file goes.

        Raises
        ------
        InputError
            A transformation that the deck does not define, a mirror, unequal scales.
        """
        total = np.eye(4)
        for move in place.moves:
            total = self._matrix(move) @ np.diag([move.length] * 3 + [1.0]) @ total
        linear = total[:3, :3]
        scale = float(np.sqrt(np.trace(linear.T @ linear) / 3))
        uneven = not scale > 0 or np.abs(linear.T @ linear / scale**2 - np.eye(3)).max() > _SAME
        if uneven or np.linalg.det(linear) < 0:
            first = place.moves[0]
            raise InputError.single(
                "*INCLUDE_TRANSFORM", got="a mirror or unequal scales", file=first.file,
                line=first.line, expected="rotations, translations and one positive scale",
            )  # fmt: skip
        return Frame(scale, linear / scale, total[:3, 3])

    def notes(self, places: Iterable[Placement]) -> list[str]:
        """Say how included files were moved."""
        moves = {move.transformation: move for place in places for move in place.moves}
        return [
            f"a file of *INCLUDE_TRANSFORM is moved by *DEFINE_TRANSFORMATION {number}: "
            f"{', '.join(self.rows[number])}, in this order; strains in global axes are turned "
            "with it, and the thickness stays"
            for number in sorted(moves)
            if number
        ]

    def _matrix(self, move: Move) -> FloatArray:
        if not move.transformation:
            return np.eye(4)
        if move.transformation not in self.matrices:
            raise InputError.single(
                "*INCLUDE_TRANSFORM", got=f"TRANID {move.transformation}", file=move.file,
                line=move.line, expected="a *DEFINE_TRANSFORMATION of the deck",
            )  # fmt: skip
        return self.matrices[move.transformation]


def read_transformations(blocks: Iterable[Block]) -> Transformations:
    """Read all *DEFINE_TRANSFORMATION; their rows are applied in the order they stand in.

    Raises
    ------
    InputError
        Rows other than SCALE, ROTATE, TRANSL, POINT and POS6P, among them MIRROR.
    """
    found = Transformations()
    for block in blocks:
        if block.name not in ("DEFINE_TRANSFORMATION", "DEFINE_TRANSFORMATION_TITLE"):
            continue
        at = int(block.name.endswith("_TITLE"))
        head = block.table([10], slice(at, at + 1)).ints(0)
        if not len(head):
            raise refuse(block, "no cards", "a number and rows")
        number = int(head[0, 0]) + block.place.define
        if number in found.matrices:
            raise refuse(block, f"number {number} again", "each number once")
        rows = block.table([10] * 8, slice(at + 1, None))
        found.matrices[number] = _composed(rows)
        found.rows[number] = tuple(name for name in rows.words(0) if name not in ("", "POINT"))
    return found


def _composed(rows: Table) -> FloatArray:
    """Multiply the matrices of all rows, the first applied first."""
    total = np.eye(4)
    points: dict[int, FloatArray] = {}
    values = rows.floats(1, 2, 3, 4, 5, 6, 7)
    for row, name in enumerate(rows.words(0)):
        a = values[row]
        if name == "POINT":
            points[int(a[0])] = a[1:4]
            continue
        try:
            total = _row(name, a, points) @ total
        except KeyError as error:
            if error.args[0] == name:
                raise rows.problem(row, name, _KNOWN) from error
            got = f"{name} with point {error.args[0]}"
            raise rows.problem(row, got, "a point of a POINT row before") from error
        except ValueError as error:
            raise rows.problem(row, f"{name}: {error}", "a direction and places apart") from error
    return total


def _row(name: str, a: FloatArray, points: dict[int, FloatArray]) -> FloatArray:
    """Return the matrix of one row; KeyError for a name or point that is not there."""
    if not name:
        return np.eye(4)
    if name == "TRANSL":
        return _affine(np.eye(3), a[:3])
    if name == "SCALE":
        return _affine(np.diag(np.where(a[:3] == 0, 1.0, a[:3])), np.zeros(3))
    if name == "ROTATE":
        if a[3:].any():
            return _rotation(a[:3], a[3:6], a[6])
        start, end = points[int(a[0])], points[int(a[1])]
        return _rotation(end - start, start, a[2])
    if name == "POS6P":
        p = [points[int(number)] for number in a[:6]]
        turn = _axes(p[3], p[4], p[5]) @ _axes(p[0], p[1], p[2]).T
        return _affine(turn, p[3] - turn @ p[0])
    raise KeyError(name)


def _affine(linear: FloatArray, shift: FloatArray) -> FloatArray:
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = linear, shift
    return matrix


def _rotation(axis: FloatArray, point: FloatArray, degrees: float) -> FloatArray:
    """Rotate about an axis through a point, by the right-hand rule."""
    x, y, z = _unit(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    angle = np.radians(degrees)
    turn = np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    return _affine(turn, point - turn @ point)


def _axes(origin: FloatArray, along: FloatArray, beside: FloatArray) -> FloatArray:
    """Columns: the axis to the second point, the one in the plane of three points, the normal."""
    first = _unit(along - origin)
    normal = _unit(np.cross(first, beside - origin))
    return np.stack([first, np.cross(normal, first), normal], axis=1)


def _unit(vector: FloatArray) -> FloatArray:
    length = float(np.linalg.norm(vector))
    if not length > 0:
        raise ValueError("no direction")
    return np.asarray(vector / length)
