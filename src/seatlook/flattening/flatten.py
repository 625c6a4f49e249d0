"""A design surface made into a flat pattern that fits it, with the strain that is left."""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from seatlook import mesh
from seatlook.errors import InputError, InputWarning, Problem, SeatlookError, did_you_mean
from seatlook.flattening.excess import Excess, excess_of
from seatlook.flattening.fabric_sheet import fabric_energy, strains_by_grain
from seatlook.flattening.face_map import stretches
from seatlook.flattening.lengths import agreed_ratios, relax_panel
from seatlook.flattening.pattern import pair, sewing_pattern
from seatlook.flattening.placement import poses
from seatlook.flattening.relax import flatten_patch
from seatlook.flattening.surface import FREE, DesignSurface, Patch, Side, sides
from seatlook.model import Fabric, FloatArray, Pattern, Pose
from seatlook.model.progress import Progress, silent

SEAM_TOLERANCE = 5e-5  # [m] by which the two lines of a seam may differ in length
SEAM_STRAIN = 0.015  # largest strain that a seam line may take


@dataclass(frozen=True, slots=True, kw_only=True)
class PanelStrain:
    """Strain a flat panel takes when laid onto its patch, area-weighted, from both principals.

    Parameters
    ----------
    energy : float [J]     stored by this in the fabric given, compression counting as tension
    """

    panel: str
    area: float
    mean: float
    rms: float
    smallest: float
    largest: float
    energy: float | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class SeamLengths:
    """Lengths [m] of a seam's two sewing lines and of the seam line on the design surface."""

    seam: str
    a: float
    b: float
    design: float

    @property
    def difference(self) -> float:
        """How much longer side a is than side b [m]."""
        return self.a - self.b


@dataclass(frozen=True, slots=True, kw_only=True)
class Flattened:
    """The pattern of a design surface.

    Parameters
    ----------
    pattern : Pattern
    placement : panel name -> Pose          near its patch, clear of the foam
    flat : panel name -> (n, 2) [m]         pattern position of each vertex of the panel's patch
    strain : (m, 2) float64 [1]             per face of the surface, small principal first;
                                            positive where the panel is stretched by the form
    grain_strain : (m, 3) float64 [1]       Green strain along warp, weft, and the angle between
    panels : tuple of PanelStrain
    seams : tuple of SeamLengths
    excess : tuple of Excess                panels strained more than their fabric takes
    """

    pattern: Pattern
    placement: MappingProxyType[str, Pose]
    flat: MappingProxyType[str, FloatArray]
    strain: FloatArray
    grain_strain: FloatArray
    panels: tuple[PanelStrain, ...]
    seams: tuple[SeamLengths, ...]
    excess: tuple[Excess, ...]


