"""Several variants of a cover in one gallery: the same camera, exposures and ranges."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import MappingProxyType

from seatlook import io, pbr
from seatlook.assembly import with_mesh
from seatlook.chain.case import Case
from seatlook.chain.companions import differs, seeds_for
from seatlook.chain.draw import map_ends
from seatlook.chain.files import RESULT
from seatlook.chain.local import with_scatter
from seatlook.comparison.cells import Cell, Contrast, cell_table
from seatlook.errors import InputError, did_you_mean
from seatlook.files import file_names
from seatlook.model import Camera, Scene
from seatlook.model.progress import Progress, silent
from seatlook.model.table import Table
from seatlook.model.zones import FREE_EDGE
from seatlook.wrinkle import INDICES, figure_names

Variant = Case | Scene | Path | str
_EQUAL = 1.2  # ratio of estimated errors up to which they count as equal


@dataclass(frozen=True, slots=True, kw_only=True)
class Comparison:
    """Variants by names; pictures are drawn when they are asked for, and once.

    Camera, rigs (with their exposures) and textures are those of the first variant, so that every
    picture of a rig compares with every other.

    Examples
    --------
    >>> comparison = compare(["fits.toml", "eased.toml"])          # doctest: +SKIP
    >>> comparison["eased", "suede", "sun"].save(Path("a.png"))    # doctest: +SKIP
    >>> comparison.show(("fits", "suede", "sun"), ("eased", "suede", "sun"))  # doctest: +SKIP
    """

    variants: MappingProxyType[str, Case]
    camera: Camera
    _drawn: dict[tuple[str, str, str], Cell] = field(default_factory=dict, repr=False)

    @property
    def baseline(self) -> str:
        """Name of the variant that the others are compared with."""
        return next(iter(self.variants))

    @property
    def first(self) -> Case:
        """The variant that the others are compared with."""
        return self.variants[self.baseline]

    @property
    def textures(self) -> tuple[str, ...]:
        """Names of the looks, in the order of the first variant's scene."""
        return tuple(self.first.scene.textures)

    @property
    def rigs(self) -> tuple[str, ...]:
        """Names of the rigs, in the order of the first variant's scene."""
        return tuple(rig.name for rig in self.first.scene.rigs)

    def __getitem__(self, names: tuple[str, str, str]) -> Cell:
        """Return the picture of (variant, texture, rig).

        Raises
        ------
        InputError
            A name that does not exist, with the nearest one.
        """
        if not isinstance(names, tuple) or len(names) != 3:
            raise InputError.single("cell", got=names, expected="[variant, texture, rig]")
        variant, texture, rig = names
        for what, name, known in (
            ("variant", variant, tuple(self.variants)),
            ("texture", texture, self.textures),
            ("rig", rig, self.rigs),
        ):
            if name not in known:
                raise _unknown(what, name, known)
        if names not in self._drawn:
            lit = next(r for r in self.first.scene.rigs if r.name == rig)
            image = pbr.render(
                self.variants[variant].solution,
                self.first.scene.textures[texture],
                rig=lit,
                camera=self.camera,
                surroundings=self.first.scene.surroundings,
            )
            self._drawn[names] = Cell(name=", ".join(names), png=image.to_png(), ev100=image.ev100)
        return self._drawn[names]

    def map(self, variant: str, index: str = "w2") -> Cell:
        """Draw an index of a variant in the range that all variants share.

        Raises
        ------
        InputError
            A name that does not exist, with the nearest one.
        """
        for what, name, known in (
            ("variant", variant, tuple(self.variants)), ("index", index, tuple(INDICES))
        ):  # fmt: skip
            if name not in known:
                raise _unknown(what, name, known)
        chosen, entry = self.variants[variant], INDICES[index]
        key = (variant, "map", index)
        if key not in self._drawn:
            values = chosen.assessment.values(index)
            picture = pbr.render_map(
                chosen.solution,
                values,
                camera=self.camera,
                title=f"{entry.symbol}, {variant}",
                unit=entry.unit,
                value_range=map_ends(entry, values, self.top),
            )
            self._drawn[key] = Cell(name=f"{variant}, {index}", png=picture.to_png())
        return self._drawn[key]

    @property
    def top(self) -> float:
        """Upper end of the range of every wrinkle map."""
        return max(case.assessment.top for case in self.variants.values())

    def table(self, measure: str = "w2_mean") -> Table:
        """Zones by variants with the difference from the first, the largest difference first.

        Raises
        ------
        InputError
            A measure that the zones do not have.
        """
        if measure not in figure_names():
            raise _unknown("measure", measure, figure_names())
        names = tuple(self.variants)
        values = {
            name: {row.zone: row[measure] for row in case.assessment.zones}
            for name, case in self.variants.items()
        }
        zones = [z for z in values[names[0]] if z != FREE_EDGE]
        rows: list[tuple[str, list[float | None], list[float | None]]] = []
        for zone in zones:
            means = [values[name].get(zone) for name in names]
            away = [None if v is None else v - values[names[0]][zone] for v in means[1:]]
            rows.append((zone, means, away))
        rows.sort(key=lambda row: -max((abs(v) for v in row[2] if v is not None), default=0.0))
        return Table(
            heads=(
                "zone",
                *(f"{measure}: {name}" for name in names),
                *(f"{name} - {names[0]}" for name in names[1:]),
            ),
            rows=tuple((zone, *means, *away) for zone, means, away in rows),
        )

    def judged(self) -> Table:
        """Zones by variants as ``table``, whether they differ, how many seeds that would take.

        They differ where the means are apart by more than mesh errors and scatter of both; None
        where those are not known, which ``precision`` measures. The seeds are those of each
        variant from which a difference of 20 % is seen, four times in five.
        """
        plain = self.table()
        rows = {
            name: {row.zone: row for row in case.assessment.zones}
            for name, case in self.variants.items()
        }
        figures = {name: case.solution.figures for name, case in self.variants.items()}
        first, *others = self.variants

        def answers(zone: str) -> tuple[str | float | None, ...]:
            base = rows[first][zone]
            pairs = [(name, rows[name].get(zone)) for name in others]
            apart = [None if row is None else differs(base, row) for _, row in pairs]
            needed = [None if row is None else seeds_for(row, figures[name]) for name, row in pairs]
            words = [None if answer is None else "yes" if answer else "no" for answer in apart]
            return (*words, *needed)

        return Table(
            heads=(
                *plain.heads,
                *(f"differs: {name}" for name in others),
                *(f"seeds for 20 %: {name}" for name in others),
            ),
            rows=tuple((*row, *answers(str(row[0]))) for row in plain.rows),
        )

    @property
    def unequal_error(self) -> str:
        """A sentence where variants are not compared at equal error; "" where they are."""
        errors = {}
        for name, case in self.variants.items():
            found = case.resolution
            if found.error is not None:
                errors[name] = found.error
            elif found.waves:
                errors[name] = max(wave.error for wave in found.waves)
        if not errors or max(errors.values()) <= _EQUAL * min(errors.values()):
            return ""
        text = ", ".join(f"{name} {100 * error:.2g} %" for name, error in errors.items())
        return (
            f"not compared at equal error: estimated error of W2 on a wave: {text}; "
            "a tolerance solves each to the same"
        )

    def show(self, a: tuple[str, str, str], b: tuple[str, str, str]) -> Contrast:
        """Lay picture ``b`` over ``a``; a notebook shows a slider between them."""
        return Contrast(a=self[a], b=self[b])

    def _repr_html_(self) -> str:
        texture = self.textures[0]
        return cell_table(
            rows=tuple(self.variants),
            columns=self.rigs,
            cell=lambda variant, rig: self[variant, texture, rig],
            corner=texture,
            below=self.table(),
        )

    def __repr__(self) -> str:
        return (
            f"Comparison({' x '.join(map(str, (len(self.variants), len(self.textures))))} x "
            f"{len(self.rigs)}: {', '.join(self.variants)}; {', '.join(self.textures)}; "
            f"{', '.join(self.rigs)})"
        )


