"""The parts of a scene file that say how it is lit and looked at."""

from __future__ import annotations

import inspect
import itertools
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from seatlook.errors import InputError
from seatlook.io.panorama import read_panorama
from seatlook.io.scene.files import SceneFiles
from seatlook.io.schema import (
    FAR_MM,
    MM,
    Array,
    Kind,
    Number,
    Rows,
    Table,
    Text,
    Texts,
    place_mm,
)
from seatlook.io.toml import Document, Key
from seatlook.model import (
    LIGHTS,
    VIEWS,
    Camera,
    FloatArray,
    Foam,
    Light,
    Rig,
    framed_view,
    named_view,
    sphere_distance,
)
from seatlook.model.light.camera import DISTANCE
from seatlook.model.light.lamps import BRIGHTEST, turned


@dataclass(frozen=True, slots=True)
class LightTable:
    """``kind`` and the arguments of that function of ``model.LIGHTS``; its lights, or None."""

    required: bool = False

    def read(self, document: Document, key: Key, value: Any) -> dict[str, Any]:
        """Return the value, converted; report what is wrong with it."""
        kinds = {"kind": Text(choices=tuple(LIGHTS), required=True)}
        chosen = value.get("kind") if isinstance(value, dict) else None
        if not isinstance(chosen, str) or chosen not in LIGHTS:
            # Without a kind, nothing can be said about the other keys.
            bare = {"kind": chosen} if chosen is not None else {}
            Table(kinds).read(document, key, bare if isinstance(value, dict) else value)
            return {"lights": None}
        make = LIGHTS[chosen]
        before = len(document.problems)
        row = Table({**kinds, **arguments(make)}).read(document, key, value)
        lights: tuple[Light, ...] | None = None
        if len(document.problems) == before:
            given = {k: v for k, v in row.items() if k in value and k != "kind"}
            with document.blame(key):
                made = make(**given)
                lights = (made,) if isinstance(made, Light) else made
        return {"lights": lights}


def arguments(make: Callable[..., Light | tuple[Light, ...]]) -> dict[str, Kind]:
    """Return what a light's function takes, read from its signature."""
    kinds: dict[str, Kind] = {}
    for name, parameter in inspect.signature(make).parameters.items():
        required = parameter.default is inspect.Parameter.empty
        annotation = str(parameter.annotation)
        if annotation == "str":
            kinds[name] = Text(required=required)
        elif annotation.startswith("tuple"):
            kinds[name] = Array(shape=(annotation.count("float"),), required=required)
        else:
            kinds[name] = Number(required=required)
    return kinds


SIZE = Array(shape=(2,), low=16, high=16384)
POINT = place_mm(3, required=False)

RIG: dict[str, Kind] = {
    "name": Text(required=True),
    "ambient_cd_m2": Number(low=0, high=1e6, default=0.0),
    "panorama": Text(),
    "panorama_cd_m2": Number(low=1e-9, high=BRIGHTEST, default=1.0),
    "panorama_azimuth_deg": Number(low=-360, high=360, default=0.0),
    "ev100": Number(low=-10, high=30),
    "light": Rows(LightTable()),
}
CAMERA: dict[str, Kind] = {
    "views": Texts(choices=tuple(VIEWS), or_one=True, default=("front_34",)),
    "target_mm": POINT,
    "distance_mm": Number(low=10, high=FAR_MM, scale=MM),
    "size": SIZE,
    "custom": Rows(
        Table(
            {
                "name": Text(required=True),
                "position_mm": place_mm(3),
                "target_mm": POINT,
                "up": Array(shape=(3,), low=-1e3, high=1e3),
                "vertical_fov_deg": Number(low=1, high=120),
                "size": SIZE,
            }
        )
    ),
}


def make_rigs(document: Document, rows: list[dict[str, Any]], files: SceneFiles) -> tuple[Rig, ...]:
    """Build the rigs of a scene; one with a light or sky that is wrong is left out."""
    rigs = []
    for number, row in enumerate(rows):
        lights = [light["lights"] for light in row["light"] or ()]
        if row["name"] is None or row["ambient_cd_m2"] is None or None in lights:
            continue
        with document.blame(("rig", number)):
            sky = _sky(files, number, row)
            if sky is None and row["panorama"] is not None:
                continue
            rig = Rig(
                name=row["name"],
                lights=tuple(itertools.chain.from_iterable(lights)),
                ambient=row["ambient_cd_m2"],
                ev100=row["ev100"],
                panorama=sky,
            )
            rigs.append(turned(rig, row["panorama_azimuth_deg"] or 0.0))
    return tuple(rigs)


def _sky(files: SceneFiles, number: int, row: dict[str, Any]) -> FloatArray | None:
    """Panorama [cd/m2] of a rig, beside the scene file; ``panorama_cd_m2`` is what 1 stands for."""
    path = files.find(("rig", number, "panorama"), row["panorama"])
    return None if path is None else np.asarray(row["panorama_cd_m2"] * read_panorama(path))


def make_cameras(document: Document, row: dict[str, Any], foam: Foam | None) -> tuple[Camera, ...]:
    """Build the named views and the user's own cameras; by default they look at the foam."""
    cameras = []
    seat = np.zeros((1, 3)) if foam is None else foam.vertices
    middle = np.asarray((seat.min(axis=0) + seat.max(axis=0)) / 2)
    target = middle if row["target_mm"] is None else row["target_mm"]
    size = _size(row["size"]) or (1280, 720)
    framed = foam is not None and row["target_mm"] is None and row["distance_mm"] is None
    distance = row["distance_mm"] or (DISTANCE if foam is None else sphere_distance(seat))
    for view in row["views"] or ():
        with document.blame(("camera", "views")):
            cameras.append(
                framed_view(view, seat, size=size)
                if framed
                else named_view(view, target=target, size=size, distance=distance)
            )
    for number, own in enumerate(row["custom"] or ()):
        if own["name"] is None or own["position_mm"] is None:
            continue
        if own["name"] in VIEWS:
            document.report(("camera", "custom", number, "name"), own["name"], "a name of its own")
        options = {k: own[k] for k in ("up", "vertical_fov_deg") if own[k] is not None}
        with document.blame(("camera", "custom", number)):
            cameras.append(
                _camera(
                    name=own["name"],
                    position=own["position_mm"],
                    target=target if own["target_mm"] is None else own["target_mm"],
                    size=_size(own["size"]) or size,
                    **options,
                )
            )
    return tuple(cameras)


def _camera(**values: Any) -> Camera:
    camera = Camera(**values)
    sight = camera.target - camera.position
    if np.linalg.norm(np.cross(sight, camera.up)) < 1e-6 * np.linalg.norm(sight):
        raise InputError.single(
            "up", got=camera.up.tolist(), expected="a direction across the line of sight"
        )
    return camera


def _size(value: FloatArray | None) -> tuple[int, int] | None:
    return None if value is None else (int(value[0]), int(value[1]))
