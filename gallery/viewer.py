"""Pictures of the viewer against the renderer's `high`, its frames per second, its weight.

Run it with: python gallery/viewer.py RESULT.npz SCENE.toml [WIDTH HEIGHT [SAMPLES]]

Protocol of the renderer's chart: pixels of the object, exposure such that the reference's median is
18 % display grey, 67 pixels per degree for FLIP. Surroundings are off. Rows are printed as a table.
"""

from __future__ import annotations

import base64
import importlib
import json
import os
import shutil
import sys
import tempfile
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from types import MappingProxyType
from typing import Any

import numpy as np
from scipy import ndimage

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / "tests"))

from seatlook import io  # noqa: E402
from seatlook.chain.case import Case  # noqa: E402
from seatlook.io.material import read_material  # noqa: E402
from seatlook.model import Appearance, Rig, bulb, sun  # noqa: E402
from seatlook.pbr.quality import TIERS  # noqa: E402
from seatlook.report.viewer.section import viewer_section  # noqa: E402
from support.browsers import FLAGS  # noqa: E402
from support.probe import probe_page  # noqa: E402
from support.reference.render_error import compare  # noqa: E402

MATERIALS = ("black-leather", "bright-leather", "pvc", "suede", "woven")
SAMPLES = 16
LIGHTS = {
    "sun 70": sun(elevation_deg=70.0, azimuth_deg=200.0),
    "sun 20": sun(elevation_deg=20.0, azimuth_deg=200.0),
    "bulb 0.8 m": bulb(position_mm=(510.0, 510.0, 430.0)),
}
SKY = {"sun 70": 4000.0, "sun 20": 4000.0, "bulb 0.8 m": 1.0}


def looks() -> dict[str, Appearance]:
    """Every material without and with its grain."""
    out = {}
    for name in MATERIALS:
        grain = read_material(name).appearance
        out[f"{name}, plain"] = replace(grain, texture="none", texture_depth=0.0)
        out[f"{name}, grain"] = grain
    return out


def rigs() -> tuple[Rig, ...]:
    """Every light alone, and under a sky."""
    return tuple(
        Rig(name=f"{name}, {kind}", lights=(light,), ambient=SKY[name] * (kind == "full"))
        for kind in ("direct", "full")
        for name, light in LIGHTS.items()
    )


def picture(
    page: Any, look: int, rig: int, size: tuple[int, int], samples: int = SAMPLES
) -> np.ndarray:
    """Radiance (h, w, 3) of the viewer."""
    ask = "([look, rig, samples]) => window.probed.then((p) => p.picture(look, rig, samples))"
    text = page.evaluate(ask, [look, rig, samples])
    values = np.frombuffer(base64.b64decode(text), np.float32)
    return values.reshape(size[1], size[0], 3)[::-1]


def cpu_seconds() -> float:
    """CPU time of all processes that this one has started: those of the browser do the drawing."""
    table, spent = {}, {}
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            fields = stat.read_text().rpartition(")")[2].split()
        except OSError:
            continue  # has ended meanwhile
        pid = int(stat.parent.name)
        table[pid], spent[pid] = int(fields[1]), int(fields[11]) + int(fields[12])
    own, found = {os.getpid()}, 0
    while len(own) > found:
        found = len(own)
        own |= {pid for pid, parent in table.items() if parent in own}
    return sum(spent[pid] for pid in own - {os.getpid()}) / os.sysconf("SC_CLK_TCK")


def shadow_agreement(reference: np.ndarray, got: np.ndarray, covered: np.ndarray) -> float:
    """Share of pixels beyond 2 px of a shadow's edge that both find lit, or both dark."""
    lit, same = (x.sum(axis=2) > 0 for x in (reference, got))
    edge = ndimage.binary_dilation(lit, iterations=2) & ndimage.binary_dilation(~lit, iterations=2)
    away = covered & ~edge
    return float((lit == same)[away].mean())


def speed(page: Any) -> None:
    """Print what a frame and a picture at rest take at 1280 x 720, also as CPU time."""
    page.evaluate("() => window.probed.then((p) => p.resize(1280, 720))")
    for scale in (1, 2, 3, 4):
        before = cpu_seconds()
        ask = "(scale) => window.probed.then((p) => p.frames(10, scale))"
        taken = page.evaluate(ask, scale) / 10
        spent = (cpu_seconds() - before) / 10
        print(f"frame at 1/{scale}: {taken:.0f} ms, {1e3 * spent:.0f} ms of CPU")


def rest(page: Any, rigs: Sequence[Rig], names: Sequence[str]) -> None:
    """Print the CPU time of a picture at rest of 4 samples at 1280 x 720, under each light."""
    ask = "([look, rig]) => window.probed.then((p) => { p.choose(look, rig); return p.still(4); })"
    print("light | material | CPU s at rest")
    for k, rig in enumerate(rigs):
        for i, name in enumerate(names):
            if rig.ambient:
                page.evaluate(ask, [i, k])  # compiles
                before = cpu_seconds()
                page.evaluate(ask, [i, k])
                print(f"{rig.name} | {name} | {cpu_seconds() - before:.2f}")


def main() -> None:
    """Print the tables."""
    result, scene_file, *size = sys.argv[1:]
    width, height = map(int, size[:2]) if size else (640, 360)
    samples = int(size[2]) if len(size) > 2 else SAMPLES
    scene = io.load_scene(Path(scene_file))
    scene = replace(scene, rigs=rigs(), textures=MappingProxyType(looks()))
    case = Case(scene, solution=io.read_result(result))
    camera = replace(case.camera("front_34"), size=(width, height))
    section = viewer_section(case, camera)
    content = {**json.loads(section.content), "size": [width, height]}
    print(f"content {len(section.content) / 1e6:.2f} MB, script {len(section.script) / 1e3:.0f} kB")
    sync_api = importlib.import_module("playwright.sync_api")
    with sync_api.sync_playwright() as playwright, tempfile.TemporaryDirectory() as folder:
        browser = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=FLAGS)
        before = cpu_seconds()
        page = probe_page(browser, "pictures", content, Path(folder))
        page.set_default_timeout(0)
        said = page.evaluate("() => window.probed.then((p) => [p.opened, p.triangles])")
        spent = 1e3 * (cpu_seconds() - before)
        print(f"first frame: {said[0]:.0f} ms, {spent:.0f} ms of CPU; {said[1]:.0f} triangles")
        speed(page)
        rest(page, scene.rigs, list(scene.textures))
        page.evaluate(f"() => window.probed.then((p) => p.resize({width}, {height}))")
        print("light | material | FLIP | block error | shadow state")
        for k, rig in enumerate(scene.rigs):
            for i, (name, look) in enumerate(scene.textures.items()):
                # In direct light nothing comes from the seat itself.
                level = TIERS["T4"] if rig.ambient else replace(TIERS["T4"], bounces=0)
                image = case.render(look, rig=rig, camera=camera, quality=level)
                got = picture(page, i, k, camera.size, samples)
                covered = np.asarray(image.cover)
                found = compare(image.radiance, got, rig=rig, cover=covered)
                state = ""
                if not rig.ambient and name == "suede, plain":
                    agreed = shadow_agreement(image.radiance, got, covered == 1.0)
                    state = f"{100 * agreed:.1f} %"
                print(f"{rig.name} | {name} | {found.flip:.4f} | {found.block:.4f} | {state}")
        browser.close()


if __name__ == "__main__":
    main()
