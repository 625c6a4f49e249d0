"""Pattern + foam + materials -> Cover: mesh the panels, pose them, list what pulls on what."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType

import numpy as np

from seatlook import mesh
from seatlook.assembly.builder import Builder
from seatlook.assembly.digest import content_digest
from seatlook.assembly.grading import Grading
from seatlook.assembly.hem import hem_of
from seatlook.assembly.placing import with_poses
from seatlook.errors import AssemblyError, InputError, Problem
from seatlook.model import Cover, FloatArray, Hook, IntArray, Panel, Scene, criteria_of
from seatlook.model.scene import ELEMENT_SIZES, FIRST_SIZE, LARGEST_SEED, TOLERANCES
from seatlook.model.zones import zones

# Wavelengths [m] of a cut panel's unevenness: from the shortest wrinkle of a cover on its foam to
# the size of a panel. Shorter waves would be crumpling, and store as much work as the making takes.
_SHORTEST, _LONGEST = 0.03, 0.24
_WAVES = 64


def assemble(
    scene: Scene,
    *,
    element_size: float | None = None,
    seed: int | None = None,
    sizes: Mapping[str, Grading] = MappingProxyType({}),
) -> Cover:
    """Mesh and place all panels of a scene and pair up what is sewn, hooked and framed.

    Parameters
    ----------
    scene : Scene
    element_size : float [m], optional      overrides the scene's; panels' own scale with it
    seed : int, optional                    overrides the scene's; drives mesh and imperfection
    sizes : panel name -> sizes             of panels whose element size varies inside

    Returns
    -------
    Cover
        Panels in the pattern's order, ready for ``solve``. It carries the scene's criteria and the
        digest of the scene with these two.

    Notes
    -----
    Panels without a pose are laid out over the foam, see :func:`with_poses`.

    Raises
    ------
    AssemblyError
        A panel without material, or parts that do not fit each other; all of them at once.
    InputError
        A panel that cannot be meshed at this element size.
    """
    _check_materials(scene)
    scene = with_mesh(scene, element_size=element_size, seed=seed)
    digest = content_digest(scene)
    scene = with_poses(scene)
    panels = scene.pattern.panels
    builder = Builder(scene.pattern, scene.element_size, {**scene.element_sizes, **sizes})
    for i, panel in enumerate(panels):
        builder.add(panel, _hooked_lines(scene.hooks, panel), seed=1000 * scene.seed + i)
    uv, faces, owner = builder.arrays()
    placed = _placed(uv, owner, scene)
    zone, zone_names = zones(
        uv[faces].mean(axis=1), owner[faces[:, 0]], scene.pattern, boxes=scene.boxes
    )
    materials = tuple(scene.materials[p.name] for p in panels)
    return Cover(
        rest=_along_grain(uv, owner, panels),
        uv=uv,
        positions=placed + _imperfection(uv, owner, scene),
        faces=faces,
        panel=owner[faces[:, 0]],
        panel_names=tuple(p.name for p in panels),
        materials=materials,
        zone=zone,
        zone_names=zone_names,
        stitchings=tuple(builder.stitching(s, scene.stage_of(s.name)) for s in scene.pattern.seams),
        anchors=(
            *(builder.hook(hook, scene, placed) for hook in scene.hooks),
            *(builder.frame(frame, scene, placed) for frame in scene.frames),
        ),
        hem=hem_of(builder, scene, uv, faces) if scene.hem and scene.pattern.seams else None,
        stages=scene.stages,
        foam=scene.foam,
        thread=scene.thread,
        seam_kinds=scene.seam_kinds,
        criteria=criteria_of(materials, scene.curvature, default=scene.c_threshold),
        element_size=float(mesh.edge_lengths(uv, faces).mean()),
        seed=scene.seed,
        scene_digest=digest,
    )


def with_mesh(
    scene: Scene,
    *,
    element_size: float | None = None,
    tolerance: float | None = None,
    seed: int | None = None,
) -> Scene:
    """Put another element size [m], or tolerance of zone means, and seed into a scene.

    Panels' own sizes scale with the size. A size goes in place of a tolerance, and the other way.

    Raises
    ------
    InputError   both, or one that is out of bounds
    """
    if element_size is not None and tolerance is not None:
        raise InputError.single(
            "tolerance_percent", got="element_size_mm as well", expected="one of them"
        )
    if tolerance is not None:
        low, high = TOLERANCES
        if not low <= tolerance <= high:
            raise InputError.single(
                "tolerance_percent", got=f"{100 * tolerance:g}",
                expected=f"{100 * low:g} to {100 * high:g}",
            )  # fmt: skip
        scene = replace(
            scene,
            tolerance=tolerance,
            element_size=FIRST_SIZE,
            element_sizes=MappingProxyType({}),
        )
    elif element_size is not None:
        scene = replace(scene, tolerance=None)
    size = scene.element_size if element_size is None else element_size
    finest, coarsest = ELEMENT_SIZES
    if not finest <= size <= coarsest:
        raise InputError.single(
            "element_size_mm", got=f"{1e3 * size:g}",
            expected=f"{1e3 * finest:g} to {1e3 * coarsest:g}",
        )  # fmt: skip
    if seed is not None and not 0 <= seed <= LARGEST_SEED:
        raise InputError.single("seed", got=seed, expected=f"0 to {LARGEST_SEED}")
    scale = size / scene.element_size
    return replace(
        scene,
        element_size=size,
        element_sizes=MappingProxyType({n: scale * s for n, s in scene.element_sizes.items()}),
        seed=scene.seed if seed is None else seed,
    )


def _check_materials(scene: Scene) -> None:
    """Refuse panels without material, all named at once."""
    problems = [
        Problem(key=f"panel.{panel.name}", got="nothing", expected="a material", file=scene.path)
        for panel in scene.pattern.panels
        if panel.name not in scene.materials
    ]
    if problems:
        raise AssemblyError(problems)


def _placed(uv: FloatArray, owner: IntArray, scene: Scene) -> FloatArray:
    """Positions (n, 3) [m] of all vertices before sewing, each panel flat."""
    poses = [scene.placement[p.name] for p in scene.pattern.panels]
    axes = np.stack([pose.rotation[:, :2] for pose in poses])
    origin = np.stack([pose.translation for pose in poses])
    return np.asarray(np.einsum("nij,nj->ni", axes[owner], uv) + origin[owner])


def _along_grain(uv: FloatArray, owner: IntArray, panels: Sequence[Panel]) -> FloatArray:
    """Turn pattern coordinates (n, 2) so that the first axis runs along the warp."""
    turned = np.empty_like(uv)
    for number, panel in enumerate(panels):
        turned[owner == number] = panel.in_grain(uv[owner == number])
    return turned


def _imperfection(uv: FloatArray, owner: IntArray, scene: Scene) -> FloatArray:
    """Offset (n, 3) [m] along the panels' normals, rms 0.3 t: a flat sheet never buckles."""
    names = [p.name for p in scene.pattern.panels]
    thickness = np.array([scene.materials[name].fabric.thickness for name in names])
    normal = np.stack([scene.placement[name].rotation[:, 2] for name in names])
    height = 0.3 * thickness[owner] * _waves(uv, scene.seed)
    return np.asarray(height[:, None] * normal[owner])


def _waves(uv: FloatArray, seed: int) -> FloatArray:
    """Random smooth field (n,) of rms 1 on any mesh, as a cut panel lies on the table.

    Every wavelength bends the panel as much as any other, so the long ones are the high ones.
    """
    rng = np.random.default_rng(seed)
    wavelength = _SHORTEST * (_LONGEST / _SHORTEST) ** rng.random(_WAVES)
    angle, phase = 2 * np.pi * rng.random((2, _WAVES))
    k = 2 * np.pi / wavelength * np.stack([np.cos(angle), np.sin(angle)])
    amplitude = wavelength**2 / np.sqrt(0.5 * (wavelength**4).sum())
    return np.asarray(np.cos(uv @ k + phase) @ amplitude)


def _hooked_lines(hooks: Sequence[Hook], panel: Panel) -> dict[str, FloatArray]:
    """Internal lines of a panel that a hook pulls on; only these must be mesh edges."""
    names = {f"{panel.name}/{line}": line for line in panel.internal_lines}
    hooked = {line for hook in hooks for line in hook.lines}
    return {name: panel.internal_lines[line] for name, line in names.items() if name in hooked}
