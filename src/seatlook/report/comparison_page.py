"""The gallery page of several variants: what differs stands first."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType
from typing import TypeVar

from seatlook import files
from seatlook._version import __version__
from seatlook.chain.draw import map_ends
from seatlook.chain.files import RESULT
from seatlook.comparison.changes import (
    Change,
    better,
    difference_tables,
    sight_changes,
    worse,
    zone_changes,
)
from seatlook.comparison.compare import Comparison
from seatlook.comparison.visibility import VariantScores
from seatlook.files import file_names
from seatlook.model import Scene
from seatlook.model.progress import Progress, silent
from seatlook.model.table import Table, number
from seatlook.report.page.data import PageData
from seatlook.report.page.types import Check, MapView, ScoreSection, Spot, WrinkleSection
from seatlook.report.page.write import write_page
from seatlook.report.sections.in_short import WORDS
from seatlook.report.sections.inputs import different_inputs, in_words
from seatlook.report.sections.parameters import parameter_tables, parameter_toml
from seatlook.report.sections.rigs import rig_head
from seatlook.report.sections.words import counted, listed
from seatlook.report.sections.wrinkles import section_of
from seatlook.report.viewer.section import variants_section
from seatlook.wrinkle import INDICES

_TABLES = {
    "W2 mean": "w2_mean",
    "Share of area with W2 above 1": "w2_area_share",
    "W_stretch mean": "w_stretch_mean",
    "W_compression mean": "w_compression_mean",
}

Changes = tuple[Change, ...]
T = TypeVar("T")
_WORST = 3  # wrinkles of each variant


def write_comparison(
    comparison: Comparison,
    folder: Path,
    *,
    scores: VariantScores | None = None,
    single_file: bool = False,
    progress: Progress = silent,
) -> Path:
    """Draw every cell and map into ``folder`` and write its ``index.html``.

    Parameters
    ----------
    scores : how visible the wrinkles are, marked in the grid and compared; None leaves that out

    Returns
    -------
    Path
        The page.
    """
    pictures = _pictures(comparison, folder, progress)
    wrinkles = _wrinkles(comparison)
    inputs = different_inputs({n: case.scene for n, case in comparison.variants.items()})
    zones, sights = zone_changes(comparison), sight_changes(scores) if scores else ()
    data = PageData(
        title=" against ".join(comparison.variants),
        camera=comparison.camera.name,
        size=comparison.camera.size,
        pixels_per_degree=comparison.camera.pixels_per_degree,
        textures=tuple(dict.fromkeys(row for row, _ in pictures)),
        rigs=tuple(rig_head(rig) for rig in comparison.first.scene.rigs),
        pictures=MappingProxyType(pictures),
        maps=tuple(_maps(comparison, folder)),
        zones=_zones(comparison, "w2_p95"),
        differences=_differences(comparison, inputs, zones, sights),
        baseline=comparison.baseline,
        wrinkles=wrinkles,
        spots=wrinkles.spots,
        summary=tuple(_summary(comparison, inputs, zones, sights)),
        facing=_facing(comparison, scores),
        score=None if scores is None else _marks(scores),
        toml=_each(comparison, parameter_toml),
        parameters=_each(comparison, parameter_tables),
        provenance=MappingProxyType(dict(_provenance(comparison))),
        verdict=listed(
            f"{WORDS[v.resolution.status]} ({n})" for n, v in comparison.variants.items()
        ),
        again=_again(comparison, folder),
        status=", ".join(f"{n} {v.resolution.status}" for n, v in comparison.variants.items()),
        checks=tuple(_checks(comparison)),
        warnings=tuple(_warnings(comparison, scores)),
        viewer=variants_section(
            comparison.variants,
            comparison.camera,
            results=_results(comparison, folder),
            top=comparison.top,
        ),
    )
    return write_page(data, folder, single_file=single_file)


def _each(
    comparison: Comparison, of: Callable[[Scene], Mapping[str, T]]
) -> MappingProxyType[str, T]:
    """Parts of every variant's scene by the names of both."""
    return MappingProxyType(
        {
            f"{name}, {owner}": part
            for name, variant in comparison.variants.items()
            for owner, part in of(variant.scene).items()
        }
    )


