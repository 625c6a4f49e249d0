"""The same picture by PyVista's physically based shading as it comes, for the chart only."""

from __future__ import annotations

import numpy as np

from seatlook.model import Appearance, Camera, Rig
from seatlook.pbr.shading.studio import Studio


def stock(studio: Studio, appearance: Appearance, *, rig: Rig, camera: Camera) -> np.ndarray:
    """Radiance (h, w, 3) read back from the eight-bit picture, twice the size and averaged.

    PyVista's lights are in no unit; here they are those that make a facing white card 0.5.
    """
    import pyvista

    mesh = studio.surface.cover_mesh
    faces = np.column_stack([np.full(len(mesh.faces), 3), mesh.faces])
    body = pyvista.PolyData(mesh.vertices, faces)
    body.point_data["Normals"] = mesh.normals
    body.point_data.active_normals_name = "Normals"
    width, height = camera.size
    plotter = pyvista.Plotter(off_screen=True, window_size=(2 * width, 2 * height), lighting="none")
    plotter.add_mesh(
        body, color=appearance.albedo.tolist(), pbr=True, metallic=appearance.metalness,
        roughness=appearance.roughness, smooth_shading=True,
    )  # fmt: skip
    strongest = max(lit(light, camera) for light in rig.lights)
    for light in rig.lights:
        lamp = pyvista.Light(light_type="scene light", color=(light.colour / light.colour.max()))
        lamp.positional = light.near
        lamp.position = (light.vector if light.near else 100 * light.vector).tolist()
        lamp.focal_point = camera.target.tolist()
        if light.near:
            lamp.cone_angle = 90
            lamp.attenuation_values = (0, 0, 1)
        lamp.intensity = 1.5 * light.intensity * light.colour.max() / strongest
        plotter.add_light(lamp)
    plotter.camera.position = camera.position.tolist()
    plotter.camera.focal_point = camera.target.tolist()
    plotter.camera.up = camera.up.tolist()
    plotter.camera.view_angle = camera.vertical_fov_deg
    picture = plotter.screenshot(return_img=True).astype(float) / 255
    plotter.close()
    linear = (picture**2.2).reshape(height, 2, width, 2, 3).mean(axis=(1, 3))
    return linear * strongest / 1.5


def lit(light, camera: Camera) -> float:
    """Largest channel of the irradiance [lux] on a plane at the target that faces the light."""
    e = light.intensity * light.colour.max()
    if light.near:
        e /= float(((light.vector - camera.target) ** 2).sum())
    return e