def flatten(
    surface: DesignSurface,
    *,
    allowance: float = 0.010,
    tension: float = 0.0,
    ease: Mapping[str, float] = MappingProxyType({}),
    short: Mapping[str, float] = MappingProxyType({}),
    fabrics: Mapping[str, Fabric] = MappingProxyType({}),
    progress: Progress = silent,
) -> Flattened:
    """Flatten every panel of a design surface and make a sewable pattern of them.

    Each panel first takes the shape of least strain energy by itself; then the two lines of a
    seam agree on the mean of their lengths, segment by segment, and the panels relax again with
    these lengths held. So both lines of a seam are equally long, piece by piece.

    Parameters
    ----------
    surface : DesignSurface
    allowance : float [m]         seam allowance and hem round every panel
    tension : float               all panels are drawn smaller by this fraction
    ease : edge or seam name -> fraction
        This sewing line becomes longer than its partner by the fraction; the panel is stretched
        along it, less and less over 150 mm or its width. A seam's name stands for the edge of its
        first panel.
    short : panel name -> fraction
        The panel becomes narrower across its grain.
    fabrics : panel name -> Fabric
        What the panel is made of: it takes the least strain energy of that, by its curves along
        warp and weft and in shear. A panel without takes that of an isotropic sheet.
    progress : called before each panel, twice: alone, then with the lengths of its seams held

    Returns
    -------
    Flattened

    Raises
    ------
    InputError
        A panel is not a disk; ``ease`` or ``short`` name nothing or ask too much.
    SeatlookError
        A panel has faces without area, or does not come to rest; its outline crosses itself in
        the plane; the lines of a seam differ by more than ``SEAM_TOLERANCE`` though none of them
        is eased.

    Warns
    -----
    InputWarning
        A panel is strained more than its fabric takes, before tension and short: where, how much
        and where a dart would go.
    """
    patches = surface.patches()
    borders = sides(patches)
    seams = pair(borders, surface.seam_lines)
    first = {seam.name: seam.a for seam in seams}
    ease = {first.get(name, name): value for name, value in ease.items()}
    _check("ease", ease, [s.name for s in borders if s.neighbour != FREE])
    _check("short", short, surface.panel_names)
    _check("tension", {"": tension}, [""])

    _check("fabrics", dict.fromkeys(fabrics, 0.0), surface.panel_names)

    count = len(patches)
    shapes = {}
    for step, patch in enumerate(patches):
        progress("flatten", panel=patch.name, step=step, steps=2 * count)
        shapes[patch.name] = _alone(patch, fabrics.get(patch.name))
    ratio = agreed_ratios(patches, borders, shapes, limit=SEAM_STRAIN)
    flat, excess = {}, []
    for step, patch in enumerate(patches, count):
        progress("flatten", panel=patch.name, step=step, steps=2 * count)
        own = [s for s in borders if s.panel == patch.name and s.neighbour != FREE]
        fabric = fabrics.get(patch.name)
        with _panel_named(patch):
            x = relax_panel(patch, own, ratio, shapes[patch.name], ease, fabric=fabric)
        wanted = max((abs(ease[s.name]) for s in own if s.name in ease), default=0.0)
        excess.append(excess_of(patch, x, fabric, allowed=wanted))
        # A panel of a fabric has kept the direction in which its grain was laid.
        x = (_grain_up(patch, x) if fabric is None else x) * (1 - tension)
        flat[patch.name] = x * [1 - short.get(patch.name, 0.0), 1.0]
    over = tuple(e for e in excess if e is not None)
    for each in over:
        warnings.warn(str(each), InputWarning, stacklevel=2)
    flattened = _report(surface, patches, borders, _side_by_side(flat), allowance, fabrics, over)
    _check_seams(flattened, spoiled={*ease, *short})
    return flattened


@contextmanager
def _panel_named(patch: Patch) -> Iterator[None]:
    """Name the panel in what goes wrong with it."""
    try:
        yield
    except SeatlookError as error:
        raise SeatlookError(f"panel {patch.name}: {error}") from None


def _alone(patch: Patch, fabric: Fabric | None) -> FloatArray:
    """Flatten a panel by itself; of a fabric with its grain laid."""
    with _panel_named(patch):
        x = flatten_patch(patch.vertices, patch.faces)
        if fabric is None:
            return x
        return flatten_patch(patch.vertices, patch.faces, start=_grain_up(patch, x), fabric=fabric)


