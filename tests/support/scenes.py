"""Small scenes made by hand: two rectangles side by side over a flat block of foam."""

from types import MappingProxyType

import numpy as np

from seatlook import model


def fabric(**change) -> model.Fabric:
    values = {
        "thickness": 0.001,
        "density": 0.6,
        "warp": model.Curve.linear(6000.0),
        "weft": model.Curve.linear(5000.0),
        "shear": model.Curve.linear(1500.0),
        "bending_warp": 1e-3,
        "bending_weft": 8e-4,
        "bending_twist": 4e-4,
    }
    return model.Fabric(**(values | change))


def material(name: str = "cloth", **change) -> model.Material:
    return model.Material(
        name=name,
        fabric=fabric(**change),
        appearance=model.Appearance(albedo=np.full(3, 0.2), roughness=0.6),
    )


def foam_material() -> model.FoamMaterial:
    return model.FoamMaterial(
        name="foam",
        strain=np.array([0.0, 0.1, 0.4, 0.6, 0.8]),
        stress=np.array([0.0, 2500.0, 5000.0, 8000.0, 25000.0]),
        young=25e3,
        poisson=0.2,
        friction=0.5,
    )


def rectangle(name: str, width: float, depth: float, *, angle: float = 90.0) -> model.Panel:
    outline = np.array([[0.0, 0.0], [width, 0.0], [width, depth], [0.0, depth]])
    turn = np.radians(angle)
    return model.Panel(
        name=name,
        outline=outline,
        corners=np.arange(4),
        cut_outline=outline,
        grain=np.array([np.cos(turn), np.sin(turn)]),
    )


def edge(name: str, panel: str, start: int, end: int) -> tuple[str, model.Edge]:
    return name, model.Edge(name=name, panel=panel, start=start, end=end)


def block(low, high) -> tuple[np.ndarray, np.ndarray]:
    """Closed box of 12 triangles with outward normals."""
    low, high = np.asarray(low, float), np.asarray(high, float)
    corners = np.array([[x, y, z] for z in (0, 1) for y in (0, 1) for x in (0, 1)])
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    faces = [f for a, b, c, d in quads for f in ((a, b, c), (a, c, d))]
    return low + corners * (high - low), np.array(faces)


def two_panels(*, gap: float = 0.02, depth_b: float = 0.1, element_size: float = 0.01):
    """LEFT (0.10 x 0.10) and RIGHT (0.08 x depth_b) sewn along LEFT's right edge."""
    pattern = model.Pattern(
        panels=(rectangle("LEFT", 0.1, 0.1), rectangle("RIGHT", 0.08, depth_b, angle=0.0)),
        edges=MappingProxyType(
            dict(
                [
                    edge("LEFT.seam", "LEFT", 1, 2),
                    edge("RIGHT.seam", "RIGHT", 3, 0),
                    edge("LEFT.rim", "LEFT", 3, 0),
                ]
            )
        ),
        seams=(model.Seam(name="middle", a="LEFT.seam", b=("RIGHT.seam",)),),
    )
    vertices, faces = block([-0.05, -0.05, -0.1], [0.25, 0.15, 0.0])
    cloth = material()
    level = 0.0006
    return model.Scene(
        name="two panels",
        path=None,
        digest="two panels",
        pattern=pattern,
        foam=model.Foam(
            vertices=vertices,
            faces=faces,
            material=foam_material(),
            curves=MappingProxyType(
                {
                    "wire": np.array([[0.1, 0.1, level], [0.1, 0.0, level]]),
                    "rail": np.array([[0.0, 0.0, level], [0.0, 0.1, level]]),
                }
            ),
        ),
        materials=MappingProxyType({"LEFT": cloth, "RIGHT": cloth}),
        placement=MappingProxyType(
            {
                "LEFT": model.Pose(rotation=np.eye(3), translation=np.array([0.0, 0.0, 0.005])),
                "RIGHT": model.Pose(
                    rotation=np.eye(3), translation=np.array([0.1 + gap, 0.0, 0.005])
                ),
            }
        ),
        stages=(
            model.Stage(name="sew", start=0.0, end=0.4),
            model.Stage(name="cover", start=0.2, end=0.6),
        ),
        hooks=(model.Hook(name="hook", line="middle", wire="wire", stage="cover"),),
        frames=(model.Frame(name="rail", edges=("LEFT.rim",), curve="rail", stage="cover"),),
        rigs=(model.Rig(name="sun", lights=(model.sun(elevation_deg=50.0, azimuth_deg=30.0),)),),
        cameras=(model.named_view("top", target=np.array([0.09, 0.05, 0.0]), size=(64, 48)),),
        element_size=element_size,
    )
