"""One assessment of a result: indices, zones, worst wrinkles, sections, distortion, distances.

Everything that says how much a cover wrinkles is asked here: for results of seatlook, for those of
other programs, by the command line, the page and notebooks alike.
"""

from __future__ import annotations

from functools import cached_property

import numpy as np

from seatlook.errors import InputError
from seatlook.model import (
    Criteria,
    Design,
    Field,
    FloatArray,
    Limit,
    Scene,
    Solution,
    Strains,
    WrinkleMap,
    criteria_of,
)
from seatlook.model.scene import SCORE_MEASURES, Verdict
from seatlook.model.zones import FREE_EDGE
from seatlook.results.deviation import SeamLine, deviation, seam_lines
from seatlook.results.gap import ZoneGap, gap, zone_gaps
from seatlook.results.resolution import Resolution, resolution
from seatlook.wrinkle import (
    DESIGN_WAVELENGTH,
    INDICES,
    Advice,
    Distortion,
    DistortionRow,
    SeamStretch,
    Section,
    Surface,
    Wrinkle,
    ZoneRow,
    advise,
    beside_sections,
    distortion,
    distortion_table,
    low_passed,
    map_top,
    seam_excess,
    section_across,
    worst_wrinkles,
    wrinkle_indices,
    zone_table,
)

WORST = 5  # wrinkles that are listed


def wrinkle_map(criteria: Criteria, solution: Solution | Strains) -> WrinkleMap:
    """Evaluate eqs. (1) to (6) by some criteria.

    Raises
    ------
    InputError
        Strains that are not finite, thresholds for another number of panels.
    """
    strains = solution if isinstance(solution, Strains) else solution.strains
    return wrinkle_indices(
        strains.top,
        strains.mid,
        strains.bottom,
        strains.thickness,
        criteria.per_face(strains.panel),
        curvature=criteria.curvature,
        strain_measure=criteria.strain_measure,
    )


