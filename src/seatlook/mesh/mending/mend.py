"""A surface of any origin made into the surface of a foam, or into a design surface."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from seatlook.errors import InputError
from seatlook.mesh.mending.bodies import (
    Body,
    choose,
    face_volumes,
    find_bodies,
    least_volume,
    unite,
)
from seatlook.mesh.mending.cleaning import (
    drop_duplicates,
    drop_specks,
    mend_slivers,
    sew_cracks,
    slivers,
)
from seatlook.mesh.mending.holes import fill, find_holes
from seatlook.mesh.mending.sheets import mend_crowded_edges
from seatlook.mesh.mending.skin import Skin, sides
from seatlook.mesh.mending.smoothing import smooth
from seatlook.mesh.mending.thicken import thicken
from seatlook.mesh.orientation import Orientation, agree
from seatlook.mesh.surface import FloatArray, IntArray, face_areas

Place = Callable[[FloatArray], str]


@dataclass(frozen=True, slots=True, kw_only=True)
class Mending:
    """What is done to a surface on request; all else is mended always.

    Parameters
    ----------
    close : fill its holes
    thicken : [m]       thickness given to an open shell, 0 for none
    unite : make one of several bodies
    body : number of the only one that is kept, from 1, the largest first
    smooth : [m]        waves shorter than this are taken out, 0 for none
    """

    close: bool = False
    thicken: float = 0.0
    unite: bool = False
    body: int | None = None
    smooth: float = 0.0

    def __post_init__(self) -> None:
        for one, two in (("close", "thicken"), ("unite", "body")):
            if getattr(self, one) and getattr(self, two):
                raise InputError.single(one, got=f"with {two}", expected="one of them")


AS_IT_IS = Mending()


def mend_body(skin: Skin, choices: Mending, place: Place) -> None:
    """Make a closed surface of one body, all faces outward.

    Raises
    ------
    InputError
        Borders are left open, several bodies are left, or there is nothing inside.
    """
    piece = _mended(skin)
    if choices.thicken:
        _check_open(skin)
        thicken(skin, choices.thicken)
    else:
        _close(skin, choices, place)
    piece = _agreed(skin).piece
    _outward(skin, piece)
    bodies = [b for b in find_bodies(skin, piece) if b.volume > least_volume(skin.vertices)]
    if not bodies:
        raise InputError.single("surface", got="nothing inside", expected="a body with a volume")
    inside = np.zeros(len(skin.faces), dtype=bool)
    inside[np.concatenate([body.faces for body in bodies])] = True
    if not inside.all():
        skin.note("faces with nothing inside dropped", (~inside).sum(),
                  skin.middle(int(np.argmin(inside))))  # fmt: skip
        skin.keep(inside)
        bodies = find_bodies(skin, _agreed(skin).piece)
    if len(bodies) > 1 and not choices.unite and choices.body is None:
        raise _several(skin, bodies, place)
    if choices.body is not None:
        choose(skin, bodies, choices.body)
    elif len(bodies) > 1:
        unite(skin, bodies)
    skin.compact()
    mend_slivers(skin, asked=True)
    if choices.smooth:
        smooth(skin, choices.smooth)
    skin.compact()
    _check_solid(skin, place)


def mend_sheet(skin: Skin, choices: Mending) -> None:
    """Mend an open surface; its longest border stays open, other holes are closed on request."""
    piece = _mended(skin)
    if choices.body is not None:
        choose(skin, _by_area(skin, piece), choices.body)
        skin.compact()
    if choices.close:
        fill(skin, find_holes(skin.vertices, skin.faces)[1:])
    if choices.thicken:
        thicken(skin, choices.thicken)
    if choices.smooth:
        smooth(skin, choices.smooth)
    skin.compact()


def is_clean(vertices: FloatArray, faces: IntArray) -> bool:
    """Whether a surface is closed, of one body with all faces to one side, and has no slivers."""
    table = sides(faces)
    skin = Skin(vertices, faces, np.arange(len(faces)))
    if not (table.members == 2).all() or len(slivers(skin)):
        return False
    if (np.bincount(table.edge, np.where(table.forward, 1, -1)) != 0).any():
        return False
    return bool((_agreed(skin).piece == 0).all())


def _mended(skin: Skin) -> IntArray:
    """Mend what every surface needs; return the piece of each face."""
    _turn(skin)
    drop_duplicates(skin)
    mend_slivers(skin)
    sew_cracks(skin)
    mend_crowded_edges(skin)
    piece = drop_specks(skin, _turn(skin))
    skin.compact()
    return piece


def _turn(skin: Skin) -> IntArray:
    """Make neighbours look to one side; return the piece of each face."""
    orientation = _agreed(skin)
    if orientation.one_sided:
        raise InputError.single(
            "surface", got="a strip with one side only", expected="a surface with two sides"
        )
    turned = orientation.sign < 0
    if turned.any():
        place = skin.middle(int(np.flatnonzero(turned)[0]))
        skin.note("faces turned to the side of their neighbours", turned.sum(), place)
        skin.faces[turned] = skin.faces[turned, ::-1]
    return orientation.piece


def _agreed(skin: Skin) -> Orientation:
    return agree(np.pad(skin.faces, ((0, 0), (0, 1)), mode="edge"), _areas(skin))


def _areas(skin: Skin) -> FloatArray:
    return face_areas(skin.vertices, skin.faces)


def _outward(skin: Skin, piece: IntArray) -> None:
    """Turn closed pieces that look inward."""
    inward = np.bincount(piece, face_volumes(skin.vertices, skin.faces)) < 0
    skin.faces[inward[piece]] = skin.faces[inward[piece], ::-1]


def _check_open(skin: Skin) -> None:
    if (sides(skin.faces).members == 2).all():
        raise InputError.single(
            "thicken", got="a closed surface", expected="an open shell", hint="it has an inside"
        )


def _close(skin: Skin, choices: Mending, place: Place) -> None:
    holes = find_holes(skin.vertices, skin.faces)
    if not holes:
        return
    if choices.close:
        fill(skin, holes)
        # A patch may end on an edge that has its two faces already.
        mend_crowded_edges(skin)
        return
    count = sum(len(hole.loop) for hole in holes)
    middle = skin.vertices[holes[0].loop].mean(axis=0)
    raise InputError.single(
        "surface",
        got=f"{count} open edges round {len(holes)} holes, the largest "
        f"{1e3 * holes[0].length:.0f} mm round at {place(middle)}",
        expected="a closed surface",
        hint="close fills the holes, thicken_mm gives an open shell a thickness",
    )


def _check_solid(skin: Skin, place: Place) -> None:
    """Refuse what is still no surface of a body after all."""
    table = sides(skin.faces)
    turns = np.bincount(table.edge, np.where(table.forward, 1, -1))
    bad = np.flatnonzero(((table.members != 2) | (turns != 0))[table.edge])
    if len(bad):
        raise InputError.single(
            "surface",
            got=f"{len(np.unique(table.edge[bad]))} edges without two faces that agree, the first "
            f"at {place(skin.middle(int(bad[0]) // 3))}",
            expected="a surface that can be mended",
            hint="mend it there, where it was drawn",
        )


def _several(skin: Skin, bodies: list[Body], place: Place) -> InputError:
    rows = [
        f"{i}: {1e3 * body.volume:.3g} l at {place(_middle(skin, body))}"
        for i, body in enumerate(bodies[:8], start=1)
    ]
    more = ", ..." if len(bodies) > 8 else ""
    return InputError.single(
        "surface",
        got=f"{len(bodies)} bodies ({'; '.join(rows)}{more})",
        expected="one body",
        hint="unite makes one of them, body = 1 takes the first",
    )


def _middle(skin: Skin, body: Body) -> FloatArray:
    return np.asarray(skin.vertices[skin.faces[body.faces]].mean(axis=(0, 1)))


def _by_area(skin: Skin, piece: IntArray) -> list[Body]:
    """Pieces of an open surface, the largest first."""
    areas = np.bincount(piece, _areas(skin))
    bodies = [Body(np.flatnonzero(piece == i), float(a)) for i, a in enumerate(areas)]
    return sorted(bodies, key=lambda body: -body.volume)
