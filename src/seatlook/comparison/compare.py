"""Several variants of a cover in one gallery: the same camera, exposures and ranges."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import MappingProxyType
from typing import TYPE_CHECKING

from seatlook import io, pbr
from seatlook.assembly import assemble
from seatlook.chain.evaluation import RESULT, picture_path, wrinkle_map
from seatlook.comparison.cells import Cell, Contrast, cell_table
from seatlook.errors import InputError, did_you_mean
from seatlook.model import Camera, Scene, Solution, WrinkleMap
from seatlook.model.progress import Progress
from seatlook.model.table import Table
from seatlook.solver import solve
from seatlook.wrinkle import ZoneRow, map_top, zone_table

if TYPE_CHECKING:
    from ipywidgets import Widget

    from seatlook.comparison.visibility import VariantScores

_MEASURES = ("w2_mean", "w2_p95", "w2_area_share", "w_stretch_mean", "w_compression_mean")


@dataclass(frozen=True, slots=True, kw_only=True)
class Variant:
    """One scene with its solution and what was found on it."""

    name: str
    scene: Scene
    solution: Solution
    indices: WrinkleMap
    zones: tuple[ZoneRow, ...]


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

    variants: MappingProxyType[str, Variant]
    camera: Camera
    _drawn: dict[tuple[str, str, str], Cell] = field(default_factory=dict, repr=False)

    @property
    def first(self) -> Variant:
        """The variant that the others are compared with."""
        return next(iter(self.variants.values()))

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
                raise InputError.single(
                    what, got=repr(name), expected=f"one of {', '.join(known)}",
                    hint=did_you_mean(name, known),
                )  # fmt: skip
        if names not in self._drawn:
            lit = next(r for r in self.first.scene.rigs if r.name == rig)
            image = pbr.render(
                self.variants[variant].solution,
                self.first.scene.textures[texture],
                rig=lit,
                camera=self.camera,
            )
            self._drawn[names] = Cell(name=", ".join(names), png=image.to_png(), ev100=image.ev100)
        return self._drawn[names]

    def map(self, variant: str, index: str = "w2") -> Cell:
        """Draw an index of a variant in the range that all variants share."""
        if variant not in self.variants or index not in self.first.indices.__slots__:
            raise InputError.single("map", got=f"{variant!r}, {index!r}", expected="known names")
        chosen, top = self.variants[variant], self.top
        key = (variant, "map", index)
        if key not in self._drawn:
            signed = index in ("c", "w1")
            picture = pbr.render_map(
                chosen.solution,
                getattr(chosen.indices, index),
                camera=self.camera,
                title=f"{index.upper()}, {variant}",
                unit="1",
                value_range=(-top if signed else 0.0, top),
            )
            self._drawn[key] = Cell(name=f"{variant}, {index}", png=picture.to_png())
        return self._drawn[key]

    @property
    def top(self) -> float:
        """Upper end of the range of every wrinkle map."""
        return max(map_top(v.indices) for v in self.variants.values())

    def table(self, measure: str = "w2_mean") -> Table:
        """Zones by variants with the difference from the first, the largest difference first.

        Raises
        ------
        InputError
            A measure that a zone's row does not have.
        """
        if measure not in _MEASURES:
            raise InputError.single(
                "measure", got=repr(measure), expected=f"one of {', '.join(_MEASURES)}",
                hint=did_you_mean(measure, _MEASURES),
            )  # fmt: skip
        names = tuple(self.variants)
        values = {
            name: {row.zone: float(getattr(row, measure)) for row in v.zones}
            for name, v in self.variants.items()
        }
        zones = [z for z in values[names[0]] if z != "free edge"]
        rows: list[tuple[str, list[float | None], list[float | None]]] = []
        for zone in zones:
            found = [values[name].get(zone) for name in names]
            away = [None if v is None else v - values[names[0]][zone] for v in found[1:]]
            rows.append((zone, found, away))
        rows.sort(key=lambda row: -max((abs(v) for v in row[2] if v is not None), default=0.0))
        return Table(
            heads=(
                "zone",
                *(f"{measure}: {name}" for name in names),
                *(f"{name} - {names[0]}" for name in names[1:]),
            ),
            rows=tuple((zone, *found, *away) for zone, found, away in rows),
        )

    def show(self, a: tuple[str, str, str], b: tuple[str, str, str]) -> Contrast:
        """Lay picture ``b`` over ``a``; a notebook shows a slider between them."""
        return Contrast(a=self[a], b=self[b])

    def visibility(self, progress: Progress | None = None) -> VariantScores:
        """Score every picture: a table of VWI, the largest difference first; takes minutes."""
        from seatlook.comparison.visibility import score_variants

        return score_variants(self, progress)

    def sliders(self) -> Widget:
        """Choose variant, texture and rig by sliders; needs the extra ``seatlook[notebook]``.

        Raises
        ------
        InputError
            ipywidgets is not installed.
        """
        from seatlook.comparison.widgets import sliders

        return sliders(self)

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
    scenes: Sequence[Scene | Path | str] | Mapping[str, Scene | Path | str],
    *,
    changes: Iterable[str] = (),
    results: Mapping[str, Path | str] = MappingProxyType({}),
    keep: Path | str | None = None,
    progress: Progress | None = None,
) -> Comparison:
    """Solve several scenes, or read their results, and put them side by side.

    Parameters
    ----------
    scenes : two or more, by names of your own if given; the others are compared with the first
    changes : values set over those of every scene's file, such as ``"mesh.seed=3"``
    results : name of a variant -> its result file, if it is solved already
    keep : folder for ``NAME/result.npz``; a result of the very scene that is there is taken
    progress : called with the step's name

    Raises
    ------
    InputError
        Fewer than two scenes, or a result of an unknown variant.
    SolverError, RenderError
    """
    if len(scenes) < 2:
        raise InputError.single("scenes", got=len(scenes), expected="two or more")
    words = tuple(changes)
    given = scenes.values() if isinstance(scenes, Mapping) else scenes
    read = [s if isinstance(s, Scene) else io.load_scene(s, changes=words) for s in given]
    names = tuple(scenes) if isinstance(scenes, Mapping) else variant_names(read)
    if _alike(names):
        raise InputError.single(
            "scenes", got=", ".join(names), expected="names that differ in letters or digits"
        )
    named = dict(zip(names, read, strict=True))
    for name in results:
        if name not in named:
            raise InputError.single("results", got=name, expected=f"one of {', '.join(named)}")
    variants = {}
    for name, scene in named.items():
        if progress is not None:
            progress("solve", variant=name)
        solution = (
            io.read_result(results[name])
            if name in results
            else _solved(scene, name, None if keep is None else Path(keep))
        )
        indices = wrinkle_map(scene, solution)
        variants[name] = Variant(
            name=name, scene=scene, solution=solution, indices=indices,
            zones=zone_table(solution, indices),
        )  # fmt: skip
    return Comparison(variants=MappingProxyType(variants), camera=read[0].cameras[0])


def variant_names(scenes: Sequence[Scene]) -> tuple[str, ...]:
    """Names of scenes, told apart by their files, then by numbers, where they are alike."""
    names = [scene.name for scene in scenes]
    if _alike(names):
        names = [s.path.stem if s.path else s.name for s in scenes]
    if _alike(names):
        names = [s.path.parent.name if s.path else s.name for s in scenes]
    if _alike(names):
        names = [f"{number} {name}" for number, name in enumerate(names, 1)]
    return tuple(names)


def _folder(name: str) -> str:
    """Folder of what belongs to a variant."""
    return Path(picture_path(name, name)).stem


def _alike(names: Sequence[str]) -> bool:
    """Whether two would share a folder: of "ease 4.0" and "ease 4.0 %" only one has pictures."""
    return len({_folder(name) for name in names}) < len(names)


def _solved(scene: Scene, name: str, keep: Path | None) -> Solution:
    """Take the kept result of this very scene, or solve and keep it."""
    path = None if keep is None else keep / _folder(name) / RESULT
    if path is not None and path.exists():
        solution: Solution = io.read_result(path)
        if (solution.cover.scene_digest, solution.cover.seed) == (scene.digest, scene.seed):
            return solution
    solution = solve(assemble(scene))
    if path is not None:
        io.write_result(solution, path)
    return solution


def with_size(comparison: Comparison, size: tuple[int, int]) -> Comparison:
    """The same variants in pictures of another size."""
    return replace(comparison, camera=replace(comparison.camera, size=size), _drawn={})
