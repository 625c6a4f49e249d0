"""What a cover is made of, as the kernels take it."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from seatlook.errors import InputError, did_you_mean
from seatlook.model import Appearance, Cover, FloatArray, Surroundings
from seatlook.pbr.kernels import stage, stitch, tables
from seatlook.pbr.kernels.brdf import MATERIAL
from seatlook.pbr.reflectance.instrument import resolved
from seatlook.pbr.reflectance.measured import load_maps, map_sets, mean_albedo
from seatlook.pbr.reflectance.relief import load_textures, texture_index
from seatlook.pbr.reflectance.tables import load_tables
from seatlook.pbr.shading.foam import FOAM, HIDDEN_FOAM
from seatlook.pbr.shading.ground import VALANCE, floor_look

Looks = Appearance | Mapping[str, Appearance] | None

# Nodes at which what a material lets through, and the fibres of its sheen, are tabulated.
_NODES, _SHEEN_NODES = 129, 513


def look_of(
    cover: Cover,
    appearance: Looks,
    thread: stitch.Thread,
    surroundings: Surroundings | None = None,
) -> stage.Look:
    """Materials of all panels, then foam, floor and valance, with what is tabulated for them.

    Raises
    ------
    InputError
        An appearance for a panel that the cover does not have.
    """
    looks = [*_per_panel(cover, appearance), FOAM]
    if surroundings is not None:
        looks[-1:] = [HIDDEN_FOAM, floor_look(surroundings.albedo), VALANCE]
    materials = pack_materials(looks)
    textures = load_textures(*{int(k) for k in materials["texture"] if k >= 0})
    maps = load_maps(map_sets(looks))
    return stage.Look(materials, *tabulated(materials), load_tables(), textures, maps, thread)


def tabulated(materials: np.ndarray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return ``couplings, layers, fibres`` of packed materials (p,), see ``kernels.stage.Look``."""
    albedos, p = load_tables(), len(materials)
    couplings = np.empty((p, len(albedos.scale_mean)))
    layers, fibres = np.empty((p, _NODES, 5)), np.empty((p, _SHEEN_NODES))
    tables.coupling(albedos, materials, couplings)
    tables.layers(albedos, materials, layers)
    tables.fibres(albedos, materials, fibres)
    return couplings, layers, fibres


def _per_panel(cover: Cover, appearance: Looks) -> list[Appearance]:
    """Appearance of every panel."""
    own = {n: m.appearance for n, m in zip(cover.panel_names, cover.materials, strict=True)}
    if isinstance(appearance, Appearance):
        own = dict.fromkeys(own, appearance)
    elif appearance is not None:
        unknown = sorted(set(appearance) - set(own))
        if unknown:
            raise InputError.single(
                "appearance",
                got=f"panel {unknown[0]!r}",
                expected=f"one of {', '.join(own)}",
                hint=did_you_mean(unknown[0], own),
            )
        own |= appearance
    return list(own.values())


def pack_materials(appearances: list[Appearance]) -> np.ndarray:
    """Records (p,) of the kernels' material type; the albedo is the mean of what is seen."""
    out = np.zeros(len(appearances), dtype=MATERIAL)
    sets = map_sets(appearances)
    for record, given in zip(out, appearances, strict=True):
        a = resolved(given)
        for name in MATERIAL.names or ():
            if name not in ("texture", "maps"):
                record[name] = getattr(a, name)
        record["texture"] = texture_index(a)
        record["maps"] = -1
        if a.maps is not None:
            record["maps"] = sets.index(a.maps)
            record["albedo"] *= mean_albedo(a.maps)
    return out