def compare(
    scenes: Sequence[Variant] | Mapping[str, Variant],
    *,
    changes: Iterable[str] = (),
    results: Mapping[str, Path | str] = MappingProxyType({}),
    keep: Path | str | None = None,
    progress: Progress = silent,
) -> Comparison:
    """Solve several scenes, or read their results, and put them side by side.

    Parameters
    ----------
    scenes : two or more scenes, their files or cases, by names of your own if given; the others
        are compared with the first
    changes : values set over those of every scene's file, such as ``"mesh.seed=3"``
    results : name of a variant -> its result file, if it is solved already
    keep : folder for ``NAME/result.npz``; a result there is taken if it is converged and of all
        that goes into the variant
    progress : called with the step's name

    Raises
    ------
    InputError
        Fewer than two scenes, or a result of an unknown variant.
    SolverError, RenderError
    """
    variants = named_cases(scenes, changes)
    folders = file_names(variants)
    for name, path in results.items():
        if name not in variants:
            raise _unknown("results", name, tuple(variants))
        variants[name] = Case(variants[name].scene, solution=io.read_result(path))
    for name, case in variants.items():
        progress("solve", variant=name)
        kept = None if keep is None else Path(keep) / folders[name] / RESULT
        case.solve(None if name in results else kept, resume=True)
    first = next(iter(variants.values()))
    return Comparison(variants=MappingProxyType(variants), camera=first.camera(None))


