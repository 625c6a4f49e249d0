"""From cases to the viewer of their page: script and content as two texts."""

from __future__ import annotations

import json
import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from seatlook.chain.case import Case
from seatlook.chain.files import RESULT
from seatlook.model import VIEWS, Camera, Light, Rig, Scene
from seatlook.model.light.lamps import ILLUMINANTS, linear_srgb, planck_colour
from seatlook.pbr.light.exposure import ev100
from seatlook.pbr.light.rig import SEAT, lux_at_seat, patched, sky_irradiance, white_of
from seatlook.pbr.shading.studio import Studio, studio
from seatlook.report.page.types import ViewerSection
from seatlook.report.sections.words import light_words, look_words
from seatlook.report.viewer.geometry import add_colours, add_geometry, add_maps
from seatlook.report.viewer.looks import add_details, looks_of
from seatlook.report.viewer.pack import Buffers
from seatlook.report.viewer.script import joined

# Lights of a rig that the viewer has room for: each has a shadow map.
MOST_LIGHTS = 8


def viewer_section(case: Case, camera: Camera, folder: Path | None = None) -> ViewerSection:
    """Everything the viewer shows of a case; ``camera`` is that of the page's pictures.

    ``folder`` is where the case's result is kept; None where that is not known.
    """
    result = None if folder is None else folder / RESULT
    return variants_section({"": case}, camera, results={"": result}, top=case.assessment.top)


def variants_section(
    variants: Mapping[str, Case], camera: Camera, *, results: Mapping[str, Path | None], top: float
) -> ViewerSection:
    """Everything the viewer shows of some cases: lights and looks are those of the first.

    Parameters
    ----------
    variants : by their names
    results : where the result of each is kept; None where that is not known
    top : upper end of the range of W2

    Notes
    -----
    The content is that of the first, with what all share; ``others`` have what is their own.
    """
    first = next(iter(variants.values()))
    records: list[np.ndarray] = []
    seats, packs = [], []
    for name, case in variants.items():
        buffers = Buffers()
        own = _seat(case, first.scene, buffers, records, top)
        seats.append({"name": name, **own, "files": _files(first.scene, results[name])})
        packs.append(buffers)
    add_colours(packs[0])
    content = {
        **seats[0],
        **add_details(records, packs[0]),
        "rigs": [_rig(rig) for rig in first.scene.rigs],
        "views": _views(first, camera),
        "seat": list(SEAT),
        "buffers": packs[0].packed(),
        "others": [
            {**seat, "buffers": pack.packed()}
            for seat, pack in zip(seats[1:], packs[1:], strict=True)
        ],
    }
    return ViewerSection(script=joined(), content=json.dumps(content, separators=(",", ":")))


def _seat(
    case: Case, scene: Scene, buffers: Buffers, records: list[np.ndarray], top: float
) -> dict[str, Any]:
    """Add what is a case's own in the looks of ``scene``, and its packed materials."""
    stage = studio(case.solution)
    triangles, geometry = add_geometry(stage, buffers)
    packed, looks = looks_of(scene, stage)
    records.extend(packed)
    looks["looks"] = [{**look, "words": look_words(look["name"])} for look in looks["looks"]]
    return {
        **geometry,
        **looks,
        "maps": add_maps(case.assessment, stage, triangles, buffers, top),
        "wrinkles": _wrinkles(case, stage),
        "seams": _seams(case, buffers),
    }


def _rig(rig: Rig) -> dict[str, Any]:
    """A rig with its exposure; a panorama becomes an even sky as bright on a card that faces up."""
    sky = sky_irradiance(rig) / np.pi
    split = len(patched(rig).lights) <= MOST_LIGHTS
    lights = (patched(rig) if split else rig).lights[:MOST_LIGHTS]
    return {
        "name": rig.name,
        "words": light_words(rig.name),
        "lights": [_light(light) for light in lights],
        "sky": sky.tolist(),
        "ev100": ev100(rig),
        "white": white_of(rig).tolist(),
        "lux": lux_at_seat(rig)["total"],
        "panorama": rig.panorama is not None,
        "left": max(len(rig.lights) - MOST_LIGHTS, 0),
    }


