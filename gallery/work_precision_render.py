"""Work-precision diagram of the renderer: FLIP against CPU seconds, beside its peers.

Run it with: python gallery/work_precision_render.py

Truth is Mitsuba 3 with the same BRDF, lights and geometry (``path_tracer``), twice 256 samples per
pixel with different seeds, in full light 512; half the FLIP between both is its own floor. Pictures
of it are kept in out/render-reference, rows in docs/charts/work_precision_render.csv; delete either
to repeat it. A tier's time is that of a further picture with new material and lights: faces seen
are kept.
"""

from __future__ import annotations

import csv
import sys
import time
from collections import defaultdict
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

ROOT = Path(__file__).parents[1]
CHARTS = ROOT / "docs" / "charts"
TABLE = CHARTS / "work_precision_render.csv"
KEPT = ROOT / "out" / "render-reference"
sys.path.insert(0, str(ROOT / "tests"))

import matplotlib  # noqa: E402

matplotlib.use("Agg")
from matplotlib import pyplot as plt  # noqa: E402

from seatlook.model import Appearance, Rig  # noqa: E402
from seatlook.pbr.quality import TIERS, Quality  # noqa: E402
from seatlook.pbr.shading.studio import Studio  # noqa: E402
from support.reference.path_tracer import trace  # noqa: E402
from support.reference.render_error import DIRECT, FULL, camera, compare, look, relief_of, scene  # noqa: E402
from support.reference.stock_pbr import stock  # noqa: E402

COLUMNS = ("light", "case", "series", "parameter", "cpu_seconds", "flip", "block_error")
# Samples per pixel of one pass, and passes of each of two references.
SAMPLES = 64
PASSES = {"direct": 4, "full": 8}
COLOURS = {"seatlook": "C0", "seatlook, with grain": "C1", "Mitsuba 3": "C2", "PyVista PBR": "C3"}
BARS = {"direct": 0.006, "full": 0.02}


@dataclass(frozen=True)
class Case:
    """One picture of the set."""

    light: str
    rig: Rig
    material: str
    textured: bool

    @property
    def name(self) -> str:
        """Name in files and rows."""
        grain = "grain" if self.textured else "plain"
        return f"{self.rig.name}-{self.material}-{grain}"

    @property
    def appearance(self) -> Appearance:
        """Material as it is drawn."""
        return look(self.material, textured=self.textured)

    @property
    def depth(self) -> int:
        """Length of the paths."""
        return 2 if self.light == "direct" else 8


def cases() -> Iterator[Case]:
    """Yield leather and suede, plain and with grain, in direct and in full light."""
    for light, rigs in (("direct", DIRECT), ("full", FULL)):
        for rig in rigs.values():
            for material in ("black-leather", "suede"):
                for textured in (False, True):
                    yield Case(light, rig, material, textured)


def reference(studio: Studio, case: Case, which: int) -> np.ndarray:
    """Radiance by path tracing, from the disk where it has been made before."""
    passes = PASSES[case.light]
    path = KEPT / f"{case.name}-{passes * SAMPLES}-{which}.npy"
    if not path.exists():
        KEPT.mkdir(parents=True, exist_ok=True)
        seeds = 100 + 50 * which + np.arange(passes)
        np.save(path, sum(traced(studio, case, SAMPLES, int(s)) for s in seeds) / passes)
    return np.load(path)


def traced(studio: Studio, case: Case, spp: int, seed: int) -> np.ndarray:
    """Radiance by path tracing."""
    return trace(
        studio, case.appearance, rig=case.rig, camera=camera(), depth=case.depth, spp=spp,
        relief=relief_of(case.appearance), seed=seed,
    )  # fmt: skip


def drawn(studio: Studio, case: Case, tier: Quality) -> np.ndarray:
    """Radiance by seatlook."""
    return studio.render(case.appearance, rig=case.rig, camera=camera(), quality=tier).radiance


def contenders(studio: Studio, case: Case) -> Iterator[tuple[str, str, Callable[[], np.ndarray]]]:
    """Yield series, parameter and what makes the picture."""
    tiers = dict(TIERS)
    if case.light == "direct":
        # In direct light alone T3 has nothing to add, and T4 nothing but samples.
        del tiers["T3"]
        tiers["T4"] = replace(tiers["T4"], strata=0, bounces=0)
    for name, tier in tiers.items():
        yield "seatlook", name, lambda tier=tier: drawn(studio, case, tier)
    if case.textured:
        return
    for spp in (4, 16):
        yield "Mitsuba 3", str(spp), lambda spp=spp: traced(studio, case, spp, 9)
    if case.light == "direct":
        yield (
            "PyVista PBR",
            "",
            lambda: stock(studio, case.appearance, rig=case.rig, camera=camera()),
        )


