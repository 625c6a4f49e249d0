"""The GLB in a real viewer: three.js in headless Chromium, served from memory, offline.

What it reads is looked at (sheen, coat, pictures, attributes), and where it draws the pictures.
"""

from __future__ import annotations

import base64
import importlib
import io
import json
import shutil
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from seatlook.io.export.writers import export_cover
from seatlook.model import Appearance, Material, TextureMaps, WrinkleMap
from seatlook.pbr import bake_grain
from support.io_samples import fields_of
from support.reference.lit_sheets import FABRIC, flat, sheet

pytestmark = pytest.mark.browser

# Chromium draws WebGL without a graphics card through SwiftShader.
FLAGS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
THREE = Path(sys.prefix) / "three" / "node_modules" / "three"
HOST = "http://viewer.test"
VIEWER = """<!doctype html><link rel="icon" href="data:,"><body style="margin:0">
<script type="importmap">{"imports": {"three": "/three/build/three.module.js",
  "three/addons/": "/three/examples/jsm/"}}</script>
<script type="module">
import * as THREE from "three";
import { GLTFLoader } from "three/addons/loaders/GLTFLoader.js";
const renderer = new THREE.WebGLRenderer({ preserveDrawingBuffer: true });
renderer.setSize(320, 160);
document.body.appendChild(renderer.domElement);
const scene = new THREE.Scene();
scene.background = new THREE.Color(0x404040);
// Straight above, world +y of the cover to the top of the picture: 0.2 m x 0.1 m fill it.
const camera = new THREE.OrthographicCamera(-0.1, 0.1, 0.05, -0.05, 0.1, 10);
camera.position.set(0, 1, 0);
camera.up.set(0, 0, -1);
camera.lookAt(0, 0, 0);
const sun = new THREE.DirectionalLight(0xffffff, 3);
sun.position.set(...LIGHT);
scene.add(sun);
const read = { meshes: [] };
try {
  const gltf = await new GLTFLoader().loadAsync("/seat.glb");
  scene.add(gltf.scene);
  gltf.scene.traverse((o) => {
    if (!o.isMesh) return;
    const m = o.material;
    read.meshes.push({
      name: o.name, type: m.type, sheen: m.sheen, sheenColor: m.sheenColor?.toArray(),
      clearcoat: m.clearcoat, roughness: m.roughness, map: m.map?.image?.width ?? null,
      normalMap: m.normalMap?.image?.width ?? null, attributes: Object.keys(o.geometry.attributes),
    });
  });
  renderer.render(scene, camera);
  read.pixels = renderer.domElement.toDataURL("image/png");
} catch (error) { read.error = String(error); }
window.read = read;
</script>"""


@pytest.fixture(scope="module")
def browser():
    sync_api = importlib.import_module("playwright.sync_api")
    assert THREE.is_dir(), "make browser installs three.js"
    with sync_api.sync_playwright() as playwright:
        chromium = playwright.chromium.launch(executable_path=shutil.which("chromium"), args=FLAGS)
        yield chromium
        chromium.close()


def view(browser, glb, light=(0, 1, 0)):
    """What the viewer read, and its pixels (160, 320, 3); nothing may leave the page."""
    lines = []

    def answer(route):
        path = route.request.url.removeprefix(HOST)
        if path == "/":
            page = VIEWER.replace("...LIGHT", ", ".join(map(str, light)))
            route.fulfill(body=page, content_type="text/html")
        elif path == "/seat.glb":
            route.fulfill(body=glb.read_bytes(), content_type="model/gltf-binary")
        elif path.startswith("/three/") and (THREE / path[7:]).is_file():
            route.fulfill(body=(THREE / path[7:]).read_bytes(), content_type="text/javascript")
        else:
            lines.append(path)
            route.abort()

    context = browser.new_context(viewport={"width": 320, "height": 160})
    page = context.new_page()
    page.on("console", lambda m: lines.append(m.text) if m.type in ("error", "warning") else None)
    page.on("pageerror", lambda error: lines.append(str(error)))
    page.route("**/*", answer)
    page.goto(HOST + "/")
    page.wait_for_function("window.read", timeout=120_000)
    read = page.evaluate("window.read")
    context.close()
    # The driver's note on reading the canvas back is not about the file.
    assert [text for text in lines if "GPU stall" not in text] == []
    assert "error" not in read, read["error"]
    content = base64.b64decode(read.pop("pixels").split(",")[1])
    return read, np.asarray(Image.open(io.BytesIO(content)).convert("RGB")).astype(float)


def cover(*looks):
    """Sheet of 0.2 m x 0.1 m, a panel for each appearance from left to right."""
    s = sheet(flat, size=0.2, steps=8, panels=len(looks))
    rest = s.cover.rest * [1.0, 0.5]
    x = s.positions * [1.0, 0.5, 1.0]
    materials = tuple(
        Material(name=f"look {k}", fabric=FABRIC, appearance=a) for k, a in enumerate(looks)
    )
    flat_cover = replace(s.cover, rest=rest, uv=rest, positions=x, materials=materials)
    return replace(s, cover=flat_cover, positions=x)


