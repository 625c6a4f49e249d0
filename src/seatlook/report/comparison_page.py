"""The gallery page of several variants: what differs stands first."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType

from seatlook import files
from seatlook._version import __version__
from seatlook.chain.draw import map_ends
from seatlook.comparison.compare import Comparison
from seatlook.comparison.visibility import VariantScores
from seatlook.files import file_names
from seatlook.model.progress import Progress, silent
from seatlook.model.table import Table, number
from seatlook.report.page.data import PageData
from seatlook.report.page.types import Check, MapView, ScoreSection, Spot, WrinkleSection
from seatlook.report.page.write import write_page
from seatlook.report.sections.parameters import parameter_tables, parameter_toml
from seatlook.report.sections.rigs import rig_head
from seatlook.report.sections.wrinkles import section_of
from seatlook.wrinkle import INDICES

_TABLES = {
    "W2 mean": "w2_mean",
    "Share of area with W2 above 1": "w2_area_share",
    "W_stretch mean": "w_stretch_mean",
    "W_compression mean": "w_compression_mean",
}

_VISIBILITY = "Visibility of wrinkles (VWI, in thresholds of a model observer)"
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
        differences=_differences(comparison, scores),
        baseline=comparison.baseline,
        wrinkles=wrinkles,
        spots=wrinkles.spots,
        summary=tuple(_summary(comparison, scores)),
        facing=_facing(comparison, scores),
        score=None if scores is None else _marks(scores),
        toml=MappingProxyType(
            {
                f"{name}, {owner}": text
                for name, variant in comparison.variants.items()
                for owner, text in parameter_toml(variant.scene).items()
            }
        ),
        parameters=MappingProxyType(
            {
                f"{name}, {owner}": table
                for name, variant in comparison.variants.items()
                for owner, table in parameter_tables(variant.scene).items()
            }
        ),
        provenance=MappingProxyType(dict(_provenance(comparison))),
        status=", ".join(f"{n} {v.resolution.status}" for n, v in comparison.variants.items()),
        checks=tuple(_checks(comparison)),
        warnings=tuple(_warnings(comparison, scores)),
    )
    return write_page(data, folder, single_file=single_file)


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


def _summary(comparison: Comparison, scores: VariantScores | None) -> Iterator[str]:
    """How much each variant wrinkles, and where the others differ most from the first."""
    shares = {n: case.assessment.share_above_one for n, case in comparison.variants.items()}
    text = "; ".join(f"{name}: {number(100 * share)} %" for name, share in shares.items())
    yield f"Share of the cover with W2 above 1: {text}."
    first, *others = comparison.variants
    zone, *row = comparison.table("w2_mean").rows[0]
    means = dict(zip(comparison.variants, row, strict=False))
    away = dict(zip(others, row[len(means) :], strict=True))
    known = {name: float(v) for name, v in away.items() if v is not None}
    if known:
        most = max(known, key=lambda name: abs(known[name]))
        yield (
            f"They differ most in {zone}: mean of W2 {number(means[most])} in {most}, "
            f"{number(means[first])} in {first}."
        )
    if scores and scores.widest:
        name, texture, rig = scores.widest
        yield (
            f"Visibility differs most for {texture} under {rig}: VWI "
            f"{number(scores.vwi[name, texture, rig])} in {name}, "
            f"{number(scores.vwi[first, texture, rig])} in {first}."
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
    comparison: Comparison, scores: VariantScores | None
) -> MappingProxyType[str, Table]:
    """Parameters that are not the same in all scenes, visibility, then zones, each sorted."""
    return MappingProxyType(
        {
            "Parameters that differ": _different_parameters(comparison),
            **(
                {_VISIBILITY: _against(comparison, scores.table())} if scores and scores.vwi else {}
            ),
            "Do the means of W2 differ": _named(comparison, comparison.judged(), "w2_mean"),
            **{name: _zones(comparison, measure) for name, measure in _TABLES.items()},
        }
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


def _different_parameters(comparison: Comparison) -> Table:
    """Keys with another value in one of the scenes; a pattern differs by its seams' ease."""
    values_of: dict[str, dict[str, str]] = {}
    for name, variant in comparison.variants.items():
        for owner, table in parameter_tables(variant.scene).items():
            for key, value, *_ in table.rows:
                values_of.setdefault(f"{owner}: {key}", {})[name] = str(value)
        for seam in variant.scene.pattern.seams:
            lengths = [variant.scene.pattern.edge_length(e) for e in (seam.a, *seam.b)]
            text = " + ".join(f"{1e3 * length:.1f}" for length in lengths)
            values_of.setdefault(f"seam {seam.name}: lengths_mm", {})[name] = text
    names = tuple(comparison.variants)
    rows = tuple(
        (key, *(values.get(name) for name in names))
        for key, values in values_of.items()
        if len({values.get(name) for name in names}) > 1
    )
    return Table(heads=("key", *names), rows=rows or (("none", *(None for _ in names)),))


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