def measure(wanted: Callable[[Case], bool] = lambda case: True) -> list[dict[str, str]]:
    """Return all rows, measuring those that are not in the table yet."""
    rows = list(csv.DictReader(TABLE.open())) if TABLE.exists() else []
    done = {(r["case"], r["series"], r["parameter"]) for r in rows}
    studio = Studio(scene())
    for case in filter(wanted, cases()):
        missing = [c for c in contenders(studio, case) if (case.name, *c[:2]) not in done]
        if not missing:
            continue
        first, second = (reference(studio, case, which) for which in (0, 1))
        truth = (first + second) / 2
        kwargs = {"rig": case.rig, "cover": cover_of(studio)}
        floor = compare(first, second, **kwargs)
        rows.append(row(case, "floor", "", 0.0, floor.flip / 2, floor.block / 2))
        for series, parameter, make in missing:
            make() if series == "seatlook" else None  # compiled, textures made, faces seen
            forget(studio)
            start = time.process_time()
            picture = make()
            spent = time.process_time() - start
            got = compare(truth, picture, **kwargs)
            rows.append(row(case, series, parameter, spent, got.flip, got.block))
            print(", ".join(rows[-1].values()), flush=True)
        write(rows)
    return rows


def forget(studio: Studio) -> None:
    """Drop what the last picture left of light; the faces seen stay."""
    values = studio._cache._values
    for key in [k for k in values if k[0] != "faces"]:
        del values[key]


def cover_of(studio: Studio) -> np.ndarray:
    """Share of each pixel that the cover fills."""
    width, height = camera().size
    return (studio.faces(camera(), 4) >= 0).reshape(height, 4, width, 4).mean(axis=(1, 3))


def row(case: Case, series: str, parameter: str, seconds: float, *errors: float) -> dict[str, str]:
    """Row of the table."""
    values = (case.light, case.name, series, parameter, f"{seconds:.3g}")
    return dict(zip(COLUMNS, (*values, *(f"{e:.3g}" for e in errors)), strict=True))


def write(rows: list[dict[str, str]]) -> None:
    """Write the table."""
    CHARTS.mkdir(parents=True, exist_ok=True)
    with TABLE.open("w", newline="") as file:
        table = csv.DictWriter(file, COLUMNS, lineterminator="\n")
        table.writeheader()
        table.writerows(rows)


def chart(rows: list[dict[str, str]]) -> None:
    """Draw the worst FLIP of each series over its mean time, direct and full light."""
    figure, panels = plt.subplots(1, 2, figsize=(9, 3.8), sharey=True, layout="constrained")
    for panel, (light, bar) in zip(panels, BARS.items(), strict=True):
        found = defaultdict(list)
        for r in rows:
            if r["light"] == light and r["series"] != "floor":
                grain = ", with grain" if r["case"].endswith("grain") else ""
                found[r["series"] + grain, r["parameter"]].append(
                    (float(r["cpu_seconds"]), float(r["flip"]))
                )
        series = defaultdict(list)
        for (name, parameter), points in found.items():
            seconds, flips = np.array(points).T
            series[name].append((seconds.mean(), flips.max(), parameter))
        for name, points in series.items():
            x, y, labels = zip(*points, strict=True)
            panel.loglog(x, y, "o-", label=name, color=COLOURS[name])
            for point in zip(labels, x, y, strict=True):
                panel.annotate(point[0], point[1:], xytext=(4, 4), textcoords="offset points")
        panel.axhline(bar, color="grey", lw=0.8, ls="--")
        panel.set(xlabel="CPU seconds of a picture, 640 x 360", title=f"{light} light")
        panel.xaxis.set_minor_formatter("")
        panel.set_xlim(0.15, 10)
        panel.grid(alpha=0.3)
    panels[0].set_ylabel("FLIP against path tracing, worst of the set")
    panels[0].legend()
    figure.savefig(CHARTS / "work_precision_render.svg")


if __name__ == "__main__":
    chart(measure())