def written(tmp_path, *looks):
    solution = cover(*looks)
    c = np.linspace(-30.0, 30.0, len(solution.cover.faces))
    w2 = np.maximum(-c / 20, 0.0)
    zero = np.zeros_like(c)
    indices = WrinkleMap(c=c, w1=c / 20, w2=w2, r_stretch=zero, w_stretch=zero, w_compression=w2)
    export_cover(bake_grain(solution), fields_of(indices), tmp_path / "seat.glb")
    return tmp_path / "seat.glb"


def test_materials_pictures_and_attributes_arrive(browser, tmp_path):
    suede = Appearance(
        albedo=np.array([0.3, 0.2, 0.1]), roughness=0.9, sheen=np.array([0.3, 0.25, 0.2]),
        sheen_roughness=0.5, texture="suede", texture_scale=0.0007, texture_depth=1.2e-4,
    )  # fmt: skip
    leather = Appearance(
        albedo=np.full(3, 0.05), roughness=0.4, coat=0.3, coat_roughness=0.3, texture="leather",
        texture_scale=0.0012, texture_depth=6e-5,
    )  # fmt: skip
    # From the side: no highlight in the camera's way.
    read, pixels = view(browser, written(tmp_path, suede, leather), light=(1, 1, 0))
    first, second = sorted(read["meshes"], key=lambda m: m["name"])
    assert first["type"] == second["type"] == "MeshPhysicalMaterial"
    assert (first["sheen"], second["sheen"]) == (1, 0)
    assert first["sheenColor"] == pytest.approx([0.3, 0.25, 0.2])
    assert (first["clearcoat"], second["clearcoat"]) == (0, pytest.approx(0.3))
    assert [m["map"] for m in (first, second)] == [512, 512]
    assert [m["normalMap"] for m in (first, second)] == [512, 512]
    names = {"_w2", "_w_stretch", "_w_compression"}
    assert all(names <= set(m["attributes"]) for m in (first, second)), json.dumps(read)
    left, right = pixels[20:-20, 20:140], pixels[20:-20, 180:300]
    # Lit, brown beside black, and with grain.
    assert left.mean() > right.mean() + 20 > 25
    assert left[..., 0].mean() > 1.2 * left[..., 2].mean()
    assert min(left.std(), right.std()) > 1.0


def test_a_picture_stands_where_the_renderer_puts_it(browser, tmp_path):
    """Red, green, blue and white quarters, 40 mm wide and 20 mm high, upright at the origin."""
    quarters = np.zeros((8, 16, 3), dtype=np.uint8)
    quarters[:4, :8], quarters[:4, 8:] = (255, 0, 0), (0, 255, 0)
    quarters[4:, :8], quarters[4:, 8:] = (0, 0, 255), (255, 255, 255)
    maps = TextureMaps(folder="made", width=0.04, height=0.02, albedo=quarters)
    look = Appearance(albedo=np.ones(3), f0=0.0, roughness=1.0, maps=maps)
    _, pixels = view(browser, written(tmp_path, look))
    for u, v, channels in (
        (0.01, 0.015, (0,)), (0.03, 0.015, (1,)), (0.01, 0.005, (2,)), (0.03, 0.005, (0, 1, 2)),
        (-0.03, -0.025, (0,)),
    ):  # fmt: skip
        pixel = pixels[round(80 - 1600 * v), round(160 + 1600 * u)]
        lit = pixel > 0.6 * pixel.max()
        assert tuple(np.flatnonzero(lit)) == channels, (u, v, pixel)


@pytest.mark.parametrize("axis", [0, 1])
def test_relief_faces_the_light_that_it_faces(browser, tmp_path, axis):
    """A roof with its ridge across ``axis``: the side towards the light is the bright one."""
    normal = np.full((16, 16, 3), (128, 128, 230), dtype=np.uint8)
    tilt, other = 128 + 100, 128 - 100
    if axis == 0:
        normal[:, :8, 0], normal[:, 8:, 0] = other, tilt
    else:
        normal[8:, :, 1], normal[:8, :, 1] = other, tilt
    maps = TextureMaps(folder="made", width=0.1, height=0.1, normal=normal)
    look = Appearance(albedo=np.full(3, 0.5), f0=0.0, roughness=1.0, maps=maps)
    # World +x is +x of the file, world +y is its -z.
    light = (1, 1, 0) if axis == 0 else (0, 1, -1)
    _, pixels = view(browser, written(tmp_path, look), light)
    # Tiles meet in the middle of the picture. World +y is up there and v = 0 at its middle: the
    # lower half of a tile lies above it, the upper half of the next below.
    dark, bright = ((120, 200), (120, 280)) if axis == 0 else ((50, 200), (110, 200))
    levels = [
        pixels[row - 5 : row + 5, column - 5 : column + 5].mean() for row, column in (dark, bright)
    ]
    assert levels[1] > levels[0] + 20