def _files(scene: Scene, result: Path | None) -> list[str]:
    """Scene and result as seen from the scene's folder, for a command; none where not known."""
    if scene.path is None or result is None or not result.is_file():
        return []
    home, kept = scene.path.resolve().parent, result.resolve()
    if home.anchor != kept.anchor:
        return []
    return [scene.path.name, Path(os.path.relpath(kept, home)).as_posix()]


def _light(light: Light) -> dict[str, Any]:
    return {
        "name": light.name,
        "near": light.near,
        "vector": light.vector.tolist(),
        "intensity": light.intensity,
        "colour": light.colour.tolist(),
        "size": light.size,
        "sides": light.sides.tolist() if light.is_rectangle else None,
        "twoSided": light.two_sided,
        "kind": _kind(light),
        "colourKeys": _colour_keys(light),
    }


def _kind(light: Light) -> str:
    """Key ``kind`` of the light in a scene, see ``model.LIGHTS``."""
    if light.is_rectangle:
        return "two_sided_rectangle" if light.two_sided else "rectangle"
    if light.near:
        return "bulb"
    return "sun" if _illuminant(light) is None else "booth"


def _colour_keys(light: Light) -> list[str]:
    """Lines of a scene file that give the light's colour; a sun needs none."""
    if light.near:
        kelvin = np.geomspace(1667, 25000, 2000)
        away = [float(((planck_colour(float(t)) - light.colour) ** 2).sum()) for t in kelvin]
        return [f"temperature_k = {kelvin[int(np.argmin(away))]:.0f}.0"]
    illuminant = _illuminant(light)
    return [] if illuminant is None else [f'illuminant = "{illuminant}"']


def _illuminant(light: Light) -> str | None:
    """Illuminant of a booth whose colour a far light has."""
    for name, place in ILLUMINANTS.items():
        if np.allclose(light.colour, linear_srgb(*place), atol=1e-9):
            return name
    return None


def _views(case: Case, camera: Camera) -> list[dict[str, Any]]:
    """The view of the pictures first, then the other named ones."""
    cameras = [camera, *(case.camera(name) for name in VIEWS if name != camera.name)]
    return [
        {
            "name": view.name,
            "position": view.position.tolist(),
            "target": view.target.tolist(),
            "up": view.up.tolist(),
            "fov": view.vertical_fov_deg,
            "size": list(view.size),
        }
        for view in cameras
    ]


def _wrinkles(case: Case, stage: Studio) -> list[dict[str, Any]]:
    """The worst wrinkles, with the direction from which each is seen."""
    mesh, solved = stage.surface.mesh, stage.surface.solved
    out = []
    for rank, wrinkle in enumerate(case.assessment.wrinkles, 1):
        away = ((mesh.vertices[:solved] - wrinkle.position) ** 2).sum(axis=1)
        out.append(
            {
                "label": f"{rank}: {wrinkle.panel}, {1e3 * wrinkle.length:.0f} mm long, "
                f"{1e3 * wrinkle.depth:.1f} mm deep",
                "cause": wrinkle.cause,
                "position": wrinkle.position.tolist(),
                "normal": mesh.normals[int(away.argmin())].tolist(),
                "length": wrinkle.length,
            }
        )
    return out


def _seams(case: Case, buffers: Buffers) -> list[str]:
    """Add points of all seams with the number of each; return the names."""
    stitchings = case.solution.cover.stitchings
    places = [stitching.a.at(case.solution.positions) for stitching in stitchings]
    if places:
        buffers.add("seam points", np.concatenate(places).astype(np.float32))
        numbers = np.repeat(np.arange(len(places)), [len(place) for place in places])
        buffers.add("seam numbers", numbers.astype(np.uint16))
    return [stitching.name for stitching in stitchings]