def at_equal_error(
    variants: Mapping[str, Case], tolerance: float, progress: Progress = silent
) -> dict[str, Case]:
    """Solve each variant to one relative error of its zone means, on a mesh of its own.

    Materials are compared at equal error, not at equal element size. The results carry their
    errors and the scatter over seeds, so that ``Comparison.judged`` can say what differs.

    Raises
    ------
    InputError
        A tolerance out of bounds, and what ``Case.check`` finds, before the first solve.
    SolverError
    """
    cases = {
        name: Case(with_mesh(case.scene, tolerance=tolerance)) for name, case in variants.items()
    }
    for case in cases.values():
        case.check()
    result = {}
    for name, case in cases.items():
        solution = case.solve(progress=progress)
        scattered = with_scatter(case.scene, solution, progress=progress)
        result[name] = Case(case.scene, solution=scattered)
    return result


def named_cases(
    scenes: Sequence[Variant] | Mapping[str, Variant], changes: Iterable[str] = ()
) -> dict[str, Case]:
    """Two or more variants as cases by names, their own where none are given.

    Raises
    ------
    InputError
        Fewer than two, or a scene that cannot be read.
    """
    if len(scenes) < 2:
        raise InputError.single("scenes", got=len(scenes), expected="two or more")
    words = tuple(changes)
    if isinstance(scenes, Mapping):
        return {name: case_of(variant, words) for name, variant in scenes.items()}
    cases = [case_of(variant, words) for variant in scenes]
    return dict(zip(variant_names(cases), cases, strict=True))


def case_of(variant: Variant, changes: tuple[str, ...] = ()) -> Case:
    """The case of a scene, of its file read with some changes, or as it is given."""
    if isinstance(variant, Case):
        return variant
    return Case(variant if isinstance(variant, Scene) else io.load_scene(variant, changes=changes))


def variant_names(cases: Sequence[Case]) -> tuple[str, ...]:
    """Names of scenes, told apart by their files, then by numbers, where they are alike."""
    scenes = [case.scene for case in cases]
    for names in (
        [s.name for s in scenes],
        [s.path.stem if s.path else s.name for s in scenes],
        [s.path.parent.name if s.path else s.name for s in scenes],
    ):
        if len(set(names)) == len(names):
            return tuple(names)
    return tuple(f"{number} {scene.name}" for number, scene in enumerate(scenes, 1))


def with_size(comparison: Comparison, size: tuple[int, int]) -> Comparison:
    """The same variants in pictures of another size."""
    return replace(comparison, camera=replace(comparison.camera, size=size), _drawn={})


def _unknown(what: str, name: str, known: Sequence[str]) -> InputError:
    return InputError.single(
        what,
        got=repr(name),
        expected=f"one of {', '.join(known)}",
        hint=did_you_mean(name, known),
    )
