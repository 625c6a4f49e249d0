"""The gallery page of several variants: what differs stands first."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from types import MappingProxyType

from seatlook import __version__, files
from seatlook.evaluation import MAPS, Progress, label, picture_path
from seatlook.report.comparison import Comparison
from seatlook.report.data import Check, MapView, PageData, Table
from seatlook.report.gather import rig_head
from seatlook.report.page import write_page
from seatlook.report.parameters import parameter_tables

_TABLES = {
    "W2 mean": "w2_mean",
    "Share of area with W2 above 1": "w2_area_share",
    "W_stretch mean": "w_stretch_mean",
    "W_compression mean": "w_compression_mean",
}


def write_comparison(
    comparison: Comparison,
    folder: Path,
    *,
    single_file: bool = False,
    progress: Progress | None = None,
) -> Path:
    """Draw every cell and map into ``folder`` and write its ``index.html``.

    Returns
    -------
    Path
        The page.
    """
    pictures, rows = {}, []
    for variant in comparison.variants:
        for texture in comparison.textures:
            row = f"{variant}: {texture}"
            rows.append(row)
            for rig in comparison.rigs:
                if progress is not None:
                    progress("render", variant=variant, texture=texture, rig=rig)
                path = f"variants/{picture_path(rig, variant).removeprefix('images/')}"
                path = f"{Path(path).with_suffix('')}/{Path(picture_path(texture, rig)).name}"
                files.write_bytes(folder / path, comparison[variant, texture, rig].png)
                pictures[row, rig] = path
    data = PageData(
        title=" against ".join(comparison.variants),
        camera=comparison.camera.name,
        size=comparison.camera.size,
        pixels_per_degree=comparison.camera.pixels_per_degree,
        textures=tuple(rows),
        rigs=tuple(rig_head(rig) for rig in comparison.first.scene.rigs),
        pictures=MappingProxyType(pictures),
        maps=tuple(_maps(comparison, folder)),
        zones=comparison.table("w2_p95"),
        differences=_differences(comparison),
        parameters=MappingProxyType(
            {
                f"{name}, {owner}": table
                for name, variant in comparison.variants.items()
                for owner, table in parameter_tables(variant.scene).items()
            }
        ),
        provenance=MappingProxyType(dict(_provenance(comparison))),
        status=", ".join(f"{n} {v.solution.status}" for n, v in comparison.variants.items()),
        checks=tuple(_checks(comparison)),
        warnings=tuple(_warnings(comparison)),
    )
    return write_page(data, folder, single_file=single_file)


def _maps(comparison: Comparison, folder: Path) -> Iterator[MapView]:
    for index, meaning in MAPS.items():
        for variant in comparison.variants:
            stem = Path(picture_path(index, variant)).parent.name
            path = f"maps/{stem}/{index}.png"
            files.write_bytes(folder / path, comparison.map(variant, index).png)
            yield MapView(
                name=f"{label(index)}, {variant}",
                image=path,
                low=-comparison.top if index == "w1" else 0.0,
                high=comparison.top,
                meaning=meaning,
            )


def _differences(comparison: Comparison) -> MappingProxyType[str, Table]:
    """Parameters that are not the same in all scenes, then zones, largest difference first."""
    return MappingProxyType(
        {
            "Parameters that differ": _different_parameters(comparison),
            **{name: comparison.table(measure) for name, measure in _TABLES.items()},
        }
    )


def _different_parameters(comparison: Comparison) -> Table:
    """Keys with another value in one of the scenes; a pattern differs by its seams' ease."""
    found: dict[str, dict[str, str]] = {}
    for name, variant in comparison.variants.items():
        for owner, table in parameter_tables(variant.scene).items():
            for key, value, *_ in table.rows:
                found.setdefault(f"{owner}: {key}", {})[name] = str(value)
        for seam in variant.scene.pattern.seams:
            lengths = [variant.scene.pattern.edge_length(e) for e in (seam.a, *seam.b)]
            text = " + ".join(f"{1e3 * length:.1f}" for length in lengths)
            found.setdefault(f"seam {seam.name}: lengths_mm", {})[name] = text
    names = tuple(comparison.variants)
    rows = tuple(
        (key, *(values.get(name) for name in names))
        for key, values in found.items()
        if len({values.get(name) for name in names}) > 1
    )
    return Table(heads=("key", *names), rows=rows or (("none", *(None for _ in names)),))


def _checks(comparison: Comparison) -> Iterator[Check]:
    for name, variant in comparison.variants.items():
        status = variant.solution.status
        yield Check(name=name, value=status, limit="converged", kept=status == "converged")


def _warnings(comparison: Comparison) -> Iterator[str]:
    for name, variant in comparison.variants.items():
        if variant.solution.status != "converged":
            yield f"{name} is not converged: {variant.solution.reason}."
    cameras = {v.scene.cameras[0].name for v in comparison.variants.values()}
    if len(cameras) > 1:
        yield f"All pictures are taken from {comparison.camera.name}, the first variant's view."


def _provenance(comparison: Comparison) -> Iterator[tuple[str, str]]:
    yield "seatlook", __version__
    for name, variant in comparison.variants.items():
        yield f"{name}, scene digest (sha256)", variant.scene.digest
        yield f"{name}, seed", str(variant.solution.cover.seed)
        yield f"{name}, element size h", f"{1e3 * variant.solution.cover.element_size:.2f} mm"