def _again(comparison: Comparison, folder: Path) -> str:
    """The command that makes the page as one file; without files of all scenes there is none."""
    paths = [case.scene.path for case in comparison.variants.values()]
    if not all(paths):
        return ""
    names = " ".join(f"{path.parent.name}/{path.name}" for path in paths if path)
    return f"seatlook compare {names} --out {folder.resolve().name} --single-file"


def _results(comparison: Comparison, folder: Path) -> dict[str, Path]:
    """Where the result of every variant is, if it is kept in the folder."""
    names = file_names(comparison.variants)
    return {name: folder / names[name] / RESULT for name in comparison.variants}


def _row(variant: str, texture: str) -> str:
    return f"{variant}: {texture}"


def _pictures(
    comparison: Comparison, folder: Path, progress: Progress
) -> dict[tuple[str, str], str]:
    """Draw every cell; variants of one texture lie below each other, under the same light."""
    pictures: dict[tuple[str, str], str] = {}
    variants, textures, rigs = (
        file_names(names) for names in (comparison.variants, comparison.textures, comparison.rigs)
    )
    steps = len(textures) * len(variants) * len(rigs)
    for texture in textures:
        for variant in variants:
            for rig in rigs:
                at = {"step": len(pictures), "steps": steps}
                progress("render", variant=variant, texture=texture, rig=rig, **at)
                path = f"variants/{variants[variant]}/{rigs[rig]}/{textures[texture]}.png"
                files.write_bytes(folder / path, comparison[variant, texture, rig].png)
                pictures[_row(variant, texture), rig] = path
    return pictures


def _summary(
    comparison: Comparison, inputs: Table, zones: Changes, sights: Changes
) -> Iterator[str]:
    """What changed in the inputs, then where it got worse, then better, each with its figures."""
    if len(comparison.variants) == 2:
        yield in_words(inputs)
    else:
        yield f"{len(inputs.rows)} inputs differ; the first table below lists them."
    yield _worst(comparison, zones, "wrinkles more", "mean W2")
    yield _best(zones, "wrinkles less", "mean W2")
    if sights:
        yield _worst(comparison, sights, "shows more", "VWI")
        yield _best(sights, "shows less", "VWI")
    if any(change.beyond is None for change in zones):
        yield (
            "Whether zones differ beyond mesh error and scatter is not known; "
            "--tolerance 0.1 solves each variant to a known error."
        )


def _worst(comparison: Comparison, changes: Changes, what: str, unit: str) -> str:
    """The first place that got worse, how much, and how many more there are."""
    bad = worse(changes)
    if not bad:
        return f"Nowhere it {what}."
    first = bad[0]
    more = f"; {len(bad) - 1} more below" if len(bad) > 1 else ""
    return (
        f"{first.variant} {what} than {comparison.baseline}, most in {first.place}: {unit} "
        f"{number(first.before)} → {number(first.after)}{more}."
    )


def _best(changes: Changes, what: str, unit: str) -> str:
    good = better(changes)
    if not good:
        return f"Nowhere it {what}."
    first = good[0]
    return (
        f"It {what} in {counted(len(good), 'place')}, most in {first.place}: {unit} "
        f"{number(first.before)} → {number(first.after)}."
    )


def _facing(
    comparison: Comparison, scores: VariantScores | None
) -> tuple[tuple[str, str], tuple[str, str]]:
    """The cells that differ most in visibility; without scores the first two variants' first."""
    first, second, *_ = comparison.variants
    widest = scores.widest if scores else None
    variant, texture, rig = widest or (second, comparison.textures[0], comparison.rigs[0])
    return (_row(first, texture), rig), (_row(variant, texture), rig)


def _marks(scores: VariantScores) -> ScoreSection:
    return ScoreSection(
        cells=MappingProxyType(
            {
                (_row(variant, texture), rig): vwi
                for (variant, texture, rig), vwi in scores.vwi.items()
            }
        )
    )