def _report(
    surface: DesignSurface,
    patches: tuple[Patch, ...],
    borders: tuple[Side, ...],
    flat: dict[str, FloatArray],
    allowance: float,
    fabrics: Mapping[str, Fabric],
    excess: tuple[Excess, ...],
) -> Flattened:
    """Collect pattern, poses and figures."""
    strain = np.empty((len(surface.faces), 2))
    by_grain = np.empty((len(surface.faces), 3))
    panels = []
    for i, patch in enumerate(patches):
        rows, form = surface.panel == i, (patch.vertices, patch.faces, flat[patch.name])
        strain[rows] = stretches(*form) - 1
        by_grain[rows] = strains_by_grain(*form)
        fabric = fabrics.get(patch.name)
        stored = None if fabric is None else fabric_energy(by_grain[rows], fabric)
        panels.append(_panel_strain(patch, strain[rows], stored))
    pattern = sewing_pattern(patches, borders, flat, allowance, seam_lines=surface.seam_lines)
    design = {s.name: float(mesh.arc_length(surface.vertices[s.vertices])[-1]) for s in borders}
    return Flattened(
        pattern=pattern,
        placement=MappingProxyType(poses(patches, flat, pattern)),
        flat=MappingProxyType(flat),
        strain=strain,
        grain_strain=by_grain,
        panels=tuple(panels),
        seams=tuple(
            SeamLengths(
                seam=seam.name,
                a=pattern.edge_length(seam.a),
                b=pattern.edge_length(seam.b[0]),
                design=design[seam.a],
            )
            for seam in pattern.seams
        ),
        excess=excess,
    )


def _panel_strain(patch: Patch, strain: FloatArray, stored: FloatArray | None) -> PanelStrain:
    area = mesh.face_areas(patch.vertices, patch.faces)
    share = area[:, None] / (2 * area.sum())
    return PanelStrain(
        panel=patch.name,
        area=float(area.sum()),
        mean=float((share * strain).sum()),
        rms=float(np.sqrt((share * strain**2).sum())),
        smallest=float(strain.min()),
        largest=float(strain.max()),
        energy=None if stored is None else float(area @ stored),
    )


def _check_seams(flattened: Flattened, *, spoiled: set[str]) -> None:
    """Refuse lines of a seam that differ in length though neither is eased or short."""
    for line, seam in zip(flattened.seams, flattened.pattern.seams, strict=True):
        edges = {seam.a, *seam.b}
        if spoiled & (edges | {flattened.pattern.edges[name].panel for name in edges}):
            continue
        if abs(line.difference) > SEAM_TOLERANCE:
            raise SeatlookError(
                f"seam {line.seam}: its lines are {1e3 * line.a:.3f} and {1e3 * line.b:.3f} mm "
                f"long, more than {1e3 * SEAM_TOLERANCE:g} mm apart"
            )


def _check(key: str, fractions: Mapping[str, float], names: Sequence[str]) -> None:
    """Refuse names that do not exist and fractions that no pattern maker would use."""
    problems = [
        Problem(
            key=key,
            got=repr(name),
            expected=f"one of {', '.join(names)}",
            hint=did_you_mean(name, names),
        )
        for name in fractions
        if name not in names
    ]
    problems += [
        Problem(key=f"{key} {name}".strip(), got=f"{value:g}", expected="-0.2 to 0.2")
        for name, value in fractions.items()
        if not abs(value) <= 0.2
    ]
    if problems:
        raise InputError(problems)


def _grain_up(patch: Patch, flat: FloatArray) -> FloatArray:
    """Turn a flat patch so that the way from front to rear runs along +y.

    Where the panel faces front or rear, upward takes the place of rearward.
    """
    normal = mesh.face_vectors(patch.vertices, patch.faces)
    area = np.linalg.norm(normal, axis=1)
    away = np.abs(normal[:, 1]).sum() / area.sum()
    axis = patch.vertices[:, 1] if away < np.sqrt(0.5) else patch.vertices[:, 2]
    # Slope of the world axis over the flat panel, in the least-squares sense.
    centred = flat - flat.mean(axis=0)
    slope, *_ = np.linalg.lstsq(centred, axis - axis.mean())
    c, s = slope[::-1] / np.linalg.norm(slope)
    return np.asarray(flat @ np.array([[c, -s], [s, c]]).T)


def _side_by_side(flat: Mapping[str, FloatArray], gap: float = 0.05) -> dict[str, FloatArray]:
    """Lay the panels out in a row above the first axis."""
    placed, right = {}, 0.0
    for name, x in flat.items():
        placed[name] = np.ascontiguousarray(x - x.min(axis=0) + [right, 0.0])
        right = placed[name][:, 0].max() + gap
    return placed