class Assessment:
    """What a result says; each part is made when it is first asked for, and kept.

    Attributes
    ----------
    solution : Solution
    criteria : Criteria
    design : Design or None    surface that the finished cover is to have
    """

    def __init__(
        self,
        solution: Solution,
        criteria: Criteria,
        *,
        strains: Strains | None = None,
        design: Design | None = None,
    ) -> None:
        self.solution, self.criteria, self.design = solution, criteria, design
        self._strains = solution.strains if strains is None else strains
        self._values: dict[str, FloatArray] = {}

    def __repr__(self) -> str:
        worst = max(self.zones, key=lambda row: row["w2_p95"])
        return (
            f"Assessment({len(self.zones)} zones, worst {worst.zone}: "
            f"W2 {worst['w2_p95']:.3g} (95 %))"
        )

    @cached_property
    def indices(self) -> WrinkleMap:
        """The paper's six indices, per face."""
        return wrinkle_map(self.criteria, self._strains)

    @cached_property
    def surface(self) -> Surface:
        """What indices and measures look at."""
        return Surface(self.solution, self.indices, self.criteria)

    def values(self, name: str) -> FloatArray:
        """Values (m,) of an index of the registry, in its unit.

        Raises
        ------
        InputError
            No index of this name.
        """
        if name not in INDICES:
            raise InputError.single(
                "index", got=repr(name), expected=f"one of {', '.join(INDICES)}"
            )
        if name not in self._values:
            self._values[name] = INDICES[name].values(self.surface)
        return self._values[name]

    @property
    def fields(self) -> tuple[Field, ...]:
        """Every index of the registry, for exports."""
        return tuple(
            Field(
                name=index.export_name,
                unit=index.unit,
                meaning=index.meaning,
                values=self.values(index.name),
            )
            for index in INDICES.values()
        )

    @property
    def net(self) -> FloatArray:
        """W2 of what the design does not ask for, (m,) [1]."""
        return self.values("w2_net")

    @property
    def top(self) -> float:
        """Upper end of the range of W2 that maps show."""
        return map_top(self.indices)

    @cached_property
    def zones(self) -> tuple[ZoneRow, ...]:
        """Figures of every zone that has a face."""
        return zone_table(
            self.solution.cover,
            {name: self.values(name) for name in INDICES},
            criteria=self.criteria,
            unresolved=self.resolution.unresolved,
            known=self.solution.figures,
        )

    @property
    def share_above_one(self) -> float:
        """Share of the area on which W2 is above 1, free edges left out."""
        inner = [(row.area, row["w2_area_share"]) for row in self.zones if row.zone != FREE_EDGE]
        area = sum(a for a, _ in inner)
        return sum(a * share for a, share in inner) / area if area else 0.0

    @cached_property
    def resolution(self) -> Resolution:
        """Whether the mesh carries what the result says."""
        return resolution(self.solution)

    @cached_property
    def wrinkles(self) -> tuple[Wrinkle, ...]:
        """The five worst wrinkles, the worst first; then what lies at ties and corners."""
        return worst_wrinkles(
            self.solution,
            self.indices,
            count=WORST,
            unresolved=self.resolution.unresolved,
            wavelengths=self._wavelengths,
        )

    @property
    def _wavelengths(self) -> tuple[float | None, ...]:
        """Wavelength [m] of the shortest wrinkle of each panel, None where there is no foam."""
        known = {wave.material: wave.wavelength for wave in self.resolution.waves}
        return tuple(known.get(material.name) for material in self.solution.cover.materials)

    @cached_property
    def stretches(self) -> tuple[SeamStretch, ...]:
        """By how much one side of every seam is too long, from notch to notch."""
        return seam_excess(self.solution, unresolved=self.resolution.unresolved)

    @cached_property
    def advice(self) -> tuple[Advice, ...]:
        """What to change, the largest first: seams, then wrinkles that no seam explains."""
        return advise(self.solution, self.stretches, self.wrinkles)

    @cached_property
    def sections(self) -> tuple[Section, ...]:
        """The height profile across each of the worst wrinkles, the intended shape beside it."""
        cover = self.solution.cover
        # The low pass is the dearest step, and its shape is shown beside sections only.
        near = beside_sections(cover, self.wrinkles, 1.5 * DESIGN_WAVELENGTH)
        intended = low_passed(cover, self.solution.positions, within=near)
        return tuple(section_across(self.solution, w, design=intended) for w in self.wrinkles)

    @cached_property
    def distortion(self) -> Distortion:
        """What the making does to the texture, per face."""
        return distortion(self.solution)

    @cached_property
    def distortion_rows(self) -> tuple[DistortionRow, ...]:
        """The same for every zone."""
        return distortion_table(self.solution, self.distortion)

    @cached_property
    def gap(self) -> FloatArray:
        """Distance (m,) [m] from the foam as drawn; above 0 the cover stands off."""
        return gap(self.solution)

    @property
    def zone_gaps(self) -> tuple[ZoneGap, ...]:
        """The same for every zone."""
        return zone_gaps(self.solution, self.gap)

    @cached_property
    def deviation(self) -> FloatArray:
        """Distance (m,) [m] from the design surface.

        Raises
        ------
        InputError
            No design surface.
        """
        return deviation(self.solution, self._drawn)

    @property
    def zone_deviations(self) -> tuple[ZoneGap, ...]:
        """The same for every zone."""
        return zone_gaps(self.solution, self.deviation)

    @cached_property
    def seam_lines(self) -> tuple[SeamLine, ...]:
        """How far every seam lies from its line on the design surface."""
        return seam_lines(self.solution, self._drawn)

    @property
    def _drawn(self) -> Design:
        if self.design is None:
            raise InputError.single(
                "design", got="nothing", expected="a table [design] with a file"
            )
        return self.design

    def verdicts(self, scene: Scene) -> tuple[Verdict, ...]:
        """Compare the limits of [accept] that are on the figures of zones with what was reached.

        Raises
        ------
        InputError
            A limit on a zone without a face.
        """
        rows = {row.zone: row for row in self.zones}
        return tuple(
            Verdict(
                limit=limit,
                value=max(rows[zone][limit.measure] for zone in limited(limit, scene, tuple(rows))),
                resolved=self.resolution.resolved,
            )
            for limit in scene.limits
            if limit.measure not in SCORE_MEASURES
        )


def assess(
    solution: Solution,
    criteria: Criteria | None = None,
    *,
    strains: Strains | None = None,
    design: Design | None = None,
) -> Assessment:
    """Assess a result by the criteria that it carries, or by others.

    Parameters
    ----------
    criteria : None takes those of the result; a result without any takes its materials' own
    strains : to be assessed instead of the solution's, face by face, as for results of other
        programs, whose thickness changes within a panel
    design : surface that the finished cover is to have, for ``deviation``
    """
    cover = solution.cover
    chosen = criteria or cover.criteria or criteria_of(cover.materials, "tensor")
    return Assessment(solution, chosen, strains=strains, design=design)


def limited(limit: Limit, scene: Scene, zones: tuple[str, ...]) -> tuple[str, ...]:
    """Names of the zones that a limit is on: one zone, or all boxes of a class.

    Parameters
    ----------
    zones : those that have a face

    Raises
    ------
    InputError
        None of them.
    """
    names = scene.limited_zones(limit, zones)
    if not names:
        raise InputError.single(
            f"accept.{limit.zone}.{limit.measure}",
            got=f"no face in zone {limit.zone!r}",
            expected=f"one of {', '.join(zones)}",
            file=scene.path,
        )
    return names


def zones_with_faces(zone: np.ndarray, names: tuple[str, ...]) -> tuple[str, ...]:
    """Names of the zones that hold a face."""
    return tuple(names[k] for k in np.unique(zone))
