"""A small cover: two panels sewn in the valley of a crowned block of foam, held all round."""

import dataclasses
from types import MappingProxyType

import numpy as np
from scipy.interpolate import CloughTocher2DInterpolator
from scipy.ndimage import gaussian_filter

from seatlook import flattening, io, mesh, model
from support import scenes

WIDTH, DEPTH, SEAM = 0.24, 0.18, 0.02
SPREAD = 0.018  # standard deviation of the valley [m]


def height(x, y, valley):
    return (
        -(x**2) / (2 * 0.5) - y**2 / (2 * 0.8) - valley * np.exp(-0.5 * ((x - SEAM) / SPREAD) ** 2)
    )


def lifted(p, valley, offset=0.0):
    """Points (k, 2) on the surface, moved along its normal."""
    e = 1e-6
    x, y = p.T
    slope = [
        (height(x + e, y, valley) - height(x - e, y, valley)) / (2 * e),
        (height(x, y + e, valley) - height(x, y - e, valley)) / (2 * e),
    ]
    normal = np.column_stack([-slope[0], -slope[1], np.ones(len(p))])
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    return np.column_stack([p, height(x, y, valley)]) + offset * normal


def surface(thickness, valley, h=0.005):
    a, b = WIDTH / 2, DEPTH / 2
    corners = np.array([[-a, -b], [SEAM, -b], [a, -b], [a, b], [SEAM, b], [-a, b]])
    sides = zip(corners, np.roll(corners, -1, axis=0), strict=True)
    rim = np.concatenate([mesh.resample(np.array(side), h)[:-1] for side in sides])
    cut = mesh.resample(np.array([[SEAM, -b], [SEAM, b]]), h)
    points, faces = mesh.triangulate(rim, h, lines=[cut])
    return flattening.DesignSurface(
        vertices=lifted(points, valley, thickness / 2),
        faces=faces,
        panel=(points[faces].mean(axis=1)[:, 0] > SEAM).astype(np.int64),
        panel_names=("LEFT", "RIGHT"),
    )


def foam(material, valley, h=0.005, margin=0.02):
    a, b = WIDTH / 2 + margin, DEPTH / 2 + margin
    corners = np.array([[-a, -b], [a, -b], [a, b], [-a, b]])
    sides = zip(corners, np.roll(corners, -1, axis=0), strict=True)
    rim = np.concatenate([mesh.resample(np.array(side), h)[:-1] for side in sides])
    points, faces = mesh.triangulate(rim, h)
    n, k = len(points), len(rim)
    below = np.column_stack([rim, np.full(k, -0.09)])
    i, j = np.arange(k), np.roll(np.arange(k), -1)
    walls = np.concatenate([np.column_stack([j, i, n + i]), np.column_stack([j, n + i, n + j])])
    bottom, closing = mesh.triangulate(rim, h)
    number = np.concatenate([n + np.arange(k), n + np.arange(k, len(bottom))])
    inner = np.column_stack([bottom[k:], np.full(len(bottom) - k, -0.09)])
    return model.Foam(
        vertices=np.concatenate([lifted(points, valley), below, inner]),
        faces=np.concatenate([faces, walls, number[closing[:, ::-1]]]),
        material=material,
    )


def scene(
    *,
    material="black-leather",
    h=0.006,
    tension=0.005,
    valley=0.005,
    ease=0.0,
    short=0.0,
    **change,
):
    """Scene of the patch; ``change`` goes into the Scene."""
    cloth = io.read_material(material)
    cushion = io.read_foam_material(io.materials_dir() / "foam-seat.toml")
    drawn = surface(cloth.fabric.thickness, valley)
    flat = flattening.flatten(
        drawn,
        tension=tension,
        ease={"LEFT-RIGHT": ease} if ease else {},
        short={"RIGHT": short} if short else {},
    )
    patches = {p.name: p for p in drawn.patches()}
    sewn = {name for seam in flat.pattern.seams for name in (seam.a, *seam.b)}
    curves, frames = {}, []
    for edge in flat.pattern.edges.values():
        if edge.name in sewn:
            continue
        patch, own = patches[edge.panel], flat.flat[edge.panel]
        line = flat.pattern.edge_points(edge.name)
        nearest = np.linalg.norm(line[:, None] - own, axis=2).argmin(axis=1)
        curves[edge.name] = patch.vertices[nearest]
        frames.append(
            model.Frame(name=edge.name, edges=(edge.name,), curve=edge.name, stage="cover")
        )
    curves["wire"] = lifted(
        np.column_stack([np.full(60, SEAM), np.linspace(-DEPTH / 2, DEPTH / 2, 60)]),
        valley,
        cloth.fabric.thickness / 2,
    )
    values = {
        "pattern": flat.pattern,
        "foam": dataclasses.replace(foam(cushion, valley), curves=MappingProxyType(curves)),
        "materials": MappingProxyType(dict.fromkeys(("LEFT", "RIGHT"), cloth)),
        "placement": flat.placement,
        "hooks": (),
        "frames": tuple(frames),
        "element_size": h,
        "stages": (
            model.Stage(name="sew", start=0.0, end=0.24),
            model.Stage(name="cover", start=0.16, end=0.4),
        ),
    }
    return dataclasses.replace(scenes.two_panels(), **(values | change))


def with_pitch(sewing, pitch):
    seams = tuple(dataclasses.replace(s, pitch=pitch) for s in sewing.pattern.seams)
    return dataclasses.replace(sewing, pattern=dataclasses.replace(sewing.pattern, seams=seams))


GRID = 0.002
X, Y = np.meshgrid(
    np.arange(-WIDTH / 2 + 0.03, WIDTH / 2 - 0.03, GRID),
    np.arange(-DEPTH / 2 + 0.03, DEPTH / 2 - 0.03, GRID),
)


def heights(solution):
    """Height of the cover over a grid that every mesh shares [m]."""
    x = solution.positions
    return CloughTocher2DInterpolator(x[:, :2], x[:, 2])(X, Y)


def low_passed_w2(solution, cutoff=0.048, c_threshold=20.0):
    """Mean W2 of the surface through a Gaussian filter that halves waves of ``cutoff`` [m]."""
    sigma = cutoff / GRID * np.sqrt(np.log(2) / 2) / np.pi
    z = gaussian_filter(heights(solution), sigma, mode="nearest")
    zy, zx = np.gradient(z, GRID)
    zxy, zxx = np.gradient(zx, GRID)
    zyy, _ = np.gradient(zy, GRID)
    # kappa > 0 on a crown; a valley's is below 0.
    a, b, c = -zxx, -zxy, -zyy
    smallest = 0.5 * (a + c) - np.sqrt(0.25 * (a - c) ** 2 + b**2)
    inside = (slice(6, -6), slice(6, -6))
    return float(np.maximum(-smallest[inside], 0.0).mean() / c_threshold)


def shape_rms(a, b):
    """Root mean square of the difference of two covers' heights [m]."""
    return float(np.sqrt(np.mean((heights(a) - heights(b)) ** 2)))