def _wrinkles(comparison: Comparison) -> WrinkleSection:
    """The worst wrinkles of every variant, each with a section across it and its place."""
    parts = {
        name: section_of(variant.assessment, comparison.camera, count=_WORST, distortion=False)
        for name, variant in comparison.variants.items()
    }
    heads = next(iter(parts.values())).worst.heads[1:]
    return WrinkleSection(
        worst=Table(
            heads=("wrinkle", *heads),
            rows=tuple(
                (f"{rank}, {name}", *cells)
                for name, part in parts.items()
                for rank, *cells in part.worst.rows
            ),
        ),
        profiles=tuple(
            replace(profile, name=f"{name}: {profile.name}")
            for name, part in parts.items()
            for profile in part.profiles
        ),
        distortion=None,
        maps=(),
        files=(),
        spots=tuple(
            # The number first: a long name is cut on a button.
            Spot(label=f"{spot.label}, {name}", x=spot.x, y=spot.y)
            for name, part in parts.items()
            for spot in part.spots
        ),
    )


def _maps(comparison: Comparison, folder: Path) -> Iterator[MapView]:
    names = file_names(comparison.variants)
    for index in INDICES.values():
        for variant, case in comparison.variants.items():
            path = f"maps/{names[variant]}/{index.name}.png"
            files.write_bytes(folder / path, comparison.map(variant, index.name).png)
            low, high = map_ends(index, case.assessment.values(index.name), comparison.top)
            yield MapView(
                name=f"{index.symbol}, {variant}",
                image=path,
                low=low,
                high=high,
                unit=index.unit,
                meaning=index.meaning,
            )


def _differences(
    comparison: Comparison, inputs: Table, zones: Changes, sights: Changes
) -> MappingProxyType[str, Table]:
    """What goes in, then worse and better, in shape and in appearance, then whole tables."""
    tables = {"What changed": inputs} | difference_tables(comparison, zones, sights)
    whole = {name: _zones(comparison, measure) for name, measure in _TABLES.items()}
    return MappingProxyType(
        {name: table for name, table in tables.items() if table.rows}
        | {"Seeds that tell zones apart": _named(comparison, comparison.judged(), "w2_mean")}
        | whole
    )


def _zones(comparison: Comparison, measure: str) -> Table:
    """The table of a measure, which is named above it and not in every head."""
    return _named(comparison, comparison.table(measure), measure)


def _named(comparison: Comparison, table: Table, measure: str) -> Table:
    """A table without the measure in its heads."""
    named = replace(table, heads=tuple(h.removeprefix(f"{measure}: ") for h in table.heads))
    return _against(comparison, named)


def _against(comparison: Comparison, table: Table) -> Table:
    """Heads of differences without the first variant, which the page names once."""
    minus = f" - {comparison.baseline}"
    heads = (f"change: {h.removesuffix(minus)}" if h.endswith(minus) else h for h in table.heads)
    return replace(table, heads=tuple(heads))


def _checks(comparison: Comparison) -> Iterator[Check]:
    for name, variant in comparison.variants.items():
        found = variant.resolution
        yield Check(name=name, value=found.status, limit="resolved", kept=found.resolved)


def _warnings(comparison: Comparison, scores: VariantScores | None) -> Iterator[str]:
    for name, variant in comparison.variants.items():
        if not variant.resolution.resolved:
            yield f"{name} is {variant.resolution.sentence}."
    if comparison.unequal_error:
        yield f"Variants are {comparison.unequal_error}."
    for name, reason in (scores.refused if scores else {}).items():
        yield f"{name} has no score: {reason}"
    cameras = {v.scene.cameras[0].name for v in comparison.variants.values()}
    if len(cameras) > 1:
        yield f"All pictures are taken from {comparison.camera.name}, the first variant's view."


def _provenance(comparison: Comparison) -> Iterator[tuple[str, str]]:
    yield "seatlook", __version__
    for name, variant in comparison.variants.items():
        yield f"{name}, run (sha256 of all that went in)", variant.solution.cover.scene_digest
        yield f"{name}, seed", str(variant.solution.cover.seed)
        yield f"{name}, element size h", f"{1e3 * variant.solution.cover.element_size:.2f} mm"
