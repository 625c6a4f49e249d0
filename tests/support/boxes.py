"""Box cushions, headrests and pillows: five rectangles over a rounded block, held by its rim."""

from types import MappingProxyType

import numpy as np

from seatlook import model
from support.scenes import edge, foam_material, material, rectangle

SIDES = ("FRONT", "RIGHT", "BACK", "LEFT")


def rounded_block(size, radius, spacing):
    """Closed block with its middle over the origin and its bottom at z = 0, rounded all round."""
    size = np.asarray(size, float)
    vertices, faces = [], []
    for axis in range(3):
        for sign in (-1.0, 1.0):
            u, v = (axis + 1) % 3, (axis + 2) % 3
            nu, nv = (max(1, round(size[k] / spacing)) for k in (u, v))
            i, j = np.meshgrid(np.arange(nu + 1), np.arange(nv + 1), indexing="ij")
            sheet = np.zeros((nu + 1, nv + 1, 3))
            sheet[..., axis] = sign * size[axis] / 2
            sheet[..., u] = (i / nu - 0.5) * size[u]
            sheet[..., v] = (j / nv - 0.5) * size[v]
            at = sum(map(len, vertices)) + np.arange((nu + 1) * (nv + 1)).reshape(nu + 1, nv + 1)
            a, b, c, d = at[:-1, :-1], at[1:, :-1], at[1:, 1:], at[:-1, 1:]
            quads = np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)
            faces.append(quads if sign > 0 else quads[:, ::-1])
            vertices.append(sheet.reshape(-1, 3))
    x, faces = np.concatenate(vertices), np.concatenate(faces)
    _, first, same = np.unique(np.round(x, 9), axis=0, return_index=True, return_inverse=True)
    x, faces = x[first], same.reshape(-1)[faces]
    inner = np.clip(x, -size / 2 + radius, size / 2 - radius)
    away = x - inner
    length = np.linalg.norm(away, axis=1, keepdims=True)
    x = np.where(length > 0, inner + radius * away / np.maximum(length, 1e-12), x)
    return x + np.array([0.0, 0.0, size[2] / 2]), faces


def box_scene(
    size=(0.28, 0.13, 0.176),
    *,
    radius=0.02,
    tension=0.01,
    start=0.03,
    element_size=0.01,
    spacing=0.006,
    name="headrest",
):
    """TOP and four sides over a block of ``size`` [m]; the sides' lower edges go to its rim.

    ``start`` [m] is how far outside each panel begins.
    """
    w, d, h = size
    spare = (2.0 - np.pi / 2) * radius  # of two rounded edges against two sharp ones
    across, deep = (1 - tension) * (w - spare), (1 - tension) * (d - spare)
    high = (1 - tension) * (h - spare / 2 - 0.5 * radius)
    level = 0.0005
    panels = [rectangle("TOP", across, deep)]
    panels += [
        rectangle(side, across if side in ("FRONT", "BACK") else deep, high) for side in SIDES
    ]
    # Corner k of TOP to the next is its edge to this side, counter-clockwise from the front.
    edges, seams = [], []
    for k, side in enumerate(SIDES):
        edges += [
            edge(f"TOP.{side}", "TOP", k, (k + 1) % 4),
            edge(f"{side}.TOP", side, 2, 3),
            edge(f"{side}.free", side, 0, 1),
            edge(f"{side}.next", side, 1, 2),
            edge(f"{side}.before", side, 3, 0),
        ]
        seams.append(
            model.Seam(name=f"TOP-{side}", a=f"TOP.{side}", b=(f"{side}.TOP",), reverse=True)
        )
        seams.append(
            model.Seam(
                name=f"{side}-{SIDES[(k + 1) % 4]}",
                a=f"{side}.next",
                b=(f"{SIDES[(k + 1) % 4]}.before",),
                reverse=True,
            )
        )
    poses = {
        "TOP": model.Pose(
            rotation=np.eye(3), translation=np.array([-across / 2, -deep / 2, h + start])
        )
    }
    curves, frames = {}, []
    rim = 0.5 * np.array([w, d]) - 0.3 * radius
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]]) * rim
    for k, side in enumerate(SIDES):
        turn = np.pi / 2 * k
        along = np.array([np.cos(turn), np.sin(turn), 0.0])
        outward = np.array([along[1], -along[0], 0.0])
        half, reach = ((across, d), (deep, w))[k % 2]
        poses[side] = model.Pose(
            rotation=np.column_stack([along, [0.0, 0.0, 1.0], outward]),
            translation=outward * (reach / 2 + start) - along * half / 2 + [0, 0, 0.3 * radius],
        )
        ends = np.stack([corners[k], corners[(k + 1) % 4]])
        curves[f"rim {side}"] = np.column_stack([ends, np.full(2, level)])
        frames.append(
            model.Frame(
                name=f"rim {side}", edges=(f"{side}.free",), curve=f"rim {side}", stage="cover"
            )
        )
    vertices, faces = rounded_block(size, radius, spacing)
    cloth = material()
    return model.Scene(
        name=name,
        path=None,
        digest=name,
        pattern=model.Pattern(
            panels=tuple(panels), edges=MappingProxyType(dict(edges)), seams=tuple(seams)
        ),
        foam=model.Foam(
            vertices=vertices,
            faces=faces,
            material=foam_material(),
            curves=MappingProxyType(curves),
        ),
        materials=MappingProxyType({panel.name: cloth for panel in panels}),
        placement=MappingProxyType(poses),
        stages=(
            model.Stage(name="sew", start=0.0, end=0.5),
            model.Stage(name="cover", start=0.3, end=0.9),
            model.Stage(name="rest", start=0.9, end=1.2),
        ),
        frames=tuple(frames),
        rigs=(model.Rig(name="sun", lights=(model.sun(elevation_deg=50.0, azimuth_deg=30.0),)),),
        cameras=(model.framed_view("front_34", vertices, size=(640, 480)),),
        element_size=element_size,
    )
