"""Physically based pictures of a solved cover, and maps of values on it.

Public names load on first use: VTK and Numba stay out of ``import seatlook``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from seatlook._door import door

if TYPE_CHECKING:
    from seatlook.pbr.backend import (
        offscreen_backend as offscreen_backend,
    )
    from seatlook.pbr.light.exposure import (
        ev100 as ev100,
    )
    from seatlook.pbr.light.rig import (
        illuminance as illuminance,
    )
    from seatlook.pbr.light.rig import (
        lux_at_seat as lux_at_seat,
    )
    from seatlook.pbr.maps.checker import (
        render_checker as render_checker,
    )
    from seatlook.pbr.maps.face_map import (
        render_map as render_map,
    )
    from seatlook.pbr.maps.preview import (
        render_preview as render_preview,
    )
    from seatlook.pbr.picture import (
        Image as Image,
    )
    from seatlook.pbr.picture import (
        Picture as Picture,
    )
    from seatlook.pbr.reflectance.instrument import (
        appearance_of as appearance_of,
    )
    from seatlook.pbr.reflectance.instrument import (
        gloss as gloss,
    )
    from seatlook.pbr.reflectance.instrument import (
        lab as lab,
    )
    from seatlook.pbr.reflectance.relief import (
        bake_grain as bake_grain,
    )
    from seatlook.pbr.shading.studio import (
        Studio as Studio,
    )
    from seatlook.pbr.shading.studio import (
        render as render,
    )

# name -> module; loaded on first use, so that "seatlook --help" stays light.
_PUBLIC: dict[str, str] = {
    "Image": "seatlook.pbr.picture",
    "Picture": "seatlook.pbr.picture",
    "Studio": "seatlook.pbr.shading.studio",
    "appearance_of": "seatlook.pbr.reflectance.instrument",
    "bake_grain": "seatlook.pbr.reflectance.relief",
    "ev100": "seatlook.pbr.light.exposure",
    "gloss": "seatlook.pbr.reflectance.instrument",
    "illuminance": "seatlook.pbr.light.rig",
    "lab": "seatlook.pbr.reflectance.instrument",
    "lux_at_seat": "seatlook.pbr.light.rig",
    "offscreen_backend": "seatlook.pbr.backend",
    "render": "seatlook.pbr.shading.studio",
    "render_checker": "seatlook.pbr.maps.checker",
    "render_map": "seatlook.pbr.maps.face_map",
    "render_preview": "seatlook.pbr.maps.preview",
}

__all__ = [
    "Image",
    "Picture",
    "Studio",
    "appearance_of",
    "bake_grain",
    "ev100",
    "gloss",
    "illuminance",
    "lab",
    "lux_at_seat",
    "offscreen_backend",
    "render",
    "render_checker",
    "render_map",
    "render_preview",
]

if not TYPE_CHECKING:
    __getattr__, __dir__ = door(__name__, _PUBLIC)
